"""Recorded walks: what was walked comes back from a file, and files of others do no harm."""

import json
import shutil
from collections import Counter

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.navigation.data.planned_walks import TourPlanner
from world2minecraft.navigation.data.recorded_walks import (
    assign_streams,
    parse_at,
    recorded_tours,
    scene_ids_of,
    snap_to_floor,
)
from world2minecraft.navigation.data.scene_items import SceneRule
from world2minecraft.navigation.data.set_building import BuildRule, build_navigation_set
from world2minecraft.navigation.records import read_episodes, read_trajectories
from world2minecraft.navigation.types import Stance
from world2minecraft.navigation.walk_stream import StreamFrame

RULE = SceneRule(size_px=(64, 36), balanced=False, seed=4)


def line(frame, eye=0.0, **more):
    at = frame.stance
    own = {"t": frame.t_s, "x": at.x, "y": at.y + eye, "z": at.z, "yaw": at.yaw_deg, "pitch": 0.0}
    return {**own, **more}


def write(path, lines):
    path.write_text("".join(json.dumps(one) + "\n" for one in lines))
    return path


@pytest.fixture(scope="module")
def tour(flat):
    return TourPlanner(flat).tour("flat_t00", np.random.default_rng([4, *b"flat_t00"]))


def test_a_walk_that_was_written_is_walked_again(flat, flat_path, tour, tmp_path):
    """The same moves as of the program's own tour; the file's names lead nowhere."""
    own = build_navigation_set([flat_path], tmp_path / "own", BuildRule(trajectories=99, work=RULE))
    moves = {one.moves for one in own.works[0].episodes if one.trajectory_id[:8] == "flat_t00"}
    name = "../../../evil"
    lines = [line(one, 1.62 * 2, tour_id=name, image=name) for one in tour.frames]
    path = write(tmp_path / "tour.jsonl", lines)
    words = ["vln", "build", str(flat_path), "--stream", str(path), "--out", str(tmp_path / "set")]
    more = ["--size", "64x36", "--every-keyframe", "--seed", "4", "--workers", "1"]
    assert cli.run([*words, *more]) == 0
    again = read_episodes(tmp_path / "set")
    assert {one.moves for one in again} == moves and moves
    assert {one.trajectory_id[:9] for one in again} == {"flat_r000"}
    assert not (tmp_path.parent / "evil").exists()
    about = json.loads((tmp_path / "set" / "dataset.json").read_text())
    assert about["streams"] == [str(path)]
    assert about["scenes"][0]["tours"] == 1
    assert len(read_trajectories(tmp_path / "set")) == len(again)


def test_lines_without_times_are_a_walk_too(flat, tour, tmp_path):
    bare = [
        {key: value for key, value in line(one, at="feet").items() if key != "t"}
        for one in tour.frames
    ]
    path = write(tmp_path / "t.jsonl", bare)
    ((first, *rest),) = recorded_tours(flat, [path])
    assert (first.t_s, rest[0].t_s) == (0.0, 0.2)
    assert first.tour_id == "flat_r000"
    told = [(one.stance.x, one.stance.y, one.stance.z) for one in (first, *rest)]
    assert told == [one.stance.feet for one in tour.frames]


def test_a_run_of_an_agent_is_a_walk(flat, flat_path, tmp_path):
    out = tmp_path / "run"
    words = ["vln", "run", str(flat_path), "Go to the piano", "--no-video", "--out", str(out)]
    assert cli.run(words) == 0
    (walked,) = recorded_tours(flat, [out])
    (episode,) = read_episodes(out)
    assert walked[0].stance == episode.start
    assert scene_ids_of(out) == {"flat"}
    times = [one.t_s for one in walked]
    assert times == sorted(set(times))
    for number in range(2):  # A run of a set lies so: a walk of each, and no way between them.
        place = tmp_path / "many" / "episodes" / f"{number:05d}"
        place.mkdir(parents=True)
        shutil.copy(out / "trace.jsonl", place)
    first, second = recorded_tours(flat, [tmp_path / "many"])
    assert len(first) == len(second) == len(walked) and scene_ids_of(tmp_path / "many") == {"flat"}


def test_who_flies_or_stands_on_a_table_is_left_out(flat):
    feet = flat.start.feet
    places = [feet, (feet[0], feet[1] + 3, feet[2]), (feet[0] + 0.3, feet[1] + 0.4, feet[2])]
    frames = [StreamFrame(n, Stance(*place)) for n, place in enumerate(places)]
    kept = snap_to_floor(flat, frames)
    assert [one.t_s for one in kept] == [0, 2]
    assert {one.stance.y for one in kept} == {feet[1]}
    assert snap_to_floor(flat, []) == []


def test_a_stream_finds_its_scene(tmp_path):
    pose = {"x": 0, "y": 0, "z": 0, "yaw": 0, "pitch": 0}
    both = write(tmp_path / "a.jsonl", [{**pose, "scene_id": "east"}, {**pose, "scene_id": "west"}])
    none = write(tmp_path / "b.jsonl", [pose])
    told = assign_streams([str(both)], ["east", "west"])
    assert Counter(told) == Counter({"east": (str(both),), "west": (str(both),)})
    assert assign_streams([str(none)], ["east"]) == {"east": (str(none),)}
    with pytest.raises(UsageError, match=r"b\.jsonl does not state its scene; give a single scene"):
        assign_streams([str(none)], ["east", "west"])
    with pytest.raises(
        UsageError, match=("belongs to scene 'west', which is not one of east, north")
    ):
        assign_streams([str(both)], ["east", "north"])
    with pytest.raises(UsageError, match="at must be 'feet' or 'eye', got 'head'"):
        parse_at("head")


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ('{"scene": "flat"}\n{"stance": [1, 2]}\n', "line 2 has no valid stance"),
        ('{"scene": "flat"}\n{"stance": {"x": "a"}}\n', "line 2 has no valid stance"),
        ('{"stance": {"x": 1, "y": 2, "z": 1e999}}\n', "line 1"),
        ("", "the file is empty; expected a trace"),
    ],
)
def test_a_damaged_trace_is_named(flat, tmp_path, text, error):
    (tmp_path / "trace.jsonl").write_text(text)
    with pytest.raises(DamagedFileError, match=error):
        recorded_tours(flat, [tmp_path])
