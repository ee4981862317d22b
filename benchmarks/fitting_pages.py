"""Pages that show generated rooms built of plain cubes and of the calm set, side by side."""

from pathlib import Path

import numpy as np

from benchmarks.compare_builds import captioned, in_rows
from world2minecraft.build import BuildParameters, build_volume
from world2minecraft.files import write_bytes
from world2minecraft.render.preview import preview
from world2minecraft.report.pictures import as_png
from world2minecraft.rooms import Room, generate_room
from world2minecraft.rooms.voxels import SHELL
from world2minecraft.types import ObjectInstance, OccupancyGrid, Placement

STEP = 4  # Voxels of 2 cm along a cell.
FILLED = 0.125
PAGE_ROOMS = 3
PREVIEW_PX = (760, 570)


def grid_of(room: Room) -> OccupancyGrid:
    """Return a room's truth as 8 cm cells: a cell is what fills most of it, if an eighth is."""
    start = [SHELL % STEP] * 3
    crop = tuple(
        slice(a, a + (n - a) // STEP * STEP) for a, n in zip(start, room.labels.shape, strict=True)
    )
    keys = room.labels[crop].astype(np.int32) << 16 | room.instance[crop]
    blocks, colours = _cells(keys), _cells(room.colour[crop])
    ordered = np.sort(blocks, axis=-1)
    filled = (ordered > 0).sum(-1)
    # The middle of what is not empty: of two things in a cell the one that fills more of it.
    at = np.minimum(STEP**3 - (filled + 1) // 2, STEP**3 - 1)
    best = np.take_along_axis(ordered, at[..., None], -1)[..., 0]
    best[filled < FILLED * STEP**3] = 0
    own = (blocks == best[..., None]) & (best > 0)[..., None]
    weight = np.maximum(own.sum(-1), 1)[..., None]
    colour = (colours * own[..., None]).sum(-2) / weight
    labels = (best >> 16).astype(np.uint8)
    return OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=np.maximum(colour, labels[..., None] > 0).astype(np.uint8),
        source=np.ones(labels.shape, np.uint8),
        instance=(best & 0xFFFF).astype(np.uint16),
        voxel_m=STEP * room.voxel_m,
        origin_m=room.origin_m + SHELL % STEP * room.voxel_m,
    )


def _cells(values: np.ndarray) -> np.ndarray:
    """Return voxels [X, Y, Z, ...] as cells of STEP^3 of them, [X', Y', Z', 64, ...]."""
    x, y, z = (side // STEP for side in values.shape[:3])
    rest = values.shape[3:]
    split = values.reshape(x, STEP, y, STEP, z, STEP, *rest)
    order = (0, 2, 4, 1, 3, 5, *range(6, 6 + len(rest)))
    return split.transpose(order).reshape(x, y, z, STEP**3, *rest)


def things_of(room: Room, grid: OccupancyGrid) -> tuple[list[Placement], list[ObjectInstance]]:
    """Return a room's objects as placements of their own cells, and as instances."""
    placements, instances = [], []
    for number, one in enumerate(room.objects, 1):
        cells = np.argwhere(grid.instance == number).astype(np.int32)
        if not len(cells):
            continue
        turns = round(one.yaw_deg / 90) % 4
        low, high = cells.min(0), cells.max(0) + 1
        size = (high - low) * grid.voxel_m
        middle = grid.origin_m + (low + high) / 2 * grid.voxel_m
        own = size[[1, 0, 2]] if turns % 2 else size
        placements.append(Placement(number, one.class_id, "cells", middle, own, turns, 1.0))
        instances.append(ObjectInstance(number, one.class_id, middle, own, one.yaw_deg, cells, 1.0))
    return placements, instances


def write_pages(folder: Path, seeds: list[int], scales: list[float]) -> list[Path]:
    """Write a page for each scale with the first rooms on it; return their paths."""
    rooms = [generate_room(seed) for seed in seeds[:PAGE_ROOMS]]
    grids = [grid_of(room) for room in rooms]
    paths = []
    for scale in (scale for scale in scales if scale * STEP * rooms[0].voxel_m < 1):
        rows = []
        for room, grid in zip(rooms, grids, strict=True):
            row = []
            for shapes in ("cubes", "calm"):
                built = build_volume(
                    grid,
                    *things_of(room, grid),
                    corner_m=np.array([0.0, room.size_m[1]]),
                    blocks_per_metre=scale,
                    parameters=BuildParameters(style="voxels", shapes=shapes),
                )
                text = f"{room.kind} {room.seed}, {scale:g} per metre, {shapes}"
                row.append(captioned(preview(built, *PREVIEW_PX), text))
            rows.append(row)
        path = folder / f"fitting_{scale:g}.png"
        write_bytes(path, as_png(in_rows(rows)))
        paths.append(path)
    return paths
