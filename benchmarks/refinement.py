"""Scripted refinement of a scene: what is wrong with it, and the next operation of the script.

Everything is expressed in the run's own room frame. A scene is done when none of these remains:

- objects that match no true one, and true ones without a match: a match has the same class and a
  centre within 0.3 m (``evaluation.metrics.objects``), for all true objects including unseen ones;
- matched chairs, sofas and beds with a wrong orientation, of the object or of its furniture;
- floaters: parts of the occupancy, connected by corners, without structure or of at most 30 cells;
- planes (the floor, the ceiling, each wall of the true room) of which 2 % or more are holes: no
  floor, ceiling, wall or window within two cells of the true face, where the truth has some.
  Places that cannot be seen count: the wall behind a wardrobe, the floor under a bed.

The script knows the truth, as a person knows the room, and uses only the editor's commands: each is
one operation on one object, one plane or one connected region. It tries each operation that the
defects suggest, on the draft and back again, and takes the one that leaves the fewest defects; of
equal ones the one that leaves most cells correct. If no single operation helps, a split is tried
together with the operation that follows it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Layout, LayoutObject, OccupancyGrid, SceneObject
from world2minecraft.editing.scene import SceneDraft, Tools, parse_command, runs_of_cells
from world2minecraft.editing.scene.plane_detection import find_planes
from world2minecraft.evaluation.metrics.objects import (
    TURN_TOLERANCE_DEG,
    TURNED_CLASSES,
    match_objects,
    turn_between_deg,
)
from world2minecraft.evaluation.scoring.object_scores import in_room
from world2minecraft.evaluation.scoring.score import see_truth
from world2minecraft.evaluation.scoring.truth_files import Truth, read_instances
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.geometry.connected_components import label_components

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
    parts, count = label_components((labels > 0) & (labels < 255))
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


Gesture = dict[str, Any]
NEAR_M = 1.2  # Farther off, a thing is another thing.
TOUCH_CELLS = 5  # Objects this near may be parts of one: the post between a seat and its base.
LEAST_CELLS = 5  # Fewer cells of another thing in an object are its rim.
OFFERS = 8  # How many pieces of furniture one would try for a thing: those nearest in size.
LARGE_M2 = 4.0  # The hole filler's bound drawn up, by one who sees that there is no window.
ADDED_AT_ONCE = 3  # Of many missing things one is added after another.
LOCKED = [4, 5, 6, 7, 8, 9, 10, 11]  # In the legend, while a box is filled: windows and objects.
MOST_GESTURES = 200


CELLS_WORTH = 30.0  # What all cells count beside one thing that is wrong: 3 % of them count as one.
DIGITS = 2  # Of that sum; less difference is none.


class Tried(NamedTuple):
    """A gesture, how much is wrong after it, and that with the cells that are wrong then too."""

    wrong: int
    cost: float
    gesture: Gesture


def next_gesture(draft: SceneDraft, tools: Tools, wanted: Wanted) -> Gesture | None:
    """Return the gesture to do next; None where nothing is wrong, or nothing helps."""
    defects = defects_of(draft, wanted)
    quick = tools._replace(match=lambda grid, one: ())
    few = defects.missing[:ADDED_AT_ONCE]
    tries = [on_objects(draft, wanted, defects, few)]
    tries += [_filled(draft, wanted, index) for index in defects.holes]
    tries += [on_objects(draft, wanted, defects, defects.missing)]
    for gestures in tries:
        best = _best(draft, quick, wanted, gestures, defects.total - 1)
        if best is not None:
            return best.gesture
    return _first_of_two(draft, quick, wanted, defects) if defects.total else None


def on_objects(
    draft: SceneDraft, wanted: Wanted, defects: Defects, added: tuple[int, ...]
) -> Iterator[Gesture]:
    """Give every gesture that what is wrong with objects, or floats, suggests.

    ``added`` are those of the missing objects that adding is tried for.
    """
    for number in defects.extra:
        yield from _for_extra(draft, wanted, defects, number)
    for index in added:
        yield from _added(wanted.objects[index])
    for number, index in defects.turned:
        yield from _turned(draft, number, wanted.objects[index])
    for cells in defects.floaters:
        yield from _held(draft, cells)


def _for_extra(
    draft: SceneDraft, wanted: Wanted, defects: Defects, number: int
) -> Iterator[Gesture]:
    one = draft.objects[number]
    yield {"op": "delete_objects", "ids": [number]}
    for index in defects.missing:
        true = wanted.objects[index]
        if np.linalg.norm(true.center_m - one.center_m) > NEAR_M:
            continue
        if true.class_id != one.class_id:
            yield {"op": "relabel_objects", "ids": [number], "class_id": true.class_id}
            continue
        yield {"op": "move_object", "id": number, "to_m": true.center_m.tolist()}
        for name in offered(true):
            turns = round(true.yaw_deg / 90) % 4
            chosen = {"id": number, "template": name, "quarter_turns": turns}
            yield {"op": "set_template", **chosen}
    for other in _beside(draft, number):
        yield {"op": "merge_objects", "ids": [number, other]}
        yield {"op": "merge_objects", "ids": [other, number]}


def _added(true: LayoutObject) -> Iterator[Gesture]:
    turns = round(true.yaw_deg / 90) % 4
    x, y, z = true.center_m.tolist()
    for name in offered(true):
        heights = {"floor": z - true.size_m[2] / 2 + 0.02, "wall": z, "ceiling": z}
        at_m = [x, y, float(heights.get(template(name).mount, heights["floor"]))]
        chosen = {"template": name, "quarter_turns": turns}
        yield {"op": "add_object", "class_id": true.class_id, "at_m": at_m, **chosen}


def _turned(draft: SceneDraft, number: int, true: LayoutObject) -> Iterator[Gesture]:
    one = draft.objects[number]
    turns = round((true.yaw_deg - one.yaw_deg) / 90) % 4
    if turns:
        yield {"op": "turn_objects", "ids": [number], "quarter_turns": turns}
    turns = round(true.yaw_deg / 90) % 4
    for name in dict.fromkeys([p.template for p in one.placements] + offered(true)):
        yield {"op": "set_template", "id": number, "template": name, "quarter_turns": turns}


def _held(draft: SceneDraft, cells: np.ndarray) -> Iterator[Gesture]:
    """Give what lets a floating part hold: it is erased, or a stroke joins it to what is near."""
    labels = draft.labels[tuple(cells.T)]
    for class_id in np.unique(labels):
        first = cells[labels == class_id][0]
        yield {"op": "delete_component", "cell": first.tolist()}
    owners = draft.instance[tuple(cells.T)]
    for number in np.unique(owners[owners > 0]).tolist():
        yield {"op": "delete_objects", "ids": [number]}
        for other in _beside(draft, number):
            yield {"op": "merge_objects", "ids": [number, other]}
        yield {"op": "snap_object", "id": number, "to": "floor"}
        stroke = _stroke(draft, cells[owners == number], cells)
        if stroke is not None:
            class_id = draft.objects[number].class_id
            yield {
                "op": "set_cells", "cells": stroke, "class_id": class_id, "instance": number
            }  # fmt: skip


def _stroke(draft: SceneDraft, own: np.ndarray, part: np.ndarray) -> list[list[int]] | None:
    """Return the runs of a straight stroke from an object's cells to the nearest other cell."""
    taken = draft.labels % 255 > 0
    taken[tuple(part.T)] = False
    best: np.ndarray | None = None
    for start in own:
        for axis in range(3):
            line = [int(v) for v in start]
            at = tuple(slice(None) if n == axis else line[n] for n in range(3))
            ends = np.flatnonzero(taken[at])
            for end in (ends[ends > start[axis]][:1], ends[ends < start[axis]][-1:]):
                for stop in end.tolist():
                    low, high = sorted((int(start[axis]), stop))
                    if best is None or high - low - 1 < len(best):
                        best = np.repeat(start[None], high - low - 1, axis=0)
                        best[:, axis] = np.arange(low + 1, high)
    if best is None or not len(best):
        return None
    best = best[draft.labels[tuple(best.T)] % 255 == 0]
    return runs_of_cells(best, draft.shape).tolist() if len(best) else None


def _filled(draft: SceneDraft, wanted: Wanted, index: int) -> Iterator[Gesture]:
    """Give what fills a plane's holes: the hole filler for all or for one, a lasso, a box."""
    plane = wanted.planes[index]
    axis = plane.normal_axis
    holes = plane.cells[~covered(draft, plane)]
    largest = _largest_hole(draft, holes, axis)
    middle = np.median(plane.cells[:, :, axis])
    for found in find_planes(draft):
        if found.axis == axis and abs(found.layer - middle) <= NEAR_CELLS + 1:
            yield {"op": "fill_holes", "plane": found.name}
            yield {"op": "fill_holes", "plane": found.name, "hole_m2": LARGE_M2}
            cell = largest[0, 0].copy()
            cell[axis] = found.layer
            yield {"op": "fill_holes", "plane": found.name, "cell": cell.tolist()}
    class_id = {"floor": 2, "ceiling": 1}.get(plane.name, 3)
    for step in range(min(NEAR_CELLS, holes.shape[1])):  # Behind the face.
        lasso = largest[:, step]
        lasso = lasso[draft.labels[tuple(lasso.T)] % 255 == 0]
        if len(lasso):
            runs = runs_of_cells(lasso, draft.shape).tolist()
            yield {"op": "set_cells", "cells": runs, "class_id": class_id, "verb": "fill"}
        low, high = holes[:, step].min(axis=0).tolist(), holes[:, step].max(axis=0).tolist()
        box = {"low": low, "high": high, "class_id": class_id}
        yield {"op": "fill_box", **box, "locked": LOCKED}
        yield {"op": "fill_box", **box}


def _largest_hole(draft: SceneDraft, holes: np.ndarray, axis: int) -> np.ndarray:
    """Return those of a plane's open places, int [N, K, 3], that are its largest hole."""
    flat = np.delete(holes[:, 0], axis, axis=1)
    mask = np.zeros(np.delete(draft.shape, axis), bool)
    mask[tuple(flat.T)] = True
    numbers = label_components(mask, corners=False)[0][tuple(flat.T)]
    return holes[numbers == np.bincount(numbers).argmax()]


def _first_of_two(
    draft: SceneDraft, tools: Tools, wanted: Wanted, defects: Defects
) -> Gesture | None:
    """Return the split that, with the gesture after it, leaves least wrong; or None."""
    best: Tried | None = None
    for split in _splits(draft, wanted):
        operation = _planned(draft, tools, split)
        if operation is None:
            continue
        draft.apply(operation)
        after = defects_of(draft, wanted)
        again = on_objects(draft, wanted, after, after.missing[:ADDED_AT_ONCE])
        row = _best(draft, tools, wanted, again, defects.total - 1)
        draft.apply(operation.inverse())
        if row and (best is None or row.cost < best.cost):
            best = row._replace(gesture=split)
    return best.gesture if best is not None else None


def _splits(draft: SceneDraft, wanted: Wanted) -> Iterator[Gesture]:
    """Give the splits of objects that hold cells of two true ones, where these part best."""
    for number in sorted(draft.objects):
        cells = draft.cells_of(number)
        owners = wanted.instance[tuple(cells.T)]
        ids, counts = np.unique(owners[owners > 0], return_counts=True)
        for true in ids[counts >= LEAST_CELLS] if (counts >= LEAST_CELLS).sum() > 1 else ():
            inside, outside = cells[owners == true], cells[(owners != true) & (owners > 0)]
            for axis, name in enumerate("xyz"):
                edge = _edge(inside[:, axis], outside[:, axis])
                at_m = float(draft.origin_m[axis] + edge * draft.voxel_m)
                yield {
                    "op": "split_object", "id": number, "plane": {"axis": name, "at_m": at_m}
                }  # fmt: skip


def _edge(inside: np.ndarray, outside: np.ndarray) -> int:
    """Return the first cell past the cut that keeps two sets of cells apart best."""
    edges = np.arange(min(inside.min(), outside.min()) + 1, max(inside.max(), outside.max()) + 1)
    if not len(edges):
        return int(inside.min())
    below = np.array([(inside < edge).mean() - (outside < edge).mean() for edge in edges])
    return int(edges[np.argmax(np.abs(below))])


def offered(true: LayoutObject) -> list[str]:
    """Return the templates of an object's class that are nearest to it in size."""
    rows = []
    for name in TEMPLATES.names():
        one = template(name)
        if one.class_id == true.class_id:
            rows.append((float(np.abs(np.array(one.typical_m) - true.size_m).sum()), name))
    return [name for _, name in sorted(rows)[:OFFERS]]


def _beside(draft: SceneDraft, number: int) -> list[int]:
    """Return the objects whose cells come near to those of one."""
    cells = draft.cells_of(number)
    if not len(cells):
        return []
    low, high = cells.min(axis=0) - TOUCH_CELLS, cells.max(axis=0) + TOUCH_CELLS + 1
    box = tuple(slice(max(int(a), 0), int(b)) for a, b in zip(low, high, strict=True))
    near = np.unique(draft.instance[box]).tolist()
    return [other for other in near if other and other != number and other in draft.objects]


def _best(
    draft: SceneDraft, tools: Tools, wanted: Wanted, gestures: Iterator[Gesture], limit: int
) -> Tried | None:
    """Do each gesture, judge the scene, and take it back.

    Returns:
        The best of those after which at most ``limit`` things are wrong.
    """
    best: Tried | None = None
    for gesture in gestures:
        operation = _planned(draft, tools, gesture)
        if operation is None:
            continue
        draft.apply(operation)
        wrong = defects_of(draft, wanted).total
        if wrong <= limit:
            cost = round(wrong - CELLS_WORTH * agreement(draft, wanted), DIGITS)
            if best is None or cost < best.cost:
                best = Tried(wrong, cost, gesture)
        draft.apply(operation.inverse())
    return best


def _planned(draft: SceneDraft, tools: Tools, gesture: Gesture):
    try:
        return parse_command(gesture).plan(draft, tools)
    except UsageError:
        return None
