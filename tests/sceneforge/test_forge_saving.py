"""What is saved is what the other verbs read; it is whole, and never over what is not ours."""

import json
import shutil

import numpy as np
import pytest
from forge_documents import Clock, edit, held, same_files, write_run
from forge_serving import small_editor
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.cli import run as w2m
from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.formats.occupancy_files import read_occupancy
from world2minecraft.formats.world_labels import read_scene
from world2minecraft.reconstruction.file_stages import build_stage
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.sceneforge.document import saving
from world2minecraft.sceneforge.document.memory_document import SavedMark
from world2minecraft.sceneforge.editor import Editor


@pytest.fixture
def run(tmp_path):
    return write_run(tmp_path / "den")


def test_five_files_are_saved_and_open_again_as_they_were(run):
    editor = Editor.open(run, clock=Clock())
    for number in range(9):
        edit(editor, number)
    assert editor.save() == run and editor.saved_rev == editor.rev == 9
    assert {path.name for path in run.iterdir()} == {*saving.SAVED_FILES, ".lock"}
    labels = editor.draft.labels
    assert np.array_equal(
        read_occupancy(run / "occ.json").labels, np.where(labels < 255, labels, 0)
    )
    centers = json.loads((run / "centers.json").read_text())["centers"]
    assert [one["id"] for one in centers] == sorted(editor.draft.objects)
    editor.close()
    fresh = Editor.open(run, out=run.with_name("other"))
    assert held(fresh)[:5] == held(editor)[:5]
    assert fresh.draft.objects.keys() == editor.draft.objects.keys()
    fresh.close()


def test_edits_are_in_what_build_makes_of_the_run(run, tmp_path):
    assert w2m(["build", str(run), "--out", str(tmp_path / "before")]) == 0
    assert (read_scene(tmp_path / "before" / "build").semantic == 8).any()
    editor = Editor.open(run)
    (table,) = editor.draft.objects
    editor.do("delete_objects", ids=[table])
    editor.save()
    editor.close()
    assert w2m(["build", str(run), "--out", str(tmp_path / "after")]) == 0
    build_stage(run, Parameters())  # What w2m reconstruct --from build runs.
    for built in (tmp_path / "after" / "build", run / "build"):
        semantic = read_scene(built).semantic
        assert semantic.any() and not (semantic == 8).any()
    assert json.loads((tmp_path / "after" / "placements.json").read_text()) == []


def test_a_save_elsewhere_takes_along_what_other_verbs_read(run, tmp_path):
    (run / "scan.json").write_text('{"room_size_m": [1, 1, 1]}\n')
    before = same_files(run)
    editor = Editor.open(run, out=tmp_path / "copy")
    edit(editor, 3)
    assert editor.save() == tmp_path / "copy"
    editor.close()
    assert same_files(run) == before
    assert same_files(tmp_path / "copy").keys() == {*saving.SAVED_FILES, "scan.json"}
    assert (tmp_path / "copy.forge").is_dir() and not run.with_name("den.forge").exists()


def test_a_file_of_someone_else_is_not_written_over(run):
    editor = Editor.open(run)
    edit(editor, 3)
    (run / "placements.json").write_text("[]\n")
    before = same_files(run)
    with pytest.raises(ConflictError) as refused:
        editor.save()
    reason = "was changed by another program; move it away, then save again"
    assert str(refused.value) == f"{run / 'placements.json'}: {reason}"
    assert same_files(run) == before and editor.saved_rev == 0
    (run / "placements.json").unlink()
    editor.save()
    assert editor.saved_rev == 1
    editor.close()


def test_saving_a_grid_does_not_overwrite_an_existing_file(tmp_path):
    np.save(tmp_path / "den.npy", np.full((6, 5, 4), 2, np.uint8))
    (tmp_path / "den").mkdir()
    (tmp_path / "den" / "room.npz").write_bytes(b"another room")
    editor = Editor.open(tmp_path / "den.npy")
    with pytest.raises(ConflictError, match="room.npz: was changed by another program"):
        editor.save()
    assert (tmp_path / "den" / "room.npz").read_bytes() == b"another room"
    editor.close()


@pytest.mark.parametrize("whole", range(3))
def test_an_interrupted_save_is_finished_on_opening(run, monkeypatch, whole):
    editor = Editor.open(run)
    edit(editor, 3)
    written, real = [], saving.write_bytes

    def full(path, data):
        if len(written) == whole and path.parent == run:
            raise OutputError(path, "cannot be written: No space left on device")
        written.append(path)
        real(path, data)

    with monkeypatch.context() as context:
        context.setattr(saving, "write_bytes", full)
        with pytest.raises(OutputError, match="No space left"):
            editor.save()
    assert editor.saved_rev == 0 and len(written) == whole
    editor.close()
    again = Editor.open(run)
    assert again.notes[0] == "An interrupted save was completed."
    assert again.saved_rev == again.rev == 1 and held(again) == held(editor)
    assert not (run.with_name("den.forge") / "saving").exists()
    again.close()
    twin = Editor.open(run, out=run.with_name("twin"))
    assert held(twin)[:5] == held(editor)[:5]
    twin.close()


def test_after_a_full_disk_it_is_saved_again(run, monkeypatch):
    editor = Editor.open(run)
    edit(editor, 3)
    real = saving.write_bytes

    def full(path, data):
        if path.name == "occ.json":
            raise OutputError(path, "cannot be written: No space left on device")
        real(path, data)

    with monkeypatch.context() as context:
        context.setattr(saving, "write_bytes", full)
        with pytest.raises(OutputError):
            editor.save()
        edit(editor, 4)
        with pytest.raises(OutputError):
            editor.save()
    edit(editor, 8)
    editor.save()
    assert editor.saved_rev == editor.rev == 3
    editor.close()


def test_opening_a_document_from_elsewhere_writes_nothing(run, tmp_path):
    editor = Editor.open(run)
    edit(editor, 3)
    editor.save()
    editor.close()
    forge = run.with_name("den.forge")
    victim = tmp_path / "victim"
    saved = json.loads((forge / "saved.json").read_text())
    (forge / "saving").mkdir()
    (forge / "saving" / "room.npz").write_bytes(b"x")
    files = {"room.npz": saving.sha256(forge / "saving" / "room.npz")}
    (forge / "saved.json").write_text(json.dumps(saved | {"pending": {"rev": 9, "files": files}}))
    told = json.loads((forge / "document.json").read_text())
    (forge / "document.json").write_text(json.dumps(told | {"target": "../victim/deep"}))
    moved = tmp_path / "down" / "den.forge"
    shutil.copytree(forge, moved)
    again = Editor.open(moved)
    again.close()
    assert not victim.exists()


def test_occ_json_opens_with_the_centres_beside_it(tmp_path):
    rows = [[x, y, 0, 2] for x in range(20) for y in range(16)]
    rows += [[x, y, 5, 8] for x in range(3, 10) for y in range(3, 8)]
    rows += [[x, 12, z, 5] for x in (14, 17) for z in range(1, 6)]
    (tmp_path / "occ.json").write_text(json.dumps(rows))
    centers = {"table": [[6, 5, 5]], "chair": [[14, 12, 3], [17, 12, 3]], "sofa": [[2, 2, 2]]}
    (tmp_path / "centers.json").write_text(json.dumps(centers))
    editor = Editor.open(tmp_path / "occ.json")
    counts = {n: (one.class_id, int(editor.cells_of[n])) for n, one in editor.draft.objects.items()}
    assert sorted(counts.values()) == [(5, 5), (5, 5), (7, 0), (8, 35)]
    table = next(one for one in editor.draft.objects.values() if one.class_id == 8)
    assert np.allclose(table.center_m, [0.52, 0.44, 0.44])
    editor.save()
    editor.close()
    assert (tmp_path / "room.npz").exists()
    again = Editor.open(tmp_path / "occ.json")
    assert again.notes == [] and again.saved_rev == again.rev
    again.close()


def test_names_of_objects_are_kept_and_changed(run):
    rows = json.loads((run / "objects.json").read_text())
    rows[0] |= {"name": "desk", "name_confidence": 0.75}
    (run / "objects.json").write_text(json.dumps(rows))
    editor = Editor.open(run, clock=Clock())
    number = rows[0]["id"]
    assert editor.draft.objects[number].name == "desk"
    edit(editor, 0)
    editor.save()
    assert _named(run) == ("desk", 0.75)
    editor.do("rename_objects", ids=[number], name="workbench")
    editor.save()
    editor.close()
    assert _named(run) == ("workbench", 1.0)


def _named(run) -> tuple[str, float]:
    row = json.loads((run / "objects.json").read_text())[0]
    return row["name"], row["name_confidence"]


@given(st.lists(st.sampled_from(["do", "undo", "redo", "save"]), max_size=40))
def test_a_scene_is_saved_where_undo_leads_back_to_it(steps):
    editor = small_editor()
    contents = editor.draft.labels.copy()
    number = 0
    for step in steps:
        if step == "do":
            number += 1
            editor.do("set_cells", cells=[[number, 1]], class_id=8)
        elif step == "save":
            editor.document.saved_mark = SavedMark()
            contents = editor.draft.labels.copy()
        elif editor.undo_kind if step == "undo" else editor.redo_kind:
            getattr(editor, step)()
        assert editor.is_saved == np.array_equal(editor.draft.labels, contents)


def test_recovered_edits_are_unsaved_until_they_are_saved(run):
    editor = Editor.open(run)
    edit(editor, 1)
    editor.close()
    again = Editor.open(run)
    assert not again.is_saved
    again.save()
    assert again.is_saved
    again.close()
