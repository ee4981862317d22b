"""The program's own files: what is written is read back, and damage is said in one line."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.types import (
    Alternative,
    FusedEvidence,
    ObjectInstance,
    OccupancyGrid,
    Placement,
    Scan,
)
from world2minecraft.formats.objects_and_placements import (
    read_objects,
    read_placements,
    write_objects,
    write_placements,
)
from world2minecraft.formats.occupancy_files import inner_corner_m, read_occupancy
from world2minecraft.formats.paper_json import read_occ_json, write_centers_json, write_occ_json
from world2minecraft.formats.run_arrays import (
    EVIDENCE_ARRAYS,
    GRID_ARRAYS,
    read_evidence,
    read_room,
    write_centers,
    write_evidence,
    write_room,
)
from world2minecraft.formats.scan_record import read_depth_kind, read_room_size, write_scan


def some_grid(seed: int = 0, shape=(6, 5, 4)) -> OccupancyGrid:
    random = np.random.default_rng(seed)
    labels = random.choice([0, 1, 2, 3, 5, 8, 11, 255], shape).astype(np.uint8)
    source = np.where(labels == 255, 0, random.integers(1, 3, shape)).astype(np.uint8)
    return OccupancyGrid(
        labels=labels,
        confidence=random.random(shape).astype(np.float16),
        colour=random.integers(0, 256, (*shape, 3)).astype(np.uint8),
        source=source,
        instance=np.where(labels == 8, 1, 0).astype(np.uint16),
        voxel_m=0.08,
        origin_m=np.array([-3, 2, -1]) * 0.08,
    )


def some_object(grid: OccupancyGrid) -> ObjectInstance:
    cells = np.argwhere(grid.instance == 1).astype(np.int32)
    return ObjectInstance(1, 8, [0.1, 0.2, 0.3], [1.0, 0.8, 0.72], 90.0, cells, 0.75)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10_000))
def test_room_round_trip(tmp_path_factory, seed):
    path = tmp_path_factory.mktemp("room") / "room.npz"
    grid, pose = some_grid(seed), np.diag([-1.0, -1, 1, 1])
    write_room(path, grid, pose)
    again, scan_to_room = read_room(path)
    for name in GRID_ARRAYS:
        assert np.array_equal(getattr(grid, name), getattr(again, name)), name
    assert np.array_equal(scan_to_room, pose)
    first = path.read_bytes()
    write_room(path, grid, pose)
    assert path.read_bytes() == first


def test_evidence_round_trip(tmp_path):
    random = np.random.default_rng(1)
    shape = (4, 3, 2)
    evidence = FusedEvidence(
        log_odds=random.normal(0, 2, shape).astype(np.float16),
        votes=random.random((*shape, 12)).astype(np.float16),
        colour_sum=random.random((*shape, 3)).astype(np.float32),
        offset_sum=random.random((*shape, 3)).astype(np.float32),
        hits=random.integers(0, 9, shape).astype(np.uint16),
        voxel_m=0.04,
        origin_m=np.array([0.04, 0, -0.08]),
        scan_to_room=np.eye(4),
    )
    write_evidence(tmp_path / "e.npz", evidence)
    again = read_evidence(tmp_path / "e.npz")
    for name in EVIDENCE_ARRAYS:
        assert np.array_equal(getattr(evidence, name), getattr(again, name)), name


def test_objects_and_placements_round_trip(tmp_path):
    grid = some_grid()
    write_objects(tmp_path / "o.json", (some_object(grid),))
    (again,) = read_objects(tmp_path / "o.json", grid)
    assert np.array_equal(again.cells, some_object(grid).cells)
    assert (again.class_id, again.yaw_deg, again.confidence) == (8, 90.0, 0.75)
    placement = Placement(
        1, 8, "desk", [1, 2, 0.36], [0.6, 1.2, 0.72], 3, 0.51, {"depth": 0.1},
        (Alternative("table", 1, 0.4),),
    )  # fmt: skip
    write_placements(tmp_path / "p.json", (placement,))
    (back,) = read_placements(tmp_path / "p.json")
    assert back.template == "desk" and back.quarter_turns == 3 and back.iou == 0.51
    assert dict(back.parameters) == {"depth": 0.1}
    assert back.alternatives == (Alternative("table", 1, 0.4),)
    assert np.array_equal(back.size_m, [0.6, 1.2, 0.72])


def test_the_papers_two_files(tmp_path):
    grid = some_grid()
    write_occ_json(tmp_path / "occ.json", grid)
    value = json.loads((tmp_path / "occ.json").read_text())
    assert value["shape"] == [6, 5, 4] and value["classes"][8] == "table"
    again = read_occ_json(tmp_path / "occ.json")
    assert np.array_equal(again.occupied, grid.occupied)
    assert np.array_equal(again.labels[again.occupied], grid.labels[grid.occupied])
    assert np.allclose(again.origin_m, grid.origin_m)
    write_centers_json(tmp_path / "centers.json", (some_object(grid),))
    (row,) = json.loads((tmp_path / "centers.json").read_text())["centers"]
    assert row["class"] == "table" and row["position_m"] == [0.1, 0.2, 0.3]


def test_scan_and_centres(tmp_path):
    scan = Scan([], np.eye(4), np.array([3.2, 4.0, 2.5]), ("a",), (("b", "lost"),), notes=("n",))
    write_scan(tmp_path / "scan.json", scan)
    assert read_room_size(tmp_path / "scan.json").tolist() == [3.2, 4.0, 2.5]
    assert read_depth_kind(tmp_path / "scan.json") == "sensor"
    assert read_depth_kind(tmp_path / "none.json") == "sensor"
    write_scan(tmp_path / "scan.json", replace(scan, depth_kind="stereo"))
    assert read_depth_kind(tmp_path / "scan.json") == "stereo"
    assert json.loads((tmp_path / "scan.json").read_text())["frames_skipped"] == [
        {"frame": "b", "reason": "lost"}
    ]
    write_centers(tmp_path / "c.npz", np.ones((2, 2, 2)), np.zeros((3, 3)), np.zeros(3))
    with np.load(tmp_path / "c.npz", allow_pickle=False) as held:
        assert held["candidates"].dtype == np.int32 and held["density"].dtype == np.float32


def test_any_occupancy_file_is_read(tmp_path):
    grid = some_grid()
    write_room(tmp_path / "room.npz", grid, np.eye(4))
    assert np.array_equal(read_occupancy(tmp_path / "room.npz").labels, grid.labels)
    np.save(tmp_path / "labels.npy", grid.labels.astype(np.int64))
    assert np.array_equal(read_occupancy(tmp_path / "labels.npy").labels, grid.labels)
    np.savez(tmp_path / "bare.npz", labels=grid.labels, voxel_m=0.1)
    bare = read_occupancy(tmp_path / "bare.npz")
    assert bare.voxel_m == 0.1 and np.array_equal(bare.source == 0, grid.labels == 255)


def test_the_inner_corner_is_the_inner_face_of_the_walls(tmp_path):
    labels = np.zeros((20, 16, 8), np.uint8)
    labels[2], labels[-2], labels[:, 3], labels[:, -4] = 3, 3, 3, 3
    np.savez(tmp_path / "g.npz", labels=labels, voxel_m=0.1, origin_m=[-0.3, 0.2, 0.0])
    corner = inner_corner_m(read_occupancy(tmp_path / "g.npz"))
    assert np.allclose(corner, [-0.3 + 0.3, 0.2 + 1.2])


@pytest.mark.parametrize(
    ("name", "content", "error", "text"),
    [
        ("room.npz", None, InputError, "not found"),
        ("room.npz", b"PK\x03\x04 damaged", DamagedFileError, "is not a readable .npz"),
        ("labels.npy", b"\x93NUMPY\x01\x00", DamagedFileError, "is not a readable .npy"),
        ("room.txt", b"hello", InputError, "is not an occupancy file; expected the suffix .npz"),
        ("occ.json", b"{", DamagedFileError, "is not JSON"),
        ("occ.json", b"[]", DamagedFileError, "is not an occ.json file"),
        (
            "occ.json",
            b'{"shape":[9999,9999,9999],"voxels":[],"voxel_m":1,"origin_m":[0,0,0]}',
            LimitError,
            "exceeds the limit of 200,000,000 cells",
        ),
        (
            "occ.json",
            b'{"shape":[2,2,2],"voxels":[[0,0,5,1]],"voxel_m":1,"origin_m":[0,0,0]}',
            DamagedFileError,
            "a voxel is outside the shape",
        ),
    ],
)
def test_damage_is_named(tmp_path, name, content, error, text):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(error, match=text) as caught:
        read_occupancy(path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize(
    "wrong", [{"voxel_m": np.ones(2)}, {"voxel_m": "x"}, {"origin_m": ["a", "b", "c"]}]
)
def test_a_cell_size_that_is_no_number_is_damage(tmp_path, wrong):
    np.savez(tmp_path / "a.npz", labels=np.zeros((2, 2, 2), np.uint8), **wrong)
    with pytest.raises(DamagedFileError, match="contains an invalid voxel_m or origin_m"):
        read_occupancy(tmp_path / "a.npz")


def test_arrays_of_objects_and_lying_headers_are_refused(tmp_path):
    np.save(tmp_path / "o.npy", np.array([{"a": 1}], object), allow_pickle=True)
    with pytest.raises(DamagedFileError, match="contains less"):
        read_occupancy(tmp_path / "o.npy")
    whole = tmp_path / "labels.npy"
    np.save(whole, np.zeros((4, 4, 4), np.uint8))
    whole.write_bytes(whole.read_bytes().replace(b"(4, 4, 4)", b"(9, 9, 9)"))
    with pytest.raises(DamagedFileError, match=r"declares \(9, 9, 9\) uint8 but contains less"):
        read_occupancy(whole)


@pytest.mark.parametrize("text", ['{"a":1}', '[{"id":1}]', '[{"id":"x"}]', "[5]"])
def test_rows_that_are_no_objects(tmp_path, text):
    (tmp_path / "o.json").write_text(text)
    with pytest.raises(DamagedFileError):
        read_objects(tmp_path / "o.json", some_grid())
    with pytest.raises(DamagedFileError):
        read_placements(tmp_path / "o.json")


@pytest.mark.parametrize("by", ["floor", "ceiling", 2, ""])
def test_objects_keep_their_supports(tmp_path, by):
    grid = some_grid()
    write_objects(tmp_path / "o.json", (replace(some_object(grid), supported_by=by),))
    assert read_objects(tmp_path / "o.json", grid)[0].supported_by == by


@pytest.mark.parametrize("by", ["sky", 1, 0, True, 1.5, []])
def test_supports_are_other_objects_or_structure(by):
    with pytest.raises(ValueError, match="supported_by must be another object's id or floor"):
        replace(some_object(some_grid()), supported_by=by)


def test_placements_say_what_their_templates_show(tmp_path):
    box = ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], 0, 0.5)
    placed = tuple(Placement(1, 10, name, *box) for name in ("fridge_double", "cells", "own_thing"))
    for named, names in ((True, ["refrigerator", None, None]), (False, [None] * 3)):
        write_placements(tmp_path / "p.json", placed, named=named)
        rows = json.loads((tmp_path / "p.json").read_text())
        assert [row.get("name") for row in rows] == names
        assert [one.template for one in read_placements(tmp_path / "p.json")] == [
            one.template for one in placed
        ]
