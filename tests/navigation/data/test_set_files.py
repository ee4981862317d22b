"""The files of a navigation set: listed, checked, read by others, and made again after damage."""

import json
import shutil

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.damaged_folders import files_of, flip

import world2minecraft as w2m
from world2minecraft import cli
from world2minecraft.api.navigation import reword_navigation_set
from world2minecraft.core.checksums import read_checksums
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.navigation.data.set_files import verify_set
from world2minecraft.navigation.data.set_repair import repair_set
from world2minecraft.navigation.records import read_items


@pytest.fixture(scope="module")
def made(flat_path, tmp_path_factory):
    """A set of a flat, and of a house that was generated for it."""
    out = tmp_path_factory.mktemp("made") / "set"
    w2m.build_navigation_set(
        [flat_path], out, houses=1, trajectories=1, size=(64, 36), seed=2, workers=1
    )
    return out


@pytest.fixture(scope="module")
def one_copy(made, tmp_path_factory):
    return shutil.copytree(made, tmp_path_factory.mktemp("one") / "copy")


@pytest.fixture
def copied(made, tmp_path):
    return shutil.copytree(made, tmp_path / "copy")


def test_every_file_of_a_set_is_listed(made):
    report = verify_set(made)
    names = files_of(made).keys()
    assert read_checksums(made).keys() == names - {"checksums.json"}
    assert {"README.md", "dataset.json", "scenes/house_01_s2/world/level.dat"} <= names
    assert (report.faults, report.files) == ((), len(names) - 1)
    assert report.items == len(read_items(made))


@settings(max_examples=400)
@given(data=st.data())
def test_any_damage_to_a_set_is_found_and_named(one_copy, data):
    """Random flips, cuts and deletions, each undone again."""
    name = data.draw(st.sampled_from(sorted({*read_checksums(one_copy), "checksums.json"})))
    kind = data.draw(st.sampled_from(["flip", "cut", "remove"]))
    path = one_copy / name
    whole = path.read_bytes()
    place, bit = data.draw(st.integers(0, len(whole) - 1)), 1 << data.draw(st.integers(0, 7))
    try:
        if kind == "remove":
            path.unlink()
        else:
            rest = bytes([whole[place] ^ bit]) + whole[place + 1 :]
            path.write_bytes(whole[:place] + (rest if kind == "flip" else b""))
        report = verify_set(one_copy)
        assert len(report.faults) == 1 and report.faults[0].startswith(f"{name}: ")
    finally:
        path.write_bytes(whole)


def kinds_of(folder):
    """A file of each kind but of dataset.json, whose options nothing else has."""
    names = read_checksums(folder)
    starts = {name.rpartition("/")[0] + name.partition(".")[2]: name for name in names}
    return sorted(name for name in starts.values() if name != "dataset.json")


@settings(max_examples=5)
@given(data=st.data())
def test_any_damaged_files_are_made_again(made, one_copy, data):
    names = st.sampled_from(kinds_of(made))
    damage = data.draw(st.dictionaries(names, st.booleans(), min_size=1))
    for name, is_missing in damage.items():
        (one_copy / name).unlink() if is_missing else flip(one_copy / name)
    report = repair_set(one_copy)
    assert (set(report.repaired), report.left) == (set(damage), ())
    assert files_of(one_copy) == files_of(made)


def test_images_alone_are_rendered_again(made, copied, monkeypatch):
    module = "world2minecraft.navigation.data.set_repair.build_navigation_set"
    monkeypatch.setattr(module, None)
    shutil.rmtree(copied / "images")
    assert len(repair_set(copied).repaired) == sum(
        one.startswith("images/") for one in files_of(made)
    )
    assert files_of(copied) == files_of(made)


def test_a_damaged_list_is_written_again(made, copied):
    flip(copied / "checksums.json")
    image = min((copied / "images").rglob("*.jpg"))
    image.unlink()
    report = verify_set(copied)
    assert report.faults[0] == "checksums.json: is damaged: it does not match its own checksum"
    assert not report.has_valid_list and len(report.missing) == 1
    assert "checksums.json" in repair_set(copied).repaired
    assert files_of(copied) == files_of(made)


def test_what_cannot_be_made_again_is_named(copied):
    flip(copied / "dataset.json", 0)
    (copied / "note.txt").write_text("mine")
    text, extra = repair_set(copied).left
    assert text.startswith("dataset.json: contains the options of the set; restore it from a copy")
    assert extra == "note.txt: unexpected file; move it away or delete it"


def test_a_reworded_set_has_a_right_list(made, copied, tmp_path):
    walk = read_items(copied)[0].trajectory_id
    words = tmp_path / "words.csv"
    words.write_text(f"trajectory_id,instruction\n{walk},Walk over to the piano and stop.\n")
    (copied / "annotations.jsonl").write_text("")  # People's own file, which changes on its own.
    before = files_of(copied)
    reword_navigation_set(copied, annotations=words)
    assert not verify_set(copied).faults
    changed = {name for name, data in files_of(copied).items() if data != before[name]}
    assert changed == {"items.jsonl", "trajectories.jsonl", "episodes.jsonl", "checksums.json"}
    flip(copied / "items.jsonl")
    (text,) = repair_set(copied).left
    assert "items.jsonl: cannot be made again" in text and "reword the set again" in text
    with pytest.raises(DamagedFileError, match="has changed since it was written; repair it with"):
        reword_navigation_set(copied, plain=True)


def test_annotations_at_the_build_are_in_the_list(flat_path, made, tmp_path):
    walk = next(one.trajectory_id for one in read_items(made) if one.scene_id == "flat")
    words = tmp_path / "words.csv"
    words.write_text(f"trajectory_id,instruction\n{walk},Walk over to the piano and stop.\n")
    w2m.build_navigation_set(
        [flat_path], tmp_path / "set", trajectories=3, size=(64, 36), seed=2, workers=1,
        annotations=words,
    )  # fmt: skip
    assert not verify_set(tmp_path / "set").faults
    assert {one.instruction.source for one in read_items(tmp_path / "set")} > {"human"}


def test_a_set_of_a_former_version_is_checked_by_its_records(made, copied):
    for name in ("checksums.json", "README.md"):
        (copied / name).unlink()
    about = json.loads((copied / "dataset.json").read_text())
    del about["checksums"], about["build"]
    (copied / "dataset.json").write_text(json.dumps(about))
    report = verify_set(copied)
    assert (report.faults, report.files) == ((), 0)
    flip(min((copied / "images").rglob("*.jpg")))
    assert len(verify_set(copied).changed) == 1
    with pytest.raises(InputError, match="items.jsonl: not found"):
        verify_set(copied / "images")


def test_hugging_face_reads_the_tables_of_a_set(made, tmp_path, monkeypatch):
    for name in ("HF_HUB_OFFLINE", "HF_DATASETS_OFFLINE"):
        monkeypatch.setenv(name, "1")
    datasets = pytest.importorskip("datasets")
    cache = str(tmp_path / "cache")
    items = datasets.load_dataset(str(made), cache_dir=cache)["full"]  # The default.
    ours = read_items(made)
    assert items["item_id"][:] == [one.item_id for one in ours]
    assert [one["text"] for one in items["instruction"]] == [one.instruction.text for one in ours]
    assert items[0]["options"][0]["label"] == "A" and items["split"][:] == [
        one.split for one in ours
    ]
    for name in ("trajectories", "episodes"):
        rows = datasets.load_dataset(str(made), name, cache_dir=cache)["full"]
        lines = (made / f"{name}.jsonl").read_text().splitlines()
        assert rows["trajectory_id"][:] == [json.loads(line)["trajectory_id"] for line in lines]


def test_the_command_names_the_damage_and_repairs_it(made, copied, capsys):
    (copied / "README.md").unlink()
    assert cli.run(["vln", "verify", str(copied)]) == 3
    out = capsys.readouterr()
    assert "fault: README.md: missing" in out.out
    assert "has 1 fault; repair it with w2m vln verify " in out.err
    assert cli.run(["vln", "verify", str(copied), "--repair", "--workers", "1"]) == 0
    assert "repaired: README.md\n" in capsys.readouterr().out
    assert cli.run(["vln", "verify", str(copied), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == len(files_of(made)) - 1
