"""Truth put in after the later stages: labels, instances with their boxes, placements."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES, UNKNOWN
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.types import OBSERVED, UNSEEN, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.evaluation.scoring.score import TrueRoom, placed
from world2minecraft.evaluation.scoring.truth import read_instances
from world2minecraft.formats.objects import (
    read_objects,
    read_placements,
    write_objects,
    write_placements,
)
from world2minecraft.formats.room import read_room, write_room
from world2minecraft.furniture import template

OWN_CELLS = "cells"


def put_true_labels(out: Path, room: TrueRoom) -> None:
    """Give the cells of ``room.npz`` that rays came to their true labels, and no objects yet."""
    grid, scan_to_room = read_room(out / "room.npz")
    known = room.reached.scored & (room.labels != UNKNOWN)
    labels = np.where(known, room.labels, np.uint8(UNKNOWN))
    colour = np.stack(
        [placed(grid.colour[..., n], grid, room.reached, 0) for n in range(3)], axis=-1
    )
    result = OccupancyGrid(
        labels=labels,
        confidence=known.astype(np.float16),
        colour=colour,
        source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=grid.voxel_m,
        origin_m=room.reached.low * grid.voxel_m,
    )
    write_room(out / "room.npz", result, scan_to_room)


def put_true_objects(out: Path, room: TrueRoom) -> None:
    """Give the object cells of ``room.npz`` the true instances, and ``objects.json`` their boxes.

    The labels of ``room.npz`` are true already.
    """
    grid, scan_to_room = read_room(out / "room.npz")
    instance = carried_instances(room, grid)
    rows = []
    for number, item in enumerate(room.objects.objects, start=1):
        cells = np.argwhere(instance == number).astype(np.int32)
        if len(cells):
            rows.append(
                ObjectInstance(
                    id=number,
                    class_id=item.class_id,
                    center_m=item.center_m,
                    size_m=item.size_m,
                    yaw_deg=item.yaw_deg,
                    cells=cells,
                    confidence=1.0,
                )
            )
    write_room(out / "room.npz", replace(grid, instance=instance), scan_to_room)
    write_objects(out / "objects.json", tuple(rows))


def carried_instances(room: TrueRoom, grid: OccupancyGrid) -> np.ndarray:
    """Return uint16 [X, Y, Z]: of each object cell, the true object that most of it belongs to.

    Only objects of the cell's own class stand for election; 0 where there is none.
    """
    truth = room.truth
    fine_instance = read_instances(truth)
    cells = np.argwhere(np.isin(grid.labels, OBJECT_CLASSES))
    instance = np.zeros(grid.shape, np.uint16)
    if not len(cells):
        return instance
    room_to_truth = invert_rigid(room.truth_to_room)
    classes = np.array([0, *(item.class_id for item in room.objects.objects)])
    wanted = grid.labels[tuple(cells.T)]
    side = max(round(grid.voxel_m / truth.voxel_m), 1)
    votes = []
    for sub in np.ndindex(side, side, side):
        points = grid.origin_m + (cells + (np.array(sub) + 0.5) / side) * grid.voxel_m
        fine = np.floor((apply(room_to_truth, points) - truth.origin_m) / truth.voxel_m)
        inside = np.asarray(((fine >= 0) & (fine < truth.labels.shape)).all(axis=1))
        at = np.where(inside[:, None], fine, 0).astype(np.int64)
        owner = np.where(inside, fine_instance[tuple(at.T)], 0).astype(np.int64)
        owner[owner >= len(classes)] = 0
        votes.append(np.where(classes[owner] == wanted, owner, 0))
    instance[tuple(cells.T)] = _majority(np.stack(votes, axis=1), len(classes))
    return instance


def _majority(votes: np.ndarray, count: int) -> np.ndarray:
    """Return for each row of votes [N, S] the number other than 0 with most; the lowest of ties."""
    row = np.repeat(np.arange(len(votes)), votes.shape[1])
    pairs, times = np.unique(row * count + votes.reshape(-1), return_counts=True)
    owner, number = pairs // count, pairs % count
    times = np.where(number == 0, 0, times)
    order = np.lexsort((-number, times, owner))  # The last of each row has most votes.
    winner = np.zeros(len(votes), np.int64)
    winner[owner[order]] = number[order]
    return winner


def put_true_placements(out: Path, room: TrueRoom) -> None:
    """Move the furniture of ``placements.json`` to where the true objects stand, as they are.

    Of several pieces that stand for one object the largest one with a template does. A template
    that cannot be as large as the object leaves it to its own cells.
    """
    grid, _ = read_room(out / "room.npz")
    chosen = read_placements(out / "placements.json")
    result = []
    for instance in read_objects(out / "objects.json", grid):
        mine = [p for p in chosen if p.object_id == instance.id]
        if mine:
            best = max(mine, key=lambda p: (p.template != OWN_CELLS, float(p.size_m.prod())))
            result.append(_moved(best, instance))
    write_placements(out / "placements.json", tuple(result))


def _moved(placement: Placement, instance: ObjectInstance) -> Placement:
    true = replace(
        placement,
        center_m=instance.center_m,
        size_m=instance.size_m,
        quarter_turns=round(instance.yaw_deg / 90) % 4,
    )
    if true.template == OWN_CELLS:
        return true
    try:
        template(true.template).parts(true.size_m, true.parameters)
    except (World2MinecraftError, ValueError):
        return replace(true, template=OWN_CELLS, parameters={})
    return true
