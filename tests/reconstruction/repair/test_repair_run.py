"""Repair of a run: its files, and runs that are not repaired."""

import json
from dataclasses import replace

import numpy as np
import pytest
from tests.reconstruction.verification.verified_room import verified_room

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Scan
from world2minecraft.formats.objects_and_placements import (
    read_placements,
    write_objects,
    write_placements,
)
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.reconstruction import repair_run as module
from world2minecraft.reconstruction.parameters import Parameters, with_method, with_settings
from world2minecraft.reconstruction.repair_run import REPAIRS, read_repairs, repair_run

SETTINGS = ["repair.max_objects=7", "repair.max_candidates=2"]
NO_SCAN: Scan = None  # type: ignore[assignment]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A furnished run whose toilet became a washing machine, and which has photos."""
    room = verified_room()
    toilet = next(one for one in room.instances if one.name == "toilet")
    wrong = {"template": "washing_machine", "parameters": {}, "alternatives": ()}
    placements = [
        replace(one, **wrong) if one.object_id == toilet.id else one for one in room.placements
    ]
    write_room(tmp_path / "room.npz", room.grid, np.eye(4))
    write_objects(tmp_path / "objects.json", room.instances)
    write_placements(tmp_path / "placements.json", tuple(placements))
    monkeypatch.setattr(module, "photos_for_repair", lambda *_: room.samples[:4])
    return tmp_path


def test_changes_are_written_and_reported(folder):
    told = []

    def progress(stage: str, done: int, total: int, note: str = "") -> None:
        told.append((stage, done, total, note))

    repair_run(folder, NO_SCAN, with_settings(Parameters(), SETTINGS), progress)
    facts = json.loads((folder / REPAIRS).read_text())
    (change,) = (one for one in facts["changes"] if one["name"] == "toilet")
    assert change["before"][0]["template"] == "washing_machine"
    assert change["after"][0]["template"] == "toilet"
    assert change["agreement_after"] > change["agreement_before"]
    assert facts["headline_after"] > facts["headline_before"]
    placed = {one.object_id: one.template for one in read_placements(folder / "placements.json")}
    assert placed[change["id"]] == "toilet"
    stage, done, total, note = told[-1]
    assert (stage, done, total) == ("repair", 1, 1)
    assert note.startswith(f"{len(facts['changes'])} of 7 objects exchanged, headline ")


def test_a_damaged_list_of_repairs_is_refused(folder):
    repair_run(folder, NO_SCAN, with_settings(Parameters(), SETTINGS))
    facts = json.loads((folder / REPAIRS).read_text())
    assert read_repairs(folder) == facts
    row = facts["changes"][0]
    for broken in (
        [],
        facts | {"headline_after": [1]},
        facts | {"views": None},
        facts | {"changes": [row | {"iou_after": "x"}]},
        facts | {"changes": [row | {"before": [{"template": "box"}]}]},
    ):
        (folder / REPAIRS).write_text(json.dumps(broken))
        with pytest.raises(DamagedFileError, match="not a list of repairs"):
            read_repairs(folder)
    (folder / REPAIRS).unlink()
    assert read_repairs(folder) is None


@pytest.mark.parametrize("how", ["paper", "off", "no depth"])
def test_some_runs_are_not_repaired(folder, monkeypatch, how):
    (folder / REPAIRS).write_text("{}")
    before = (folder / "placements.json").read_bytes()
    chosen = with_settings(Parameters(), SETTINGS)
    if how == "paper":
        chosen = with_method(chosen, "paper")
    elif how == "off":
        chosen = with_settings(chosen, ["repair.enabled=no"])
    else:
        monkeypatch.setattr(module, "photos_for_repair", lambda *_: ())
    repair_run(folder, NO_SCAN, chosen)
    assert (folder / "placements.json").read_bytes() == before
    assert not (folder / REPAIRS).exists()


@pytest.mark.parametrize(("frames", "left"), [(40, 28), (16, 4), (15, 15), (3, 3)])
def test_photos_of_the_report_are_left_out_if_there_are_others(tmp_path, monkeypatch, frames, left):
    names = tuple(f"{n:03d}" for n in range(frames))
    asked = {}
    monkeypatch.setattr(
        module, "sample_photos", lambda scan, votes, **options: asked.update(options) or ()
    )
    scan = type("Frames", (), {"frames_used": names})()
    assert module.photos_for_repair(tmp_path, scan, 8) == ()  # type: ignore[arg-type]
    assert asked["count"] == 8 and frames - len(asked["without"]) == left
