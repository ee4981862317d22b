"""A run that was cut off goes on where it stopped; a changed one begins again."""

import json

import pytest

from world2minecraft.core.errors import InputError, OutputError, UnknownNameError
from world2minecraft.core.output_folders import check_writable
from world2minecraft.reconstruction.parameters import Parameters, with_settings
from world2minecraft.reconstruction.pipeline import manifest
from world2minecraft.reconstruction.run_folder import (
    BUILT_FROM,
    RunFolder,
    check_finished,
    hash_capture,
)

STAGES = ("scan", "fuse", "build")


def run_until(folder, manifest, last=None, start=None):
    """Run stages up to ``last``; return those that were really run."""
    run = RunFolder(folder, STAGES, start)
    run.begin(manifest)
    done = []
    for stage in STAGES:
        if run.needs(stage):
            with run.stage(stage):
                done.append(stage)
        if stage == last:
            break
    return done


def test_a_cut_off_run_goes_on(tmp_path):
    assert run_until(tmp_path, {"a": 1}, last="fuse") == ["scan", "fuse"]
    assert run_until(tmp_path, {"a": 1}) == ["build"]


def test_a_stage_that_fails_is_not_finished(tmp_path):
    run = RunFolder(tmp_path, STAGES)
    run.begin({"a": 1})
    with pytest.raises(RuntimeError), run.stage("scan"):
        raise RuntimeError
    assert run_until(tmp_path, {"a": 1}) == list(STAGES)


def test_a_finished_or_changed_run_begins_again(tmp_path):
    run_until(tmp_path, {"a": 1})
    assert run_until(tmp_path, {"a": 1}) == list(STAGES)
    run_until(tmp_path, {"a": 1}, last="fuse")
    assert run_until(tmp_path, {"a": 2}) == list(STAGES)


def test_from_begins_at_a_stage_even_with_other_parameters(tmp_path):
    run_until(tmp_path, {"a": 1})
    assert run_until(tmp_path, {"a": 2}, start="build") == ["build"]


def test_what_is_built_must_be_of_one_run(tmp_path):
    with pytest.raises(InputError, match=r"room.npz not found; run w2m reconstruct"):
        check_finished(tmp_path)
    for name in BUILT_FROM:
        (tmp_path / name).write_text("")
    check_finished(tmp_path)  # Of a plan or a grid: no stage is told.
    for finished, is_whole in (
        (["scan", "label"], False),
        (["scan", "label", "find"], False),
        (["scan", "label", "find", "furnish"], True),
        (["scan"], True),  # All of them are still those of the run before.
        ("label", True),
        (5, True),
    ):
        (tmp_path / "manifest.json").write_text(json.dumps({"finished": finished}))
        if is_whole:
            check_finished(tmp_path)
        else:
            with pytest.raises(InputError, match="it was interrupted before the furnish stage"):
                check_finished(tmp_path)


def test_from_needs_the_stages_before(tmp_path):
    with pytest.raises(InputError, match="the stage 'scan' has not been completed"):
        run_until(tmp_path, {}, start="fuse")
    with pytest.raises(UnknownNameError, match="did you mean 'build'"):
        run_until(tmp_path, {}, start="biuld")


def test_a_damaged_manifest_is_no_manifest(tmp_path):
    (tmp_path / "manifest.json").write_text("{")
    assert run_until(tmp_path, {"a": 1}) == list(STAGES)


def test_times_lie_in_run_json_and_nowhere_else(tmp_path):
    run_until(tmp_path, {"a": 1})
    assert set(json.loads((tmp_path / "run.json").read_text())["stage_s"]) == set(STAGES)
    assert json.loads((tmp_path / "manifest.json").read_text()) == {
        "a": 1,
        "finished": list(STAGES),
    }


def test_stage_times_add_up_and_are_written_from_begin_on(tmp_path):
    run = RunFolder(tmp_path / "out", STAGES)
    with run.timed("scan"):
        sum(range(200_000))
    assert not (tmp_path / "out").exists()
    run.begin({})
    with run.stage("scan"):
        pass
    assert json.loads((tmp_path / "out/run.json").read_text())["stage_s"]["scan"] > 0


def test_an_out_that_is_a_file_is_refused_and_kept(tmp_path):
    target = tmp_path / "out"
    target.write_text("mine")
    with pytest.raises(OutputError, match="is a file; the output must be a folder"):
        RunFolder(target, STAGES)
    with pytest.raises(OutputError):
        check_writable(target)
    assert target.read_text() == "mine"


def test_a_full_disk_is_refused(tmp_path, monkeypatch):
    usage = type("Usage", (), {"free": 3 << 20})()
    monkeypatch.setattr("shutil.disk_usage", lambda _: usage)
    with pytest.raises(OutputError, match="the disk has 3 MB free, 64 MB are required"):
        check_writable(tmp_path / "out")


def test_the_hash_sees_names_and_bytes_but_no_hidden_files(tmp_path):
    (tmp_path / "a").write_text("1")
    first = hash_capture(tmp_path)
    (tmp_path / ".cache").write_text("x")
    assert hash_capture(tmp_path) == first
    (tmp_path / "a").rename(tmp_path / "b")
    renamed = hash_capture(tmp_path)
    (tmp_path / "b").write_text("2")
    assert len({first, renamed, hash_capture(tmp_path)}) == 3


def test_manifest_hashes_palette_and_user_furniture(tmp_path, monkeypatch):
    capture, palette, own = tmp_path / "scan", tmp_path / "mine.json", tmp_path / "furniture"
    capture.mkdir()
    own.mkdir()
    monkeypatch.setenv("W2M_FURNITURE", str(own))
    palette.write_text("{}")
    chosen = with_settings(Parameters(), [f"build.palette={palette}"])
    told = [manifest(capture, None, chosen)]
    palette.write_text("{ }")
    told.append(manifest(capture, None, chosen))
    (own / "my_chair.json").write_text("{}")
    told.append(manifest(capture, None, chosen))
    assert told[0] != told[1] != told[2]
    plain = manifest(capture, None, Parameters())
    assert plain["palette"] is None and plain["furniture"] == told[2]["furniture"] is not None


def test_results_within_a_capture_are_no_part_of_it(tmp_path):
    (tmp_path / "a").write_text("1")
    out = tmp_path / "OUT"
    first = hash_capture(tmp_path, without=out)
    (out / "capture").mkdir(parents=True)
    (out / "capture" / "b").write_text("2")
    assert hash_capture(tmp_path, without=out) == first != hash_capture(tmp_path)
    inner = hash_capture(out / "capture", without=out)
    (out / "capture" / "b").write_text("3")
    assert hash_capture(out / "capture", without=out) != inner
