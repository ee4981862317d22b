"""A generated room that is known exactly: its grid, its objects, its world and photos of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from world2minecraft.construction import build_volume
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import (
    BlockVolume,
    Camera,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.procgen import Room, generate_room
from world2minecraft.reconstruction.retrieval import place_templates
from world2minecraft.reconstruction.verification.photo_agreement import thing_numbers
from world2minecraft.reconstruction.verification.photo_samples import PhotoSample
from world2minecraft.rendering.voxel_camera import cast_voxels, prepare_voxels

COARSE = 4  # Voxels of the room along a cell of the grid.
CAMERA = Camera(120, 90, 75.0, 75.0, 60.0, 45.0)
STRUCTURE_NYU40 = {1: 22, 2: 2, 3: 1, 4: 9}


@dataclass(frozen=True, eq=False)
class VerifiedRoom:
    """A room with photos of it; ``placements`` are those of its true objects."""

    grid: OccupancyGrid
    instances: tuple[ObjectInstance, ...]
    placements: tuple[Placement, ...]
    samples: tuple[PhotoSample, ...]

    def volume(self, placements: Sequence[Placement]) -> BlockVolume:
        """Return the world with other furniture."""
        return build_volume(self.grid, placements, self.instances)


@cache
def verified_room(seed: int = 3, kind: str = "bathroom") -> VerifiedRoom:
    """Return a room with six photos of it."""
    room = generate_room(seed, kind=kind)
    grid = _grid(room)
    instances = _instances(room, grid)
    return VerifiedRoom(grid, instances, place_templates(grid, instances), _samples(room))


def _grid(room: Room) -> OccupancyGrid:
    """Return the grid whose cells hold what most of their occupied voxels hold, objects first."""
    shape = [side // COARSE * COARSE for side in room.labels.shape]
    inner = tuple(slice(side) for side in shape)
    numbers = _blocks(thing_numbers(room.labels, room.instance)[inner])
    best = np.where((numbers > 0).any(axis=3), numbers.max(axis=3), numbers.min(axis=3))
    place = (numbers == best[..., None]).argmax(axis=3)[..., None]
    labels = np.take_along_axis(_blocks(room.labels[inner]), place, 3)[..., 0]
    colour = np.stack(
        [
            np.take_along_axis(_blocks(room.colour[inner][..., band]), place, 3)[..., 0]
            for band in range(3)
        ],
        axis=3,
    )
    voxel_m = room.voxel_m * COARSE
    return OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=colour,
        source=np.ones(labels.shape, np.uint8),
        instance=np.maximum(best, 0).astype(np.uint16),
        voxel_m=voxel_m,
        origin_m=np.round(room.origin_m / voxel_m) * voxel_m,
    )


def _blocks(values: np.ndarray) -> np.ndarray:
    """Return the voxels of each cell along a last axis."""
    x, y, z = (side // COARSE for side in values.shape)
    split = values.reshape(x, COARSE, y, COARSE, z, COARSE).transpose(0, 2, 4, 1, 3, 5)
    return split.reshape(x, y, z, COARSE**3)


def _instances(room: Room, grid: OccupancyGrid) -> tuple[ObjectInstance, ...]:
    found = []
    for number, item in enumerate(room.objects, 1):
        cells = np.argwhere(grid.instance == number).astype(np.int32)
        if not len(cells):
            continue
        name = _entry(item.name)
        found.append(
            ObjectInstance(
                number,
                item.class_id,
                item.center_m,
                item.size_m,
                item.yaw_deg,
                cells,
                1.0,
                name.name if name else "",
                1.0 if name else 0.0,
            )
        )
    return tuple(found)


def _entry(name: str):
    vocabulary = read_vocabulary()
    return vocabulary.of_template(name) or vocabulary.find(name)


def _samples(room: Room) -> tuple[PhotoSample, ...]:
    scene = prepare_voxels(room.labels, room.voxel_m, room.origin_m)
    seen_of = np.zeros(len(room.objects) + 1, np.uint8)
    for number, item in enumerate(room.objects, 1):
        entry = _entry(item.name)
        seen_of[number] = entry.nyu40 if entry else 40
    structure = np.array([STRUCTURE_NYU40.get(number, 40) for number in range(256)], np.uint8)
    samples = []
    across, deep, _ = room.size_m
    for number in range(6):
        angle = np.pi * number / 3
        away = np.array([np.cos(angle), np.sin(angle), -0.45])
        eye = np.array([across / 2, deep / 2, 1.6]) - 0.25 * away * [across, deep, 0]
        pose = look_at(eye, eye + away)
        hits = cast_voxels(scene, CAMERA, pose)
        at = np.maximum(hits.voxel_index, 0)
        owner = room.instance.reshape(-1)[at]
        labels = room.labels.reshape(-1)[at]
        colour = room.colour.reshape(-1, 3)[at]
        seen = np.where(owner > 0, seen_of[owner], structure[labels])
        samples.append(
            PhotoSample(
                f"photo {number}", CAMERA, pose, colour, hits.depth_m, seen.astype(np.uint8), colour
            )
        )
    return tuple(samples)
