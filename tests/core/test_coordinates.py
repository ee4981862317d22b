"""Frames, axes and angles: laws first, then the paper's own equations."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from world2minecraft.core import coordinates as co

metres = st.floats(-20, 20, allow_nan=False, width=32)
degrees = st.floats(-720, 720, allow_nan=False, width=32)
pitches = st.floats(-90, 90, allow_nan=False, width=32)
scales = st.sampled_from([0.5, 1.0, 2.0, 4.0, 12.5])
vectors = hnp.arrays(np.float64, (3,), elements=metres)
clouds = hnp.arrays(np.float64, st.tuples(st.integers(0, 8), st.just(3)), elements=metres)
grids = hnp.arrays(np.uint8, hnp.array_shapes(min_dims=3, max_dims=3, min_side=1, max_side=5))
turns = st.integers(-9, 9)


@st.composite
def rigid(draw):
    """A rotation by two yaws with a tumble between them, and a shift."""
    tumble = np.eye(4)
    tumble[:3, :3] = co.ROOM_AXES_TO_BLOCK
    transform = co.rotation_about_z(draw(degrees)) @ tumble @ co.rotation_about_z(draw(degrees))
    transform[:3, 3] = draw(vectors)
    return transform


def assert_rotation(rotation):
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(rotation) == pytest.approx(1)


def assert_transform(transform):
    """It is 4x4, so that products of transforms chain, and moves no point into the distance."""
    assert transform.shape == (4, 4)
    assert transform[3].tolist() == [0, 0, 0, 1]


# Transforms.


@given(rigid(), clouds)
def test_inverse_takes_points_back(transform, points):
    for inverse in (co.invert(transform), co.invert_rigid(transform)):
        assert_transform(inverse)
        np.testing.assert_allclose(inverse @ transform, np.eye(4), atol=1e-9)
        np.testing.assert_allclose(
            co.apply(inverse, co.apply(transform, points)), points, atol=1e-9
        )


@given(rigid(), rigid(), clouds)
def test_a_product_applies_the_right_one_first(b_to_c, a_to_b, points):
    chained = co.apply(b_to_c @ a_to_b, points)
    np.testing.assert_allclose(chained, co.apply(b_to_c, co.apply(a_to_b, points)), atol=1e-9)


def test_apply_keeps_leading_axes():
    points = np.arange(24.0).reshape(2, 4, 3)
    shift = np.eye(4)
    shift[:3, 3] = [1, 2, 3]
    assert np.array_equal(co.apply(shift, points), points + np.array([1, 2, 3]))


@given(degrees)
def test_a_turn_about_z_is_a_rotation_that_keeps_up(yaw):
    turn = co.rotation_about_z(yaw)
    assert_transform(turn)
    assert_rotation(turn[:3, :3])
    assert np.array_equal(turn[:3, 2], [0, 0, 1])


def test_quarter_turns_are_exact_and_counter_clockwise():
    x = np.array([1.0, 0.0, 0.0])
    seen = [co.apply(co.rotation_about_z(90 * turn), x).tolist() for turn in range(5)]
    assert seen == [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]]


# Cameras.


def test_opengl_and_opencv_cameras_see_the_same_ray():
    """OpenGL looks along its -z with y up; OpenCV along its +z with y down."""
    gl_to_world = np.eye(4)
    cv_to_world = co.opengl_to_opencv_pose(gl_to_world)
    for gl, cv in [([0, 0, -1], [0, 0, 1]), ([0, 1, 0], [0, -1, 0]), ([1, 0, 0], [1, 0, 0])]:
        gl_ray = co.apply(gl_to_world, np.array(gl, float))
        assert np.array_equal(gl_ray, co.apply(cv_to_world, np.array(cv, float)))
    assert_rotation(cv_to_world[:3, :3])


@given(rigid())
def test_opengl_to_opencv_twice_is_the_identity(pose):
    twice = co.opengl_to_opencv_pose(co.opengl_to_opencv_pose(pose))
    np.testing.assert_array_equal(twice, pose)
    np.testing.assert_array_equal(co.opengl_to_opencv_pose(pose)[:3, 3], pose[:3, 3])


@given(vectors, vectors)
def test_look_at_sees_its_target_straight_ahead(eye, target):
    distance = np.linalg.norm(target - eye)
    if distance < 0.1:
        return
    pose = co.look_at(eye, target)
    assert_transform(pose)
    assert_rotation(pose[:3, :3])
    seen = co.apply(co.invert_rigid(pose), target)
    np.testing.assert_allclose(seen, [0, 0, distance], atol=1e-6 * (1 + distance))
    assert pose[2, 1] <= 1e-9  # The image's down never points up in the room.


@pytest.mark.parametrize("up", [1.0, -1.0])
def test_look_at_straight_up_or_down_is_still_a_rotation(up):
    assert_rotation(co.look_at(np.zeros(3), np.array([0, 0, up]))[:3, :3])


@pytest.mark.parametrize("up", [1.0, -1.0])
def test_looking_straight_up_is_the_limit_of_tilting(up):
    """Who looks along +x and tilts to the zenith, or the nadir, ends in the same picture."""
    almost = co.look_at(np.zeros(3), np.array([1e-5, 0, up]))
    straight = co.look_at(np.zeros(3), np.array([0, 0, up]))
    np.testing.assert_allclose(straight, almost, atol=1e-4)


# Grids.


@given(
    hnp.arrays(np.int64, st.tuples(st.integers(0, 8), st.just(3)), elements=st.integers(-99, 99)),
    hnp.arrays(np.int64, (3,), elements=st.integers(-99, 99)),
    st.sampled_from([0.02, 0.04, 0.08, 0.1]),
)
def test_the_centre_of_a_cell_lies_in_it(cells, corner, voxel_m):
    origin_m = corner * voxel_m
    centers = co.cell_centers_m(cells, origin_m, voxel_m)
    assert np.array_equal(co.metres_to_cells(centers, origin_m, voxel_m), cells)


def test_a_cell_holds_its_minimum_corner_and_not_the_other():
    points = np.array([[0.0, 0.0, 0.0], [0.5, 0.25, 0.25], [-0.125, 0.0, 0.0]])
    cells = co.metres_to_cells(points, np.zeros(3), 0.25)
    assert cells.tolist() == [[0, 0, 0], [2, 1, 1], [-1, 0, 0]]


@given(grids, turns, turns)
def test_turns_of_a_grid_add_up_and_four_are_the_identity(grid, first, second):
    twice = co.turn_grid(co.turn_grid(grid, first), second)
    np.testing.assert_array_equal(twice, co.turn_grid(grid, first + second))
    np.testing.assert_array_equal(co.turn_grid(grid, 4), grid)


def test_a_turned_grid_follows_the_turned_room():
    """Slow reference: cell centres about the grid's middle, carried by the 4x4 turn."""
    grid = np.arange(2 * 3 * 2).reshape(2, 3, 2)
    turned = co.turn_grid(grid, 1)
    for i, j, k in np.ndindex(grid.shape):
        middle = np.array([i + 0.5 - 1, j + 0.5 - 1.5, k])
        x, y, _ = co.apply(co.rotation_about_z(90), middle)
        assert turned[int(x + 1.5), int(y + 1), k] == grid[i, j, k]


# Rooms and blocks.


@given(metres, metres, scales, clouds)
def test_block_to_room_undoes_room_to_block(x_min, y_max, scale, points):
    corner = np.array([x_min, y_max])
    there = co.apply(co.room_to_block(corner, scale), points)
    np.testing.assert_allclose(co.apply(co.block_to_room(corner, scale), there), points, atol=1e-9)


@given(metres, metres, scales)
def test_a_room_is_never_mirrored(x_min, y_max, scale):
    linear = co.room_to_block(np.array([x_min, y_max]), scale)[:3, :3]
    assert_rotation(linear / scale)


@given(metres, metres, scales)
def test_the_corner_of_the_room_stands_where_it_must(x_min, y_max, scale):
    transform = co.room_to_block(np.array([x_min, y_max]), scale)
    assert_transform(transform)
    corner = co.apply(transform, np.array([x_min, y_max, 0.0]))
    np.testing.assert_allclose(corner, co.ROOM_CORNER_BLOCK, atol=1e-9)


def test_room_axes_are_east_up_and_north():
    transform = co.room_to_block(np.zeros(2), 1.0)
    axes = [co.apply(transform, axis) - co.ROOM_CORNER_BLOCK for axis in np.eye(3)]
    assert np.array_equal(axes, [[1, 0, 0], [0, 0, -1], [0, 1, 0]])


@given(grids)
def test_block_axes_and_back_is_the_identity(grid):
    np.testing.assert_array_equal(co.block_axes_to_grid(co.grid_to_block_axes(grid)), grid)


@given(grids)
def test_cells_and_grids_go_to_block_axes_alike(grid):
    cells = np.argwhere(np.ones_like(grid))
    there = co.cells_to_block_axes(cells, grid.shape[1])
    blocks = co.grid_to_block_axes(grid)
    np.testing.assert_array_equal(blocks[tuple(there.T)], grid[tuple(cells.T)])


@given(grids, scales)
def test_integer_maps_and_metres_agree(grid, blocks_per_metre):
    """At one block a voxel, a cell's centre in metres falls in the block that it goes to."""
    voxel_m = 1 / blocks_per_metre
    y_max = grid.shape[1] * voxel_m
    cells = np.argwhere(np.ones_like(grid))
    centers = co.cell_centers_m(cells, np.zeros(3), voxel_m)
    block = co.apply(co.room_to_block(np.array([0.0, y_max]), blocks_per_metre), centers)
    expected = co.cells_to_block_axes(cells, grid.shape[1]) + co.ROOM_CORNER_BLOCK
    np.testing.assert_array_equal(np.floor(block), expected)


def test_an_l_shaped_room_is_not_mirrored():
    """Seen from above, the chair stands to the left of one who looks from the door to the notch.

    A mirror image would put it to the right; a turn cannot.
    """
    room = np.zeros((4, 3, 1), np.uint8)
    room[0, 0], room[3, 0], room[0, 2] = 1, 2, 3  # Door, notch, chair.
    blocks = co.grid_to_block_axes(room)
    (door,), (notch,), (chair,) = (np.argwhere(blocks == value) for value in (1, 2, 3))
    ahead, aside = notch - door, chair - door
    # From above, with x east and z south, left of ahead is (z, -x) of it.
    assert aside[0] * ahead[2] - aside[2] * ahead[0] > 0


# Angles.


@given(degrees)
def test_a_room_yaw_and_its_game_yaw_look_the_same_way(yaw):
    ahead = co.apply(co.rotation_about_z(yaw), np.array([1.0, 0.0, 0.0]))
    pose = co.camera_to_block_of_game_pose(np.zeros(3), -90.0 - yaw, 0.0)
    np.testing.assert_allclose(pose[:3, 2], co.ROOM_AXES_TO_BLOCK @ ahead, atol=1e-6)


@given(degrees, pitches, vectors)
def test_the_game_camera_is_right_handed(yaw, pitch, eye):
    pose = co.camera_to_block_of_game_pose(eye, yaw, pitch)
    assert_transform(pose)
    assert_rotation(pose[:3, :3])
    assert np.array_equal(pose[:3, 3], eye)
    assert pose[1, 0] == pytest.approx(0)  # The image's right is level,
    assert pose[1, 1] <= 1e-9  # and its down never points up.


@pytest.mark.parametrize(
    ("yaw", "pitch", "forward"),
    [
        (0, 0, [0, 0, 1]),
        (-90, 0, [1, 0, 0]),
        (90, 0, [-1, 0, 0]),
        (180, 0, [0, 0, -1]),
        (0, 90, [0, -1, 0]),
        (0, -90, [0, 1, 0]),
    ],
)
def test_the_game_camera_looks_where_the_game_says(yaw, pitch, forward):
    pose = co.camera_to_block_of_game_pose(np.zeros(3), yaw, pitch)
    np.testing.assert_allclose(pose[:3, 2], forward, atol=1e-12)


def test_looking_south_the_right_hand_is_west():
    assert np.allclose(co.camera_to_block_of_game_pose(np.zeros(3), 0, 0)[:3, 0], [-1, 0, 0])


# The paper's equations, and where they slip.


def printed_rotation(yaw, pitch):
    """The last equation of the paper's "Extrinsic Camera Matrix", as it stands there."""
    s, c, sp, cp = np.sin(yaw), np.cos(yaw), np.sin(pitch), np.cos(pitch)
    return np.array([[-c, 0, -s], [s * sp, -cp, -c * sp], [-s * cp, -sp, c * cp]])


@given(degrees, pitches)
def test_the_papers_rotation_is_its_printed_equation(yaw, pitch):
    printed = printed_rotation(np.radians(yaw), np.radians(pitch))
    np.testing.assert_allclose(co.paper_rotation(yaw, pitch), printed, atol=1e-6)


@given(degrees, pitches)
def test_the_papers_rotation_is_world_to_camera(yaw, pitch):
    ours = co.camera_to_block_of_game_pose(np.zeros(3), yaw, pitch)[:3, :3]
    np.testing.assert_allclose(co.paper_rotation(yaw, pitch), ours.T, atol=1e-6)


def test_the_papers_rotation_is_wrong_for_nonzero_pitch():
    """Level it is its own transpose; facing north and looking down, it says up."""
    level = co.paper_rotation(37, 0)
    np.testing.assert_allclose(level, level.T, atol=1e-12)
    forward = co.paper_rotation(180, 30)[:, 2]
    assert forward[1] == pytest.approx(0.5)
    assert co.camera_to_block_of_game_pose(np.zeros(3), 180, 30)[1, 2] == pytest.approx(-0.5)


@pytest.mark.parametrize(("width", "height", "fov"), [(640, 480, 70), (1920, 1129, 90)])
def test_the_papers_focal_length_is_too_long_by_the_aspect(width, height, fov):
    alpha = np.radians(fov)
    assert co.paper_focal_px(width, fov) == pytest.approx(width / (2 * np.tan(alpha / 2)))
    right = co.focal_px_of_fov(height, fov)
    assert co.paper_focal_px(width, fov) / right == pytest.approx(width / height)


@given(st.integers(1, 4000), st.floats(1, 170))
def test_a_field_of_view_comes_back_from_its_focal_length(side, fov):
    assert co.fov_deg_of_focal_px(side, co.focal_px_of_fov(side, fov)) == pytest.approx(fov)


@given(vectors, degrees, st.floats(-90, 90, allow_nan=False, width=32))
def test_a_game_pose_comes_back_from_its_camera(eye, yaw, pitch):
    """Straight up and down too, where the way that one looks says no yaw."""
    camera_to_block = co.camera_to_block_of_game_pose(eye, yaw, pitch)
    found_eye, found_yaw, found_pitch = co.game_pose_of_camera_to_block(camera_to_block)
    assert np.array_equal(found_eye, eye)
    assert -180 <= found_yaw < 180
    off = (found_yaw - yaw + 180) % 360 - 180
    assert off == pytest.approx(0, abs=1e-4)
    assert found_pitch == pytest.approx(pitch, abs=1e-4)


@pytest.mark.parametrize(
    ("yaw", "pitch", "ahead"),
    [(0, 0, (0, 0, 1)), (90, 0, (-1, 0, 0)), (180, 0, (0, 0, -1)), (-90, 0, (1, 0, 0)),
     (0, 90, (0, -1, 0)), (0, -90, (0, 1, 0))],
)  # fmt: skip
def test_game_yaw_is_clockwise_from_south(yaw, pitch, ahead):
    pose = co.camera_to_block_of_game_pose(np.zeros(3), yaw, pitch)
    np.testing.assert_allclose(pose[:3, 2], ahead, atol=1e-12)


@given(vectors, degrees, pitches, scales, vectors)
def test_a_camera_that_is_carried_sees_the_same(eye, yaw, pitch, scale, point):
    """What is ahead in blocks is as far ahead in the room, in metres, and in the same pixel."""
    block_to_room = co.block_to_room(np.array([1.0, 2.0]), scale)
    camera_to_block = co.camera_to_block_of_game_pose(eye, yaw, pitch)
    camera_to_room = co.carry_camera(camera_to_block, block_to_room)
    assert_transform(camera_to_room)
    assert_rotation(camera_to_room[:3, :3])
    in_blocks = co.apply(co.invert_rigid(camera_to_block), point)
    in_room = co.apply(co.invert_rigid(camera_to_room), co.apply(block_to_room, point))
    np.testing.assert_allclose(in_room * scale, in_blocks, atol=1e-6)
    back = co.carry_camera(camera_to_room, co.invert(block_to_room))
    np.testing.assert_allclose(back, camera_to_block, atol=1e-6)


@given(rigid(), rigid(), scales)
def test_any_frame_may_carry_a_camera(camera_to_a, a_to_b, scale):
    """However the frames are turned to each other: its axes stay as long, its place moves."""
    a_to_b[:3, :3] *= scale
    camera_to_b = co.carry_camera(camera_to_a, a_to_b)
    assert_transform(camera_to_b)
    assert_rotation(camera_to_b[:3, :3])
    ahead = co.apply(a_to_b, camera_to_a[:3, 3] + camera_to_a[:3, 2])
    np.testing.assert_allclose(
        co.apply(co.invert_rigid(camera_to_b), ahead), [0, 0, scale], atol=1e-6
    )


@given(rigid())
def test_pitch_of_a_rolled_camera_stays_within_90_degrees(pose):
    _, yaw, pitch = co.game_pose_of_camera_to_block(pose)
    assert -180 <= yaw < 180
    assert -90 <= pitch <= 90


@pytest.mark.parametrize(("scale", "eye"), [(1.0, 1.62), (4.0, 6.48)])
def test_a_player_grows_with_the_scale(scale, eye):
    assert co.eye_height_blocks(scale) == pytest.approx(eye)


@given(st.integers(1, 4000), st.floats(1, 170))
def test_a_focal_length_spans_its_field_of_view(side, fov):
    seen = 2 * np.degrees(np.arctan(side / 2 / co.focal_px_of_fov(side, fov)))
    assert seen == pytest.approx(fov)


def test_sides_of_a_room_have_the_compass_names_of_blocks():
    block_of = {"east": (1, 0, 0), "west": (-1, 0, 0), "south": (0, 0, 1), "north": (0, 0, -1)}
    for side, name in co.COMPASS_OF_SIDE.items():
        outward = np.zeros(3)
        outward["xy".index(side[0])] = 1 if side[1] == "+" else -1
        assert tuple(co.ROOM_AXES_TO_BLOCK @ outward) == block_of[name]
