"""Chairs: one paint each, one paint a set, and seats that rest on their legs."""

import numpy as np
import pytest
from tests.construction.build_samples import FURN, Sketch, placement

from world2minecraft.construction import build_volume
from world2minecraft.construction.block_lattice import lattice_over
from world2minecraft.construction.fitted_objects import LOWER
from world2minecraft.construction.surface_painting import chair_paints, lit_colour
from world2minecraft.construction.template_blocks import half_block_design
from world2minecraft.core.types import OccupancyGrid, Placement
from world2minecraft.furniture import template
from world2minecraft.geometry.colour import srgb_to_oklab

SOFA = 7
BROWN, SHADE, RED = (120, 80, 45), (35, 24, 14), (190, 30, 30)


def chairs(*colours: tuple[tuple[int, int, int], tuple[int, int, int]]):
    """A grid with chairs of 4 x 4 x 8 cells, the upper half of one colour, the lower another."""
    labels = np.zeros((10 * len(colours), 8, 10), np.uint8)
    instance = np.zeros(labels.shape, np.uint16)
    colour = np.zeros((*labels.shape, 3), np.uint8)
    for number, (upper, lower) in enumerate(colours, 1):
        x = 10 * number - 8
        labels[x : x + 4, 2:6, 1:9], instance[x : x + 4, 2:6, 1:9] = 5, number
        colour[x : x + 4, 2:6, 1:5], colour[x : x + 4, 2:6, 5:9] = lower, upper
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=colour,
        source=np.ones(labels.shape, np.uint8),
        instance=instance,
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )
    return grid, srgb_to_oklab(colour), labels > 0


def test_the_lit_half_says_the_paint():
    paints = chair_paints(*chairs((BROWN, SHADE)), 0.4)
    assert np.allclose(paints[1], srgb_to_oklab(np.array(BROWN, np.uint8)), atol=1e-4)


def test_chairs_of_a_set_share_a_paint_but_a_red_one_does_not():
    other_brown = tuple(value + 6 for value in BROWN)
    paints = chair_paints(*chairs((BROWN, SHADE), (RED, SHADE), (other_brown, SHADE)), 0.4)
    assert np.array_equal(paints[1], paints[3])
    assert paints[2][1] > paints[1][1] + 0.05, "more red than the brown ones"


def test_grey_cushions_do_not_hide_a_wooden_frame():
    grey = (150, 150, 148)
    paints = chair_paints(*chairs((grey, BROWN), (grey, grey)), 0.4)
    assert np.allclose(paints[1], srgb_to_oklab(np.array(BROWN, np.uint8)), atol=1e-4)
    assert np.hypot(*paints[2][1:]) < 0.01


def test_no_chairs_no_paints():
    grid, colours, usable = chairs((BROWN, SHADE))
    assert chair_paints(grid, colours, np.zeros_like(usable), 0.4) == {}


def test_lit_colour_of_one_cell_is_its_own():
    one = np.array([[0.5, 0.1, -0.1]], np.float32)
    assert np.array_equal(lit_colour(one), one[0])


def test_a_seat_rests_on_its_posts_at_every_turn():
    chair = template("chair")
    for turns in range(4):
        placement = Placement(1, 5, "chair", [1.0, 1.0, 0.44], [0.48, 0.48, 0.88], turns, 0.5)
        parts = chair.parts(placement.size_m, placement.parameters)
        lattice = lattice_over(chairs((BROWN, SHADE))[0], np.array([0.0, 2.0]), 4.0)
        design = half_block_design(placement, parts, lattice)
        seat = next(n for n, part in enumerate(parts, 1) if part.role == "seat")
        seats = np.argwhere(design.part == seat)
        assert len(seats) and (design.halves[tuple(seats.T)] == LOWER).all()
        below = seats - [0, 0, 1]
        legs = [n for n, part in enumerate(parts, 1) if part.role == "leg"]
        assert np.isin(design.part[tuple(below.T)], legs).all()
        back = next(n for n, part in enumerate(parts, 1) if part.role == "back")
        column = np.unique(np.argwhere(design.part == back)[:, :2], axis=0)
        for x, y in column:
            filled = design.halves[x, y] > 0
            assert filled[: int(np.flatnonzero(filled)[-1]) + 1].all(), "no gap under the back"


@pytest.mark.parametrize(
    ("class_id", "name", "plain"), [(SOFA, "sofa", True), (FURN, "counter", False)]
)
def test_the_runs_of_a_sofa_share_a_paint(class_id, name, plain):
    sketch = Sketch((50, 25, 30))
    for x, colour in (((5, 16), RED), ((16, 27), SHADE)):
        sketch.put(x, (2, 12), (0, 9), class_id, colour, 1)
    runs = [
        placement(name, class_id, (0.08 * x, 0.56, 0.36), (0.88, 0.8, 0.72)) for x in (10.5, 21.5)
    ]
    volume = build_volume(sketch.grid(), runs, (), corner_m=sketch.corner_m)
    used = np.unique(volume.states[volume.instance == 1])
    names = {volume.palette[int(one)].partition("[")[0] for one in used}
    assert any("red" in one for one in names)
    assert plain == all("black" not in one and "brown" not in one for one in names), names
