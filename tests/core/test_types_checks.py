"""Constructors: each rule has a value that breaks it and the exact sentence it is answered with."""

import numpy as np
import pytest

from world2minecraft.core import types

EYE = np.eye(4)
MIRROR = np.diag([-1.0, 1.0, 1.0, 1.0])
IS_MIRRORED = "but is mirrored (determinant -1.000); check for an axis flipped on export"
SHEARED = EYE + np.outer([1.0, 0, 0, 0], [0, 0.01, 0, 0])
OFF_LAST_ROW = EYE + np.outer([0, 0, 0, 1.0], [0, 0, 0.5, 0])
CAMERA = types.Camera(4, 3, 2.0, 2.0, 2.0, 1.5)


def zeros(*shape, dtype=np.uint8):
    return np.zeros(shape, dtype)


GRID_CELLS = types.GridCells(
    np.array([0, 255], np.uint8),
    zeros(2, dtype=np.float16),
    zeros(2, 3),
    np.array([1, 0], np.uint8),
    zeros(2, dtype=np.uint16),
)
PLACEMENT = types.Placement(1, 5, "chair", [1, 1, 0.4], [0.5, 0.5, 0.8], 1, 0.7)
SCENE_OBJECT = types.SceneObject(1, 5, [1, 1, 0.4], [0.5, 0.5, 0.8], 90.0, 0.5, (PLACEMENT,))

GOOD = {
    types.Camera: dict(width_px=4, height_px=3, fx_px=2.0, fy_px=2.0, cx_px=2.0, cy_px=1.5),
    types.View: dict(
        name="f1",
        camera_to_scan=EYE,
        colour=zeros(3, 4, 3),
        colour_camera=CAMERA,
        depth_m=zeros(3, 4, dtype=np.float32),
        depth_camera=CAMERA,
        labels=zeros(3, 4),
    ),
    types.Scan: dict(views=[], scan_to_room=EYE, room_size_m=[4, 3, 2.5], frames_used=["f1"]),
    types.PointEvidence: dict(
        view="f1",
        camera_m=[0, 0, 0],
        points_m=zeros(5, 3, dtype=np.float32),
        weight=zeros(5, dtype=np.float32),
        colour=zeros(5, 3),
        votes=zeros(5, 12, dtype=np.float16),
    ),
    types.GridEvidence: dict(
        view="f1",
        probabilities=zeros(2, 3, 4, 12, dtype=np.float16),
        seen=zeros(2, 3, 4, dtype=np.bool_),
        voxel_m=0.08,
        grid_to_scan=EYE,
    ),
    types.FusedEvidence: dict(
        log_odds=zeros(2, 3, 4, dtype=np.float16),
        votes=zeros(2, 3, 4, 12, dtype=np.float16),
        colour_sum=zeros(2, 3, 4, 3, dtype=np.float32),
        offset_sum=zeros(2, 3, 4, 3, dtype=np.float32),
        hits=zeros(2, 3, 4, dtype=np.uint16),
        voxel_m=0.08,
        origin_m=[0.16, -0.08, 0],
        scan_to_room=EYE,
    ),
    types.OccupancyGrid: dict(
        labels=np.full((2, 3, 4), 255, np.uint8),
        confidence=zeros(2, 3, 4, dtype=np.float16),
        colour=zeros(2, 3, 4, 3),
        source=zeros(2, 3, 4),
        instance=zeros(2, 3, 4, dtype=np.uint16),
        voxel_m=0.08,
        origin_m=[0, 0, -0.08],
    ),
    types.ObjectInstance: dict(
        id=1,
        class_id=5,
        center_m=[1, 1, 0.4],
        size_m=[0.5, 0.5, 0.8],
        yaw_deg=90.0,
        cells=zeros(2, 3, dtype=np.int32),
        confidence=0.5,
    ),
    types.Placement: dict(
        object_id=1,
        class_id=5,
        template="chair",
        center_m=[1, 1, 0.4],
        size_m=[0.5, 0.5, 0.8],
        quarter_turns=1,
        iou=0.7,
    ),
    types.Opening: dict(kind="door", start_m=[0, 0], end_m=[1, 0], sill_m=0.0, head_m=2.0),
    types.LayoutObject: dict(class_id=5, center_m=[1, 1, 0], size_m=[1, 1, 1], yaw_deg=0.0),
    types.Layout: dict(floor_polygon_m=[[0, 0], [4, 0], [4, 3]], wall_height_m=2.5),
    types.Entity: dict(position=(0.5, 64.0, 1.0), id="minecraft:cow"),
    types.BlockVolume: dict(
        states=zeros(2, 3, 4, dtype=np.uint16),
        palette=(types.AIR,),
        semantic=zeros(2, 3, 4),
        instance=zeros(2, 3, 4, dtype=np.uint16),
        corner=(0, 63, 0),
        block_to_room=EYE,
    ),
    types.GridCells: dict(
        labels=np.array([0, 255], np.uint8),
        confidence=zeros(2, dtype=np.float16),
        colour=zeros(2, 3),
        source=np.array([1, 0], np.uint8),
        instance=zeros(2, dtype=np.uint16),
    ),
    types.SceneObject: dict(
        id=1, class_id=5, center_m=[1, 1, 0.4], size_m=[0.5, 0.5, 0.8], yaw_deg=90.0, confidence=0.5
    ),
    types.Operation: dict(
        kind="fill",
        cells=np.array([[0, 0, 0], [1, 0, 0]], np.int32),
        before=GRID_CELLS,
        after=GRID_CELLS,
    ),
    types.Blocks: dict(
        states=np.array([0, 1], np.uint16),
        semantic=zeros(2),
        instance=zeros(2, dtype=np.uint16),
    ),
    types.BlockEdit: dict(
        kind="drop",
        cells=np.array([[0, 64, 0], [1, 64, 0]], np.int32),
        palette=(types.AIR, "minecraft:stone"),
        before=types.Blocks(np.ones(2, np.uint16), zeros(2), zeros(2, dtype=np.uint16)),
        after=types.Blocks(zeros(2, dtype=np.uint16), zeros(2), zeros(2, dtype=np.uint16)),
    ),
}

BAD = [
    (types.Camera, dict(width_px=0), "width_px must be 1 to 20000, got 0"),
    (types.Camera, dict(height_px=20_001), "height_px must be 1 to 20000, got 20001"),
    (types.Camera, dict(width_px=4.5), "width_px must be 1 to 20000, got 4.5"),
    (types.Camera, dict(fx_px=0.0), "fx_px must be above 0, got 0.0"),
    (types.Camera, dict(fy_px=float("nan")), "fy_px must be above 0, got nan"),
    (types.Camera, dict(cx_px=float("inf")), "cx_px, cy_px must be finite, got [inf, 1.5]"),
    (types.Camera, dict(distortion=(0.0,)), "distortion must have shape 5, got (1,)"),
    (
        types.View,
        dict(name="a/b"),
        "name must be a short printable name without slashes, got 'a/b'",
    ),
    (types.View, dict(name=""), "name must be a short printable name without slashes, got ''"),
    (
        types.View,
        dict(camera_to_scan=MIRROR),
        f"camera_to_scan must be a rotation and a translation, {IS_MIRRORED}",
    ),
    (
        types.View,
        dict(depth_to_colour=SHEARED),
        "depth_to_colour must be a rotation and a translation, but has a rotation that is not "
        "orthonormal; export it again",
    ),
    (
        types.View,
        dict(camera_to_scan=OFF_LAST_ROW),
        "camera_to_scan must be a rotation and a translation, but ends with the row "
        "[0.0, 0.0, 0.5, 1.0], not 0 0 0 1; transpose the matrix",
    ),
    (types.View, dict(camera_to_scan=np.eye(3)), "camera_to_scan must have shape 4x4, got (3, 3)"),
    (types.View, dict(colour_camera=None), "colour and colour_camera must be given together"),
    (types.View, dict(depth_m=None), "depth_m and depth_camera must be given together"),
    (types.View, dict(colour=zeros(4, 3, 3)), "colour must have shape 3x4x3, got (4, 3, 3)"),
    (types.View, dict(labels=zeros(4, 3)), "labels must have shape 3x4, got (4, 3)"),
    (
        types.View,
        dict(colour=None, colour_camera=None),
        "labels require a colour image",
    ),
    (types.View, dict(depth_m=zeros(3, 4)), "depth_m must be float32, got uint8"),
    (
        types.View,
        dict(depth_m=np.full((3, 4), np.nan, np.float32)),
        "depth_m must be finite and not negative (0 for missing depth)",
    ),
    (
        types.View,
        dict(depth_m=np.full((3, 4), -1, np.float32)),
        "depth_m must be finite and not negative (0 for missing depth)",
    ),
    (types.Scan, dict(room_size_m=[4, 0, 2]), "room_size_m must be above 0, got [4.0, 0.0, 2.0]"),
    (types.Scan, dict(world_up=[0, 2, 0]), "world_up must be a unit vector, got [0.0, 2.0, 0.0]"),
    (
        types.Scan,
        dict(scale="guessed"),
        "scale must be metric, estimated or unknown, got 'guessed'",
    ),
    (
        types.PointEvidence,
        dict(points_m=zeros(5, 3, dtype=np.float64)),
        "points_m must be float32, got float64",
    ),
    (
        types.PointEvidence,
        dict(points_m=zeros(5, 2, dtype=np.float32)),
        "points_m must have shape anyx3, got (5, 2)",
    ),
    (
        types.PointEvidence,
        dict(weight=zeros(4, dtype=np.float32)),
        "weight must have shape 5, got (4,)",
    ),
    (types.PointEvidence, dict(colour=zeros(4, 3)), "colour must have shape 5x3, got (4, 3)"),
    (
        types.PointEvidence,
        dict(votes=zeros(5, 11, dtype=np.float16)),
        "votes must have shape 5x12, got (5, 11)",
    ),
    (types.PointEvidence, dict(camera_m=[0, 0]), "camera_m must have shape 3, got (2,)"),
    (
        types.GridEvidence,
        dict(probabilities=zeros(2, 3, 4, 11, dtype=np.float16)),
        "probabilities must have shape anyxanyxanyx12, got (2, 3, 4, 11)",
    ),
    (types.GridEvidence, dict(seen=zeros(2, 3, 4)), "seen must be bool, got uint8"),
    (types.GridEvidence, dict(voxel_m=-0.08), "voxel_m must be above 0, got -0.08"),
    (
        types.GridEvidence,
        dict(grid_to_scan=MIRROR),
        f"grid_to_scan must be a rotation and a translation, {IS_MIRRORED}",
    ),
    (
        types.FusedEvidence,
        dict(votes=zeros(2, 3, 5, 12, dtype=np.float16)),
        "votes must have shape 2x3x4x12, got (2, 3, 5, 12)",
    ),
    (
        types.FusedEvidence,
        dict(hits=zeros(2, 3, 4, dtype=np.int32)),
        "hits must be uint16, got int32",
    ),
    (
        types.FusedEvidence,
        dict(origin_m=[0.04, 0, 0]),
        "origin_m must be a multiple of 0.08 m, got [0.04, 0.0, 0.0]",
    ),
    (
        types.OccupancyGrid,
        dict(labels=np.full((2, 3, 4), 12, np.uint8)),
        "labels must contain class ids 0 to 11 or 255, got 12",
    ),
    (
        types.OccupancyGrid,
        dict(labels=zeros(0, 3, 4)),
        "labels must not be empty, got shape (0, 3, 4)",
    ),
    (
        types.OccupancyGrid,
        dict(labels=zeros(2, 3, 4)),
        "labels must be 255 exactly where source is 0 (unseen)",
    ),
    (
        types.OccupancyGrid,
        dict(source=np.full((2, 3, 4), 3, np.uint8)),
        "source must be 0, 1 or 2, got 3",
    ),
    (
        types.OccupancyGrid,
        dict(source=np.ones((2, 3, 4), np.uint8)),
        "labels must be 255 exactly where source is 0 (unseen)",
    ),
    (
        types.OccupancyGrid,
        dict(confidence=np.full((2, 3, 4), np.nan, np.float16)),
        "confidence must be between 0 and 1",
    ),
    (
        types.OccupancyGrid,
        dict(colour=zeros(2, 3, 4)),
        "colour must have shape 2x3x4x3, got (2, 3, 4)",
    ),
    (
        types.OccupancyGrid,
        dict(origin_m=[0, 0, 0.01]),
        "origin_m must be a multiple of 0.08 m, got [0.0, 0.0, 0.01]",
    ),
    (types.ObjectInstance, dict(id=0), "id must be 1 to 65535, got 0"),
    (types.ObjectInstance, dict(id=65_536), "id must be 1 to 65535, got 65536"),
    (
        types.ObjectInstance,
        dict(class_id=3),
        "class_id must be an object class, 5 to 11, got 3",
    ),
    (types.ObjectInstance, dict(confidence=1.5), "confidence must be between 0 and 1, got 1.5"),
    (types.ObjectInstance, dict(yaw_deg=float("nan")), "yaw_deg must be finite, got [nan]"),
    (
        types.ObjectInstance,
        dict(cells=zeros(2, 3, dtype=np.int64)),
        "cells must be int32, got int64",
    ),
    (types.Placement, dict(quarter_turns=4), "quarter_turns must be 0 to 3, got 4"),
    (types.Placement, dict(iou=-0.1), "iou must be between 0 and 1, got -0.1"),
    (
        types.Placement,
        dict(template="../x"),
        "template must be a short printable name without slashes, got '../x'",
    ),
    (types.Opening, dict(kind="hatch"), "kind must be window, door or doorway, got 'hatch'"),
    (types.Opening, dict(sill_m=2.0), "sill_m must be below head_m, got 2.0 and 2.0"),
    (types.LayoutObject, dict(size_m=[1, 1, 0]), "size_m must be above 0, got [1.0, 1.0, 0.0]"),
    (
        types.Layout,
        dict(floor_polygon_m=[[0, 0], [1, 0]]),
        "floor_polygon_m must have 3 or more corners, got 2",
    ),
    (types.Layout, dict(wall_height_m=0), "wall_height_m must be above 0, got 0"),
    (
        types.BlockVolume,
        dict(palette=("minecraft:stone",)),
        "palette must start with minecraft:air, got ('minecraft:stone',)",
    ),
    (types.BlockVolume, dict(palette=()), "palette must start with minecraft:air, got ()"),
    (
        types.Entity,
        dict(position=(0.0, float("nan"), 1.0)),
        "position must be three finite numbers, got (0.0, nan, 1.0)",
    ),
    (
        types.BlockVolume,
        dict(states=np.ones((2, 3, 4), np.uint16)),
        "states has index 1, but the palette has 1 entries",
    ),
    (
        types.BlockVolume,
        dict(semantic=np.full((2, 3, 4), 99, np.uint8)),
        "semantic must contain class ids 0 to 11 or 255, got 99",
    ),
    (types.BlockVolume, dict(corner=(0, 63)), "corner must be three integers, got (0, 63)"),
    (
        types.GridCells,
        dict(source=zeros(2)),
        "labels must be 255 exactly where source is 0 (unseen)",
    ),
    (types.GridCells, dict(colour=zeros(3, 3)), "colour must have shape 2x3, got (3, 3)"),
    (
        types.GridCells,
        dict(confidence=np.full(2, 2, np.float16)),
        "confidence must be between 0 and 1",
    ),
    (types.SceneObject, dict(class_id=3), "class_id must be an object class, 5 to 11, got 3"),
    (
        types.SceneObject,
        dict(id=2, placements=(PLACEMENT,)),
        "placements of object 2 must have its id and class, got object 1 of class 5",
    ),
    (
        types.Operation,
        dict(cells=zeros(2, 3, dtype=np.int32)),
        "cells must not contain duplicates",
    ),
    (
        types.Operation,
        dict(cells=np.array([[0, 0, 0]], np.int32)),
        "before must have 1 cells, got 2",
    ),
    (
        types.Operation,
        dict(counts_as="paint"),
        "counts_as must be one of add, delete, orient, move, relabel, other, got 'paint'",
    ),
    (
        types.Operation,
        dict(objects_after=(SCENE_OBJECT, SCENE_OBJECT)),
        "objects_after must not contain duplicate objects, got [1, 1]",
    ),
    (
        types.Operation,
        dict(kind=""),
        "kind must be a short printable name without slashes, got ''",
    ),
    (types.Blocks, dict(semantic=zeros(3)), "semantic must have shape 2, got (3,)"),
    (
        types.BlockEdit,
        dict(cells=zeros(2, 3, dtype=np.int32)),
        "cells must not contain duplicates",
    ),
    (
        types.BlockEdit,
        dict(cells=np.array([[0, 64, 0]], np.int32)),
        "before must contain the blocks of 1 cells, got 2",
    ),
    (
        types.BlockEdit,
        dict(palette=(types.AIR,)),
        "before has index 1, but the palette has 1 entries",
    ),
    (
        types.BlockEdit,
        dict(
            after=types.Blocks(
                zeros(2, dtype=np.uint16),
                zeros(2),
                zeros(2, dtype=np.uint16),
                (types.BlockEntity((9, 9, 9), "minecraft:sign"),),
            )
        ),
        "after has data at (9, 9, 9), which is not one of its cells",
    ),
]


@pytest.mark.parametrize("kind", GOOD, ids=lambda kind: kind.__name__)
def test_a_good_value_is_taken(kind):
    assert isinstance(kind(**GOOD[kind]), kind)


@pytest.mark.parametrize(
    ("kind", "change", "message"), BAD, ids=lambda value: getattr(value, "__name__", "")
)
def test_a_bad_value_is_answered_with_a_sentence(kind, change, message):
    with pytest.raises(ValueError) as caught:
        kind(**{**GOOD[kind], **change})
    assert str(caught.value) == message


@pytest.mark.parametrize("kind", GOOD, ids=lambda kind: kind.__name__)
def test_a_value_cannot_be_changed(kind):
    value = kind(**GOOD[kind])
    name = next(iter(GOOD[kind]))
    with pytest.raises(AttributeError):
        setattr(value, name, None)
    held = [item for item in vars(value).values() if isinstance(item, np.ndarray)]
    assert all(not item.flags.writeable for item in held)


@pytest.mark.parametrize("kind", GOOD, ids=lambda kind: kind.__name__)
def test_a_callers_array_stays_its_own(kind):
    """Values hold views: the array that was given can still be written by its owner."""
    given = {name: item for name, item in GOOD[kind].items() if isinstance(item, np.ndarray)}
    kind(**GOOD[kind])
    assert all(item.flags.writeable for item in given.values())
