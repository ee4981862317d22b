"""The paper's two cases, their turns, and the grid that regions stand on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from label_worlds import poses_in, room_of_things

from world2minecraft.core.coordinates import apply, invert, look_at, rotation_about_z
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraftocc.labels.camera_region import (
    RegionRule,
    floor_under,
    label_region,
    region_in,
)
from world2minecraft.minecraftocc.labels.image_labels import gather_region, is_on_cells
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.minecraftocc.types import FineClass, SceneVoxels

PLAIN = RegionRule(axis_offset_cells=0, diagonal_offset_cells=0)
EYE = np.array([1.23, -0.71, 1.6])


def looking(yaw_deg: float, pitch_deg: float = -10.0, eye=EYE) -> np.ndarray:
    ahead = rotation_about_z(yaw_deg)[:3, 0] + [0, 0, np.tan(np.radians(pitch_deg))]
    return look_at(eye, eye + ahead)


@pytest.mark.parametrize("yaw_deg", range(0, 360, 90))
def test_an_axis_view_has_its_player_at_the_middle_of_the_back(yaw_deg):
    region = label_region(looking(yaw_deg + 3.0), PLAIN)
    assert region.kind == "axis"
    at = apply(invert(region.region_to_room), EYE) / region.voxel_m
    assert np.abs(at[:2] - [30, 0]).max() <= 0.5 + 1e-6
    ahead = invert(region.region_to_room)[:3, :3] @ rotation_about_z(yaw_deg)[:3, 0]
    assert np.allclose(ahead, [0, 1, 0])


@pytest.mark.parametrize("yaw_deg", range(45, 360, 90))
def test_a_diagonal_view_has_its_player_at_the_minimum_corner(yaw_deg):
    region = label_region(looking(yaw_deg - 4.0), PLAIN)
    assert region.kind == "diagonal"
    at = apply(invert(region.region_to_room), EYE) / region.voxel_m
    assert np.abs(at[:2]).max() <= 0.5 + 1e-6
    ahead = invert(region.region_to_room)[:3, :3] @ rotation_about_z(yaw_deg)[:3, 0]
    assert np.allclose(ahead, [np.sqrt(0.5), np.sqrt(0.5), 0])


@pytest.mark.parametrize(
    ("yaw_deg", "kind"),
    [(22.4, "axis"), (22.6, "diagonal"), (67.4, "diagonal"), (67.6, "axis")],
)
def test_the_nearest_of_eight_yaws_tells_the_case(yaw_deg, kind):
    assert label_region(looking(yaw_deg), PLAIN).kind == kind


@given(yaw_deg=st.floats(-360, 360), floor_cells=st.integers(-40, 40))
def test_the_floor_is_the_bottom_layer(yaw_deg, floor_cells):
    for kind in ("paper", "free"):
        region = label_region(looking(yaw_deg), RegionRule(kind), floor_m=floor_cells * 0.08)
        assert np.isclose(region.region_to_room[2, 3], (floor_cells - 1) * 0.08)


@given(yaw_deg=st.floats(-360, 360))
def test_four_quarter_turns_of_a_view_are_the_identity(yaw_deg):
    one, four = (label_region(looking(yaw_deg + turn)).region_to_room for turn in (0, 360))
    assert np.allclose(one, four)


@pytest.mark.parametrize("yaw_deg", [0.0, 45.0, 90.0, 135.0])
def test_regions_of_opposite_views_lie_back_to_back(yaw_deg):
    eye = np.array([0.4, 0.8, 1.6])  # On the cells' borders, so that no rounding is between.
    here, there = (label_region(looking(yaw_deg + turn, eye=eye), PLAIN) for turn in (0, 180))
    half_turn = rotation_about_z(180.0)
    half_turn[:2, 3] = 2 * eye[:2]
    assert np.allclose(half_turn @ here.region_to_room, there.region_to_room)


@pytest.mark.parametrize(("yaw_deg", "back"), [(0.0, [0, 5]), (45.0, [3, 3])])
def test_the_fallback_offset_moves_the_box_back(yaw_deg, back):
    rule = RegionRule(axis_offset_cells=5, diagonal_offset_cells=3)
    plain, moved = (label_region(looking(yaw_deg), one) for one in (PLAIN, rule))
    shift = invert(plain.region_to_room) @ moved.region_to_room
    assert np.allclose(shift[:3, 3], [-back[0] * 0.08, -back[1] * 0.08, 0])


@given(yaw_deg=st.floats(-180, 180), x=st.floats(-5, 5), y=st.floats(-5, 5))
def test_a_paper_region_falls_on_the_cells_of_its_scene(yaw_deg, x, y):
    origin = np.array([0.03, -0.01, 0.02])
    pose = looking(yaw_deg, eye=np.array([x, y, 1.5]))
    region = label_region(pose, RegionRule(shape=(7, 9, 5)), grid_origin_m=origin)
    cells = (region.centers_m() - origin) / 0.08 - 0.5
    assert np.abs(cells - np.round(cells)).max() < 1e-6


@pytest.mark.parametrize("yaw_deg", range(0, 360, 45))
def test_a_copy_is_what_slices_and_quarter_turns_give(yaw_deg):
    voxels = voxelize_scene(room_of_things())
    pose = looking(yaw_deg, eye=np.array([1.0, 0.9, 1.0]))
    region = region_in(voxels, pose, RegionRule(shape=(12, 12, 9)))
    assert is_on_cells(region, voxels)
    own, to_room = gather_region(voxels, region)[0], region.region_to_room
    ends = apply(region.region_to_room, np.array([np.zeros(3), region.shape]) * region.voxel_m)
    first = np.round((ends.min(axis=0) - voxels.origin_m) / voxels.voxel_m).astype(int)
    wide = np.pad(voxels.labels, 40, constant_values=255)
    box = wide[tuple(slice(a + 40, a + 40 + n) for a, n in zip(first, region.shape, strict=True))]
    turns = round(np.degrees(np.arctan2(to_room[1, 0], to_room[0, 0])) / 90)
    assert np.array_equal(own, np.rot90(box, -turns))


def test_a_free_region_turns_with_the_view():
    region = label_region(looking(33.3), RegionRule("free"))
    ahead = invert(region.region_to_room)[:3, :3] @ rotation_about_z(33.3)[:3, 0]
    assert np.allclose(ahead, [0, 1, 0])
    assert np.allclose((invert(region.region_to_room) @ [*EYE, 1])[:2] / 0.08, [30, 0])


def test_the_floor_under_a_camera_is_found():
    volume = room_of_things()
    voxels = voxelize_scene(volume)
    for pose in poses_in(volume, 8, 1):
        assert floor_under(voxels, pose) == pytest.approx(0.0)
    assert floor_under(voxels, look_at([50.0, 50.0, 1.0], [51.0, 50.0, 1.0])) == pytest.approx(0)


@pytest.mark.parametrize(("x", "height"), [(0.4, 0.0), (2.6, 1.04)])
def test_a_rug_is_no_floor_and_a_gallery_is(x, height):
    labels = np.zeros((50, 30, 40), np.uint8)
    labels[:, :, :3] = labels[25:, :, 15] = 2
    labels[3:9, 10:20, 3] = 2  # The rug that one stands on.
    fine = (labels > 0).astype(np.uint16)
    names = (FineClass("minecraft:air"), FineClass("minecraft:stone"))
    voxels = SceneVoxels(labels, fine, 0 * fine, names, 0.08, np.array([0, 0, -0.24]))
    pose = look_at([x, 1.2, 1.6 + height], [1.0, 5.0, 1.6 + height])
    assert floor_under(voxels, pose) == pytest.approx(height)


def test_a_camera_may_look_straight_down():
    down = look_at(EYE, EYE - [0, 0, 1.0])
    assert label_region(down).kind in ("axis", "diagonal")


def test_errors_say_what_to_do():
    with pytest.raises(UnknownNameError, match=r"no region kind is named 'papers'; did you"):
        RegionRule("papers")
    with pytest.raises(UsageError, match=r"must be three positive integers, got \(0, 1, 1\)"):
        RegionRule(shape=(0, 1, 1))
