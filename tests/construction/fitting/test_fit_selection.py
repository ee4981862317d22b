"""The rule of choice: the exact optimum of the IoU of all blocks together."""

from itertools import product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.construction.fitting.selection import choose, compute_gains
from world2minecraft.construction.fitting.shapes import CALM, SIDES, shape_set
from world2minecraft.construction.fitting.stabilization import make_stair_corners
from world2minecraft.minecraft.rules.connections import update_connections

CALM_SET = shape_set(CALM)
FEW = shape_set(frozenset(("slab",)))


@settings(max_examples=20)
@given(seed=st.integers(0, 10_000))
def test_no_other_choice_has_a_better_iou(seed):
    wanted = (np.random.default_rng(seed).random((4, 512)) < 0.45).astype(np.float32)
    wanted[:, :256] *= np.random.default_rng(seed + 1).random((4, 1)) < 0.5
    gains = compute_gains(wanted, wanted, FEW, calm=0.0)
    chosen, _ = choose(gains, FEW)
    best = max(gains.iou(np.array(every)) for every in product(range(FEW.free), repeat=4))
    assert gains.iou(chosen) >= best - 1e-6


def test_lam_is_the_iou_that_is_reached():
    wanted = np.random.default_rng(3).random((30, 512)).astype(np.float32) ** 4
    gains = compute_gains(wanted, wanted, CALM_SET, calm=0.0)
    chosen, lam = choose(gains, CALM_SET)
    assert abs(gains.iou(chosen) - lam) < 1e-3


def test_each_shape_is_found_again():
    masks = CALM_SET.masks[1 : CALM_SET.free]
    chosen, _ = choose(compute_gains(masks, masks, CALM_SET), CALM_SET)
    assert chosen.tolist() == list(range(1, CALM_SET.free))


def test_stair_corners_are_never_chosen():
    masks = CALM_SET.masks[CALM_SET.free :]
    chosen, _ = choose(compute_gains(masks, masks, CALM_SET), CALM_SET)
    assert (chosen < CALM_SET.free).all()


def test_what_is_barred_is_not_chosen():
    masks = CALM_SET.masks[1 : CALM_SET.free]
    barred = np.zeros((len(masks), len(CALM_SET)), bool)
    barred[:, 1] = True
    assert 1 not in choose(compute_gains(masks, masks, CALM_SET), CALM_SET, None, barred)[0]


@given(seed=st.integers(0, 10_000))
def test_corners_are_those_that_the_game_computes(seed):
    """The same rule written a second time, in another file and other axes."""
    rng = np.random.default_rng(seed)
    straight = np.flatnonzero((CALM_SET.stairs >= 0) & (np.arange(len(CALM_SET)) < CALM_SET.free))
    grid = rng.choice([0, 1, *straight, *straight], (4, 4, 3))
    made = make_stair_corners(grid, CALM_SET)
    palette = ["minecraft:air", *(one.sample for one in CALM_SET.shapes)]
    states, names = update_connections(np.swapaxes(grid[:, ::-1], 1, 2).astype(np.uint16), palette)
    told = np.swapaxes(states, 1, 2)[:, ::-1]
    assert [names[n] for n in told.ravel()] == [palette[n] for n in made.ravel()]


def test_a_table_of_corners():
    """Two rows that meet: the one in front makes an outer corner, the one behind an inner."""

    def number(facing: str) -> int:
        shapes = [dict(one.properties) for one in CALM_SET.shapes]
        wanted = {"facing": facing, "half": "bottom", "shape": "straight"}
        return shapes.index(wanted) + 1

    grid = np.zeros((3, 3, 1), np.intp)
    grid[1, 1, 0], grid[2, 1, 0] = number("east"), number("north")
    outer = CALM_SET.shapes[make_stair_corners(grid, CALM_SET)[1, 1, 0] - 1]
    assert dict(outer.properties)["shape"] == "outer_left"
    grid[2, 1, 0], grid[0, 1, 0] = 0, number("south")
    inner = CALM_SET.shapes[make_stair_corners(grid, CALM_SET)[1, 1, 0] - 1]
    assert dict(inner.properties)["shape"] == "inner_right"
    assert SIDES[0] == "east"
