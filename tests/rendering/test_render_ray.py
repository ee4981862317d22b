"""Rays through blocks: empty boxes, bundles, glass, holes, turned boxes, and what stands out."""

from dataclasses import replace

import numpy as np
import pytest
from block_models_for_tests import FewLooks
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import CAMERA, random_pose, random_volume, volume_of

from world2minecraft.core.coordinates import apply, look_at
from world2minecraft.core.types import Camera
from world2minecraft.rendering import prepare_scene, render_volume
from world2minecraft.rendering.empty_space_boxes import find_empty_boxes
from world2minecraft.rendering.ray_caster.packet_tracing import DIVERGED, MISS, PLANE, trace_packet
from world2minecraft.rendering.scene_tables import BOXES, FULL, NO_FACE


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.floats(0, 0.5))
def test_empty_boxes_are_air_and_hold_the_cells_that_name_them(seed, share):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 12, 3))
    kinds = np.where(rng.random(shape) < share, rng.choice([FULL, BOXES], shape), 0).astype(np.int8)
    space, bounds = find_empty_boxes(kinds)
    assert np.array_equal(space < 0, kinds != 0)
    assert np.array_equal(space[kinds != 0], kinds[kinds != 0])
    for cell in np.argwhere(kinds == 0):
        low, high = bounds[space[tuple(cell)]][:3], bounds[space[tuple(cell)]][3:]
        assert (low <= cell).all()
        assert (cell < high).all()
    for x0, y0, z0, x1, y1, z1 in bounds[np.unique(space[space >= 0])]:
        assert not kinds[x0:x1, y0:y1, z0:z1].any()


def test_an_open_hall_is_one_box():
    kinds = np.zeros((20, 10, 15), np.int8)
    kinds[0], kinds[-1] = FULL, FULL
    _, bounds = find_empty_boxes(kinds)
    assert bounds.tolist() == [[1, 0, 0, 19, 10, 15]]


def test_a_bundle_agrees_with_each_of_its_rays():
    rng = np.random.default_rng(1)
    modes = []
    for _ in range(12):
        volume = random_volume(rng, share=0.05)
        scene = prepare_scene(volume)
        pose = scene.room_to_grid @ random_pose(rng, volume)
        cells = np.zeros((4, 3), np.int64)
        for u, v in rng.integers(0, 40, (30, 2)):
            offsets = [(u, v), (u + 7, v), (u, v + 7), (u + 7, v + 7)]
            rays = [pose[:3, :3] @ [(a - 20) / 30, (b - 20) / 30, 1] for a, b in offsets]
            corners = np.array([[*pose[:3, 3], *ray] for ray in rays])
            mode, face, layer = trace_packet(
                scene.tables.space, scene.tables.bounds, corners, cells
            )
            modes.append(mode)
            if mode == PLANE:
                low, high = cells[0], cells[1] + 1
                met = scene.tables.space[low[0] : high[0], low[1] : high[1], low[2] : high[2]]
                assert (met == FULL).all()
                assert low[face // 2] == layer
    assert {DIVERGED, PLANE, MISS} <= set(modes)


def test_a_bundle_that_begins_in_a_block_goes_alone():
    space, bounds = find_empty_boxes(np.full((3, 3, 3), FULL, np.int8))
    corners = np.tile([1.5, 1.5, 1.5, 1.0, 0.1, 0.1], (4, 1))
    assert trace_packet(space, bounds, corners, np.zeros((4, 3), np.int64)) == (
        DIVERGED,
        NO_FACE,
        0,
    )


def row_of(*states: int, scale: float = 1.0):
    """A row of blocks along x, with air around it; the camera's way is along x."""
    cells = np.zeros((len(states), 3, 3), np.int64)
    cells[:, 1, 1] = states
    return volume_of(cells, scale=scale)


def look_along(volume, looks=None, **options):
    eye = apply(volume.block_to_room, np.add(volume.corner, [0.5, 1.5, 1.5]))
    scene = prepare_scene(volume, looks)
    return render_volume(scene, CAMERA, look_at(eye, eye + np.array([1.0, 0, 0])), **options)


def test_a_camera_inside_a_block_ignores_that_block():
    picture = look_along(row_of(1, 0, 0, 0, 6, 0))
    assert picture.depth_m[24, 32] == pytest.approx(3.5)
    assert picture.instance[24, 32] == 18


def test_a_ray_that_misses_the_boxes_of_a_cell_goes_on():
    volume = row_of(0, 0, 4, 0, 1)  # A bottom slab, then a cube behind it.
    eye = apply(volume.block_to_room, np.add(volume.corner, [0.5, 1.75, 1.5]))
    picture = render_volume(volume, CAMERA, look_at(eye, eye + np.array([1.0, 0, 0])))
    assert picture.depth_m[24, 32] == pytest.approx(3.5)
    below = look_along(row_of(0, 0, 4, 0, 1))
    assert below.depth_m[26, 32] == pytest.approx(1.5)


def test_glass_is_told_apart_from_what_lies_behind():
    picture = look_along(row_of(0, 0, 1, 1, 0, 6), FewLooks({1: "glass"}), outputs=("opaque",))
    assert picture.depth_m[24, 32] == pytest.approx(1.5)
    assert picture.opaque_depth_m[24, 32] == pytest.approx(4.5)
    assert picture.block_index[24, 32] == np.ravel_multi_index((2, 1, 1), (6, 3, 3))
    assert picture.glass_index[24, 32] == picture.block_index[24, 32]
    assert picture.opaque_index[24, 32] == np.ravel_multi_index((5, 1, 1), (6, 3, 3))


def test_glass_tints_what_lies_behind_and_joins_its_like():
    plain = look_along(row_of(0, 0, 0, 0, 0, 6), FewLooks({1: "glass"}), outputs=("colour",))
    once = look_along(row_of(0, 0, 1, 0, 0, 6), FewLooks({1: "glass"}), outputs=("colour",))
    joined = look_along(row_of(0, 0, 1, 1, 0, 6), FewLooks({1: "glass"}), outputs=("colour",))
    apart = look_along(row_of(0, 0, 1, 0, 1, 6), FewLooks({1: "glass"}), outputs=("colour",))
    blue = [int(one.colour[24, 32, 2]) for one in (plain, once, joined, apart)]
    assert blue[0] + 20 < blue[1] < blue[3] - 5
    assert blue[1] == pytest.approx(blue[2], abs=3)


def test_holes_are_no_surface_and_their_rims_are():
    picture = look_along(row_of(0, 0, 0, 1, 0, 6), FewLooks({1: "holes"}))
    hit = picture.instance[14:34, 22:42]
    assert (hit == 3).any()
    assert (hit == 18).any()
    seen = picture.depth_m[14:34, 22:42]
    assert np.isclose(seen[hit == 3], 2.5).mean() > 0.9
    assert np.isclose(seen[hit == 18], 4.5).all()


def test_a_face_that_is_not_there_is_seen_through():
    picture = look_along(row_of(0, 0, 1, 0, 6), FewLooks({1: "no west"}))
    assert picture.depth_m[24, 32] == pytest.approx(3.5)


def test_a_turned_plate_is_met_where_it_is_and_gives_its_normal():
    picture = look_along(
        row_of(0, 0, 1, 0, 6), FewLooks({1: "diagonal"}), outputs=("normal", "colour")
    )
    assert picture.depth_m[24, 32] == pytest.approx(2.0, abs=0.05)
    normal = picture.normal[24, 32]
    assert np.linalg.norm(normal) == pytest.approx(1)
    assert normal[0] == pytest.approx(-np.sqrt(0.5))
    assert abs(normal[2]) == pytest.approx(np.sqrt(0.5))


def test_overhanging_elements_belong_to_their_block():
    volume = row_of(0, 0, 1, 0, 0)
    picture = look_along(volume, FewLooks({1: "tall"}))
    cells = set(picture.block_index[picture.block_index >= 0].tolist())
    assert cells == {np.ravel_multi_index((2, 1, 1), (5, 3, 3))}
    rows = np.nonzero((picture.block_index >= 0).any(axis=1))[0]
    assert rows.min() == 0  # Four blocks tall: it leaves the grid, and the picture.


def test_normals_of_full_blocks_are_those_of_their_faces():
    picture = look_along(row_of(0, 0, 0, 6), outputs=("normal",))
    hit = picture.block_index >= 0
    assert set(map(tuple, picture.normal[hit].tolist())) == {(-1.0, 0.0, 0.0)}
    assert not picture.normal[~hit].any()


def test_crossed_air_is_air_before_the_surface():
    rng = np.random.default_rng(4)
    volume = random_volume(rng)
    picture = render_volume(volume, CAMERA, random_pose(rng, volume), outputs=("free",))
    assert picture.free.shape == volume.states.shape
    assert (volume.states[picture.free] == 0).all()
    assert picture.free.sum() > 20
    alone = look_along(row_of(0, 0, 0, 6, 0, 0), outputs=("free",))
    assert alone.free[:3, 1, 1].all()
    assert not alone.free[3:, 1, 1].any()


def test_more_samples_change_the_colour_and_nothing_else():
    rng = np.random.default_rng(5)
    volume = random_volume(rng)
    pose = random_pose(rng, volume)
    one, four = (render_volume(volume, CAMERA, pose, samples=n) for n in (1, 2))
    assert np.array_equal(one.block_index, four.block_index)
    assert np.array_equal(one.depth_m, four.depth_m)
    assert not np.array_equal(one.colour, four.colour)
    assert np.abs(one.colour.astype(int).mean() - four.colour.astype(int).mean()) < 4


def test_clear_glass_is_a_surface_that_one_sees_through():
    states = ["minecraft:air", "minecraft:glass", "minecraft:red_concrete"]
    cells = np.zeros((6, 3, 3), np.uint16)
    cells[2, 1, 1], cells[5, 1, 1] = 1, 2
    volume = replace(volume_of(np.zeros((6, 3, 3))), palette=tuple(states), states=cells)
    picture = look_along(volume, outputs=("colour", "opaque"))
    eight = picture.depth_m[20:28, 28:36]
    assert np.allclose(eight, 1.5 / 4)
    behind = picture.opaque_depth_m[22:26, 30:34]
    assert np.isclose(behind, 4.5 / 4).any()
    red, _, blue = picture.colour[22:26, 30:34].reshape(-1, 3).max(axis=0).astype(int)
    assert red > blue + 40


def test_a_ray_from_an_edge_between_cells_ends():
    """Rounding of 0 steps pointed back there: overlapping empty boxes passed rays on for ever."""
    camera = Camera(24, 18, 20.0, 20.0, 12.0, 9.0)
    for seed in range(8):
        rng = np.random.default_rng(seed)
        scene = prepare_scene(random_volume(rng, share=0.08))
        grid_to_room = np.linalg.inv(scene.room_to_grid)
        for _ in range(6):
            eye = rng.integers(1, [8, 6, 7]).astype(np.float64)
            eye[rng.integers(3)] += rng.choice([0, 0.37])  # On an edge, or on a corner.
            ahead = rng.normal(size=3)
            pose = look_at(apply(grid_to_room, eye), apply(grid_to_room, eye + ahead))
            depth_m = render_volume(scene, camera, pose, outputs=()).depth_m
            assert np.isfinite(depth_m).all()
