"""Damaged data sets: what the plan and the seed determine is made again, byte for byte."""

import json
import shutil

import pytest
from house_of_blocks import cottage
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.damaged_folders import files_of, flip

from world2minecraft import cli
from world2minecraft.api.datasets import build_photo_dataset, export_dataset, import_dataset
from world2minecraft.core.checksums import read_checksums
from world2minecraft.core.errors import ConflictError
from world2minecraft.core.locks import Lock
from world2minecraft.minecraft.formats import write_blocks
from world2minecraft.minecraftocc.building import build_dataset, repair_dataset
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.labels.camera_region import RegionRule
from world2minecraft.minecraftocc.plan import Recipe, house_scenes, plan_dataset, source_scenes
from world2minecraft.minecraftocc.store import open_store, verify_store
from world2minecraft.rendering.views import camera_of

RECIPE = Recipe(
    camera=camera_of(32, 24, vertical_fov_deg=70), region=RegionRule("paper", (12, 12, 8), 0.4)
)


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    path = tmp_path_factory.mktemp("worlds") / "cottage.schem"
    write_blocks(cottage().volume(), path)
    return path


@pytest.fixture(scope="module")
def made(source, tmp_path_factory):
    """A set of a generated house and a world."""
    scenes = [*house_scenes(1), *source_scenes([source])]
    folder = tmp_path_factory.mktemp("made") / "data"
    with open_engine("pool", 1) as engine:
        build_dataset(folder, plan_dataset(scenes, 4, recipe=RECIPE), engine)
    return folder


@pytest.fixture(scope="module")
def one_copy(made, tmp_path_factory):
    return shutil.copytree(made, tmp_path_factory.mktemp("one") / "copy")


@pytest.fixture
def copied(made, tmp_path):
    return shutil.copytree(made, tmp_path / "copy")


def repair(folder):
    with open_engine("pool", 1) as engine:
        return repair_dataset(folder, engine)


def test_worlds_scenes_and_tours_are_listed_and_checked(made, copied):
    world = "worlds/house_0001/world"
    names = {f"{world}/level.dat", "scenes/house_0001.poses.jsonl", "scenes/cottage.json"}
    assert names <= read_checksums(made).keys() and not verify_store(made).faults
    (copied / "scenes/cottage.objects.json").unlink()
    for name in names:
        flip(copied / name)
    shutil.rmtree(copied / world / "region")
    report = verify_store(copied)
    assert set(report.changed) == names
    assert "scenes/cottage.objects.json" in report.missing
    assert any(name.startswith(f"{world}/region/") for name in report.missing)
    assert len(report.faults) == len(report.changed) + len(report.missing)


def kinds_of(folder):
    """A file of each kind but of dataset.json, whose plan nothing else has."""
    names = read_checksums(folder)
    starts = {name.rpartition("/")[0] + name.partition(".")[2]: name for name in names}
    return sorted(name for name in starts.values() if name != "dataset.json")


@settings(max_examples=6)
@given(data=st.data())
def test_any_damaged_files_are_made_again(made, one_copy, data):
    names = st.sampled_from(kinds_of(made))
    damage = data.draw(st.dictionaries(names, st.booleans(), min_size=1))
    for name, is_missing in damage.items():
        (one_copy / name).unlink() if is_missing else flip(one_copy / name)
    report = repair(one_copy)
    assert (set(report.repaired), report.left) == (set(damage), ())
    assert files_of(one_copy) == files_of(made)


def test_nothing_is_made_without_damage_and_extra_files_stay(made, copied):
    assert repair(copied) == repair(made)
    (copied / "worlds/house_0001/note.txt").write_text("mine")
    report = repair(copied)
    assert report.left == (
        "worlds/house_0001/note.txt: unexpected file; move it away or delete it",
    )
    assert (copied / "worlds/house_0001/note.txt").read_text() == "mine"


def test_a_damaged_list_is_made_again_with_all_files(made, copied):
    flip(copied / "checksums.json", 99)
    flip(copied / "scenes/cottage.json")
    report = repair(copied)
    assert set(report.repaired) == {"checksums.json", "scenes/cottage.json"} and not report.left
    assert files_of(copied) == files_of(made)


def test_a_set_without_a_list_gets_one(copied):
    (copied / "checksums.json").unlink()
    meta = json.loads((copied / "dataset.json").read_text())
    del meta["checksums"]
    (copied / "dataset.json").write_text(json.dumps(meta))
    (copied / "shards/train/house_0001-000.tar").unlink(missing_ok=True)
    (copied / "shards/test/house_0001-000.tar").unlink(missing_ok=True)
    report = repair(copied)
    assert len(report.repaired) == 1 and not report.left
    assert verify_store(copied).files == len(files_of(copied)) - 1


def test_what_cannot_be_made_again_is_named_with_advice(made, copied, source, tmp_path):
    flip(copied / "dataset.json", 0)
    (text,) = repair(copied).left
    assert text.startswith("dataset.json: contains the plan of the data set; restore it from a")
    shutil.copy(made / "dataset.json", copied)
    flip(copied / "scenes/cottage.json")
    shutil.move(source, tmp_path / "away.schem")
    (text,) = repair(copied).left
    assert text.startswith("scenes/cottage.json: cannot be made again: ") and str(source) in text
    shutil.move(tmp_path / "away.schem", source)
    assert not repair(copied).left


def test_files_of_another_version_are_not_mixed_in(copied, monkeypatch):
    shard = next((copied / "shards").rglob("cottage-000.tar"))
    flip(shard, 700)
    before = shard.read_bytes()
    module = "world2minecraft.minecraftocc.building"
    monkeypatch.setattr(f"{module}.shard_rendering.pack_sample", other_sample)
    monkeypatch.setattr(f"{module}.repair.versions", lambda: {"world2minecraft": "9"})
    (text,) = repair(copied).left
    assert "cannot be made again with other versions; repair it with numpy " in text
    assert shard.read_bytes() == before


def other_sample(sample, table, files):
    from dataclasses import replace

    from world2minecraft.minecraftocc.store import pack_sample

    return pack_sample(replace(sample, facts={**sample.facts, "hour": 3.0}), table, files)


def test_imported_sets_and_photo_sets_are_repaired(tmp_path):
    photos = build_photo_dataset(tmp_path / "PHOTO", rooms=2, images=2, size=(32, 24))
    export_dataset(photos, tmp_path / "NPZ", "npz")
    imported = import_dataset(tmp_path / "NPZ", tmp_path / "SET").folder
    for folder, repaired in ((photos.folder, 3), (imported, 1)):
        before = files_of(folder)
        (folder / "README.md").unlink()
        if folder == photos.folder:
            flip(folder / "classes.json")
            flip(next(folder.rglob("*.tar")))
        assert len(repair(folder).repaired) == repaired
        assert files_of(folder) == before
    flip(imported / "classes.json")
    (text,) = repair(imported).left
    assert text.startswith("classes.json: cannot be made again; import the data set again")
    assert len(open_store(photos.folder)) == 2


def test_a_set_in_use_is_not_repaired(copied):
    (copied / "README.md").unlink()
    lock = Lock(copied / ".lock", "built")
    lock.acquire()
    with pytest.raises(ConflictError, match="is being built by process"):
        repair(copied)
    lock.release()


def test_the_command_names_the_damage_and_repairs_it(made, copied, capsys):
    flip(copied / "scenes/cottage.json")
    (copied / "README.md").unlink()
    assert cli.run(["dataset", "verify", str(copied)]) == 3
    out = capsys.readouterr()
    assert "fault: README.md: missing\nfault: scenes/cottage.json: changed\n" in out.out
    assert "has 2 faults; repair it with w2m dataset verify " in out.err
    assert cli.run(["dataset", "verify", str(copied), "--repair", "--jobs", "1"]) == 0
    assert "repaired: README.md\nrepaired: scenes/cottage.json\n" in capsys.readouterr().out
    assert files_of(copied) == files_of(made)
    (copied / "note.txt").write_text("mine")
    assert cli.run(["dataset", "verify", str(copied), "--repair"]) == 3
    assert "left: note.txt: unexpected file; move it away" in capsys.readouterr().out
