"""Objects through the editor, with the stages behind it: commands that match, and questions."""

import numpy as np
import pytest

from world2minecraft.core.errors import UsageError
from world2minecraft.furniture import template, template_cells
from world2minecraft.furniture.layout_checks import floaters
from world2minecraft.sceneforge.editor import Editor


@pytest.fixture
def editor(tmp_path):
    """A room with a chair, a double bed at the wall x = 0.64 m, and a box in the air."""
    labels = np.zeros((60, 60, 32), np.uint8)
    labels[:, :, 0], labels[7] = 2, 3
    for name, at, turns in (("chair", (40, 40, 1), 3), ("double_bed", (8, 14, 1), 0)):
        one = template(name)
        labels[tuple(template_cells(one, one.typical_m, None, turns, at).T)] = one.class_id
    labels[50:54, 10:14, 20:24] = 11
    np.save(tmp_path / "room.npy", labels)
    editor = Editor.open(tmp_path / "room.npy")
    yield editor
    editor.close()


def the(editor, class_id):
    """The only object of a class."""
    (one,) = [one for one in editor.draft.objects.values() if one.class_id == class_id]
    return one


def test_the_best_furniture_is_offered_first_with_its_iou(editor):
    rows = editor.ask("alternatives", id=the(editor, 6).id)
    assert 2 <= len(rows) <= 5 and rows[0]["template"] == "double_bed"
    assert rows[0]["quarter_turns"] == 0 and rows[0]["iou"] > 0.9
    assert [row["iou"] for row in rows[1:]] == sorted((r["iou"] for r in rows[1:]), reverse=True)
    with pytest.raises(UsageError, match="object 99 not found; objects: 1, 2, 3"):
        editor.ask("alternatives", id=99)


def test_an_offer_is_taken_by_a_command(editor):
    bed = the(editor, 6)
    for row in editor.ask("alternatives", id=bed.id)[1:]:
        editor.do("set_template", id=bed.id, template=row["template"])
        assert the(editor, 6).placements[0].template == row["template"]
        assert the(editor, 6).placements[0].iou == pytest.approx(row["iou"], abs=0.05)
        editor.undo()
    assert the(editor, 6).placements[0].template == "double_bed"


def test_turning_furniture_measures_its_fit_again(editor):
    bed = the(editor, 6)
    fits = [bed.placements[0].iou]
    for _ in range(4):
        editor.do("turn_objects", ids=[bed.id], quarter_turns=1)
        fits.append(the(editor, 6).placements[0].iou)
    assert fits[0] == fits[4] > 0.9 and fits[1] < 0.8
    editor.undo()
    assert the(editor, 6).placements[0].iou == fits[3]


def test_centers_are_previewed_and_change_nothing(editor):
    figures = {"density_kernel": 3, "density_threshold": 0.2, "cluster_radius": 2}
    rows = editor.ask("centers", **figures)
    assert sorted(row["class_id"] for row in rows) == [5, 6, 11] and editor.rev == 0
    (chair,) = [row for row in rows if row["class_id"] == 5]
    assert np.abs(np.array(chair["at_m"]) - the(editor, 5).center_m)[:2].max() < 0.15
    assert [row["class_id"] for row in editor.ask("centers", class_id=6, **figures)] == [6]
    assert editor.ask("centers", **figures | {"density_threshold": 1.0, "density_kernel": 9}) == []
    with pytest.raises(UsageError, match="density_kernel must be odd"):
        editor.ask("centers", **figures | {"density_kernel": 4})


def test_detecting_again_by_default_keeps_object_ids(editor):
    before = {n: len(editor.draft.cells_of(n)) for n in editor.draft.objects}
    figures = {"density_kernel": 3, "density_threshold": 0.2, "cluster_radius": 2}
    editor.do("recluster", **figures)
    assert {n: len(editor.draft.cells_of(n)) for n in editor.draft.objects} == before


def test_what_collides_is_told(editor):
    assert editor.ask("warnings") == []
    bed = the(editor, 6)
    editor.do("add_object", class_id=8, at_m=[*bed.center_m[:2], 2.0], template="coffee_table")
    table = the(editor, 8)
    editor.do("move_object", id=table.id, to_m=[*bed.center_m[:2], bed.center_m[2] - 0.2])
    (row,) = editor.ask("warnings")
    assert row["kind"] == "collision" and sorted(row["ids"]) == sorted([bed.id, table.id])


def test_what_hangs_in_the_air_is_the_most_doubtful_place(editor):
    rows = editor.ask("doubtful")
    assert rows[0]["kind"] == "floater" and rows[0]["object_id"] == the(editor, 11).id
    assert rows[0]["why"] == "64 object cells floating in the air"
    assert np.abs(np.array(rows[0]["at_m"]) - the(editor, 11).center_m)[:2].max() < 0.1
    assert [row["doubt"] for row in rows] == sorted((r["doubt"] for r in rows), reverse=True)
    editor.do("delete_objects", ids=[the(editor, 11).id])
    assert floaters(editor.draft.labels).parts == 0
    assert all(row["kind"] != "floater" for row in editor.ask("doubtful"))


def test_a_chair_and_its_turned_copy_are_split_and_merged(editor):
    chair = the(editor, 5)
    cells = len(editor.draft.cells_of(chair.id))
    editor.do("split_object", id=chair.id, plane={"axis": "z", "at_m": 0.5})
    parts = [one.id for one in editor.draft.objects.values() if one.class_id == 5]
    assert len(parts) == 2
    editor.do("merge_objects", ids=parts)
    merged = the(editor, 5)
    assert len(editor.draft.cells_of(merged.id)) == cells
    assert merged.placements[0].template == chair.placements[0].template
    assert merged.yaw_deg == chair.yaw_deg == 270


def test_a_relabelled_object_gets_furniture_of_its_class(editor):
    bed = the(editor, 6)
    editor.do("relabel_objects", ids=[bed.id], class_id=7)
    sofa = the(editor, 7)
    assert sofa.id == bed.id and {p.class_id for p in sofa.placements} == {7}
    editor.do("rematch", ids=[sofa.id])
    assert the(editor, 7).placements
