"""Episodes and paths as VLN-CE and R2R read them: their keys, frames, angles and graphs."""

import gzip
import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.navigation.vln_sets import a_trajectory, an_episode, small_set

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import write_json
from world2minecraft.navigation.exporters import export_set
from world2minecraft.navigation.exporters.r2r import heading, write_r2r
from world2minecraft.navigation.exporters.vlnce import (
    TOKENS,
    block_to_habitat,
    positions,
    rotation,
    split_words,
    subsample_path,
    vocabulary,
)
from world2minecraft.navigation.records import write_episodes
from world2minecraft.navigation.types import Stance

# The keys that VLN-CE's classes take; another one is a TypeError there.
EPISODE_KEYS = {
    *("episode_id", "scene_id", "start_position", "start_rotation", "info", "trajectory_id"),
    *("goals", "reference_path", "instruction"),
}
angles = st.floats(-180, 180)


def unpacked(path):
    return json.loads(gzip.decompress(path.read_bytes()))


def turned(quaternion, vector):
    """A vector turned by x, y, z, w, by the formula of quaternions."""
    axis, w = np.array(quaternion[:3]), quaternion[3]
    return vector + 2 * np.cross(axis, np.cross(axis, vector) + w * vector)


@given(angles)
def test_a_heading_looks_where_the_game_looks(yaw_deg):
    yaw = math.radians(yaw_deg)
    quaternion = rotation(Stance(0, 0, 0, yaw_deg))
    assert math.isclose(sum(value**2 for value in quaternion), 1, abs_tol=1e-5)
    forward = turned(quaternion, np.array([0.0, 0.0, -1.0]))  # Habitat's agents look to -z.
    assert np.allclose(forward, [-math.sin(yaw), 0, math.cos(yaw)], atol=1e-5)


@given(angles)
def test_r2rs_heading_looks_where_the_game_looks(yaw_deg):
    yaw = math.radians(yaw_deg)
    east_north = math.sin(heading(yaw_deg)), math.cos(heading(yaw_deg))
    assert np.allclose(east_north, (-math.sin(yaw), -math.cos(yaw)), atol=1e-9)


def test_vlnce_reads_its_keys_and_no_other(tmp_path):
    root = export_set(small_set(tmp_path / "set"), "vlnce", tmp_path / "out").out
    train = unpacked(root / "train/train.json.gz")
    truth = unpacked(root / "train/train_gt.json.gz")
    words = train["instruction_vocab"]["word_list"]
    assert words[:2] == ["<pad>", "<unk>"] and len(set(words)) == len(words)
    assert (
        words == unpacked(root / "val_unseen/val_unseen.json.gz")["instruction_vocab"]["word_list"]
    )
    assert [episode["scene_id"] for episode in train["episodes"]] == [
        "kitchen/stages/kitchen.glb",
        "villa/stages/villa.glb",
    ]
    for episode in train["episodes"]:
        assert set(episode) == EPISODE_KEYS
        assert set(episode["instruction"]) == {"instruction_text", "instruction_tokens"}
        tokens = episode["instruction"]["instruction_tokens"]
        text = episode["instruction"]["instruction_text"]
        assert len(tokens) == TOKENS
        assert [words[token] for token in tokens if token] == split_words(text)
        # A quarter of a metre a block: no scene.json lies beside these scenes.
        assert episode["start_position"] == [0.5, 16.0, 0.75]
        assert episode["goals"] == [{"position": [2.25, 16.0, 0.75], "radius": 3.0}]
        assert episode["info"]["geodesic_distance"] == 1.75
        told = truth[str(episode["episode_id"])]
        assert told["actions"] == [1] * 7 + [0] and told["forward_steps"] == 7
        assert len(told["locations"]) == 8
        assert told["locations"][0] == episode["start_position"]
        assert told["locations"][-1] == episode["reference_path"][-1]
    names = json.loads((root / "names.json").read_text())
    assert names["episodes"] == {"kitchen-e0": 1, "villa-e0": 2, "attic-e0": 3}


def test_places_stand_where_the_exported_stage_stands(tmp_path):
    to_room = block_to_room(np.array([-2.0, 3.0]), 4.0)
    write_json(tmp_path / "home/build/scene.json", {"block_to_room": to_room.tolist()})
    frame = block_to_habitat("home", tmp_path, 1.0)
    # The room's corner (x_min, y_max, floor) is block (0, 64, 0); the stage has x, z, -y.
    assert positions(frame, [(0, 64, 0), (4, 68, 8)]) == [[-2.0, 0.0, -3.0], [-1.0, 1.0, -1.0]]


def test_a_scene_that_says_no_transform_is_refused(tmp_path):
    write_json(tmp_path / "home/scene.json", {"block_to_room": [[1]]})
    with pytest.raises(DamagedFileError, match="block_to_room must"):
        block_to_habitat("home", tmp_path, 1.0)


def test_a_long_instruction_is_cut_and_signs_are_words(tmp_path):
    folder = small_set(tmp_path / "set")
    episode = an_episode("kitchen")
    words = replace(episode.instruction, text="Go, then " + "left " * 300)
    write_episodes(folder / "episodes.jsonl", [replace(episode, instruction=words)])
    root = export_set(folder, "vlnce", tmp_path / "out").out
    whole = unpacked(root / "train/train.json.gz")
    assert len(whole["episodes"][0]["instruction"]["instruction_tokens"]) == TOKENS
    assert vocabulary(["Go, then left."]) == ["<pad>", "<unk>", ",", ".", "go", "left", "then"]


@given(st.lists(st.tuples(*[st.floats(-50, 50)] * 3), min_size=1, max_size=30))
def test_a_subsampled_path_keeps_its_ends_and_spacing(way):
    way = [list(place) for place in way]
    kept = subsample_path(way)
    assert kept[0] == way[0] and kept[-1] == way[-1]
    gaps = [math.dist(one, two) for one, two in pairwise(kept[:-1])]
    assert all(gap >= 2.0 for gap in gaps)


def test_r2r_paths_are_ways_in_their_graph(tmp_path):
    root = export_set(small_set(tmp_path / "set"), "r2r", tmp_path / "out").out
    rows = json.loads((root / "R2R_train.json").read_text())
    views = json.loads((root / "viewpoints.json").read_text())
    assert [row["scan"] for row in rows] == ["kitchen", "villa"]
    for row in rows:
        assert len(row["path"]) == 8 and row["distance"] == 7.0 and len(row["instructions"]) == 1
        assert row["heading"] == pytest.approx(math.pi / 2)  # East.
        graph = json.loads((root / f"connectivity/{row['scan']}_connectivity.json").read_text())
        number = {node["image_id"]: n for n, node in enumerate(graph)}
        for one, two in pairwise(row["path"]):
            assert graph[number[one]]["unobstructed"][number[two]]
            assert graph[number[two]]["unobstructed"][number[one]]
        joined = np.array([node["unobstructed"] for node in graph])
        assert (joined == joined.T).all() and not joined.diagonal().any()
        assert joined.sum() == 14
        x, y, z = views[row["path"][0]]["position"]
        assert (x, y, z) == (0.5, -0.75, 16.0)  # East, north, up.
        assert graph[0]["pose"][3::4] == [0.5, -0.75, 17.5, 1.0]


def test_turns_on_the_spot_and_ways_that_cross_share_viewpoints(tmp_path):
    one = a_trajectory(frames=4)
    standing = [one.keyframes[0], *one.keyframes]
    standing[1] = replace(standing[1], stance=replace(standing[1].stance, yaw_deg=90.0))
    back = replace(one, trajectory_id="back", keyframes=tuple(reversed(one.keyframes)))
    write_r2r(tmp_path, [replace(one, keyframes=tuple(standing)), back])
    rows = json.loads((tmp_path / "R2R_train.json").read_text())
    assert rows[0]["path"] == list(reversed(rows[1]["path"]))
    assert len(rows[0]["path"]) == 4
    views = json.loads((tmp_path / "viewpoints.json").read_text())
    first = views[rows[0]["path"][0]]["images"]
    assert [round(math.degrees(view["heading"])) for view in first] == [90, 270, 90]


def test_a_set_without_episodes_is_told(tmp_path):
    folder = small_set(tmp_path / "set")
    (folder / "episodes.jsonl").unlink()
    with pytest.raises(InputError, match="episodes.jsonl: not found"):
        export_set(folder, "vlnce", tmp_path / "out")
