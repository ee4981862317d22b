"""What is asked of cells: floaters, holes, differences."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.editing.scene.cell_patch import cells_of_runs
from world2minecraft.editing.scene.difference import compare_labels, resample_labels
from world2minecraft.evaluation.metrics.occupancy import count_occupancy
from world2minecraft.formats.occupancy_files import labels_grid
from world2minecraft.sceneforge.editor import Editor

labels_of = st.integers(0, 10_000).map(
    lambda seed: np.random.default_rng(seed).choice([0, 2, 3, 5, 255], (4, 3, 5)).astype(np.uint8)
)


def room() -> np.ndarray:
    """A floor and a wall of 1.6 m each way, with a hole in each, and a floater."""
    labels = np.zeros((22, 22, 22), np.uint8)
    labels[1:21, 1:21, 0] = 2
    labels[0, 1:21, 1:21] = labels[21, 1:21, 1:21] = 3
    labels[1:21, 0, 1:21] = labels[1:21, 21, 1:21] = 3
    labels[8:10, 8:11, 0] = 0
    labels[10, 10, 10:12] = 11
    labels[14:18, 4:6, 1:7] = 10
    return labels


@pytest.fixture
def editor(tmp_path) -> Editor:
    np.save(tmp_path / "room.npy", room())
    opened = Editor.open(tmp_path / "room.npy", out=tmp_path)
    yield opened
    opened.close()


def cells(runs, shape) -> list[list[int]]:
    return cells_of_runs(runs, shape).tolist()


def test_floaters_are_listed_with_where_they_are(editor):
    (one,) = editor.ask("floaters")
    assert cells(one["runs"], editor.draft.shape) == [[10, 10, 10], [10, 10, 11]]
    assert (one["cells"], one["class_id"]) == (2, 11)
    assert one["at_m"] == [0.84, 0.84, 0.88]
    assert editor.ask("floaters", max_cells=1) == []


def test_holes_are_listed_by_plane_and_filled_by_its_name(editor):
    rows = {row["plane"]: row for row in editor.ask("holes")}
    assert list(rows) == ["floor", "wall:1", "wall:2", "wall:3", "wall:4"]
    floor = rows["floor"]
    assert floor["cells"] == 6 and floor["share"] == 0.015 and floor["class_id"] == 2
    assert floor["at_m"] == 0.04 and floor["area_m2"] == 2.56
    operation = editor.do("fill_holes", plane="floor")
    assert operation.cells.tolist() == cells(floor["runs"], editor.draft.shape)
    assert all(row["share"] == 0 for row in editor.ask("holes"))


def test_an_opening_is_told_apart(editor):
    editor.do("fill_box", low=[0, 5, 4], high=[0, 14, 14], class_id=0)
    wall = next(row for row in editor.ask("holes") if row["plane"] == "wall:1")
    assert wall["cells"] == 0 and len(cells(wall["openings"], editor.draft.shape)) == 110
    wall = next(row for row in editor.ask("holes", hole_m2=1.0) if row["plane"] == "wall:1")
    assert wall["cells"] == 110 and wall["openings"] == []


@given(labels_of, labels_of)
def test_a_difference_is_what_the_counts_of_occupancy_count(labels, other):
    found, counts = compare_labels(labels, other), count_occupancy(labels, other)
    assert found.added.sum() == counts.false_positives
    assert found.removed.sum() == counts.false_negatives
    right = np.diag(counts.table)[1:].sum()
    assert found.changed.sum() == counts.true_positives - right
    assert not (found.added & found.removed).any() and not (found.added & found.changed).any()


def test_the_scene_is_compared_with_what_was_opened(editor):
    assert editor.ask("compare")["iou"] == 1
    editor.do("fill_holes", plane="floor")
    editor.do("remove_floaters")
    editor.do("set_cells", cells=[[int(np.ravel_multi_index((14, 4, 1), (22, 22, 22))), 1]],
              class_id=5)  # fmt: skip
    answer = editor.ask("compare")
    assert answer["cells"] == {"added": 6, "removed": 2, "changed": 1}
    assert cells(answer["removed"], editor.draft.shape) == [[10, 10, 10], [10, 10, 11]]
    counts = count_occupancy(editor.draft.labels, room())
    assert answer["iou"] == round(counts.iou, 4) and answer["class_iou"]["objs"] == 0
    json.dumps(answer, allow_nan=False)


def test_filling_unseen_cells_differs_from_the_opened_scene(tmp_path):
    labels = room()
    labels[8:10, 8:11, 0] = 255
    np.save(tmp_path / "unseen.npy", labels)
    editor = Editor.open(tmp_path / "unseen.npy", out=tmp_path)
    editor.do("fill_holes", plane="floor")
    assert editor.ask("compare")["cells"] == {"added": 6, "removed": 0, "changed": 0}
    editor.close()


def test_the_scene_is_compared_with_a_finer_shifted_grid(editor, tmp_path):
    fine = np.repeat(np.repeat(np.repeat(room(), 2, 0), 2, 1), 2, 2)[:, :40]
    place = {"voxel_m": 0.04, "origin_m": np.zeros(3)}
    np.savez(tmp_path / "fine.npz", labels=fine, **place)
    answer = editor.ask("compare", path="fine.npz")
    assert answer["cells"] == {"added": 0, "removed": 0, "changed": 0} and answer["iou"] == 1


def test_only_generated_rooms_have_a_truth(editor):
    with pytest.raises(UsageError, match="only generated rooms have one"):
        editor.ask("compare", path="truth")


@given(labels_of, st.integers(-3, 3), st.integers(-2, 2))
def test_a_grid_of_the_same_cells_is_moved_by_whole_cells(labels, x, y):
    draft = SceneDraft(labels_grid(labels))
    moved = labels_grid(labels, origin_m=np.array([x, y, 0]) * 0.08)
    got = resample_labels(moved, draft)
    for cell in np.ndindex(labels.shape):
        there = (cell[0] - x, cell[1] - y, cell[2])
        inside = all(0 <= a < n for a, n in zip(there, labels.shape, strict=True))
        assert got[cell] == (labels[there] if inside else 255)


def test_what_cannot_be_compared_is_said(editor, tmp_path):
    np.savez(tmp_path / "coarse.npz", labels=room(), voxel_m=0.16)
    np.savez(tmp_path / "far.npz", labels=room(), origin_m=np.array([8.0, 0, 0]))
    said = {
        "coarse.npz": "the voxel size is 0.16 m, larger than the scene's 0.08 m; use a grid with "
        "voxels of that size or smaller",
        "far.npz": "the grid does not overlap this room; use a grid in the coordinate frame of "
        "the scene",
        "../out.npz": "'../out.npz' is outside the scene's folder; copy the file into it",
        "/etc/passwd": "'/etc/passwd' is outside the scene's folder; copy the file into it",
        "a\0.npz": "invalid file name 'a\\x00.npz'",
    }
    for path, text in said.items():
        with pytest.raises(UsageError) as refusal:
            editor.ask("compare", path=path)
        assert str(refusal.value) == text
    with pytest.raises(InputError, match="not found"):
        editor.ask("compare", path="none.npz")


def test_a_link_out_of_the_folder_is_not_followed(editor, tmp_path):
    try:
        (tmp_path / "link.npz").symlink_to(Path(__file__))
    except OSError:
        pytest.skip("links cannot be made here")
    with pytest.raises(UsageError, match="outside the scene's folder"):
        editor.ask("compare", path="link.npz")
