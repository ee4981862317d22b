"""What a refined scene is held to: true objects, no floaters, planes without holes.

Everything is carried into the run's own room frame. A scene is done when nothing is left of:

- objects that match no true one, and true ones that none matches: a match has the same class and
  a centre within 0.3 m (``metrics.objects``), all true objects asked for, also unseen ones;
- matched chairs, sofas and beds that look another quarter, be it the object or its furniture;
- floaters: parts of the occupancy, joined by corners, without structure, or of 30 cells and less;
- planes (the floor, the ceiling, each wall of the true room) of which 2 % and more are holes: no
  floor, ceiling, wall or window within two cells of the true face, where the truth has some.
  Places that nobody could see count: the wall behind a wardrobe, the floor under a bed.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from world2minecraft.coordinates import apply, invert_rigid
from world2minecraft.edit.scene import SceneDraft
from world2minecraft.evaluate.frames import truth_of_run, used_frames
from world2minecraft.evaluate.layout import in_room
from world2minecraft.evaluate.score import see_truth
from world2minecraft.evaluate.truth import Truth, read_instances
from world2minecraft.exchange.room import read_room
from world2minecraft.geometry.parts import connected_parts
from world2minecraft.metrics.objects import (
    TURN_TOLERANCE_DEG,
    TURNED_CLASSES,
    match_objects,
    turn_between_deg,
)
from world2minecraft.types import Layout, LayoutObject, OccupancyGrid, SceneObject

HOLE_SHARE = 0.02
NEAR_CELLS = 2  # A wall is found to a cell, and a cell of it lies half before its face.
SMALL_CELLS = 30
DOOR = np.uint8(254)  # Stands for cells with a door, while planes are looked for.


@dataclass(frozen=True, eq=False)
class TruePlane:
    """One plane: for each place of it the cells, int [N, K, 3], one of which must be structure."""

    name: str
    cells: np.ndarray
    normal_axis: int


@dataclass(frozen=True, eq=False)
class Wanted:
    """The truth of one scene in the frame and the cells of its reconstruction."""

    objects: tuple[LayoutObject, ...]
    labels: np.ndarray  # uint8 [X, Y, Z], 255 where no ray came
    instance: np.ndarray  # int64 [X, Y, Z], 0 or n for the n-th object
    planes: tuple[TruePlane, ...]


class Defects(NamedTuple):
    """What is wrong with a scene."""

    extra: tuple[int, ...]  # ids of objects
    missing: tuple[int, ...]  # indices of true objects
    turned: tuple[tuple[int, int], ...]  # an object and the true one that it matches
    floaters: tuple[np.ndarray, ...]  # cells int [N, 3] each
    holes: tuple[int, ...]  # indices of planes
    pairs: dict[int, int]  # true object to object, of all that match

    @property
    def total(self) -> int:
        """How many things are wrong."""
        return sum(len(part) for part in self[:5])


def wanted_of(run: Path, capture: Path) -> Wanted:
    """Return what a reconstruction should have been."""
    truth = truth_of_run(run, capture)
    grid, scan_to_room = read_room(run / "room.npz")
    room = see_truth(truth, used_frames(run, truth), scan_to_room, grid.voxel_m)
    labels = _on_grid(room.labels, room.reached.low, grid)
    seen = _on_grid(room.reached.scored.astype(np.uint8), room.reached.low, grid)
    (layout, *_) = in_room(truth.layouts, room.truth_to_room)
    instance = _instances(truth, room.truth_to_room, grid)
    doors = [n for n, one in enumerate(room.objects.objects, 1) if one.name == "door"]
    planes = _planes(layout, grid, np.where(np.isin(instance, doors), DOOR, labels))
    labels = np.where(seen == 1, labels, np.uint8(255))
    return Wanted(room.objects.objects, labels, instance, planes)


def defects_of(draft: SceneDraft, wanted: Wanted) -> Defects:
    """Return what is wrong with a scene."""
    found = sorted(draft.objects.values(), key=lambda one: one.id)
    pairs = match_objects(found, wanted.objects)
    mine, true = {m for m, _ in pairs}, {n for _, n in pairs}
    turned = [(found[m].id, n) for m, n in pairs if _looks_wrong(found[m], wanted.objects[n])]
    return Defects(
        tuple(one.id for m, one in enumerate(found) if m not in mine),
        tuple(n for n in range(len(wanted.objects)) if n not in true),
        tuple(turned),
        tuple(floating(draft)),
        tuple(n for n, p in enumerate(wanted.planes) if hole_share(draft, p) >= HOLE_SHARE),
        {n: found[m].id for m, n in pairs},
    )


def agreement(draft: SceneDraft, wanted: Wanted) -> float:
    """Return the share of the cells, occupied in the truth or here, whose class is right."""
    known = (wanted.labels != 255) & ((wanted.labels > 0) | (draft.labels % 255 > 0))
    return float(np.mean(draft.labels[known] == wanted.labels[known]))


def floating(draft: SceneDraft) -> list[np.ndarray]:
    """Return the cells int [N, 3] of each part that hangs in the air, the largest first."""
    labels = draft.labels
    parts, count = connected_parts((labels > 0) & (labels < 255))
    sizes = np.bincount(parts.ravel(), minlength=count + 1)
    structure = np.bincount(parts[(labels > 0) & (labels <= 4)], minlength=count + 1) > 0
    loose = ~structure | (sizes <= SMALL_CELLS)
    loose[0] = False
    if count:
        loose[int(sizes[1:].argmax()) + 1] = False
    if not loose.any():
        return []
    at = np.argwhere(loose[parts])
    numbers = parts[tuple(at.T)]
    return [at[numbers == one] for one in sorted(np.flatnonzero(loose), key=lambda n: -sizes[n])]


def hole_share(draft: SceneDraft, plane: TruePlane) -> float:
    """Return the share of a plane's places that no structure covers."""
    return float((~covered(draft, plane)).mean()) if len(plane.cells) else 0.0


def covered(draft: SceneDraft, plane: TruePlane) -> np.ndarray:
    """Return whether each place of a plane has structure, bool [N]."""
    labels = draft.labels[tuple(np.moveaxis(plane.cells, -1, 0))]
    return np.asarray(((labels >= 1) & (labels <= 4)).any(axis=1))


def _looks_wrong(one: SceneObject, true: LayoutObject) -> bool:
    if true.class_id not in TURNED_CLASSES:
        return False
    looks = [one.yaw_deg, *(90.0 * p.quarter_turns for p in one.placements)]
    return any(turn_between_deg(yaw, true.yaw_deg) > TURN_TOLERANCE_DEG for yaw in looks)


def _on_grid(values: np.ndarray, low: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return values of a box of room cells that begins at ``low`` on a grid; 255 beyond it."""
    shift = np.round(grid.origin_m / grid.voxel_m).astype(np.int64) - low
    cells = np.indices(grid.shape).reshape(3, -1).T + shift
    inside = ((cells >= 0) & (cells < values.shape)).all(axis=1)
    result = np.full(len(cells), 255, np.uint8)
    result[inside] = values[tuple(cells[inside].T)]
    return result.reshape(grid.shape)


def _instances(truth: Truth, truth_to_room: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return the true object that most of eight points of each cell lie in."""
    fine = read_instances(truth)
    room_to_truth = invert_rigid(truth_to_room)
    cells = np.indices(grid.shape).reshape(3, -1).T
    votes = np.zeros((len(cells), len(truth.objects) + 1), np.uint8)
    for corner in np.ndindex(2, 2, 2):
        points = grid.origin_m + (cells + 0.25 + 0.5 * np.array(corner)) * grid.voxel_m
        at = np.floor((apply(room_to_truth, points) - truth.origin_m) / truth.voxel_m)
        inside = ((at >= 0) & (at < fine.shape)).all(axis=1)
        owner = fine[tuple(np.where(inside[:, None], at, 0).astype(np.int64).T)]
        owner = np.where(inside & (owner <= len(truth.objects)), owner, 0)
        votes[np.arange(len(cells)), owner] += 1
    votes[:, 0] = 0
    return np.where(votes.any(axis=1), votes.argmax(axis=1), 0).reshape(grid.shape)


def _planes(layout: Layout, grid: OccupancyGrid, labels: np.ndarray) -> tuple[TruePlane, ...]:
    polygon, low = layout.floor_polygon_m, layout.floor_z_m
    step, high = grid.voxel_m, layout.floor_z_m + layout.wall_height_m
    x, y = (np.arange(a + step / 2, b, step) for a, b in zip(*_ends(polygon), strict=True))
    flat = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    found = [
        _plane(name, np.column_stack([flat, np.full(len(flat), z)]), 2, grid, labels)
        for name, z in (("floor", low), ("ceiling", high))
    ]
    heights = np.arange(low + step / 2, high, step)
    for number, (a, b) in enumerate(zip(polygon, np.roll(polygon, -1, axis=0), strict=True), 1):
        length = float(np.hypot(*(b - a)))
        along = (np.arange(step / 2, length, step) / length)[:, None] * (b - a) + a
        points = np.column_stack([np.repeat(along, len(heights), 0), np.tile(heights, len(along))])
        axis = 0 if abs((b - a)[0]) < abs((b - a)[1]) else 1
        found.append(_plane(f"wall {number}", points, axis, grid, labels))
    return tuple(found)


def _ends(polygon: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return polygon.min(axis=0), polygon.max(axis=0)


def _plane(
    name: str, points_m: np.ndarray, axis: int, grid: OccupancyGrid, labels: np.ndarray
) -> TruePlane:
    """Return the places of a plane that have structure in the truth, ``labels``, behind the face.

    Where a door or its frame stands in a wall, the wall has no hole.
    """
    middle = (points_m - grid.origin_m) / grid.voxel_m
    outward = 1 if np.median(middle[:, axis]) > grid.shape[axis] / 2 else -1
    steps = outward * (np.arange(NEAR_CELLS, -NEAR_CELLS, -1) - 0.5)  # From behind the face.
    cells = np.repeat(middle[:, None], len(steps), axis=1)
    cells[..., axis] += steps
    cells = np.floor(cells).astype(np.int64)
    # A grid may end a cell behind a face: what would lie beyond it is its last cell there.
    cells[..., axis] = np.clip(cells[..., axis], 0, grid.shape[axis] - 1)
    inside = ((cells >= 0) & (cells < grid.shape)).all(axis=(1, 2))
    cells = cells[inside]
    true = labels[tuple(np.moveaxis(cells[:, :NEAR_CELLS], -1, 0))]
    solid, door = ((true >= 1) & (true <= 4)).any(axis=1), (true == DOOR).any(axis=1)
    return TruePlane(name, cells[solid & ~door], axis)
