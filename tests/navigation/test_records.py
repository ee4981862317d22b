"""Records on disk: what is written is read again; what is not sound is refused by its line."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.navigation.vln_sets import a_trajectory, next_action, next_view

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.navigation import records
from world2minecraft.navigation.records import (
    check_image_name,
    parse_record,
    read_episodes,
    read_items,
    read_trajectories,
    resolve_scene_path,
    to_json_line,
    write_episodes,
    write_items,
    write_trajectories,
)
from world2minecraft.navigation.types import Episode, Instruction, Item, Move, Stance

ITEMS = [next_view(step=2), next_view(step=3), next_action(step=0), next_action(step=7)]
EPISODE = Episode(
    "e0",
    "worlds/kitchen",
    "kitchen",
    Stance(1.5, 64.0, 2.5, 90.0),
    ((7.5, 64.0, 2.5),),
    "piano",
    Instruction("Go to the piano.", level="goal"),
    moves=(Move.FORWARD, Move.LEFT, Move.STOP),
    reference=(Stance(1.5, 64.0, 2.5, 90.0), Stance(0.5, 64.0, 2.5, 90.0)),
)


def test_items_are_read_as_they_were_written(tmp_path):
    write_items(tmp_path / "items.jsonl", ITEMS)
    assert read_items(tmp_path) == ITEMS  # A folder is asked for its file.
    assert read_items(tmp_path / "items.jsonl") == ITEMS


def test_trajectories_and_episodes_are_read_as_they_were_written(tmp_path):
    write_trajectories(tmp_path / "trajectories.jsonl", [a_trajectory()])
    write_episodes(tmp_path / "episodes.jsonl", [EPISODE])
    assert read_trajectories(tmp_path) == [a_trajectory()]
    read = read_episodes(tmp_path)
    assert read == [EPISODE]
    assert all(isinstance(move, Move) for move in read[0].moves)


def test_the_same_items_are_the_same_bytes(tmp_path):
    write_items(tmp_path / "a", ITEMS)
    write_items(tmp_path / "b", read_items(tmp_path / "a"))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@given(
    text=st.text(min_size=1, max_size=60).filter(lambda text: text.strip()),
    place=st.floats(allow_nan=False, allow_infinity=False),
    extra=st.dictionaries(
        st.text(max_size=9), st.integers() | st.lists(st.booleans()) | st.none(), max_size=3
    ),
)
def test_any_words_places_and_extras_come_back(text, place, extra):
    options = (
        replace(ITEMS[0].options[0], stance=Stance(place, 0.0, -place)),
        *ITEMS[0].options[1:],
    )
    item = replace(ITEMS[0], instruction=Instruction(text), options=options, extra=extra)
    line = to_json_line(item)
    assert "\n" not in line
    assert parse_record(Item, line) == item


def changed(**fields):
    data = json.loads(to_json_line(ITEMS[0]))
    data.update(fields)
    return json.dumps(data)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("{", "line 2: not valid JSON"),
        ("[]", "line 2: the line: Input should be an object"),
        ("NaN", "line 2: not valid JSON (NaN is not a finite number)"),
        (changed(step="2"), "line 2: step: Input should be a valid integer"),
        (changed(step=-1), "line 2: step must be 0 or more, got -1"),
        (changed(metres_per_block=0), "line 2: metres_per_block must be 0.001 to 1000, got 0.0"),
        (changed(task="sing"), "line 2: task must be one of next_view, next_action, got 'sing'"),
        (changed(split="test"), "split must be one of train, val_seen, val_unseen, got 'test'"),
        (changed(composition="all"), "line 2: composition must be base or extend, got 'all'"),
        (changed(answer="E"), "options must be labelled A, B, ... and include the answer"),
        (changed(options=[]), "options must be labelled A, B, ... and include the answer"),
        (changed(current="../../etc/passwd"), "must be a path inside the folder of the set"),
        (changed(current="/etc/passwd"), "must be a path inside the folder of the set"),
        (changed(current="images/other.jpg"), "sha256 of images/other.jpg must be 64"),
        (
            changed(task="next_action"),
            ("option A: the options of a next_action item must have text only"),
        ),
        (changed(scene_id="../x"), "scene ID '../x' must be a valid file name"),
        (changed(scene_id=".."), "scene ID '..' must be a valid file name"),
        (
            changed(item_id=" "),
            ("line 2: ' ' is not a valid name: expected 1 to 240 printable characters"),
        ),
        (changed(instruction={"text": " "}), "line 2: an instruction must not be empty"),
        (changed(instruction={"text": "x" * 5000}), "the instruction has 5,000 characters"),
        (
            changed(history=["images/kitchen/t0/000.jpg"] * 70),
            ("the item has 75 images, the limit is 64"),
        ),
        (to_json_line(ITEMS[1]), "line 2: duplicate ID kitchen-t0-nv-3"),
    ],
)
def test_what_is_no_item_is_refused_with_its_line(tmp_path, line, reason):
    path = tmp_path / "items.jsonl"
    path.write_text(f"{to_json_line(ITEMS[1])}\n{line}\n")
    with pytest.raises(DamagedFileError) as caught:
        read_items(path)
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_numbers_beyond_all_bounds_are_refused(tmp_path):
    line = changed(metres_per_block=5).replace('"metres_per_block": 5', '"metres_per_block": 1e999')
    (tmp_path / "items.jsonl").write_text(line)
    with pytest.raises(DamagedFileError, match="1e999 is not a finite number"):
        read_items(tmp_path)


def test_deep_json_is_refused():
    with pytest.raises(UsageError):
        parse_record(Item, changed(extra={}).replace('"extra": {}', '"extra": ' + "[" * 100_000))


def test_sizes_come_before_memory(tmp_path, monkeypatch):
    write_items(tmp_path / "items.jsonl", ITEMS)
    monkeypatch.setattr(records, "MAX_LINE_BYTES", 100)
    with pytest.raises(LimitError, match="line 1: exceeds the limit of 100 bytes"):
        read_items(tmp_path)
    monkeypatch.setattr(records, "MAX_FILE_BYTES", 100)
    with pytest.raises(LimitError, match="exceeds the limit of 100"):
        read_items(tmp_path)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(InputError, match="items.jsonl: not found; w2m vln build SCENE --out SET"):
        read_items(tmp_path)


def test_what_is_not_sound_is_not_written(tmp_path):
    with pytest.raises(UsageError, match="inside the folder of the set"):
        write_items(tmp_path / "items.jsonl", [replace(ITEMS[2], current="a\\b.jpg")])
    for odd in (object(), float("nan"), "\ud800"):
        with pytest.raises(UsageError, match="cannot be written as JSON"):
            write_items(tmp_path / "items.jsonl", [replace(ITEMS[2], extra={"x": odd})])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "name", ["", "/a", "a//b", "../a", "a/..", "a/./b", "C:/a", "a\\b", "a\nb", "a" * 300, "a/ /b"]
)
def test_a_name_that_leaves_the_folder_is_refused(name):
    with pytest.raises(UsageError, match="must be a path inside the folder of the set"):
        check_image_name(name)


def test_a_set_that_was_moved_finds_its_scenes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for place in ("worlds/here", "set/beside", "set/scenes/house_01"):
        (tmp_path / place).mkdir(parents=True)
    found = {
        "worlds/here": "worlds/here",
        "beside": "set/beside",
        "old/set/scenes/house_01": "set/scenes/house_01",
        "old/gone": "old/gone",  # So that an error names what the episode says.
    }
    assert {name: resolve_scene_path(name, Path("set")).as_posix() for name in found} == found
