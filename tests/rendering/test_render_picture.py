"""Pictures: planes at their depth, turned scenes, the ids' meaning, bands, refusals."""

import numpy as np
import pytest
from scenes import CAMERA, PALETTE, random_pose, random_volume, volume_of

from world2minecraft.core.coordinates import apply, look_at
from world2minecraft.core.types import Camera
from world2minecraft.minecraft.turn_and_mirror import turn_volume
from world2minecraft.rendering import cast_voxels, prepare_scene, render_volume
from world2minecraft.rendering.plain_models import INVISIBLE, visible_boxes


def closed_room(scale=4.0):
    states = np.ones((18, 12, 14), np.int64)
    states[1:-1, 1:-1, 1:-1] = 0
    return volume_of(states, scale=scale)


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 12.5])
def test_a_wall_lies_at_its_analytic_depth(scale):
    volume = closed_room(scale)
    middle = np.array(volume.corner) + np.array(volume.states.shape) / 2
    eye = apply(volume.block_to_room, middle)
    picture = render_volume(volume, CAMERA, look_at(eye, eye + np.array([1.0, 0, 0])))
    on_wall = picture.face == 0
    assert on_wall.sum() > 500
    assert np.allclose(picture.depth_m[on_wall], 8 / scale, atol=1e-5)
    v, u = np.nonzero(on_wall)
    rays = np.hypot(np.hypot((u + 0.5 - 32) / 40, (v + 0.5 - 24) / 40), 1)
    assert np.allclose(picture.range_m[on_wall], rays * 8 / scale, rtol=1e-5)


def test_every_ray_meets_a_closed_room():
    volume = closed_room()
    inside = np.random.default_rng(5)
    for _ in range(5):
        low = np.array(volume.corner) + 1.2
        eye = apply(
            volume.block_to_room, inside.uniform(low, low + np.array(volume.states.shape) - 2.4)
        )
        picture = render_volume(volume, CAMERA, look_at(eye, eye + inside.normal(size=3)))
        assert (picture.block_index >= 0).all()


def test_rotating_scene_and_camera_keeps_the_picture():
    rng = np.random.default_rng(6)
    volume = random_volume(rng, (8, 6, 8))
    turned = turn_volume(volume, 1)
    centre = np.array(volume.corner) + np.array(volume.states.shape) / 2
    # Counter-clockwise from above: block +x (east) becomes -z (north).
    turn = np.eye(4)
    turn[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    new_centre = np.array(turned.corner) + np.array(turned.states.shape) / 2
    turn[:3, 3] = new_centre - turn[:3, :3] @ centre
    room = volume.block_to_room
    pose = random_pose(rng, volume)
    moved = turned.block_to_room @ turn @ np.linalg.inv(room) @ pose
    first = render_volume(volume, CAMERA, pose)
    second = render_volume(turned, CAMERA, moved)
    hit = first.block_index >= 0
    assert hit.sum() > 500
    assert np.isclose(first.depth_m, second.depth_m, atol=1e-4).mean() > 0.999
    assert (first.instance == second.instance).mean() > 0.999


def test_ids_are_those_of_the_block_that_is_named():
    volume = random_volume(np.random.default_rng(7))
    picture = render_volume(volume, CAMERA, random_pose(np.random.default_rng(8), volume))
    hit = picture.block_index >= 0
    named = picture.block_index[hit]
    assert (volume.states.reshape(-1)[named] > 0).all()
    assert np.array_equal(picture.semantic[hit], volume.semantic.reshape(-1)[named])
    assert np.array_equal(picture.instance[hit], volume.instance.reshape(-1)[named])
    assert (picture.semantic[~hit] == 0).all()
    assert (picture.face[~hit] == 255).all()
    assert (picture.depth_m[~hit] == 0).all()


def test_bands_on_threads_change_nothing():
    volume = random_volume(np.random.default_rng(9))
    pose = random_pose(np.random.default_rng(10), volume)
    camera = Camera(70, 53, 45.0, 44.0, 34.0, 27.0)
    one = render_volume(volume, camera, pose)
    for threads in (2, 3, 16):
        many = render_volume(volume, camera, pose, threads=threads)
        for name in ("colour", "depth_m", "range_m", "block_index", "face", "semantic"):
            assert np.array_equal(getattr(one, name), getattr(many, name)), name


def test_a_scene_made_once_gives_the_same_picture():
    volume = random_volume(np.random.default_rng(11))
    pose = random_pose(np.random.default_rng(12), volume)
    direct = render_volume(volume, CAMERA, pose)
    prepared = render_volume(prepare_scene(volume), CAMERA, pose)
    assert np.array_equal(direct.colour, prepared.colour)


def test_only_what_is_asked_for_is_made():
    volume = random_volume(np.random.default_rng(13))
    picture = render_volume(volume, CAMERA, np.eye(4), outputs=("semantic",))
    assert picture.colour is None
    assert picture.instance is None
    assert picture.semantic is not None


def test_an_unknown_output_is_refused():
    with pytest.raises(
        ValueError,
        match="^unknown output 'normals'; outputs: colour, depth, semantic, instance, opaque",
    ):
        render_volume(closed_room(), CAMERA, np.eye(4), outputs=("normals",))


def test_an_enormous_picture_is_refused_before_memory_is_taken():
    camera = Camera(20_000, 20_000, 100.0, 100.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="an image may have at most 64,000,000 samples"):
        render_volume(closed_room(), camera, np.eye(4))


def test_a_red_block_is_red_with_darker_corners():
    states = np.zeros((9, 9, 9), np.int64)
    states[:, 0, :] = 6
    states[4, 1, 4] = 1
    volume = volume_of(states, scale=1.0)
    middle = apply(volume.block_to_room, volume.corner + np.array([4.5, 6.0, 4.5]))
    picture = render_volume(
        volume, Camera(90, 90, 60, 60, 45, 45), look_at(middle, middle - [0, 0, 1])
    )
    floor = picture.instance == 18
    red, green, blue = (picture.colour[..., n][floor].astype(int) for n in range(3))
    assert (red > green + 60).all()
    assert (red > blue + 60).all()
    # Beside the block the floor is darker than far from it.
    offset = np.hypot(*(np.indices((90, 90)) - 44.5))
    ring, away = floor & (offset < 12), floor & (offset > 22) & (offset < 30)
    assert ring.any()
    assert picture.colour[..., 0][ring].mean() < picture.colour[..., 0][away].mean() - 5


@pytest.mark.parametrize(
    "state",
    [
        "minecraft:torch",
        "minecraft:oak_sign[rotation=0,waterlogged=false]",
        "minecraft:oak_wall_sign[facing=north,waterlogged=false]",
        "minecraft:stone_button[face=wall,facing=east,powered=false]",
        "minecraft:poppy",
        "minecraft:white_carpet",
    ],
)
def test_nothing_that_is_placed_vanishes(state):
    boxes = visible_boxes(state)
    assert len(boxes) >= 1
    assert (boxes[:, 3:] > boxes[:, :3]).all()
    assert boxes.min() >= 0
    assert boxes.max() <= 1


@pytest.mark.parametrize("state", sorted(INVISIBLE))
def test_what_nobody_sees_is_not_drawn(state):
    assert len(visible_boxes(state)) == 0


def test_a_virtual_scan_lands_on_the_voxels_that_it_names():
    rng = np.random.default_rng(14)
    labels = np.where(rng.random((40, 36, 30)) < 0.01, 3, 0).astype(np.uint8)
    labels[0], labels[-1], labels[:, 0], labels[:, -1] = 3, 3, 3, 3
    labels[5, 5, 5] = 255
    origin = np.array([-0.1, -0.2, -0.06])
    pose = look_at(np.array([0.3, 0.2, 0.3]), np.array([0.6, 0.4, 0.2]))
    hits = cast_voxels(labels, CAMERA, pose, voxel_m=0.02, origin_m=origin)
    v, u = np.nonzero(hits.voxel_index >= 0)
    depth = hits.depth_m[v, u].astype(np.float64)[:, None]
    rays = np.column_stack([(u + 0.5 - 32) / 40, (v + 0.5 - 24) / 40, np.ones(len(u))])
    points = (apply(pose, rays * depth) - origin) / 0.02
    cells = np.column_stack(np.unravel_index(hits.voxel_index[v, u], labels.shape))
    assert len(u) > 1000
    assert (labels[tuple(cells.T)] == 3).all()
    assert (np.abs(points - (cells + 0.5)).max(axis=1) < 0.5 + 1e-3).all()


def test_the_palette_of_these_tests_is_drawn_whole():
    assert all(len(visible_boxes(state)) for state in PALETTE[1:])
