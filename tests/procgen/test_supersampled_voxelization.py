"""Round and turned parts as voxels: volumes are kept, turns are true, bars hang together."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.geometry.connected_components import label_components
from world2minecraft.procgen.rooms.furniture_model import Bar, Model, Part
from world2minecraft.procgen.rooms.placement import Item
from world2minecraft.procgen.rooms.supersampled_voxelization import (
    is_plain,
    make_model,
    solid_cells,
)

WOOD = (180, 140, 90)


def item(part, yaw_deg=0.0, x_m=1.0, y_m=2.0):
    return Item(Model("thing", 11, (0.4, 0.3, 0.5), (part,)), x_m, y_m, 0.0, yaw_deg)


@given(
    st.floats(0.1, 0.5), st.floats(0.1, 0.5), st.floats(0.1, 0.5), st.floats(0, 360),
    st.sampled_from(["box", "ball", "drum"]),
)  # fmt: skip
@settings(max_examples=25, deadline=None)
def test_the_volume_is_that_of_the_shape(depth, width, height, yaw_deg, form):
    part = Part((-depth / 2, -width / 2, 0, depth / 2, width / 2, height), WOOD, form=form)
    _, filled = solid_cells(item(part, yaw_deg), part)
    share = {"box": 1.0, "ball": np.pi / 6, "drum": np.pi / 4}[form]
    volume = share * depth * width * height
    # A third of a voxel is enough to fill it, so that thin boards stay: a skin of 4 mm at most.
    skin = 0.004 * 2 * (depth * width + depth * height + width * height)
    assert volume - skin < filled.sum() * 8e-6 < volume + 1.5 * skin


@pytest.mark.parametrize("yaw_deg", [0, 90, 180, 270])
def test_a_box_turned_by_quarters_is_the_box_to_the_voxel(yaw_deg):
    part = Part((-0.2, -0.14, 0.0, 0.2, 0.14, 0.3), WOOD)
    first, filled = solid_cells(item(part, yaw_deg), part)
    wanted = (20, 14, 15) if yaw_deg % 180 == 0 else (14, 20, 15)
    assert filled.shape == wanted and filled.all()
    assert first.tolist() == [50 - wanted[0] // 2, 100 - wanted[1] // 2, 0]
    assert is_plain(item(part, yaw_deg), part)


@given(st.floats(-180, 180))
@settings(max_examples=20, deadline=None)
def test_a_turned_board_of_one_voxel_has_no_gaps(yaw_deg):
    part = Part((-0.01, -0.2, 0.0, 0.01, 0.2, 0.1), WOOD)
    _, filled = solid_cells(item(part, yaw_deg), part)
    assert label_components(filled, corners=True)[1] == 1
    i, j = np.nonzero(filled.any(axis=2))
    assert np.hypot(np.ptp(i), np.ptp(j)) >= 18


@given(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4), st.floats(0.1, 0.9))
@settings(max_examples=20, deadline=None)
def test_a_bar_is_one_piece_from_end_to_end(x, y, z):
    bar = Bar((0.0, 0.0, 0.0), (x, y, z), 0.014, WOOD)
    _, filled = solid_cells(item(bar), bar)
    assert label_components(filled)[1] == 1
    assert filled.any(axis=(0, 1)).sum() >= int(z / 0.02)


def test_the_front_turns_with_the_yaw():
    part = Part((0.1, -0.02, 0.0, 0.2, 0.02, 0.1), WOOD)
    for yaw_deg in (30, 115, 260):
        first, filled = solid_cells(item(part, yaw_deg, 0.0, 0.0), part)
        middle = (np.argwhere(filled).mean(axis=0) + first + 0.5) * 0.02
        angle = np.arctan2(middle[1], middle[0])
        assert np.degrees(angle) % 360 == pytest.approx(yaw_deg, abs=2)


def test_a_model_fills_its_size_wherever_its_parts_were_drawn():
    parts = [Part((3.0, 1.0, 0.5, 3.3, 1.2, 0.9), WOOD, form="ball"),
             Bar((3.1, 1.1, 0.5), (3.6, 1.4, 0.7), 0.02, WOOD)]  # fmt: skip
    model = make_model("thing", 11, parts)
    placed = Item(model, model.size_m[0] / 2, model.size_m[1] / 2, 0.0, 0.0)
    cells = [np.argwhere(f) + first for first, f in (solid_cells(placed, p) for p in model.parts)]
    held = np.concatenate(cells)
    assert held.min(axis=0).tolist() == [0, 0, 0]
    assert ((held.max(axis=0) + 1) * 0.02).tolist() == pytest.approx(list(model.size_m))
