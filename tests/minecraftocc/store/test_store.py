"""A whole store: read back by us, by webdataset and by Hugging Face; every damage found."""

import json
import os
import shutil
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from occ_samples import assert_same, sample, samples

from world2minecraft.core.checksums import read_checksums
from world2minecraft.core.errors import (
    ConflictError,
    DamagedFileError,
    InputError,
    LimitError,
    UnknownNameError,
    UsageError,
)
from world2minecraft.minecraftocc.store import open_store, verify_store, write_store
from world2minecraft.minecraftocc.store import writer as writing_module
from world2minecraft.minecraftocc.store.index import read_index
from world2minecraft.minecraftocc.store.sample_files import SampleFiles

PNG = SampleFiles("png")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("store") / "data"
    patch = pytest.MonkeyPatch()
    patch.setattr(writing_module, "SHARD_SAMPLES", 4)
    write_store(folder, samples(), {"name": "tiny"}, files=PNG)
    patch.undo()
    return folder


@pytest.fixture(scope="module")
def one_copy(made, tmp_path_factory):
    return shutil.copytree(made, tmp_path_factory.mktemp("one") / "copy")


@pytest.fixture
def copied(made, tmp_path):
    return shutil.copytree(made, tmp_path / "copy")


def test_all_samples_come_back_in_their_order(made):
    store = open_store(made)
    assert len(store) == 14
    assert list(store) == store.keys() and store.keys()[3] in store and "x" not in store
    for ours, theirs in zip(samples(), store.samples(), strict=True):
        assert_same(ours, theirs)


def test_any_sample_by_its_key(made):
    store = open_store(made)
    assert_same(sample(103, "house_0002", "test"), store["house_0002-a-000103"])
    bare = store.sample("house_0002-a-000103", pictures=False)
    assert bare.colour is None and bare.depth_m is None
    with pytest.raises(UnknownNameError, match="did you mean 'house_0002-a-000"):
        store["house_0002-a-00010"]


def test_splits(made):
    store = open_store(made)
    assert len(store.keys("train")) == len(store.keys("test")) == 7
    assert {one.scene_id for one in store.samples("test", pictures=False)} == {"house_0002"}
    with pytest.raises(UsageError, match="has no split 'val'; known splits: test, train"):
        store.keys("val")


def test_the_index_has_a_row_for_each_sample(made):
    index = open_store(made).index()
    assert index["key"].tolist() == [one.key for one in samples()]
    assert index["class_chair"][3] == int((sample(3).occ.labels == 5).sum())
    assert index["x"].tolist() == [1.5] * 14
    assert index["shard"].tolist()[3:5] == [f"shards/train/house_0001-00{n}.tar" for n in (0, 1)]


def test_meta_tells_what_it_is(made):
    meta = open_store(made).meta
    assert meta["images"] == {"train": 7, "test": 7}
    assert meta["name"] == "tiny"
    assert len(meta["shards"]) == 4


def test_the_same_samples_give_the_same_files(made, tmp_path, monkeypatch):
    monkeypatch.setattr(writing_module, "SHARD_SAMPLES", 4)
    write_store(tmp_path / "again", samples(), {"name": "tiny"}, files=PNG)
    files = [path for path in made.rglob("*") if path.is_file()]
    assert len(files) == 9
    for path in files:
        assert (tmp_path / "again" / path.relative_to(made)).read_bytes() == path.read_bytes()


def test_a_folder_with_a_data_set_is_left_alone(made):
    with pytest.raises(ConflictError, match="already contains a data set"):
        write_store(made, samples())


def test_an_unfinished_data_set_leaves_nothing(tmp_path):
    def stopped():
        yield from samples(2)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_store(tmp_path, stopped(), files=PNG)
    assert not os.listdir(tmp_path)
    write_store(tmp_path, samples(2), files=PNG)
    assert len(open_store(tmp_path)) == 4


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ({"key": "my.frame"}, "sample key must be 1 to 90 characters of A-Z, a-z, 0-9, - and _, "
         "got 'my.frame'"),
        ({"key": "k" * 91}, "sample key must be 1 to 90 characters"),
        ({"scene_id": "room 1"}, "scene name must be 1 to 80 characters .* got 'room 1'"),
        ({"split": "tset"}, "split must be train, val, test or empty, got 'tset'"),
    ],
)  # fmt: skip
def test_names_that_no_reader_would_find_are_refused(tmp_path, words, text):
    with pytest.raises(UsageError, match=text):
        write_store(tmp_path, [replace(sample(), **words)])


def test_two_samples_of_one_key_are_refused(tmp_path):
    with pytest.raises(UsageError, match="two samples have the key 'house_0001-a-000000'"):
        write_store(tmp_path, [sample(), sample()])


@pytest.mark.parametrize("split", ["train", "val", "test", ""])
def test_any_split_is_found_again(tmp_path, split):
    write_store(tmp_path, [replace(sample(split=split), key="k" * 90, scene_id="s" * 80)])
    assert [one.split for one in open_store(tmp_path).samples(split)] == [split]


# Others read it.


def test_webdataset_reads_it(made):
    wds = pytest.importorskip("webdataset")
    shards = [str(made / f"shards/train/house_0001-{n:03d}.tar") for n in range(2)]
    read = list(wds.WebDataset(shards, shardshuffle=False).decode("rgb8"))
    assert [one["__key__"] for one in read] == [sample(n).key for n in range(7)]
    np.testing.assert_array_equal(read[2]["png"], sample(2).colour)
    np.testing.assert_array_equal(read[2]["occ.npz"]["labels"], sample(2).occ.labels)
    assert read[2]["json"]["camera"]["fx_px"] == 10.0


@pytest.mark.parametrize("pictures", [True, False])
def test_hugging_face_reads_it(tmp_path, monkeypatch, pictures):
    for name in ("HF_HUB_OFFLINE", "HF_DATASETS_OFFLINE"):
        monkeypatch.setenv(name, "1")
    datasets = pytest.importorskip("datasets")
    write_store(tmp_path / "data", samples(3, pictures=pictures), files=PNG)
    read = datasets.load_dataset(str(tmp_path / "data"), cache_dir=str(tmp_path / "cache"))
    assert {split: len(rows) for split, rows in read.items()} == {"train": 3, "test": 3}
    row, whole = read["train"][1], sample(1)
    assert row["__key__"] == whole.key
    assert row["json"]["region"]["voxel_m"] == 0.08
    labels = np.array(row["occ.npz"]["labels"], np.uint8)
    np.testing.assert_array_equal(labels, whole.occ.labels)
    if pictures:
        np.testing.assert_array_equal(np.asarray(row["png"]), whole.colour)
        depth = np.asarray(row["depth.png"])
        np.testing.assert_array_equal(depth, np.rint(whole.depth_m * 1000))


def test_hugging_face_reads_a_set_without_splits(tmp_path, monkeypatch):
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    datasets = pytest.importorskip("datasets")
    write_store(tmp_path / "data", [replace(one, split="") for one in samples(2)], files=PNG)
    read = datasets.load_dataset(str(tmp_path / "data"), cache_dir=str(tmp_path / "cache"))
    assert {split: len(rows) for split, rows in read.items()} == {"full": 4}


# Damage.


def test_a_whole_store_has_no_faults(made):
    verdict = verify_store(made)
    assert verdict.faults == ()
    assert (verdict.samples, verdict.shards) == (14, 4)


def test_the_list_names_every_file(made):
    names = {path.relative_to(made).as_posix() for path in made.rglob("*") if path.is_file()}
    assert read_checksums(made).keys() == names - {"checksums.json"}
    assert verify_store(made).files == len(names) - 1


@settings(max_examples=700)
@given(data=st.data())
def test_any_damage_to_any_file_is_found_and_named(one_copy, data):
    """Random flips, cuts and deletions, each undone again."""
    name = data.draw(st.sampled_from(sorted(read_checksums(one_copy) | {"checksums.json": 0})))
    path = one_copy / name
    whole = path.read_bytes()
    try:
        damage_file(path, whole, data)
        report = verify_store(one_copy)
        assert report.faults and all(name in fault for fault in report.faults)
        assert {*report.missing, *report.changed} == {name} - {"checksums.json"}
    finally:
        path.write_bytes(whole)


def damage_file(path, whole, data):
    """Change a byte of a file, cut it or remove it."""
    kind, place = data.draw(st.sampled_from(["flip", "cut", "remove"])), 0
    if kind == "remove":
        return path.unlink()
    place = data.draw(st.integers(0, len(whole) - 1))
    if kind == "cut":
        return path.write_bytes(whole[:place])
    bit = 1 << data.draw(st.integers(0, 7))
    return path.write_bytes(whole[:place] + bytes([whole[place] ^ bit]) + whole[place + 1 :])


def test_the_list_survives_no_change_of_itself(copied):
    path = copied / "checksums.json"
    path.write_text(json.dumps(json.loads(path.read_text())))  # The same values.
    (fault,) = verify_store(copied).faults
    assert fault == "checksums.json: is damaged: it does not match its own checksum"


def test_a_set_of_a_former_version_is_checked_by_its_index(copied):
    (copied / "checksums.json").unlink()
    assert verify_store(copied).faults == ("checksums.json: missing",)
    meta = json.loads((copied / "dataset.json").read_text())
    del meta["checksums"]
    (copied / "dataset.json").write_text(json.dumps(meta))
    report = verify_store(copied)
    assert (report.faults, report.files, report.has_valid_list) == ((), 0, False)
    shard = copied / "shards/test/house_0002-000.tar"
    shard.write_bytes(shard.read_bytes()[:5000])
    assert verify_store(copied).changed == ("shards/test/house_0002-000.tar",)


def test_what_is_missing_and_what_is_too_much_is_named(copied):
    (copied / "shards/train/house_0001-001.tar").unlink()
    (copied / "shards/train/other.tar.part").write_bytes(b"x")
    (copied / "note.txt").write_text("x")
    shard = copied / "shards/test/house_0002-001.tar"
    shard.write_bytes(shard.read_bytes()[:5000])
    faults = verify_store(copied).faults
    assert faults[:2] == (
        "note.txt: unexpected file",
        "shards/train/other.tar.part: unexpected file",
    )
    assert "shards/train/house_0001-001.tar: missing, with 3 samples" in faults
    assert "shards/test/house_0002-001.tar: sample house_0002-a-000106 is missing" in faults


def test_an_index_of_other_samples_is_found(copied, tmp_path):
    write_store(tmp_path / "other", samples(7, ("house_0001",)), files=PNG)
    shutil.copy(tmp_path / "other/index.parquet", copied)
    assert verify_store(copied).faults == ("index.parquet: changed",)
    edit(copied / "dataset.json", checksums=None)
    (copied / "checksums.json").unlink()
    assert (
        "index.parquet: the checksum differs from that in dataset.json"
        in verify_store(copied).faults
    )


@pytest.mark.parametrize(
    ("change", "text"),
    [
        (lambda d: (d / "dataset.json").unlink(), "not a data set: dataset.json not found"),
        (lambda d: (d / "dataset.json").write_text("[]"), "not a valid dataset.json in format 1"),
        (lambda d: edit(d / "dataset.json", complete=False), "is not complete; run the same"),
        (lambda d: (d / "classes.json").write_text("{}"), "not a valid list of classes"),
        (lambda d: (d / "index.parquet").unlink(), "not a valid index"),
        (lambda d: (d / "index.parquet").write_bytes(b"PAR1" * 99), "not a valid index"),
        (lambda d: shutil.rmtree(d / "shards"), "cannot be read: No such file"),
    ],
)
def test_an_unreadable_store_is_reported_in_one_line(copied, change, text):
    change(copied)
    with pytest.raises(InputError, match=text):
        list(open_store(copied).samples())


def edit(path, **changes):
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


@pytest.mark.parametrize(
    ("column", "value", "text"),
    [
        ("shard", "../../etc/passwd", "invalid shard name"),
        ("shard", "shards/train/../../x.tar", "invalid shard name"),
        ("size", 1 << 60, "invalid position or size"),
        ("size", -5, "invalid position or size"),
        ("offset", -512, "invalid position or size"),
        ("offset", 1 << 40, "ends before its last sample"),
        ("offset", 512, "not found at byte 512"),
        ("key", "other-a-000001", "sample other-a-000001 not found"),
    ],
)
def test_inconsistent_rows_are_refused(copied, column, value, text):
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pq.read_table(copied / "index.parquet")
    values = table[column].to_pylist()
    values[0] = value
    at = table.column_names.index(column)
    changed = table.set_column(at, table.field(column), pa.array(values, table.field(column).type))
    pq.write_table(changed, copied / "index.parquet")
    with pytest.raises(DamagedFileError, match=text):
        next(open_store(copied).samples())


def test_an_index_whose_texts_are_no_utf_8_is_refused(copied):
    import pyarrow.parquet as pq

    path = copied / "index.parquet"
    table = pq.read_table(path)
    key = table["key"][0].as_py().encode()
    pq.write_table(table, path, compression="none", use_dictionary=False)
    path.write_bytes(path.read_bytes().replace(key, b"\xff" + key[1:]))
    with pytest.raises(DamagedFileError, match="not a valid index"):
        read_index(path)


def test_an_index_with_missing_columns_or_extra_rows_is_refused(copied, monkeypatch):
    import pyarrow.parquet as pq

    from world2minecraft.minecraftocc.store import index

    monkeypatch.setattr(index, "MAX_ROWS", 5)
    with pytest.raises(LimitError, match="14 rows"):
        open_store(copied)
    monkeypatch.undo()
    pq.write_table(
        pq.read_table(copied / "index.parquet").drop(["sha256"]), copied / "index.parquet"
    )
    with pytest.raises(DamagedFileError, match="does not contain a column sha256 of type string"):
        open_store(copied)


def test_no_file_is_left_when_writing_fails(tmp_path):
    def failing():
        yield from samples(2)
        raise KeyError("gone")

    with pytest.raises(KeyError):
        write_store(tmp_path / "data", failing(), files=PNG)
    assert not os.listdir(tmp_path)
