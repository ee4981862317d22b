"""Orbits that fit, tours that stay in free space, tour files that come back."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scenes import random_volume

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import apply, block_to_room, invert, invert_rigid
from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering.presentation.shot_rendering import draw_frames
from world2minecraft.rendering.views import (
    GamePose,
    Shot,
    camera_of,
    game_pose_of,
    orbit_shots,
    plan_tour,
    read_tour,
    tour_line,
    with_open_doors,
    write_lines,
)
from world2minecraft.rendering.views.orbit import corner_points_m
from world2minecraft.rendering.views.visibility import view_blockers_of
from world2minecraft.rendering.views.walk_through import TURN_COST, _best_sequence

CAMERA = camera_of(48, 36, vertical_fov_deg=70)
DOOR = "minecraft:oak_door[facing=west,half={half},hinge=left,open=false,powered=false]"
PALETTE = (AIR, "minecraft:stone", DOOR.format(half="lower"), DOOR.format(half="upper"),
           "minecraft:white_carpet", "minecraft:oak_slab[type=bottom,waterlogged=false]",
           "minecraft:lava[level=0]", "minecraft:barrier[waterlogged=false]")  # fmt: skip


def house(scale=1.0, door=True):
    """Two rooms of 4 x 4 blocks side by side along x, a wall between them, a door in it."""
    states = np.ones((11, 5, 6), np.uint16)
    states[1:5, 1:4, 1:5] = states[6:10, 1:4, 1:5] = 0
    if door:
        states[5, 1, 2], states[5, 2, 2] = 2, 3
    return built(states, scale)


def built(states, scale=1.0):
    return BlockVolume(
        states,
        PALETTE,
        np.zeros(states.shape, np.uint8),
        np.zeros(states.shape, np.uint16),
        (-3, 60, 7),
        block_to_room(np.array([0.0, 2.0]), scale),
    )


# Orbits.


@pytest.mark.parametrize("size", [(48, 36), (20, 60), (90, 20)])
@pytest.mark.parametrize("elevation_deg", [0.0, 28.0, 70.0])
def test_an_orbit_holds_the_whole_build_and_fills_the_picture(size, elevation_deg):
    volume = random_volume(np.random.default_rng(1))
    camera = camera_of(*size, vertical_fov_deg=50)
    shots = orbit_shots(volume, camera, 7, elevation_deg=elevation_deg)
    fullest = 0.0
    for shot in shots:
        seen = apply(invert_rigid(shot.camera_to_room), corner_points_m(volume))
        assert (seen[:, 2] > 0).all()
        at = seen[:, :2] / seen[:, 2:] * camera.fx_px
        fullest = max(fullest, float(np.abs(at / (np.array(size) / 2)).max()))
        assert (np.abs(at) <= np.array(size) / 2).all()
    assert fullest > 0.85


def test_an_orbit_frames_the_roof_and_not_the_garden():
    states = np.zeros((20, 10, 20), np.uint16)
    semantic = np.zeros(states.shape, np.uint8)
    states[:, 0], semantic[:, 0] = 1, UNKNOWN  # The garden, a house in its middle, and its roof.
    states[8:12, 1:4, 8:12], semantic[8:12, 1:4, 8:12] = 1, SemanticClass.WALL
    states[8:12, 4:7, 8:12], semantic[8:12, 4:7, 8:12] = 1, UNKNOWN
    volume = replace(built(states), semantic=semantic)
    corners = apply(invert(volume.block_to_room), corner_points_m(volume))
    size = np.ptp(corners, axis=0)
    assert size[1] == pytest.approx(7)
    assert (size[[0, 2]] < 20).all() and (size[[0, 2]] >= 4).all()


def test_an_orbit_goes_around_once_at_one_height():
    shots = orbit_shots(random_volume(np.random.default_rng(2)), CAMERA, 8, rate_hz=4.0)
    eyes = np.array([shot.camera_to_room[:3, 3] for shot in shots])
    assert np.ptp(eyes[:, 2]) < 1e-9
    np.testing.assert_allclose(eyes.mean(axis=0)[:2], (eyes[0] + eyes[4])[:2] / 2, atol=1e-9)
    assert [shot.t_s for shot in shots] == [n / 4 for n in range(8)]


# What hides the view.


def test_walls_block_views_doors_do_not_ceilings_roof():
    hiding = view_blockers_of(house())
    assert hiding.hides[0].all() and not hiding.hides[1:5, 1:4, 1:5].any()
    assert not hiding.hides[5, 1:3, 2].any()
    assert hiding.roofed[1:5, 1:4, 1:5].all()
    assert not view_blockers_of(built(np.zeros((2, 2, 2), np.uint16))).roofed.any()


# Tours.


def eyes_of(tour, volume):
    return [game_pose_of(shot.camera_to_room, volume.block_to_room) for shot in tour.shots]


def test_a_tour_goes_through_the_door_into_both_rooms():
    volume = house()
    tour = plan_tour(volume, CAMERA, 12)
    poses = eyes_of(tour, volume)
    assert len(poses) == 12
    assert min(pose.x for pose in poses) < 2 - 0.5 < 3 < max(pose.x for pose in poses)
    opened, doors = with_open_doors(volume, tour.way)
    assert doors == 1
    states = {opened.palette[n] for n in np.unique(opened.states)}
    assert {state for state in states if "door" in state} == {
        DOOR.format(half=half).replace("open=false", "open=true") for half in ("lower", "upper")
    }


def test_a_tour_stays_in_free_cells_at_eye_height():
    volume = house()
    for pose in eyes_of(plan_tour(volume, CAMERA, 40), volume):
        cell = np.floor(np.array([pose.x, pose.y, pose.z]) - volume.corner).astype(int)
        assert volume.states[tuple(cell)] in (0, 2, 3)
        assert pose.y == pytest.approx(61 + 1.62)


def test_a_moving_tour_is_smooth():
    volume = house()
    poses = eyes_of(plan_tour(volume, CAMERA, None, rate_hz=24.0), volume)
    turns = np.diff(np.unwrap(np.radians([pose.yaw_deg for pose in poses])))
    steps = np.diff([(pose.x, pose.z) for pose in poses], axis=0)
    assert np.degrees(np.abs(turns)).max() < 50 / 24 * 1.6
    assert np.linalg.norm(steps, axis=1).max() < 1.0 / 24 * 1.6


def test_a_tour_looks_into_the_room_not_at_a_near_wall():
    volume = house(door=False)
    scene = prepare_scene(volume)
    poses = [shot.camera_to_room for shot in plan_tour(volume, CAMERA, 8).shots]
    middle = [picture.depth_m[18, 24] for picture in draw_frames(scene, CAMERA, poses)]
    assert np.median(middle) > 2.0
    assert min(middle) > 1.0


def test_the_same_tour_comes_twice():
    one, other = (plan_tour(house(), CAMERA, 5) for _ in range(2))
    for a, b in zip(one.shots, other.shots, strict=True):
        assert np.array_equal(a.camera_to_room, b.camera_to_room)


def test_one_turns_round_in_a_closet():
    states = np.ones((3, 5, 3), np.uint16)
    states[1, 1:4, 1] = 0
    volume = built(states)
    poses = eyes_of(plan_tour(volume, CAMERA, 9), volume)
    assert {(round(pose.x, 6), round(pose.z, 6)) for pose in poses} == {(-1.5, 8.5)}
    turned = np.unwrap(np.radians([pose.yaw_deg for pose in poses]))
    assert np.degrees(turned[-1] - turned[0]) == pytest.approx(320, abs=1e-6)


def test_a_floor_without_a_roof_is_walked_too():
    volume = built(np.ones((8, 1, 8), np.uint16))
    assert {round(pose.y, 6) for pose in eyes_of(plan_tour(volume, CAMERA, 4), volume)} == {62.62}


@pytest.mark.parametrize("block", [1, 7])
def test_a_tour_is_on_the_floor_not_on_what_surrounds_it(block):
    states = np.ones((12, 4, 12), np.uint16)
    states[:, 1:] = block
    states[4:8, 1:, 4:8] = 0
    semantic = np.zeros(states.shape, np.uint8)
    semantic[:, 0] = SemanticClass.FLOOR
    volume = replace(built(states), semantic=semantic)
    shots = plan_tour(volume, CAMERA, 4).shots
    frames = draw_frames(prepare_scene(volume), CAMERA, [shot.camera_to_room for shot in shots])
    assert min(np.isfinite(picture.depth_m).mean() for picture in frames) > 0.5
    assert {round(pose.y, 6) for pose in eyes_of(plan_tour(volume, CAMERA, 4), volume)} == {62.62}


def test_a_barrier_that_closes_a_hole_in_the_floor_carries():
    volume = built(np.full((8, 1, 8), 7, np.uint16))
    assert {round(pose.y, 6) for pose in eyes_of(plan_tour(volume, CAMERA, 4), volume)} == {62.62}


def test_a_tour_without_a_ceiling_looks_lower():
    pitches = []
    for top in (5, 3):
        volume = built(house(door=False).states[:, :top])
        pitches += [
            {round(pose.pitch_deg) for pose in eyes_of(plan_tour(volume, CAMERA, 4), volume)}
        ]
    assert pitches == [{9}, {17}]


def test_where_nobody_can_stand_there_is_no_tour():
    volume = built(np.zeros((3, 3, 3), np.uint16))
    with pytest.raises(UsageError) as told:
        plan_tour(volume, CAMERA, 4)
    assert str(told.value) == (
        "cannot plan a tour: the build has no place for a player to stand; try an orbit (--orbit)"
    )


def test_the_best_headings_are_found_among_all():
    """Against every sequence of a small problem."""
    rng = np.random.default_rng(4)
    rating = rng.random((3, 12))
    found = _best_sequence(rating)

    def value(sequence):
        total = sum(rating[n, heading] for n, heading in enumerate(sequence))
        for a, b in pairwise(sequence):
            step = abs((b - a + 6) % 12 - 6)
            if step > 5:
                return -np.inf
            total -= TURN_COST * step * (1 + step / 5)
        return total

    every = [(a, b, c) for a in range(12) for b in range(12) for c in range(12)]
    assert value(found) == pytest.approx(max(map(value, every)))


# Files.


def test_a_tour_comes_back_from_its_file(tmp_path):
    to_room = block_to_room(np.array([0.0, 2.0]), 4.0)
    camera = camera_of(48, 36, intrinsics=(40, 41, 20, 18))
    shot = Shot(camera, GamePose(1.5, 64, -2.25, 100, 20).camera_to_room(to_room, 6.48), 0.5)
    line = tour_line(shot, 3, to_room, {"scene_id": "a", "intrinsics": camera.matrix.tolist()})
    write_lines(tmp_path / "poses.jsonl", [line])
    assert line["frame"] == 3 and line["y"] == 70.48
    (back,) = read_tour(tmp_path / "poses.jsonl")
    assert back.camera == camera
    assert back.t_s == 0.5
    np.testing.assert_allclose(back.pose.camera_to_room(to_room), shot.camera_to_room, atol=1e-7)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_the_same_columns_come_as_csv(tmp_path, end):
    path = tmp_path / "tour.csv"
    lines = (
        "frame, t, x, y, z, yaw, pitch, vertical_fov_deg, width, height, at",
        "0, 0.5, 1.5, 64, -2, 90, 10, 70, 48, 36, feet",
        "1, 1, 1, 2, 3, 4, 5, , , ,",
    )
    path.write_bytes("".join(line + end for line in lines).encode())
    first, second = read_tour(path)
    assert first.pose == GamePose(1.5, 64, -2, 90, 10, "feet")
    assert first.camera == CAMERA
    assert second.pose == GamePose(1, 2, 3, 4, 5, "eye")
    assert second.camera is None


def test_what_is_no_csv_is_told(tmp_path):
    path = tmp_path / "tour.csv"
    path.write_text("x,y,z,yaw,pitch\n" + "1" * 140_000)
    with pytest.raises(
        DamagedFileError, match=r"tour.csv: not a valid CSV file \(field larger than"
    ):
        read_tour(path)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "contains no poses; each line needs x, y, z, yaw and pitch"),
        ("{", "line 1 is not valid JSON"),
        ("\n[1]", "line 2 is not a JSON object"),
        ('{"x": 1, "y": 2, "z": 3, "pitch": 4}', "line 1 does not contain yaw"),
        ('{"x": 1, "y": 2, "z": 3, "yaw": "north", "pitch": 4}',
         "line 1 is not a valid pose (could not convert string to float: 'north')"),
        ('{"x": 1, "y": 2, "z": 3, "yaw": 0, "pitch": 0, "t": NaN}',
         "line 1 is not a valid pose (t must be a finite number, got nan)"),
        ('{"x": 1, "y": 2, "z": 3, "yaw": 0, "pitch": 100}',
         "line 1 is not a valid pose (pitch must be -90 (up) to 90 (down) degrees, got 100)"),
        (json.dumps({"x": 1, "y": 2, "z": 3, "yaw": 0, "pitch": 0, "width": 1e9, "height": 4,
                     "vertical_fov_deg": 70}),
         "line 1 is not a valid pose (invalid camera: width_px must be 1 to 20000, got "
         "1000000000)"),
    ],
)  # fmt: skip
def test_what_is_no_tour_is_told(tmp_path, text, reason):
    path = tmp_path / "bad.jsonl"
    path.write_text(text)
    with pytest.raises(DamagedFileError) as told:
        read_tour(path)
    assert str(told.value) == f"{path}: {reason}"
