"""Planned views: smooth, exact, spread over the rooms, and each worth its picture."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.types import AIR, BlockVolume, Camera, Layout
from world2minecraft.minecraft.physics.body_fit import bodies_fit
from world2minecraft.minecraft.physics.walk_graph import collision_grid, walk_graph
from world2minecraft.minecraftocc.tours import (
    TourRule,
    kind_of_yaw,
    nyu_camera,
    paper_camera,
    plan_views,
    read_views,
    write_views,
)
from world2minecraft.minecraftocc.tours.planning import GAP_DEG, GAP_M
from world2minecraft.minecraftocc.tours.rooms import find_rooms, share_views
from world2minecraft.minecraftocc.tours.view_quality import assess_views
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering.batch import render_batch
from world2minecraft.rendering.views.cameras import GamePose, camera_of

COUNT = 60


@pytest.fixture(scope="module")
def house():
    return generate_world(11, rooms=4, storeys=1)


@pytest.fixture(scope="module")
def volume(house):
    return house.volume


@pytest.fixture(scope="module")
def scene(volume):
    return prepare_scene(volume)


@pytest.fixture(scope="module")
def views(volume, scene):
    return plan_views(volume, COUNT, 3, scene=scene)


def eyes_of(views):
    return np.array([[view.pose.x, view.pose.y, view.pose.z] for view in views])


def turned(a, b):
    return abs((a - b + 180) % 360 - 180)


# What is promised of every plan.


def test_as_many_views_as_asked_each_named_once(views):
    assert len(views) == COUNT
    assert len({(view.tour_id, view.frame) for view in views}) == COUNT
    for tour_id in {view.tour_id for view in views}:
        frames = [view.frame for view in views if view.tour_id == tour_id]
        assert frames == list(range(len(frames)))


def test_the_same_seed_gives_the_same_views_and_another_others(volume, scene, views):
    again = plan_views(volume, COUNT, 3)
    assert [view.pose for view in again] == [view.pose for view in views]
    other = plan_views(volume, COUNT, 4, scene=scene)
    assert [view.pose for view in other] != [view.pose for view in views]


def test_few_views_are_flat_or_empty_and_no_two_alike(volume, scene):
    views = plan_views(volume, 24, scene=scene)
    poses = np.array([view.camera_to_room for view in views])
    seen = assess_views(scene, volume, poses, TourRule())
    assert (seen.plane > 0.35).mean() <= 0.1 and (seen.count < 3).mean() <= 0.1
    eyes, per_metre = eyes_of(views), volume.blocks_per_metre
    for n, view in enumerate(views):
        near = np.abs(eyes[:n] - eyes[n]).max(axis=1) < 0.5 * per_metre
        alike = [views[m] for m in np.flatnonzero(near) if views[m].room == view.room]
        assert all(
            turned(view.pose.yaw_deg, one.pose.yaw_deg) >= 20
            or abs(view.pose.pitch_deg - one.pose.pitch_deg) >= 20
            for one in alike
        )


def test_the_ceiling_fills_a_view_of_it_alone(volume, scene):
    room = find_rooms(volume, walk_graph(volume), collision_grid(volume), TourRule())[0]
    graph = walk_graph(volume)
    eye = graph.feet[room.places[0]] + [0, 1.6 * volume.blocks_per_metre, 0]
    shares = []
    for yaw in (0, 90, 180, 270):
        pose = GamePose(*eye, float(yaw), 0.0, "eye").camera_to_room(volume.block_to_room)
        shares.append(assess_views(scene, volume, pose[None], TourRule()).plane[0])
    ceiling = GamePose(*eye, 0.0, -89.0, "eye").camera_to_room(volume.block_to_room)
    up = assess_views(scene, volume, ceiling[None], TourRule()).plane[0]
    assert up > 0.5 and min(shares) < 0.6


def test_the_pose_is_the_camera(volume, views):
    for view in views:
        assert view.pose.at == "eye"
        expected = view.pose.camera_to_room(volume.block_to_room)
        np.testing.assert_array_equal(view.camera_to_room, expected)
        assert view.camera == nyu_camera()


def test_tours_move_smoothly(volume, views):
    for a, b in pairwise(views):
        if a.tour_id == b.tour_id:
            step = np.linalg.norm(np.subtract(*eyes_of([a, b]))) / volume.blocks_per_metre
            assert step <= GAP_M
            assert turned(a.pose.yaw_deg, b.pose.yaw_deg) <= GAP_DEG
            assert b.t_s > a.t_s


def test_yaws_are_exact_in_the_asked_shares(volume, scene):
    plan = plan_views(volume, 150, 0, scene=scene)
    kinds = [view.kind for view in plan]
    for kind, share in zip(("axis", "diagonal", "free"), (0.4, 0.2, 0.4), strict=True):
        assert abs(kinds.count(kind) / len(plan) - share) < 0.12
    for view in plan:
        rest = {"axis": 90, "diagonal": 45, "free": 1e9}[view.kind]
        assert view.kind == "free" or view.pose.yaw_deg % rest == 0
    pitches = np.array([view.pose.pitch_deg for view in plan])
    heights = eyes_of(plan)[:, 1]
    assert np.ptp(pitches) > 10 and pitches.min() >= -8 and pitches.max() <= 32
    assert len(np.unique(heights.round(2))) > 5


def test_bodies_fit_under_every_eye_and_no_eye_is_on_the_roof(volume, views):
    solid, eyes = collision_grid(volume), eyes_of(views)
    scale = volume.blocks_per_metre
    for eye_m in (1.1, 0.7):  # Above what one steps on, and nobody's eye is lower than 1.2.
        feet = eyes - [0, eye_m * scale, 0]
        half = 0.3 * scale - 0.1 * scale
        assert bodies_fit(solid, volume.corner, feet, half, (0.0, 0.4 * scale)).all()
    graph = walk_graph(volume)
    for eye in eyes:
        away = np.abs(graph.feet - eye + [0, 1.45 * scale, 0]).max(axis=1)
        assert away.min() < 0.6 * scale
    assert eyes[:, 1].max() < volume.corner[1] + volume.states.shape[1] - 2


def test_no_view_is_blocked_or_empty(scene, views):
    """Measured again, in pictures of another size."""
    camera = camera_of(80, 60, vertical_fov_deg=49.6)
    poses = np.array([view.camera_to_room for view in views])
    seen = render_batch(scene, camera, poses, outputs=("depth", "semantic", "block"))
    depth, semantic = np.asarray(seen.depth_m), np.asarray(seen.semantic)
    near = ((depth > 0) & (depth < 0.5)).mean(axis=(1, 2))
    assert near.max() < 0.35
    out = ((depth == 0) | (semantic == 4)).mean(axis=(1, 2))
    assert out.max() < 0.55
    for picture in semantic:
        assert len(np.unique(picture[picture > 0])) >= 3
        assert ((picture >= 5) & (picture < 255)).mean() > 0.01


def test_no_two_views_are_nearly_the_same(volume, views):
    near = TourRule().apart_m * volume.blocks_per_metre * 0.7**4
    for n, a in enumerate(views):
        for b in views[n + 1 :]:
            alike = np.abs(np.subtract(*eyes_of([a, b]))).max() < near
            assert not (
                alike
                and turned(a.pose.yaw_deg, b.pose.yaw_deg) < 4
                and abs(a.pose.pitch_deg - b.pose.pitch_deg) < 4
            )


# Rooms.


@pytest.mark.parametrize("seed", [11, 2])
def test_the_rooms_of_a_house_are_separated(seed):
    house = generate_world(seed, rooms=5, storeys=1)
    volume = house.volume
    graph = walk_graph(volume)
    rooms = find_rooms(volume, graph, collision_grid(volume), TourRule())
    at = np.full(len(graph), -1)
    for room in rooms:
        at[room.places] = room.number
    cells = np.floor(graph.feet).astype(int)  # Block (0, 64, 0) is the first within the walls.
    deep = house.house.size[1]
    found = 0
    for own in house.house.rooms:
        x, y = cells[:, 0], deep - 1 - cells[:, 2]
        inside = (x >= own.low[0]) & (x < own.high[0]) & (y >= own.low[1]) & (y < own.high[1])
        numbers = at[inside & (at >= 0)]
        if len(numbers) > 20:
            found += 1
            assert (numbers == np.bincount(numbers).argmax()).mean() > 0.85
    assert found >= 3 and len(rooms) >= found


def test_views_are_shared_by_worth(volume):
    graph = walk_graph(volume)
    rooms = find_rooms(volume, graph, collision_grid(volume), TourRule())
    parts = share_views(rooms, 100)
    assert sum(parts) == 100
    order = np.argsort([room.worth for room in rooms], kind="stable")
    assert parts[order[-1]] >= parts[order[0]]
    assert {view.room for view in plan_views(volume, 100)} > {rooms[order[-1]].number}


def test_layouts_say_the_rooms_where_they_are_known(volume):
    """A floor plan of one half of the house: only that half is toured."""
    low, high = np.zeros(2), np.array(volume.states.shape)[[0, 2]] / volume.blocks_per_metre
    half = Layout(np.array([low, [high[0], 0], [high[0], high[1] / 2], [0, high[1] / 2]]), 2.5)
    rule = TourRule(layouts=(half,))
    graph = walk_graph(volume)
    (room,) = find_rooms(volume, graph, collision_grid(volume), rule)
    z = graph.feet[room.places][:, 2]
    assert (volume.block_to_room[1, 2] * z + volume.block_to_room[1, 3] < high[1] / 2).all()


def box(states, semantic):
    palette = (AIR, "minecraft:stone", "minecraft:red_wool", "minecraft:oak_planks")
    shape = states.shape
    return BlockVolume(
        states.astype(np.uint16),
        palette,
        semantic.astype(np.uint8),
        np.zeros(shape, np.uint16),
        (-1, 63, -1),
        block_to_room(np.zeros(2), 2.0),
    )


def two_rooms():
    """Rooms of 4 x 4 x 2.5 m beside each other without a door, each with a red box in a corner."""
    states, semantic = np.ones((19, 7, 10), int), np.full((19, 7, 10), 3)
    semantic[:, 0], semantic[:, 6] = 2, 1
    for x in (1, 10):
        states[x : x + 8, 1:6, 1:9] = semantic[x : x + 8, 1:6, 1:9] = 0
        states[x : x + 3, 1:3, 1:3], semantic[x : x + 3, 1:3, 1:3] = 2, 8
        states[x + 5 : x + 8, 1:3, 6:9], semantic[x + 5 : x + 8, 1:3, 6:9] = 3, 10
    return box(states, semantic)


def test_a_room_that_no_way_leads_to_is_toured_unless_forbidden():
    rule = TourRule(start=(4.5, 64.0, 3.5))
    both = plan_views(two_rooms(), 40, 0, rule)
    assert {view.room for view in both} == {0, 1}
    near = plan_views(two_rooms(), 40, 0, replace(rule, reachable_only=True))
    assert {view.room for view in near} == {0} and eyes_of(near)[:, 0].max() < 8


def test_a_small_place_gives_the_views_it_has():
    rule = TourRule(spacing_m=0.5, apart_m=1.0, apart_deg=60)
    assert 0 < len(plan_views(two_rooms(), 500, 0, rule)) < 500


@pytest.mark.parametrize(
    ("count", "text"),
    [
        (0, "the number of views must be 1 or more, got 0"),
        (5, "cannot plan views: this world has no place"),
    ],
)
def test_plans_that_cannot_be(count, text):
    full = box(np.ones((3, 3, 0), int), np.ones((3, 3, 0), int))
    with pytest.raises(UsageError, match=text):
        plan_views(full, count)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (
            {"yaw_shares": (0, 0, 0)},
            "yaw_shares must be three numbers of 0 or more, not all 0, got (0, 0, 0)",
        ),
        (
            {"eye_m": (1.5, 1.2)},
            "eye_m must be two heights from 0.3 to 1.75 in ascending order, got (1.5, 1.2)",
        ),
        (
            {"pitch_deg": (-70, 0)},
            "pitch_deg must be two angles from -60 to 60 in ascending order, got (-70, 0)",
        ),
        ({"spacing_m": 2.0}, "spacing_m must be from 0.05 to 0.6, got 2"),
    ],
)
def test_rules_that_make_no_sense(words, text):
    with pytest.raises(UsageError) as raised:
        TourRule(**words)
    assert str(raised.value) == text


# Cameras and files.


def test_cameras_are_those_of_nyu_and_the_paper():
    nyu, paper = nyu_camera(), paper_camera()
    assert (nyu.width_px, nyu.height_px, nyu.fx_px, nyu.fy_px) == (640, 480, 518.8579, 518.8579)
    assert np.degrees(2 * np.arctan(240 / nyu.fy_px)) == pytest.approx(49.64, abs=0.01)
    assert np.degrees(2 * np.arctan(paper.height_px / 2 / paper.fy_px)) == pytest.approx(70)


@pytest.mark.parametrize(
    "camera", [nyu_camera(), paper_camera(), Camera(320, 240, 250.5, 251.0, 158.0, 121.5)]
)
def test_a_tour_file_gives_the_views_back(tmp_path, volume, views, camera):
    ours = [replace(view, camera=camera) for view in views[:9]]
    write_views(tmp_path / "tour.jsonl", ours, volume.block_to_room, "house_0001")
    again = read_views(tmp_path / "tour.jsonl", volume.block_to_room)
    for a, b in zip(ours, again, strict=True):
        assert (a.tour_id, a.frame, a.pose, a.t_s) == (b.tour_id, b.frame, b.pose, b.t_s)
        np.testing.assert_array_equal(a.camera_to_room, b.camera_to_room)
        assert a.camera == b.camera
    first = (tmp_path / "tour.jsonl").read_text().splitlines()[0]
    assert '"scene_id": "house_0001"' in first and f'"kind": "{ours[0].kind}"' in first


def test_feet_are_lifted_to_the_eye_of_the_scale(tmp_path):
    path = tmp_path / "tour.jsonl"
    path.write_text('{"x": 1, "y": 64, "z": 2, "yaw": 0, "pitch": 0, "at": "feet"}\n')
    (view,) = read_views(path, block_to_room(np.zeros(2), 4.0))
    assert view.camera_to_room[2, 3] == pytest.approx(1.62) and view.tour_id == "t000"
    path.write_text('{"x": 1, "y": 64, "z": 2, "yaw": 0, "pitch": 0, "frame": "first"}\n')
    with pytest.raises(DamagedFileError, match="line 1 is not a valid pose"):
        read_views(path, block_to_room(np.zeros(2), 4.0))


def test_kinds_of_yaw():
    assert [kind_of_yaw(yaw) for yaw in (0.0, -180.0, 45.0, -135.0, 30.0)] == [
        "axis", "axis", "diagonal", "diagonal", "free",
    ]  # fmt: skip
