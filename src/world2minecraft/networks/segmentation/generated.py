"""Labelled frames of generated rooms, to train on before real ones or beside them.

Half of the frames show plain colours, as virtual scans do, and half show textured surfaces with
the exposure and noise of a phone. The classes come from the names of the furniture. What NYU40
counts as other furniture or other props is ignored.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Camera
from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.networks.segmentation.frames import (
    IGNORED,
    NYU_CAMERA,
    LabelledFrame,
    labelled_frame,
)
from world2minecraft.procgen.rooms.recipes import TRAINING_KINDS
from world2minecraft.procgen.rooms.room import Room, generate_room
from world2minecraft.procgen.sensors.photo_rendering import (
    Photo,
    develop,
    expose,
    prepare_textured,
    take_photo,
)
from world2minecraft.procgen.sensors.trajectory import plan_trajectory

FIRST_SEED = 200_000  # Far from the seeds of benchmarks.
SIZE_PX = (320, 240)
FRAMES_PER_ROOM = 8
TEXTURED = 0.5  # Share of the frames with textures.
STRUCTURE = {
    SemanticClass.CEILING: "ceiling",
    SemanticClass.FLOOR: "floor",
    SemanticClass.WALL: "wall",
    SemanticClass.WINDOW: "window",
}
FURNITURE = {
    "armchair": "chair",
    "bag": "bag",
    "bath_cabinet": "cabinet",
    "bathtub": "bathtub",
    "bed": "bed",
    "books": "books",
    "bookshelf": "bookshelf",
    "box": "box",
    "chair": "chair",
    "coats": "clothes",
    "coffee_table": "table",
    "counter": "cabinet",
    "cupboard": "cabinet",
    "curtain": "curtain",
    "desk": "desk",
    "dining_table": "table",
    "door": "door",
    "dresser": "dresser",
    "filing_cabinet": "cabinet",
    "floor_lamp": "lamp",
    "fridge": "refrigerator",
    "kitchen_table": "table",
    "laundry": "clothes",
    "mirror": "mirror",
    "monitor": "television",
    "nightstand": "night stand",
    "office_chair": "chair",
    "pendant": "lamp",
    "picture": "picture",
    "shoe_cabinet": "cabinet",
    "sideboard": "cabinet",
    "sink_counter": "cabinet",
    "sofa": "sofa",
    "spiral_shelf": "shelves",
    "table_lamp": "lamp",
    "toilet": "toilet",
    "towel": "towel",
    "toy_shelf": "shelves",
    "tv": "television",
    "tv_board": "cabinet",
    "wall_cabinet": "cabinet",
    "wardrobe": "cabinet",
    "washstand": "cabinet",
    "whiteboard": "whiteboard",
}
# Tops with a class of their own, and where they begin above the foot of the furniture in metres.
TOPS = {
    "counter": ("counter", 0.86),
    "sink_counter": ("counter", 0.86),
    "washstand": ("sink", 0.74),
}


def voxel_classes(room: Room) -> np.ndarray:
    """Return the class of each voxel of a room, uint8 [X, Y, Z]: NYU40 ids minus 1."""
    ids = nyu40_names()
    of_class = np.full(256, IGNORED, np.uint8)
    for class_, name in STRUCTURE.items():
        of_class[int(class_)] = ids[name] - 1
    of_instance = np.full(len(room.objects) + 1, IGNORED, np.uint8)
    for number, item in enumerate(room.objects, 1):
        if item.name in FURNITURE:
            of_instance[number] = ids[FURNITURE[item.name]] - 1
    result = np.where(room.instance > 0, of_instance[room.instance], of_class[room.labels])
    heights_m = room.origin_m[2] + (np.arange(room.labels.shape[2]) + 0.5) * room.voxel_m
    for number, item in enumerate(room.objects, 1):
        if item.name in TOPS:
            name, begin_m = TOPS[item.name]
            is_top = heights_m > item.center_m[2] - item.size_m[2] / 2 + begin_m
            result[(room.instance == number) & is_top] = ids[name] - 1
    return result


def generate_frames(
    seeds: Iterable[int], per_room: int = FRAMES_PER_ROOM
) -> Iterator[LabelledFrame]:
    """Yield labelled frames of one generated room for each seed.

    Args:
        seeds: Seed of each room. The same seed gives the same frames.
        per_room: Number of frames of each room.
    """
    kinds = TRAINING_KINDS
    camera = NYU_CAMERA.scaled_to(*SIZE_PX)
    for seed in seeds:
        rng = np.random.default_rng([seed, 40])
        room = generate_room(
            seed, kind=kinds[seed % len(kinds)], clutter=float(rng.random()), shape=None
        )
        yield from _room_frames(room, camera, per_room, rng)


def _room_frames(
    room: Room, camera: Camera, count: int, rng: np.random.Generator
) -> Iterator[LabelledFrame]:
    classes = voxel_classes(room).reshape(-1)
    textured = prepare_textured(room, float(rng.uniform(0.3, 1.0)))
    poses = plan_trajectory(room, textured.photos.scene, camera, count, rng)
    for number, pose in enumerate(poses):
        photo = take_photo(textured.photos, camera, pose)
        colour = photo.colour
        if rng.random() < TEXTURED:
            colour = develop(expose(textured, camera, pose[None]), rng)
        labels = _labels(photo, classes)
        yield labelled_frame(f"{room.seed}-{number}", colour, labels, photo.depth_m, camera)


def _labels(photo: Photo, classes: np.ndarray) -> np.ndarray:
    labels = classes[np.maximum(photo.voxel_index, 0)]
    labels[photo.voxel_index < 0] = IGNORED
    return labels


def write_frames(folder: Path, frames: Iterable[LabelledFrame]) -> int:
    """Write frames as ``NAME.color.jpg``, ``NAME.depth.png`` (mm) and ``NAME.label40.png``.

    The depth has the size of the geometry channels. Labels are NYU40 ids minus 1.

    Args:
        folder: Folder to write to, which is made if it does not exist.
        frames: Frames whose camera is ``NYU_CAMERA``, scaled to their size.

    Returns:
        The number of frames.
    """
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    for frame in frames:
        Image.fromarray(frame.colour).save(folder / f"{frame.name}.color.jpg", quality=88)
        Image.fromarray(frame.labels).save(folder / f"{frame.name}.label40.png")
        depth_mm = np.rint(frame.depth_m * 1000).clip(0, 65535).astype(np.uint16)
        Image.fromarray(depth_mm).save(folder / f"{frame.name}.depth.png")
        count += 1
    return count


def read_frames(folder: Path) -> list[LabelledFrame]:
    """Read the frames written by ``write_frames``, in the order of their names.

    Raises:
        InputError: If there are none.
    """
    frames = []
    for path in sorted(folder.glob("*.label40.png")):
        name = path.name.removesuffix(".label40.png")
        colour = np.array(Image.open(folder / f"{name}.color.jpg").convert("RGB"))
        depth_m = np.array(Image.open(folder / f"{name}.depth.png")).astype(np.float32) / 1000
        camera = NYU_CAMERA.scaled_to(colour.shape[1], colour.shape[0])
        labels = np.array(Image.open(path))
        frames.append(LabelledFrame(name, colour, labels, camera, depth_m, depth_m))
    if not frames:
        raise InputError(folder, "contains no frames NAME.label40.png; write_frames makes them")
    return frames
