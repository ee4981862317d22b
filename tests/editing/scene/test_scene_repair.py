"""Floaters, holes and rough surfaces: found, repaired, and nothing else touched."""

import itertools

import numpy as np
import pytest
from box_rooms import DOOR, WINDOW, box_draft, box_room, generated_labels
from hypothesis import given
from voxel_scenes import TOOLS, done, grid_of, held, object_at, random_scene, seeds

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.editing.scene import SceneDraft, parse_command, runs_of_cells
from world2minecraft.editing.scene.plane_detection import find_planes
from world2minecraft.editing.scene.repair import find_floaters, pinholes, plane_gaps, smooth_labels

AROUND = [step for step in itertools.product((-1, 0, 1), repeat=3) if any(step)]
FACES = [step for step in AROUND if sum(map(abs, step)) == 1]


def around(labels, cell, steps):
    """The labels of a cell's neighbours; beyond the grid there is nothing."""
    for step in steps:
        there = tuple(a + b for a, b in zip(cell, step, strict=True))
        if all(0 <= a < side for a, side in zip(there, labels.shape, strict=True)):
            yield there, int(labels[there])


def slow_pieces(labels):
    left = {tuple(cell) for cell in np.argwhere((labels > 0) & (labels < 255)).tolist()}
    pieces = []
    while left:
        piece, queue = set(), [min(left)]
        while queue:
            here = queue.pop()
            if here in left:
                left.remove(here)
                piece.add(here)
                queue += [there for there, _ in around(labels, here, AROUND)]
        pieces.append(sorted(piece))
    return pieces


@given(seeds)
def test_floaters_are_the_small_pieces_but_the_largest(seed):
    draft = random_scene(seed)
    thin = np.random.default_rng(seed).random(draft.shape) < 0.8
    labels = np.where(thin & (draft.labels < 255), 0, draft.labels)
    draft = SceneDraft(grid_of(labels))
    pieces = sorted(slow_pieces(labels), key=lambda cells: -len(cells))
    found = find_floaters(draft, 3)
    small = [cells for cells in pieces if len(cells) <= 3]
    assert len(found) == len(small) - bool(pieces and len(pieces[0]) <= 3)
    assert [len(one.cells) for one in found] == sorted(len(one.cells) for one in found)[::-1]
    everything = [[list(cell) for cell in cells] for cells in small]
    assert all(one.cells.tolist() in everything for one in found)


def test_a_large_piece_of_structure_never_floats():
    labels = box_room()
    labels[20:30, 20:30, 10], labels[20:23, 20:23, 20], labels[40, 40, 10:20] = 3, 1, 10
    found = find_floaters(box_draft(labels), 100_000)
    assert [(len(one.cells), one.class_id) for one in found] == [(10, 10), (9, 1)]


def slowly_smoothed(labels):
    result = labels.copy()
    for cell in map(tuple, np.argwhere(labels < 255).tolist()):
        near = [label for _, label in around(labels, cell, AROUND) if 5 <= label < 255]
        faces = [there for there, label in around(labels, cell, FACES) if 0 < label < 255]
        if labels[cell] == 0 and len(near) >= 17:
            result[cell] = min(set(near), key=lambda one: (-near.count(one), one))
        if labels[cell] >= 5:
            near.append(int(labels[cell]))
            most = max(set(near), key=near.count)
            if 2 * near.count(most) > len(near):
                result[cell] = most
            if len(faces) == 1:
                beyond = [n for _, n in around(labels, faces[0], FACES) if 0 < n < 255]
                if len(beyond) > 4:
                    result[cell] = 0
    return result


@given(seeds)
def test_smoothing_is_a_majority_of_neighbours(seed):
    rng = np.random.default_rng(seed)
    shares = rng.dirichlet([1, 1, 1, 1, 0.3])
    labels = rng.choice([0, 5, 8, 3, 255], (5, 4, 6), p=shares).astype(np.uint8)
    result = smooth_labels(labels)
    assert np.array_equal(result, slowly_smoothed(labels))
    kept = (labels == 3) | (labels == 255)
    assert (result[kept] == labels[kept]).all() and not ((result == 3) & ~kept).any()


def test_smoothing_fills_pits_and_leaves_inner_edges():
    labels = np.zeros((9, 9, 9), np.uint8)
    labels[:, :, :3] = 7  # A seat
    labels[:, :3, 3:] = 7  # and its back; between them nine cells touch fifteen.
    labels[5, 6, 2] = 0
    result = smooth_labels(labels)
    assert result[5, 6, 2] == 7
    result[5, 6, 2] = 0
    assert np.array_equal(result, labels)


def test_smoothing_takes_bumps_and_leaves_legs():
    labels = np.zeros((9, 9, 8), np.uint8)
    labels[:, :, 0] = 2
    labels[2:7, 2:7, 5] = 8  # A table's top, one cell thick,
    labels[2, 2, 1:5] = labels[6, 6, 1:5] = 8  # two legs,
    labels[4, 4, 6] = 8  # and a bump.
    result = smooth_labels(labels)
    assert result[4, 4, 6] == 0
    result[4, 4, 6] = 8
    assert np.array_equal(result, labels)


@given(seeds)
def test_pinholes_lie_between_cells_along_two_axes(seed):
    rng = np.random.default_rng(seed)
    labels = rng.choice([0, 5, 3, 255], (5, 4, 6), p=[0.3, 0.4, 0.1, 0.2]).astype(np.uint8)
    mine = labels == 5
    slow = []
    for cell in map(tuple, np.argwhere((labels == 0) | (labels == 255)).tolist()):
        near = {there for there, label in around(labels, cell, FACES) if label == 5}
        both = sum(
            {tuple(c + s * (axis == n) for n, c in enumerate(cell)) for s in (-1, 1)} <= near
            for axis in range(3)
        )
        slow += [list(cell)] if both >= 2 else []
    assert pinholes(labels, mine).tolist() == slow


@given(seeds)
def test_a_repair_done_and_undone_changes_nothing(seed):
    draft = random_scene(seed)
    before = held(draft)
    number = min(draft.objects, default=1)
    rng = np.random.default_rng(seed)
    some = runs_of_cells(np.argwhere(rng.random(draft.shape) < 0.5), draft.shape).tolist()
    command = (
        {"op": "remove_floaters", "max_cells": 2, "locked": [5]},
        {"op": "smooth"},
        {"op": "smooth", "class_id": 8, "runs": some, "locked": [5]},
        {"op": "fill_holes", "plane": f"object:{number}"},
    )[seed % 4]
    try:
        done(draft, parse_command(command))
    except UsageError:
        assert held(draft) == before


def filled(draft, plane, **fields):
    return done(draft, parse_command({"op": "fill_holes", "plane": plane, **fields}))


def share(draft, name):
    return next(plane_gaps(draft, one).share for one in find_planes(draft) if one.name == name)


def test_a_box_room_has_six_planes_without_holes():
    draft = box_draft(box_room())
    planes = find_planes(draft)
    assert [one.name for one in planes] == [
        "floor", "ceiling", "wall:1", "wall:2", "wall:3", "wall:4",
    ]  # fmt: skip
    assert [(one.axis, one.layer) for one in planes] == [
        (2, 0), (2, 33), (0, 0), (0, 49), (1, 0), (1, 44),
    ]  # fmt: skip
    for plane in planes:
        gaps = plane_gaps(draft, plane)
        assert not gaps.holes.any() and gaps.share == 0
        assert gaps.openings.sum() == (260 if plane.name == "wall:3" else 0)


def test_holes_are_filled_and_doors_and_windows_are_not():
    labels = box_room()
    labels[30:35, 20:26, 0] = 0  # A hole in the floor, 0.19 square metres,
    labels[35:41, 0, 5:10] = 0  # in the wall of the door,
    labels[49, 10:11, 7:32] = 0  # and across a wall; one that is too large:
    labels[49, 20:30, 10:20] = 0
    draft = box_draft(labels)
    assert share(draft, "floor") == pytest.approx(30 / (48 * 43))
    operation = filled(draft, "all")
    assert operation.counts_as == "add"
    whole = box_room()
    whole[49, 20:30, 10:20] = 0
    assert np.array_equal(draft.labels, whole)
    assert (draft.labels[DOOR] == 0).all() and (draft.labels[WINDOW] == 4).all()


def test_what_furniture_hides_is_a_hole_of_any_size():
    labels = box_room()
    labels[1:9, 10:40, 0:28] = 255  # Behind the fronts and the top of a row of wardrobes
    labels[0, 10:40, 0:28] = 255  # neither floor nor wall nor window was seen.
    labels[8, 10:40, 1:28], labels[1:9, 10:40, 27] = 10, 10
    draft = box_draft(labels)
    assert share(draft, "floor") > 0.1 and share(draft, "wall:1") > 0.3
    filled(draft, "floor")
    filled(draft, "wall:1")
    assert (draft.labels[1:9, 10:40, 0] == 2).all() and (draft.labels[0, 10:40, 1:28] == 3).all()
    assert (draft.labels[1:8, 10:40, 1:27] == 255).all()


def test_behind_a_slope_a_plane_ends():
    labels = box_room()
    labels[WINDOW] = 3
    for x in range(20):  # A roof from a knee wall of 13 cells up to the ceiling; nothing behind.
        labels[x, 1:44, 14 + x :] = 255
        labels[x, 1:44, 13 + x] = 1
    draft = box_draft(labels)
    rows = {one.name: plane_gaps(draft, one) for one in find_planes(draft)}
    assert {"ceiling", "wall:1", "wall:2"} <= set(rows)
    assert all(not one.holes.any() for one in rows.values())
    draft.labels[:20, 1:44][draft.labels[:20, 1:44] == 1] = 10  # Were it a wardrobe, it would not.
    assert plane_gaps(draft, find_planes(draft)[1]).holes.sum() > 400


def test_unseen_glass_beside_the_air_of_the_room_stays_open():
    labels = box_room()
    labels[WINDOW] = 255
    draft = box_draft(labels)
    with pytest.raises(UsageError):
        filled(draft, "wall:1")
    filled(draft, "wall:1", cell=[0, 20, 15])
    assert (draft.labels[WINDOW] == 3).all()


def test_a_named_gap_is_filled_alone_even_a_door():
    labels = box_room()
    labels[5, 0, 5] = 0
    draft = box_draft(labels)
    filled(draft, "wall:3", cell=[25, 0, 10])
    assert (draft.labels[DOOR] == 3).all() and draft.labels[5, 0, 5] == 0


def test_rooms_that_share_a_wall_have_own_planes_and_doors():
    labels = np.concatenate([box_room(), box_room()[1:]], axis=0)
    labels[:, 44] = np.where(labels[:, 44] == 0, 3, labels[:, 44])
    labels[49, 10:20, 1:27] = 0  # A door between them,
    labels[49, 30:32, 5:9] = 0  # a hole in the wall that they share,
    labels[70:73, 20:24, 0] = 0  # and one in the floor of the second.
    draft = box_draft(labels)
    planes = {one.name: one for one in find_planes(draft)}
    assert [(one.axis, one.layer) for one in planes.values()] == [
        (2, 0), (2, 33), (0, 0), (0, 49), (0, 98), (1, 0), (1, 44),
    ]  # fmt: skip
    assert (
        filled(draft, "wall:2").cells.tolist()
        == np.argwhere(np.pad(np.ones((1, 2, 4)), ((49, 49), (30, 13), (5, 25)))).tolist()
    )
    assert len(filled(draft, "floor").cells) == 12
    assert (draft.labels[49, 10:20, 1:27] == 0).all()


def test_a_wall_that_bends_is_filled_where_it_is():
    labels = box_room()
    labels[1, 30:40, 1:-1], labels[0, 30:40, 1:-1] = 3, 255
    labels[1, 35:37, 10:12] = 0
    draft = box_draft(labels)
    assert len(find_planes(draft)) == 6
    filled(draft, "wall:1")
    assert (draft.labels[1, 35:37, 10:12] == 3).all()
    assert (draft.labels[0, 35:37, 10:12] == 255).all()


def test_filling_never_paints_over_furniture():
    labels = box_room()
    labels[30:33, 0, 5:8] = 10
    labels[20:22, 20:22, 0] = 11
    draft = box_draft(labels)
    with pytest.raises(UsageError):
        filled(draft, "all")


def test_a_room_at_an_angle_to_the_axes_has_no_wall_planes():
    x, y, _ = np.indices((60, 60, 30))
    labels = np.where(np.abs(x - y) <= 1, 3, 0).astype(np.uint8)
    assert find_planes(box_draft(labels)) == []


def broken_planes(truth, rng):
    """Where squares of 4 x 4 are cut through the shell, three a plane; bool [X, Y, Z]."""
    broken = np.zeros(truth.shape, bool)
    start = box_draft(truth)
    for plane in find_planes(start):
        for place in rng.choice(np.argwhere(plane_gaps(start, plane).own), 3):
            low = np.insert(place - 1, plane.axis, plane.layer - 1)
            high = np.insert(place + 3, plane.axis, plane.layer + 2)
            broken[tuple(slice(max(a, 0), b) for a, b in zip(low, high, strict=True))] = True
    return broken & np.isin(truth, (1, 2, 3))


def floating_cells(labels, rng):
    """Single cells in the air, two cells at least from all else; bool [X, Y, Z]."""
    floating = np.zeros(labels.shape, bool)
    solid = (labels > 0) & (labels < 255)
    for cell in rng.permutation(np.argwhere(labels == 0))[:200]:
        box = tuple(slice(max(a - 2, 0), a + 3) for a in cell)
        if not solid[box].any() and not floating[box].any():
            floating[tuple(cell)] = True
    return floating


@pytest.mark.parametrize(("seed", "shape"), [(500, None), (505, None), (513, None), (524, "box")])
def test_a_damaged_generated_room_is_repaired(seed, shape):
    """Holes and floaters are made on purpose; windows, doors and furniture are there."""
    truth = generated_labels(seed, shape)
    rng = np.random.default_rng(seed)
    broken = broken_planes(truth, rng)
    labels = np.where(broken, 0, truth)
    floating = floating_cells(labels, rng)
    draft = box_draft(np.where(floating, 11, labels))
    assert floating.sum() > 20 and broken.sum() > 100
    done(draft, parse_command({"op": "remove_floaters", "max_cells": 2}))
    assert (draft.labels[floating] == 0).all()
    filled(draft, "all")
    for plane in find_planes(draft):
        assert plane_gaps(draft, plane).share < 0.02, plane
    # Of a thick wall one sheet is filled; nothing else is.
    wrong = draft.labels != truth
    assert not (wrong & ~broken).any() and wrong.sum() < 0.7 * broken.sum()


def chair_with_hole() -> SceneDraft:
    labels, instance = np.zeros((5, 5, 4), np.uint8), np.zeros((5, 5, 4), np.uint16)
    labels[:, :, 1], instance[:, :, 1] = 5, 7
    labels[2, 2, 1], instance[2, 2, 1] = 0, 0
    labels[0, 4, 1], instance[0, 4, 1] = 0, 0
    return SceneDraft(grid_of(labels, instance), [object_at(7, 5, np.argwhere(instance == 7))])


def test_a_pinhole_of_an_object_is_closed_and_its_corner_is_not():
    draft = chair_with_hole()
    box = draft.objects[7]
    filled(draft, "object:7")
    assert draft.labels[2, 2, 1] == 5 and draft.instance[2, 2, 1] == 7
    assert draft.labels[0, 4, 1] == 0 and draft.objects[7] is box


def test_floaters_that_are_kept_stay():
    labels = np.zeros((9, 3, 3), np.uint8)
    labels[0], labels[3, 1, 1], labels[6, 1, 0:2] = 3, 5, 11
    draft = box_draft(labels)
    keep = [int(np.ravel_multi_index((6, 1, 1), labels.shape))]
    done(draft, parse_command({"op": "remove_floaters", "keep": keep}))
    assert draft.labels[3, 1, 1] == 0 and draft.labels[6, 1].tolist() == [11, 11, 0]


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        (
            {"op": "fill_holes", "plane": "wall:9"},
            "no plane is named 'wall:9'; did you mean 'wall:4'?",
        ),
        (
            {"op": "fill_holes", "plane": "floor"},
            "floor has no holes to fill; specify a cell of an opening to close it",
        ),
        (
            {"op": "fill_holes", "plane": "all"},
            "any plane has no holes to fill; specify a cell of an opening to close it",
        ),
        (
            {"op": "fill_holes", "plane": "floor", "cell": [3, 3, 3]},
            "cell [3, 3, 3] is not in a gap of floor",
        ),
        ({"op": "fill_holes", "plane": "object:x"}, "object x not found; see the object tree"),
        (
            {"op": "remove_floaters"},
            "no floaters with at most 30 cells found",
        ),
        ({"op": "smooth"}, "nothing to change: furniture is already smooth or locked"),
    ],
)
def test_impossible_repairs_are_refused_with_a_reason(fields, text):
    with pytest.raises((UsageError, UnknownNameError)) as refusal:
        parse_command(fields).plan(box_draft(box_room()), TOOLS)
    assert str(refusal.value) == text


HUGE = 10**30


@pytest.mark.parametrize(
    "fields",
    [
        {"op": "set_cells", "cells": [[HUGE, 1]], "class_id": 5},
        {"op": "set_cells", "cells": [[0, HUGE]], "class_id": 5},
        {"op": "fill_box", "low": [HUGE, 0, 0], "high": [HUGE, 0, 0], "class_id": 5},
        {"op": "fill_box", "low": [-HUGE, 0, 0], "high": [-1, HUGE, 0], "class_id": 5},
        {"op": "delete_component", "cell": [HUGE, -HUGE, 0]},
        {"op": "delete_component", "cell": [-1, 0, 0]},
        {"op": "paste", "cells": [[0, 9]], "by": [HUGE, -HUGE, 0]},
        {"op": "remove_floaters", "max_cells": HUGE, "keep": [HUGE]},
        {"op": "fill_holes", "plane": "floor", "cell": [HUGE, 0, 0]},
        {"op": "fill_holes", "plane": "object:" + "9" * 30},
        {"op": "fill_holes", "plane": "object:²"},
        {"op": "smooth", "runs": [[HUGE, HUGE]]},
    ],
)
def test_huge_numbers_are_refused_like_any_other(fields):
    with pytest.raises(UsageError) as refusal:
        parse_command(fields).plan(box_draft(box_room()), TOOLS)
    assert "\n" not in str(refusal.value)


def test_a_huge_box_is_cut_at_the_sides_of_the_grid():
    draft = box_draft(box_room())
    fields = {"low": [-HUGE, 5, 5], "high": [HUGE, 5, 5], "class_id": 10}
    operation = done(draft, parse_command({"op": "fill_box", **fields}))
    assert len(operation.cells) == 50
