"""The whole way on a small virtual scan: every file, its laws, and the same bytes again."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.minecraft.schematics.sponge import read_schem
from world2minecraft.minecraft.worlds.world_writer import read_world

FILES = {
    "manifest.json", "run.json", "scan.json", "evidence.npz", "room.npz", "centers.npz",
    "occ.json", "centers.json", "objects.json", "placements.json", "preview.png", "report.html",
    "report.json", "build/room.schem", "build/datapack.zip", "build/scene.json", "build/scene.npz",
    "build/world/level.dat",
}  # fmt: skip


@pytest.fixture(scope="module")
def capture(dining_scan) -> Path:
    return dining_scan


@pytest.fixture(scope="module")
def out(capture, tmp_path_factory) -> Path:
    """The finished reconstruction of the capture."""
    folder = tmp_path_factory.mktemp("run") / "OUT"
    assert w2m(["reconstruct", str(capture), "--out", str(folder)]) == 0
    return folder


def digests(folder: Path) -> dict[str, str]:
    """A hash of every file of a run but run.json."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != "run.json"
    }


def test_every_file_is_there_and_nothing_half_written(out):
    names = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    assert names >= FILES
    assert not [name for name in names if Path(name).name.startswith(".")]


def test_the_room_is_right_within_one_voxel(out):
    truth = json.loads((out / "report.json").read_text())["truth"]
    assert truth["surface_within_one_voxel"]["precision"] >= 0.99
    assert truth["surface_within_one_voxel"]["recall"] >= 0.97
    assert truth["frame_error"]["tilt_deg"] < 0.3 and truth["frame_error"]["yaw_deg"] < 0.4
    assert abs(truth["frame_error"]["floor_m"]) < 0.02


def test_given_labels_are_used_and_help(out, capture, tmp_path):
    voted = json.loads((out / "report.json").read_text())["truth"]["occupancy"]
    assert voted["miou_present_classes"] > 0.5
    shutil.copytree(out, tmp_path / "plain")
    words = ["reconstruct", str(capture), "--out", str(tmp_path / "plain"), "--from", "label"]
    assert w2m([*words, "--labeller", "geometric"]) == 0
    plain = json.loads((tmp_path / "plain/report.json").read_text())["truth"]["occupancy"]
    assert voted["miou_present_classes"] > plain["miou_present_classes"]


def test_the_same_bytes_with_another_hash_seed_and_thread_count(out, capture, tmp_path):
    environment = os.environ | {
        "PYTHONHASHSEED": "4321",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "NUMBA_NUM_THREADS": "1",
    }
    words = ["reconstruct", str(capture), "--out", str(tmp_path)]
    subprocess.run(
        [sys.executable, "-m", "world2minecraft", *words],
        env=environment,
        check=True,
        capture_output=True,
    )
    assert digests(tmp_path) == digests(out)


def test_world_and_schematic_hold_the_same_blocks(out):
    world, schem = read_world(out / "build/world"), read_schem(out / "build/room.schem")
    counts = []
    for volume in (world, schem):
        kinds, numbers = np.unique(volume.states[volume.states > 0], return_counts=True)
        counts.append({volume.palette[k]: int(n) for k, n in zip(kinds, numbers, strict=True)})
    assert counts[0] == counts[1] and sum(counts[0].values()) > 500


def test_objects_and_instances_agree(out):
    grid, _ = read_room(out / "room.npz")
    instances = read_objects(out / "objects.json", grid)
    placements = read_placements(out / "placements.json")
    assert {item.id for item in instances} == set(np.unique(grid.instance)) - {0}
    assert {item.object_id for item in placements} == {item.id for item in instances}
    for item in instances:
        assert (grid.labels[tuple(item.cells.T)] == item.class_id).all()
    assert {5, 8} <= {item.class_id for item in instances}, "chairs and a table"


def test_from_build_keeps_what_came_before(out, capture, tmp_path, capsys):
    before = digests(out)
    words = ["reconstruct", str(capture), "--out", str(out), "--from", "build"]
    assert w2m([*words, "--blocks-per-metre", "2"]) == 0
    after = digests(out)
    same = {name for name in before if before[name] == after.get(name)}
    assert {"room.npz", "evidence.npz", "placements.json", "objects.json"} <= same
    assert before["build/room.schem"] != after["build/room.schem"]
    assert w2m([*words, "--blocks-per-metre", "4"]) == 0
    assert {k: v for k, v in digests(out).items() if k.startswith("build/")} == {
        k: v for k, v in before.items() if k.startswith("build/")
    }


def test_later_stages_use_the_recorded_alignment(out, capture, tmp_path, monkeypatch):
    shutil.copytree(out, tmp_path / "again")
    before = digests(out)
    monkeypatch.setattr(sys.modules["world2minecraft.capture.open_scan"], "align", None)
    words = ["reconstruct", str(capture), "--out", str(tmp_path / "again"), "--from"]
    for stage in ("label", "find", "furnish", "report"):
        assert w2m([*words, stage]) == 0
        assert digests(tmp_path / "again") == before


def test_from_tells_the_settings_of_the_stages_that_it_keeps(out, capture, tmp_path, capsys):
    shutil.copytree(out, tmp_path / "again")
    words = ["reconstruct", str(capture), "--out", str(tmp_path / "again"), "--from"]
    assert w2m([*words, "find", "--set", "find.min_cells=12"]) == 0
    assert w2m([*words, "build", "--blocks-per-metre", "2"]) == 0
    assert "kept from the earlier run: find.min_cells=12" in capsys.readouterr().out
    manifest = json.loads((tmp_path / "again/manifest.json").read_text())
    assert manifest["parameters"]["find"]["min_cells"] == 12
    before = digests(tmp_path / "again")
    assert w2m([*words, "build", "--set", "find.min_cells=20"]) == 2
    assert "omit find.min_cells, or start at find (--from)" in capsys.readouterr().err
    assert digests(tmp_path / "again") == before, "nothing is touched"


def test_a_run_that_was_cut_off_goes_on(out, capture, monkeypatch, tmp_path):
    from world2minecraft.reconstruction import file_stages as steps

    shutil.copytree(out, tmp_path / "cut")
    words = ["reconstruct", str(capture), "--out", str(tmp_path / "cut")]
    real = steps.FILE_STAGES["furnish"]
    monkeypatch.setitem(
        steps.FILE_STAGES, "furnish", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt)
    )
    assert w2m([*words, "--from", "label"]) == 130
    assert json.loads((tmp_path / "cut/manifest.json").read_text())["finished"][-1] == "find"
    stamp = (tmp_path / "cut/evidence.npz").stat().st_mtime_ns
    monkeypatch.setitem(steps.FILE_STAGES, "furnish", real)
    assert w2m(words) == 0
    assert (tmp_path / "cut/evidence.npz").stat().st_mtime_ns == stamp


def test_build_at_another_scale_and_from_a_bare_array(out, tmp_path):
    assert w2m(["build", str(out), "--out", str(tmp_path / "b"), "--blocks-per-metre", "1"]) == 0
    small = read_schem(tmp_path / "b/build/room.schem")
    assert small.states.shape[1] < read_schem(out / "build/room.schem").states.shape[1]
    grid, _ = read_room(out / "room.npz")
    np.save(tmp_path / "labels.npy", grid.labels)
    words = ["build", str(tmp_path / "labels.npy"), "--out", str(tmp_path / "c")]
    assert w2m([*words, "--blocks-per-metre", "12.5"]) == 0
    assert (tmp_path / "c/build/world/level.dat").is_file()
    assert w2m(["build", str(out), "--out", str(out)]) == 2


def test_the_report_stands_alone(out):
    page = (out / "report.html").read_text()
    crops = len(re.findall(r'alt="Object \d+ in the world"', page))
    (room,) = re.findall(r'srcdoc="([^"]*)"', page)  # Its policy lets nothing out.
    page = page.replace(room, "")
    assert crops > 0 and page.count("data:image/") == 15 + 2 * crops
    assert "://" not in page.split("</style>")[1]
    assert "default-src &amp;#x27;none&amp;#x27;" in room
    assert len(page) + len(room) < 5_000_000
    assert "Photos and built world" in page and "Comparison with ground truth" in page


def test_a_run_of_version_0_1_is_built_and_reported_again(out, capture, tmp_path):
    folder = tmp_path / "former"
    shutil.copytree(out, folder)
    new = {"name", "name_confidence", "supported_by"}  # What 0.1 did not write.
    for name in ("objects.json", "placements.json"):
        rows = json.loads((folder / name).read_text())
        kept = [{key: value for key, value in row.items() if key not in new} for row in rows]
        (folder / name).write_text(json.dumps(kept))
    for name in ("names.npz", "repairs.json"):
        (folder / name).unlink(missing_ok=True)
    assert w2m(["reconstruct", str(capture), "--out", str(folder), "--from", "build"]) == 0
    rows = json.loads((folder / "report.json").read_text())["objects"]
    assert rows and not any("name" in row for row in rows)
    assert (folder / "report.html").is_file()
