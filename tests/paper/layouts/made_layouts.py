"""Layouts in the forms of others, written from their formats, with one room: 4 x 3 m."""

import json

PX = 256 / 3.5
BED = ("double_bed", 2.0, 1.6, 0.5)  # name, front to back, side, height


def write(path, told):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(told))
    return path


def gpt_record(objects, *, unit="px", length=4.0, width=3.0, name="room-1"):
    """One record of LayoutGPT; objects are (name, left, top, depth, length, width, height, deg)."""
    scale = PX if unit == "px" else 1.0
    told = []
    for word, left, top, depth, long, wide, high, turned in objects:
        values = {"left": left, "top": top, "depth": depth, "length": long, "width": wide,
                  "height": high}  # fmt: skip
        told.append([word, {**{k: v * scale for k, v in values.items()}, "orientation": turned}])
    size = f"max length {length * scale:g}{unit}, max width {width * scale:g}{unit}"
    prompt = f"Condition:\nRoom Type: bedroom\nRoom Size: {size}\n"
    return {"query_id": name, "iter": 0, "prompt": prompt, "object_list": told}


def shell(x=4.0, y=3.0, z=2.5):
    """The six entries of I-Design that are no objects."""

    def entry(name, place, size, angle=0.0):
        return {
            "new_object_id": name,
            "position": dict(zip("xyz", place, strict=True)),
            "size_in_meters": dict(zip(("length", "width", "height"), size, strict=True)),
            "rotation": {"z_angle": angle},
        }

    return [
        entry("south_wall", (x / 2, 0, z / 2), (x, 0, z)),
        entry("north_wall", (x / 2, y, z / 2), (x, 0, z), 180.0),
        entry("east_wall", (x, y / 2, z / 2), (y, 0, z), 270.0),
        entry("west_wall", (0, y / 2, z / 2), (y, 0, z), 90.0),
        entry("middle of the room", (x / 2, y / 2, 0), (x, y, 0)),
        entry("ceiling", (x / 2, y / 2, z), (x, y, 0)),
    ]


def placed(name, place, size, angle=0.0, **more):
    """An object of I-Design."""
    return {
        "new_object_id": name,
        "position": dict(zip("xyz", place, strict=True)),
        "size_in_meters": dict(zip(("length", "width", "height"), size, strict=True)),
        "rotation": {"z_angle": angle},
        **more,
    }


def vlm_task(assets, *, sizes=True):
    """A scene file of LayoutVLM; assets are name -> (category, x, y, z of its bounding box)."""

    def asset(category, x, y, z):
        box = {"assetMetadata": {"boundingBox": {"x": x, "y": y, "z": z}}} if sizes else {}
        return {"annotations": {"category": category}, **box}

    return {
        "task_description": "a bedroom",
        "boundary": {
            "floor_vertices": [[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]],
            "wall_height": 2.5,
        },
        "assets": {name: asset(*of) for name, of in assets.items()},
    }
