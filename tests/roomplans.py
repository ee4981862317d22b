"""RoomPlan JSON of a layout, written from Apple's published structures, apart from our reader.

``CapturedRoom`` and ``CapturedRoom.Surface`` and ``.Object`` as Swift's JSONEncoder writes them:
column-major transforms, metres, y up, a surface in its x-y plane, an object's front along its z.
"""

import uuid

import numpy as np

CATEGORIES = {
    "dining_table": "table",
    "kitchen_table": "table",
    "desk": "table",
    "coffee_table": "table",
    "chair": "chair",
    "armchair": "chair",
    "sofa": "sofa",
    "bed": "bed",
    "wardrobe": "storage",
    "bookcase": "storage",
    "sideboard": "storage",
    "counter": "storage",
    "wall_cabinet": "storage",
    "fridge": "refrigerator",
    "tv": "television",
}


def session_of(turn_deg=0.0, shift=(0.0, 0.0, 0.0)):
    """Return the 4x4 that carries our z-up frame to a session's: y up, turned and shifted."""
    a = np.radians(turn_deg)
    turn = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    to_y_up = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], float)
    pose = np.eye(4)
    pose[:3, :3] = turn @ to_y_up
    pose[:3, 3] = shift
    return pose


def transform(session, along, up, middle):
    """Sixteen numbers, column after column, of a box whose x runs along and whose y runs up."""
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2] = along, up, np.cross(along, up)
    pose[:3, 3] = middle
    return (session @ pose).T.reshape(-1).tolist()


def surface(session, start, end, bottom, top, category, **more):
    start, end = np.array([*start, 0.0]), np.array([*end, 0.0])
    length = float(np.linalg.norm(end - start))
    middle = (start + end) / 2 + [0, 0, (bottom + top) / 2]
    return {
        "identifier": str(uuid.UUID(int=round(length * 1e6) + round(bottom * 1e3))),
        "category": category,
        "dimensions": [length, top - bottom, 0],
        "transform": transform(session, (end - start) / length, [0, 0, 1.0], middle),
        "confidence": {"high": {}},
        "completedEdges": [],
        "polygonCorners": [],
        "curve": None,
        "parentIdentifier": None,
        "story": 0,
        **more,
    }


def thing(session, center, size, yaw_deg, category, **more):
    """``size`` is front-to-back, side, height; the front looks along ``yaw_deg``."""
    a = np.radians(yaw_deg)
    front = np.array([np.cos(a), np.sin(a), 0.0])
    along = np.cross([0, 0, 1.0], front)  # x cross y is z, the front.
    depth, width, height = size
    return {
        "identifier": str(uuid.UUID(int=round(abs(center[0]) * 1e6))),
        "category": {category: {}},
        "dimensions": [width, height, depth],
        "transform": transform(session, along, [0, 0, 1.0], center),
        "confidence": {"medium": {}},
        "attributes": [],
        "story": 0,
        **more,
    }


def captured_room(layout, session=None, floors=True):
    """Return a CapturedRoom of a layout, as RoomPlan would have seen it."""
    session = session_of() if session is None else session
    base = layout.floor_z_m
    corners = layout.floor_polygon_m
    walls = [
        surface(session, a, b, base, base + layout.wall_height_m, {"wall": {}})
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    ]
    kinds = {"door": ("doors", {"door": {"isOpen": False}}), "window": ("windows", {"window": {}})}
    kinds["doorway"] = ("openings", {"opening": {}})
    found = {"doors": [], "windows": [], "openings": []}
    for opening in layout.openings:
        key, category = kinds[opening.kind]
        heights = (base + opening.sill_m, base + opening.head_m)
        found[key].append(surface(session, opening.start_m, opening.end_m, *heights, category))
    objects = [
        thing(session, item.center_m, item.size_m, item.yaw_deg, CATEGORIES[item.name])
        for item in layout.objects
        if item.name in CATEGORIES
    ]
    return {
        "identifier": str(uuid.UUID(int=7)),
        "version": 2,
        "story": 0,
        "walls": walls,
        **found,
        "objects": objects,
        "floors": [floor(session, corners, base)] if floors else [],
        "sections": [{"label": "diningRoom", "center": [0, 0, 0], "story": 0}],
    }


def floor(session, corners, z):
    middle = np.array([*corners.mean(axis=0), z])
    local = [[x - middle[0], y - middle[1], 0.0] for x, y in corners]
    return {
        "identifier": str(uuid.UUID(int=9)),
        "category": {"floor": {}},
        "dimensions": [*np.ptp(corners, axis=0).tolist(), 0],
        "transform": transform(session, [1.0, 0, 0], [0, 1.0, 0], middle),
        "polygonCorners": local,
        "confidence": {"high": {}},
        "completedEdges": [],
        "curve": None,
        "parentIdentifier": None,
        "story": 0,
    }
