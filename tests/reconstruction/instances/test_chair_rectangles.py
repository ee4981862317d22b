"""The free turn of a chair: right where it shows in the cells, and none where it does not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture import template, template_cells
from world2minecraft.reconstruction.instances.object_extent import min_area_rectangle

CHAIR = SemanticClass.CHAIR
VOXEL_M = 0.08


def _seat(angle_deg, sides_m=(0.46, 0.46), middle=(1.21, 1.33)):
    """Return labels with a seat askew: a cell is met by 4 of its 64 parts."""
    steps = (np.arange(40 * 4) + 0.5) * VOXEL_M / 4
    x, y = np.meshgrid(steps - middle[0], steps - middle[1], indexing="ij")
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    inside = (np.abs(x * cos + y * sin) <= sides_m[0] / 2) & (
        np.abs(y * cos - x * sin) <= sides_m[1] / 2
    )
    met = inside.reshape(40, 4, 40, 4).sum(axis=(1, 3)) >= 1
    return np.repeat(met[:, :, None], 6, axis=2)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("angle", [15, 18, 20, 25, 30])
def test_the_turn_of_a_seat_is_found(angle, sign):
    found = min_area_rectangle(np.argwhere(_seat(sign * angle)), CHAIR, VOXEL_M)
    assert found is not None
    assert found.angle_deg == pytest.approx(sign * angle, abs=7)
    np.testing.assert_allclose(found.middle * VOXEL_M, (1.21, 1.33), atol=0.05)
    np.testing.assert_allclose(found.sides * VOXEL_M, 0.46, atol=0.14)


@pytest.mark.parametrize("name", ["chair", "armchair", "office_chair", "stool"])
@pytest.mark.parametrize("turns", range(4))
def test_a_straight_chair_has_no_free_turn(name, turns):
    cells = template_cells(
        template(name), template(name).typical_m, quarter_turns=turns, shift=(9, 9, 1)
    )
    assert min_area_rectangle(cells, CHAIR, VOXEL_M) is None


@pytest.mark.parametrize(
    ("angle", "sides_m"), [(20, (0.1, 0.46)), (20, (1.0, 0.9)), (45, (0.46,) * 2)]
)
def test_a_back_alone_a_heap_and_a_diamond_have_none(angle, sides_m):
    assert min_area_rectangle(np.argwhere(_seat(angle, sides_m)), CHAIR, VOXEL_M) is None


def test_other_classes_have_none():
    assert min_area_rectangle(np.argwhere(_seat(20)), SemanticClass.OBJS, VOXEL_M) is None


@given(st.integers(-44, 44), st.integers(1, 3), st.floats(1.1, 1.3))
@settings(max_examples=40, deadline=None)
def test_a_quarter_turn_of_the_grid_leaves_the_angle(angle, turns, x):
    labels = _seat(angle, (0.48, 0.42), (x, 1.2))
    plain = min_area_rectangle(np.argwhere(labels), CHAIR, VOXEL_M)
    turned = min_area_rectangle(np.argwhere(turn_grid(labels, turns)), CHAIR, VOXEL_M)
    assert (plain is None) == (turned is None)
    if plain is not None and turned is not None:
        assert plain.angle_deg == turned.angle_deg
        swapped = plain.sides[::-1] if turns % 2 else plain.sides
        np.testing.assert_allclose(turned.sides, swapped)
