"""A run that was cut off goes on where it stopped; a changed one begins again."""

import json

import pytest

from world2minecraft.errors import InputError, OutputError, UnknownNameError
from world2minecraft.run_folder import RunFolder, check_writable, hash_capture

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


def test_from_needs_the_stages_before(tmp_path):
    with pytest.raises(InputError, match="stage 'scan' was never finished here"):
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


def test_times_of_one_stage_add_up_and_nothing_is_written_before_it_begins(tmp_path):
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
    with pytest.raises(OutputError, match="is a file; --out needs a folder"):
        RunFolder(target, STAGES)
    with pytest.raises(OutputError):
        check_writable(target)
    assert target.read_text() == "mine"


def test_a_full_disk_is_refused(tmp_path, monkeypatch):
    usage = type("Usage", (), {"free": 3 << 20})()
    monkeypatch.setattr("shutil.disk_usage", lambda _: usage)
    with pytest.raises(OutputError, match="its disk has 3 MB free; 64 needed"):
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
