"""occ.json and centers.json of any make; the paper gives no schema, so the likely ones are read."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.formats.occupancy_files import CELLS, METRES, read_any_centers, read_any_occ
from world2minecraft.formats.paper_json import _lines, write_occ_json

CELLS_OF = [[0, 0, 0, 2], [1, 0, 0, 2], [1, 2, 3, 5], [4, 1, 0, 11]]
NAMED = [[x, y, z, CLASS_NAMES[c]] for x, y, z, c in CELLS_OF]
METRES_OF = [[0.04 + 0.08 * x, 0.04 + 0.08 * y, 0.04 + 0.08 * z, c] for x, y, z, c in CELLS_OF]
FORMS = {
    "rows": CELLS_OF,
    "rows with names": NAMED,
    "under voxels": {"voxels": CELLS_OF},
    "under data": {"data": NAMED, "voxel_size": 0.08},
    "records": [{"x": x, "y": y, "z": z, "class": c} for x, y, z, c in CELLS_OF],
    "records with labels": {
        "occupancy": [{"position": [x, y, z], "label": str(c)} for x, y, z, c in CELLS_OF]
    },
    "records of points": [
        {"position": dict(zip("xyz", row[:3], strict=True)), "category": row[3]} for row in NAMED
    ],
    "two lists": {"coords": [row[:3] for row in CELLS_OF], "labels": [row[3] for row in CELLS_OF]},
    "points and labels": {
        "points": [row[:3] for row in CELLS_OF],
        "labels": [row[3] for row in CELLS_OF],
    },
    "by class name": {
        name: [row[:3] for row in NAMED if row[3] == name] for name in {row[3] for row in NAMED}
    },
    "by class number": {
        "voxels": {str(c): [row[:3] for row in CELLS_OF if row[3] == c] for c in (2, 5, 11)}
    },
    "metres": METRES_OF,
    "metres in records": [{"x": x, "y": y, "z": z, "class_id": c} for x, y, z, c in METRES_OF],
}


def wanted():
    labels = np.zeros((5, 3, 4), np.uint8)
    for x, y, z, c in CELLS_OF:
        labels[x, y, z] = c
    return labels


def put(folder, value, name="occ.json"):
    (folder / name).write_text(json.dumps(value))
    return folder / name


@pytest.mark.parametrize("form", FORMS)
def test_a_form_is_read(tmp_path, form):
    grid, unit = read_any_occ(put(tmp_path, FORMS[form]))
    assert np.array_equal(grid.labels, wanted())
    assert grid.voxel_m == pytest.approx(0.08) and not grid.origin_m.any()
    assert unit == (METRES if form.startswith("metres") else CELLS)


def test_a_class_for_each_cell_is_read(tmp_path):
    told = {"grid": wanted().tolist(), "voxel_m": 0.05, "origin": [0.5, 0, -0.25]}
    grid, _ = read_any_occ(put(tmp_path, told))
    assert np.array_equal(grid.labels, wanted())
    assert grid.voxel_m == 0.05 and grid.origin_m.tolist() == pytest.approx([0.5, 0, -0.25])


def test_shape_pads_the_grid_and_negative_cells_move_the_origin(tmp_path):
    grid, _ = read_any_occ(put(tmp_path, {"voxels": CELLS_OF, "shape": [9, 9, 9]}))
    assert grid.shape == (9, 9, 9)
    moved = [[x - 2, y, z, c] for x, y, z, c in CELLS_OF]
    grid, _ = read_any_occ(put(tmp_path, moved))
    assert np.array_equal(grid.labels, wanted())
    assert grid.origin_m.tolist() == pytest.approx([-0.16, 0, 0])


def test_our_own_form_is_read_as_ever(tmp_path):
    grid, _ = read_any_occ(put(tmp_path, CELLS_OF))
    write_occ_json(tmp_path / "ours.json", grid)
    assert np.array_equal(read_any_occ(tmp_path / "ours.json")[0].labels, grid.labels)


CENTERS = {
    "rows": [[1, 2, 3, 5], [4, 1, 0, "objs"]],
    "records": [{"x": 1, "y": 2, "z": 3, "class": "chair"}, {"x": 4, "y": 1, "z": 0, "class": 11}],
    "under centers": {
        "centers": [{"center": [1, 2, 3], "label": 5}, {"center": [4, 1, 0], "label": 11}]
    },
    "by class": {"chair": [[1, 2, 3]], "objs": [[4, 1, 0]]},
    "ours": {
        "format": "world2minecraft/centers",
        "version": 1,
        "centers": [
            {"id": 1, "class": "chair", "class_id": 5, "position_m": [0.12, 0.2, 0.28]},
            {"id": 2, "class": "objs", "class_id": 11, "position_m": [0.36, 0.12, 0.04]},
        ],
    },
}  # fmt: skip


@pytest.mark.parametrize("form", CENTERS)
def test_centres_are_read_in_the_unit_of_the_voxels(tmp_path, form):
    grid, unit = read_any_occ(put(tmp_path, CELLS_OF))
    found = read_any_centers(put(tmp_path, CENTERS[form], "centers.json"), grid, unit)
    assert [one.class_id for one in found] == [5, 11]
    assert np.allclose([one.position_m for one in found], [[0.12, 0.2, 0.28], [0.36, 0.12, 0.04]])


def test_centres_in_metres_are_taken_as_they_are(tmp_path):
    grid, unit = read_any_occ(put(tmp_path, METRES_OF))
    path = put(tmp_path, [[0.12, 0.2, 0.28, 5]], "centers.json")
    assert np.allclose(read_any_centers(path, grid, unit)[0].position_m, [0.12, 0.2, 0.28])


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ([], "neither voxels nor a shape found"),
        ({"voxels": [[0, 0, 0, 12]]}, "12 is not a class; expected 0 to 11, 255 or a class name"),
        ({"voxels": [[0, 0, 0, "sofas"]]}, "'sofas' is not a class; expected 0 to 11, 255"),
        ([[0, 0, 0]], "expected x, y, z and a class, got [0, 0, 0]"),
        ([[0, None, 0, 2]], "float() argument must be"),
        ([[0, "nan", 0, 2]], "a position is not a number"),
        ({"voxels": [[0, 0, 0, 2], [0.5, 0, 0, 2]], "voxel_m": -1}, "must be above 0, got -1"),
        (7, "expected a list of positions"),
        ({"coords": [[0, 0, 0]], "labels": [1, 2]}, "1 positions but 2 classes"),
    ],
)
def test_what_has_no_known_form_is_told(tmp_path, value, reason):
    with pytest.raises(
        DamagedFileError, match="does not contain voxels in a supported form"
    ) as refused:
        read_any_occ(put(tmp_path, value))
    assert reason in str(refused.value)


def test_a_far_voxel_takes_no_memory(tmp_path):
    with pytest.raises(LimitError, match="the limit is 200,000,000 cells"):
        read_any_occ(put(tmp_path, [[0, 0, 0, 2], [10**6, 10**6, 10**6, 2]]))


values = st.recursive(
    st.none() | st.integers(-5, 40) | st.floats(-9, 9) | st.sampled_from(CLASS_NAMES),
    lambda inner: st.lists(inner, max_size=4)
    | st.dictionaries(
        st.sampled_from(["x", "y", "z", "class", "voxels", "points", "shape", "voxel_m"]), inner
    ),
    max_leaves=12,
)  # fmt: skip


@given(values)
def test_whatever_is_given_is_read_or_told(tmp_path_factory, value):
    path = put(tmp_path_factory.mktemp("occ"), value)
    try:
        grid, _ = read_any_occ(path)
    except (DamagedFileError, LimitError):
        return
    assert grid.labels.size


@given(st.integers(1, 12345), st.integers(1, 40), st.integers(0, 99))
def test_rows_are_written_as_plain_text(most, count, seed):
    rows = np.random.default_rng(seed).integers(0, most, (count, 4))
    assert _lines(rows) == "".join(f"[{x},{y},{z},{c}],\n" for x, y, z, c in rows.tolist())
