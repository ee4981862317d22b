"""Fitted objects: exact where they can be, stable, whole, symmetric, and equal when turned."""

from functools import cache, partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.construction.fitting import (
    CALM,
    Fit,
    Rules,
    ShapeSet,
    Target,
    find_symmetry,
    fit_once,
    fit_parts,
    fit_solid,
    shape_set,
    solve,
)
from world2minecraft.construction.fitting.stabilization import label_parts, remove_crumbs
from world2minecraft.core.coordinates import grid_to_block_axes
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.rules.stability import find_unstable

ALL = shape_set(CALM | {"carpet", "post"})
STANDS = Rules()


def target_of_boxes(boxes, shape=(16, 16, 16)) -> Target:
    wanted = np.zeros(shape, np.float32)
    for box in boxes:
        wanted[tuple(slice(a, b) for a, b in zip(box[:3], box[3:], strict=True))] = 1
    return Target(wanted, np.zeros_like(wanted))


def falls(numbers: np.ndarray, shapes: ShapeSet) -> list:
    """What would not stay of shapes on a stone floor, after the game has connected them."""
    palette = ["minecraft:air", *(one.sample for one in shapes.shapes), "minecraft:stone"]
    whole = np.pad(numbers, 1)
    whole[:, :, 0] = len(palette) - 1
    states, names = update_connections(grid_to_block_axes(whole.astype(np.uint16)), palette)
    zeros = np.zeros(states.shape, np.uint8)
    volume = BlockVolume(states, tuple(names), zeros, zeros.astype(np.uint16), (0, 0, 0), np.eye(4))
    return [one for one in find_unstable(volume) if "stone" not in one.state]


def hovering(numbers: np.ndarray, shapes: ShapeSet) -> int:
    parts = label_parts(numbers, shapes)
    return len(set(np.unique(parts[parts > 0])) - set(np.unique(parts[:, :, 0])))


def random_target(seed: int) -> Target:
    rng = np.random.default_rng(seed)
    boxes = []
    for _ in range(rng.integers(1, 5)):
        low = rng.integers(0, 20, 3)
        boxes.append((*low, *(low + rng.integers(2, 14, 3))))
    target = target_of_boxes(boxes, (24, 24, 24))
    return target._replace(thin=target.wanted * (rng.random() < 0.5))


def test_a_cube_is_a_cube():
    fit = fit_solid(target_of_boxes([(0, 0, 0, 16, 16, 16)]), ALL)
    assert fit.numbers.shape == (2, 2, 2)
    assert (fit.numbers == 1).all()
    assert fit.iou == pytest.approx(1)


def test_a_sub_block_shift_finds_the_lattice():
    """A cube of two blocks whose target lies a quarter of a block off is found whole."""
    wanted = np.zeros((20, 20, 16), np.float32)
    wanted[4:20, 0:16] = 1
    assert fit_solid(Target(wanted, 0 * wanted), ALL).iou == pytest.approx(1)


@settings(max_examples=15)
@given(seed=st.integers(0, 10_000))
def test_nothing_falls_or_hovers(seed):
    fit = fit_solid(random_target(seed), ALL, STANDS)
    assert fit.numbers.any()
    assert falls(fit.numbers, ALL) == []
    parts = np.unique(label_parts(fit.numbers, ALL))
    assert hovering(fit.numbers, ALL) == 0 or len(parts) == 2  # The empty one, and all there is.


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000), turns=st.integers(1, 3))
def test_a_turned_object_gives_the_turned_fit(seed, turns):
    target = random_target(seed)
    turned = Target(np.rot90(target.wanted, turns).copy(), np.rot90(target.thin, turns).copy())
    one, other = fit_solid(target, ALL), fit_solid(turned, ALL)
    assert other.iou == pytest.approx(one.iou, abs=0.05)


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000))
def test_what_is_symmetric_is_fitted_symmetric(seed):
    target = random_target(seed)
    wanted = np.maximum(target.wanted, target.wanted[:, ::-1])
    even = Target(wanted, 0 * wanted)
    assert find_symmetry(even)[1]
    fit = fit_solid(even, ALL, Rules(even=(False, True)))
    assert np.array_equal(ALL.mirrors[1][fit.numbers[:, ::-1]], fit.numbers)


def test_the_same_target_gives_the_same_fit():
    one, other = (fit_solid(random_target(7), ALL) for _ in range(2))
    assert np.array_equal(one.numbers, other.numbers)


def test_nothing_vanishes():
    wanted = np.zeros((2, 2, 1), np.float32)
    wanted[0, 0, 0] = 0.2
    fit = solve(Target(wanted, 0 * wanted), (4, 4), ALL)
    assert fit.numbers.any()


def test_a_table_top_without_legs_gets_posts():
    fit = fit_solid(target_of_boxes([(0, 0, 18, 24, 24, 24)], (24, 24, 24)), ALL)
    kinds = ALL.kinds[fit.numbers]
    assert (kinds[:, :, 0] == "post").sum() in (1, 4)
    assert hovering(fit.numbers, ALL) == 0


def test_without_posts_the_top_stays_alone():
    calm = shape_set(CALM)
    fit = fit_solid(target_of_boxes([(0, 0, 18, 24, 24, 24)], (24, 24, 24)), calm)
    assert fit.numbers.any()


def test_a_flush_top_ends_its_block():
    plate = target_of_boxes([(0, 0, 0, 16, 16, 2)], (16, 16, 2))
    low = ALL.is_low
    assert low[solve(plate, (0, 0), ALL).numbers].any()
    assert not low[solve(plate, (0, 0), ALL, Rules(flush=True)).numbers].any()


def test_crumbs_are_left_out_and_what_a_wall_holds_stays():
    grid = np.zeros((4, 4, 4), np.intp)
    grid[0, 0, 0] = grid[3, 3, 3] = 1
    held = np.zeros(grid.shape, bool)
    assert remove_crumbs(grid, ALL, True)[3, 3, 3] == 0
    held[3, 3, 3] = True
    assert remove_crumbs(grid, ALL, True, held)[3, 3, 3] == 1


CHAIR = np.array(
    [
        *([x, y, 0, x + 0.04, y + 0.04, 0.41] for x in (-0.24, 0.2) for y in (-0.22, 0.18)),
        [-0.24, -0.22, 0.41, 0.24, 0.22, 0.46],
        [-0.24, -0.22, 0.46, -0.18, 0.22, 0.88],
    ]
)
TABLE = np.array(
    [
        *([x, y, 0, x + 0.05, y + 0.05, 0.71] for x in (-0.6, 0.55) for y in (-0.4, 0.35)),
        [-0.6, -0.4, 0.71, 0.6, 0.4, 0.75],
    ]
)


def kinds_of(fit: Fit) -> set[str]:
    return set(ALL.kinds[fit.numbers].ravel().tolist()) - {"empty"}


@cache
def chair_of(scale: float):
    """The chair as it is fitted, with its parts; two tests look at one of them."""
    return fit_parts(CHAIR, scale, ALL)


@pytest.mark.parametrize("scale", [3.0, 4.0, 5.0, 6.0, 8.0])
@pytest.mark.parametrize("boxes", [CHAIR, TABLE], ids=["chair", "table"])
def test_furniture_stands_on_legs_in_one_piece(boxes, scale):
    fit, part = chair_of(scale) if boxes is CHAIR else fit_parts(boxes, scale, ALL)
    assert "post" in kinds_of(fit)
    assert hovering(fit.numbers, ALL) == 0
    assert falls(fit.numbers, ALL) == []
    assert ((part > 0) == (fit.numbers > 0)).all()
    assert part.max() <= len(boxes)
    assert np.array_equal(ALL.mirrors[1][fit.numbers[:, ::-1]], fit.numbers)


def test_a_chair_is_no_block():
    fit, _ = chair_of(4.0)
    assert not (ALL.kinds[fit.numbers] == "full").any()
    back, front = (ALL.kinds[fit.numbers[row, :, -1]].tolist() for row in (0, -1))
    assert back != front


def test_furniture_fills_the_blocks_it_is_given():
    wide = np.array([[-0.3, -0.5, 0.0, 0.3, 0.5, 1.0]])
    fit, _ = fit_parts(wide, 4.0, ALL, counts=(2, 5))
    assert fit.numbers.shape[:2] == (2, 5)
    assert fit.iou > 0.95


def test_a_table_for_things_to_lie_on_is_flush():
    fit, _ = fit_parts(TABLE, 4.0, ALL, flush=True)
    assert not ALL.is_low[fit.numbers].any()


def test_no_boxes_are_refused():
    with pytest.raises(ValueError, match="at least one box"):
        fit_parts(np.zeros((0, 6)), 4.0, ALL)


@pytest.mark.parametrize("phase", [None, (3, 5)])
def test_a_kept_fit_is_the_fit_of_these_cells_kinds_and_rules(phase):
    kinds = frozenset({"slab", "stairs"})
    shapes = shape_set(kinds)
    for seed in (1, 2, 1):
        target = random_target(seed)
        for rules in (Rules(), Rules(calm=4.0)):
            kept = fit_once(target, kinds, rules, phase)
            fit = fit_solid if phase is None else partial(solve, phase=phase)
            plain = fit(target, shapes=shapes, rules=rules)
            assert np.array_equal(kept.numbers, plain.numbers)
            assert np.array_equal(kept.middle, plain.middle) and kept[2:] == plain[2:]
            assert fit_once(random_target(seed), kinds, rules, phase) is kept
            assert not kept.numbers.flags.writeable
    assert fit_once(target._replace(bottom=4), kinds, rules, phase) is not kept
    assert fit_once(target, frozenset(), rules, phase) is not kept
