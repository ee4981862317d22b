"""Where a design with handles stands: its body before its wall, the handles before the body."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.design_placement import design_box, filled_blocks
from world2minecraft.core.types import Placement
from world2minecraft.furniture import block_design, template

ROOM_M = 6.0


@given(
    st.sampled_from(["chest_of_drawers", "cabinet", "wardrobe_panels", "fridge", "stove", "sofa"]),
    st.floats(0.0, 1.0),
    st.integers(0, 3),
    st.sampled_from([1.0, 2.0, 4.0]),
)
def test_no_design_is_pushed_into_the_wall_behind(name, share, turns, scale):
    one = template(name)
    depth, width, height = one.size_m
    deep = depth.minimum + share * (depth.maximum - depth.minimum)
    size = np.array([deep, width.typical, height.typical])
    lattice = Lattice((0, 64, 0), (40, 40, 20), np.array([0.0, ROOM_M]), scale)
    # The back touches the wall that the front looks away from; walls lie on the lattice.
    away = {0: (1, 0), 1: (0, 1), 2: (-1, 0), 3: (0, -1)}[turns]
    middle = np.array([ROOM_M / 2, ROOM_M / 2, height.typical / 2])
    axis, sign = (0, away[0]) if away[0] else (1, away[1])
    middle[axis] = deep / 2 if sign > 0 else ROOM_M - deep / 2
    found = block_design(Placement(1, one.class_id, name, middle, size, turns, 1.0), scale)
    low, _ = design_box(found, Placement(1, one.class_id, name, middle, size, turns, 1.0), lattice)
    cells = np.argwhere(filled_blocks(found)) + low
    walls = lattice.coordinates_of(np.array([[0.0, 0.0, 0.0], [ROOM_M, ROOM_M, 0.0]]))[:, axis]
    if sign > 0:
        assert cells[:, axis].min() == round(walls[0])
    else:
        assert cells[:, axis].max() == round(walls[1]) - 1
