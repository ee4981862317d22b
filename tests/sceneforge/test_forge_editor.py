"""The Python of SceneForge, through its public methods."""

import json

import numpy as np
import pytest

from world2minecraft.core.errors import ConflictError, UnknownNameError, UsageError
from world2minecraft.editing.scene import runs_of_cells
from world2minecraft.editing.scene.voxel_commands import SetCells
from world2minecraft.sceneforge.editor import Editor


@pytest.fixture(scope="module")
def labels():
    """A floor, a wall and a table of 0.8 by 0.6 m, 0.72 m high."""
    cells = np.zeros((30, 28, 20), np.uint8)
    cells[:, :, 0], cells[0] = 2, 3
    cells[10:20, 10:18, 9] = 8
    for x in (10, 19):
        for y in (10, 17):
            cells[x, y, 1:9] = 8
    return cells


@pytest.fixture
def source(tmp_path, labels):
    np.save(tmp_path / "den.npy", labels)
    return tmp_path / "den.npy"


@pytest.fixture
def editor(source):
    editor = Editor.open(source, clock=lambda: 1234.5)
    yield editor
    editor.close()


HOLE = [[1, 3], [21, 2]]  # Cells of the wall, z up first.


def test_objects_are_found_in_a_bare_grid(editor):
    (table,) = editor.draft.objects.values()
    assert table.class_id == 8 and table.placements
    assert editor.cells_of[table.id] == 112


def test_an_edit_is_done_undone_and_redone(editor, labels):
    operation = editor.do("set_cells", cells=HOLE, class_id=0, actor="tab 1")
    assert (operation.actor, operation.time_s, operation.counts_as) == ("tab 1", 1234.5, "delete")
    assert editor.draft.labels.ravel()[1:4].tolist() == [0, 0, 0]
    assert (editor.rev, editor.undo_kind, editor.redo_kind) == (1, "paint", "")
    editor.undo()
    assert np.array_equal(editor.draft.labels, labels)
    assert (editor.rev, editor.undo_kind, editor.redo_kind) == (2, "", "paint")
    editor.redo()
    assert editor.draft.labels.ravel()[1] == 0 and editor.rev == 3


def test_a_command_is_given_by_name_as_a_value_or_as_its_plan(editor):
    editor.do("set_cells", cells=[[1, 1]], class_id=0)
    editor.do(SetCells(cells=[(2, 1)], class_id=0))
    planned = editor.preview("set_cells", cells=[[3, 1]], class_id=0)
    assert editor.draft.labels.ravel()[3] == 3
    editor.do(planned)
    assert editor.draft.labels.ravel()[1:4].tolist() == [0, 0, 0]
    with pytest.raises(ConflictError, match="the labels of its cells has changed since"):
        editor.do(planned)
    assert editor.rev == 3


def test_each_step_is_told_in_order_with_what_was_done(editor):
    told = []
    stop = editor.on_change(lambda rev, step, op: told.append((rev, step, int(op.after.labels[0]))))
    editor.do("set_cells", cells=HOLE, class_id=0)
    editor.undo()
    editor.redo()
    stop()
    editor.undo()
    assert told == [(1, "do", 0), (2, "undo", 3), (3, "redo", 0)]


def test_cells_of_objects_are_counted_along(editor):
    table = next(iter(editor.draft.objects))
    some = runs_of_cells(editor.draft.cells_of(table)[:30], editor.draft.shape).tolist()
    editor.do("set_cells", cells=some, class_id=0)
    assert editor.cells_of[table] == len(editor.draft.cells_of(table)) == 82
    assert editor.scene_json()["objects"][0]["cells"] == 82
    editor.undo()
    assert editor.cells_of[table] == 112


def test_the_scene_is_what_the_page_expects(editor):
    scene = editor.scene_json()
    assert json.loads(json.dumps(scene, allow_nan=False)) == scene
    # The number of the document is the server's: it may show one after the other.
    assert list(scene) == [name for name in fields_of_wire("Scene") if name != "document"]
    assert list(scene["objects"][0]) == fields_of_wire("SceneObject")
    assert list(scene["objects"][0]["placements"][0]) == fields_of_wire("Placed")
    assert list(scene["classes"][0]) == fields_of_wire("ClassInfo")
    assert len(scene["classes"]) == len(scene["counts"]) == 12
    assert sum(scene["counts"]) == 30 * 28 * 20


def fields_of_wire(name):
    """The fields of an interface of wire.ts, in order."""
    import re
    from importlib.resources import files

    text = files("world2minecraft").joinpath("sceneforge/web/src/wire.ts").read_text()
    body = re.search(rf"export interface {name} {{\n(.*?)\n}}", text, re.DOTALL)
    return re.findall(r"^  (\w+):", body.group(1), re.MULTILINE)


def test_questions_are_asked_by_name(editor):
    assert editor.ask("counts") == {"cells": editor.draft.counts[:12].tolist(), "objects": 1}
    with pytest.raises(UnknownNameError, match="no query is named 'count'; did you mean 'counts'"):
        editor.ask("count")
    with pytest.raises(UsageError, match="^counts: cells: Extra inputs are not permitted, not 3$"):
        editor.ask("counts", cells=3)


def test_a_scene_knows_its_source(editor, source):
    assert editor.holds(source) and editor.holds(source.with_name("den.npy.forge"))
    assert not editor.holds(source.with_name("other.npy")) and not editor.holds(None)


def test_nothing_is_written_before_it_is_saved(editor, source):
    editor.do("set_cells", cells=HOLE, class_id=0)
    assert not (source.parent / "den").exists()
    folder = editor.save()
    assert folder == source.parent / "den" and editor.saved_rev == editor.rev == 1
    with pytest.raises(ConflictError, match="den: is being edited by process"):
        Editor.open(folder)  # A scene of its own, which is saved to the same folder.
    assert not source.with_name("den.forge").exists()
    editor.close()
    again = Editor.open(folder)
    assert np.array_equal(again.draft.labels, editor.draft.labels)
    assert again.draft.objects.keys() == editor.draft.objects.keys()
    again.close()
