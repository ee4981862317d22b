"""Generated furnished rooms as grids of 8 cm, as a scan that saw all of them would give."""

from functools import cache

import numpy as np

from world2minecraft.core.types import OccupancyGrid, Placement
from world2minecraft.procgen import Room, generate_room
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.instances.parameters import InstanceParameters
from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates

STEP = 4  # Fine cells of 2 cm a cell.
FILLED = 0.125  # Of a cell, to count as occupied.
VOXEL_M = 0.08


@cache
def furnished_room(
    seed: int, kind: str | None = None
) -> tuple[OccupancyGrid, tuple[Placement, ...]]:
    """The grid of a generated room and the placements that stage 6 finds in it."""
    found = find_objects(true_grid(generate_room(seed, kind=kind)), InstanceParameters())
    return found.grid, tuple(place_templates(found.grid, found.instances, RetrievalParameters()))


@cache
def corner_of(seed: int, kind: str | None = None) -> tuple[float, float]:
    """The corner (x_min, y_max) of a generated room's inner box, in whole cells."""
    depth_m = generate_room(seed, kind=kind).size_m[1]
    return 0.0, float(np.round(depth_m / VOXEL_M) * VOXEL_M)


def true_grid(room: Room) -> OccupancyGrid:
    """A room in cells of 8 cm whose origin is a whole number of cells."""
    low = np.floor(room.origin_m / VOXEL_M + 1e-6).astype(int)
    before = np.rint((room.origin_m - low * VOXEL_M) / room.voxel_m).astype(int)
    after = -(np.array(room.labels.shape) + before) % STEP
    pads = [*zip(before.tolist(), after.tolist(), strict=True)]
    labels = _blocks(np.pad(room.labels, pads))
    instance = _blocks(np.pad(room.instance, pads))
    colour = _blocks(np.pad(room.colour, [*pads, (0, 0)]).astype(np.float32))
    filled = labels > 0
    share = filled.mean(-1)
    kinds = np.arange(1, 12)
    counts = np.stack([(labels == kind).sum(-1) for kind in kinds], -1)
    chosen = np.where(share >= FILLED, kinds[counts.argmax(-1)], 0).astype(np.uint8)
    own = labels == chosen[..., None]
    numbers = np.where(own, instance, 0).max(-1) * (chosen > 4)
    mean = (colour * own[..., None]).sum(-2) / np.maximum(own.sum(-1), 1)[..., None]
    return OccupancyGrid(
        labels=chosen,
        confidence=np.ones(chosen.shape, np.float16),
        colour=mean.astype(np.uint8) * (chosen > 0)[..., None].astype(np.uint8),
        source=np.ones(chosen.shape, np.uint8),
        instance=numbers.astype(np.uint16),
        voxel_m=VOXEL_M,
        origin_m=low * VOXEL_M,
    )


def _blocks(values: np.ndarray) -> np.ndarray:
    """Group an array [4X, 4Y, 4Z, ...] to [X, Y, Z, 64, ...]."""
    x, y, z = (side // STEP for side in values.shape[:3])
    rest = values.shape[3:]
    split = values.reshape(x, STEP, y, STEP, z, STEP, *rest)
    return split.transpose(0, 2, 4, 1, 3, 5, *range(6, 6 + len(rest))).reshape(x, y, z, 64, *rest)
