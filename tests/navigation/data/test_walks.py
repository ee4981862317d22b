"""Streams become moves: cutting, corners, replay, keyframes."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.navigation.data.free_floor import free_walker

from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.navigation.data.keyframes import (
    find_keyframes,
    path_fault,
    path_length_m,
    picture_fault,
)
from world2minecraft.navigation.data.stream_segmentation import split_into_walks
from world2minecraft.navigation.types import MOVE_SETS, Move, Stance
from world2minecraft.navigation.walk_discretization import discretize_walk, simplify_path
from world2minecraft.navigation.walk_stream import StreamFrame, frame_of_pose
from world2minecraft.rendering.views.pose_file import read_tour

VLNCE = MOVE_SETS["vlnce"]


def frames(places, yaws=None, every_s=0.2, tour="t", pitch=0.0):
    yaws = [0.0] * len(places) if yaws is None else yaws
    return [
        StreamFrame(n * every_s, Stance(x, 0.0, z, yaw, pitch), "s", tour)
        for n, ((x, z), yaw) in enumerate(zip(places, yaws, strict=True))
    ]


def straight(count, step=0.2, start=0.0):
    return [(0.0, start + n * step) for n in range(count)]


def slow_corners(path, epsilon):
    """The definition, by recursion."""

    def away(point, begin, end):
        along = end - begin
        share = 0 if not along @ along else np.clip((point - begin) @ along / (along @ along), 0, 1)
        return np.linalg.norm(point - begin - share * along)

    def kept(first, last):
        if last - first < 2:
            return []
        apart = [away(path[n], path[first], path[last]) for n in range(first + 1, last)]
        far = int(np.argmax(apart))
        if apart[far] <= epsilon:
            return []
        middle = first + 1 + far
        return [*kept(first, middle), middle, *kept(middle, last)]

    return sorted({0, *kept(0, len(path) - 1), len(path) - 1})


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=25))
@settings(max_examples=80, deadline=None)
def test_corners_are_those_of_the_definition(points):
    path = np.array(points, float) / 3
    assert simplify_path(path, 0.4).tolist() == slow_corners(path, 0.4)


def test_a_walk_without_a_stop_is_one_segment():
    assert [len(part) for part in split_into_walks(frames(straight(20)), 1.0)] == [20]


def test_a_pause_ends_a_walk_and_a_short_one_does_not():
    waits = [(0.0, 2.0)] * 12
    places = [*straight(10), *waits, *straight(10, start=2.2)]
    parts = split_into_walks(frames(places), 1.0)
    assert len(parts) == 2
    assert parts[0][-1].stance.z == pytest.approx(2.0, abs=0.21)
    assert parts[1][0].stance.z == 2.0
    short = [*straight(10), *waits[:5], *straight(10, start=2.2)]
    assert len(split_into_walks(frames(short), 1.0)) == 1


def test_turning_on_the_spot_is_a_part_of_the_way():
    yaws = [0.0] * 10 + list(np.linspace(0, 90, 15)) + [90.0] * 5
    places = [*straight(10), *[(0.0, 2.0)] * 15, *[(-0.2 * n, 2.0) for n in range(1, 6)]]
    assert len(split_into_walks(frames(places, yaws), 1.0)) == 1


def test_looking_around_ends_a_walk():
    yaws = [0.0] * 10 + list(np.arange(15) * 24.0) + [0.0] * 10
    places = [*straight(10), *[(0.0, 2.0)] * 15, *straight(10, start=2.2)]
    parts = split_into_walks(frames(places, yaws), 1.0)
    assert len(parts) == 2
    assert sum(map(len, parts)) < 35


@pytest.mark.parametrize("jump", [1.6, 30.0])
def test_a_teleport_ends_a_walk(jump):
    assert len(split_into_walks(frames([*straight(5), *straight(5, start=jump + 0.8)]), 1.0)) == 2


def test_limits_are_in_metres_of_the_room():
    places = [(x * 4, z * 4) for x, z in straight(20)]  # 1 m/s at four blocks a metre
    assert len(split_into_walks(frames(places), 4.0)) == 1


def test_gaps_scenes_and_looks_at_the_floor_end_walks():
    walk = frames(straight(20))
    late = [*walk[:10], *(StreamFrame(f.t_s + 5, f.stance, "s", "t") for f in walk[10:])]
    assert len(split_into_walks(late, 1.0)) == 2
    other = [*walk[:10], *(StreamFrame(f.t_s, f.stance, "other", "t") for f in walk[10:])]
    assert len(split_into_walks(other, 1.0)) == 2
    assert split_into_walks(frames(straight(20), pitch=80.0), 1.0) == []


def test_a_corner_is_turned_and_a_heading_met():
    places = [*[(0.0, 0.2 * n) for n in range(11)], *[(-0.2 * n, 2.0) for n in range(1, 11)]]
    walk = discretize_walk(frames(places, [0.0] * 20 + [90.0]), VLNCE, 1.0, free_walker(VLNCE, 1.0))
    assert walk.refusal == ""
    assert walk.moves.count(Move.RIGHT) - walk.moves.count(Move.LEFT) == 6
    assert walk.moves.count(Move.LEFT) <= 2
    assert 15 <= walk.moves.count(Move.FORWARD) <= 16
    assert walk.moves[-1] == Move.STOP
    end = walk.stances[-1]
    assert np.hypot(end.x + 2.0, end.z - 2.0) <= 0.225
    assert end.yaw_deg == pytest.approx(90.0)


@given(
    st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=2, max_size=5),
    st.floats(-180, 179),
    st.sampled_from(["vlnce", "rxr"]),
    st.sampled_from([1.0, 4.0, 12.5]),
)
@settings(max_examples=60, deadline=None)
def test_what_is_accepted_ends_where_the_walk_ended(corners, yaw, name, scale):
    move_set = MOVE_SETS[name]
    places = [tuple(np.array(corner) * scale) for corner in corners]
    walk = discretize_walk(
        frames(places, [yaw] * len(places)), move_set, scale, free_walker(move_set, scale)
    )
    assert walk.refusal in ("", "ends at another position")
    if walk.refusal:
        return
    end = walk.stances[-1]
    away = np.hypot(end.x - places[-1][0], end.z - places[-1][1]) / scale
    assert away <= move_set.forward_m / 2 + 0.1 + 1e-9
    assert abs((end.yaw_deg - yaw + 180) % 360 - 180) <= move_set.turn_deg / 2 + 1e-6
    assert len(walk.stances) == len(walk.moves)


def test_most_curves_are_accepted():
    """Whoever refused all would pass the law above."""
    rng, accepted = np.random.default_rng(0), 0
    for _ in range(50):
        heading = np.cumsum(rng.normal(0, 0.12, 60))
        steps = 0.1 * np.stack([np.cos(heading), np.sin(heading)], axis=1)
        places = [tuple(place) for place in np.cumsum(steps, axis=0)]
        walk = discretize_walk(frames(places), VLNCE, 1.0, free_walker(VLNCE, 1.0))
        accepted += not walk.refusal
    assert accepted >= 45


def test_a_wall_refuses_a_walk():
    def walled(stance, move):
        there, _ = free_walker(VLNCE, 1.0)(stance, move)
        return (stance, True) if there.z > 1 else (there, False)

    assert discretize_walk(frames(straight(12)), VLNCE, 1.0, walled).refusal == "collision"


def test_keyframes_stand_where_runs_end():
    places = [*[(0.0, 0.2 * n) for n in range(11)], *[(-0.2 * n, 2.0) for n in range(1, 11)]]
    walk = discretize_walk(frames(places, [0.0] * 20 + [90.0]), VLNCE, 1.0, free_walker(VLNCE, 1.0))
    marks = find_keyframes(walk, VLNCE, 0.25)
    assert marks[0].stance == walk.stances[0]
    assert [mark.action for mark in marks[-1:]] == ["stop"]
    assert all(mark.stance == walk.stances[mark.at] for mark in marks)
    assert sum(mark.run for mark in marks) == len(walk.moves)
    assert all(mark.run <= 4 for mark in marks)
    replayed = [move for mark in marks for move in [mark.move] * mark.run]
    assert tuple(replayed) == walk.moves
    assert all(mark.chunk == walk.moves[mark.at : mark.at + 4] for mark in marks)
    assert path_fault(marks, path_length_m(marks, 1.0), 2.8) == ""
    assert path_fault(marks[-1:], 0.0, 0.0) == "no movement"
    assert path_fault(marks, 0.5, 2.8) == "too short"
    assert path_fault(marks, 3.5, 0.2) == "ends near its start"


def test_pictures_that_are_black_or_the_same_are_refused():
    assert picture_fault([90, 90], [0, 255]) == ""
    assert picture_fault([90, 3], [0, 255]) == "black image"
    assert picture_fault([90, 90], [0, 7]) == "repeated image"


def test_streams_are_read_with_feet_under_their_eyes(tmp_path):
    lines = [
        {"t": 1, "x": 1, "y": 70.0, "z": 2, "yaw": 10, "pitch": 5, "tour_id": "b"},
        {"t": 0, "x": 1, "y": 70.0, "z": 2, "yaw": 0, "pitch": 0, "tour_id": "b", "at": "feet"},
    ]
    path = tmp_path / "walk.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    eye, feet = (frame_of_pose(one, eye_height_blocks(4.0)) for one in read_tour(path))
    assert (feet.stance.y, eye.stance.y) == (70.0, pytest.approx(70.0 - 4 * 1.62))
    path.write_text("{}\n")
    with pytest.raises(DamagedFileError, match="line 1 does not contain x"):
        read_tour(path)
