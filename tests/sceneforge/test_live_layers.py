"""The layers of a running reconstruction, and the routes that serve them."""

import itertools
import json
import os
import shutil
import struct
import time

import numpy as np
import pytest
from forge_serving import client, served
from scipy.spatial import cKDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError
from world2minecraft.formats.run_arrays import read_evidence, read_room
from world2minecraft.sceneforge.live_layers import (
    STAGES,
    WALL_HEIGHT_M,
    finished_layers,
    layer_bytes,
)


def unpack(data: bytes, magic: bytes = b"W2ML") -> tuple[dict, dict[str, np.ndarray]]:
    """Read a packet as the page does."""
    assert data[:4] == magic
    (size,) = struct.unpack_from("<I", data, 4)
    header = json.loads(data[8 : 8 + size])
    arrays = {
        name: np.frombuffer(
            data, row["dtype"], int(np.prod(row["shape"])), 8 + size + row["offset"]
        ).reshape(row["shape"])
        for name, row in header.pop("arrays").items()
    }
    return header, arrays


def test_layers_appear_with_the_stages_of_this_run(small_run, tmp_path):
    run = tmp_path / "OUT"
    assert finished_layers(run, 0) == []
    shutil.copytree(small_run, run)
    manifest = json.loads((run / "manifest.json").read_text())
    shown = []
    for count in range(len(manifest["finished"]) + 1):
        done = {**manifest, "finished": manifest["finished"][:count]}
        (run / "manifest.json").write_text(json.dumps(done))
        shown.append(finished_layers(run, 0))
    assert shown[0] == [] and shown[-1] == list(STAGES)
    assert all(set(one) <= set(other) for one, other in itertools.pairwise(shown))
    os.utime(run / "manifest.json", (1000, 1000))
    assert finished_layers(run, time.time()) == []
    (run / "manifest.json").write_text("[]")
    assert finished_layers(run, 0) == []


def test_cameras_are_the_poses_of_the_frames_in_the_room(small_run):
    _, arrays = unpack(layer_bytes(small_run, "cameras"))
    rays, size = arrays["rays"], json.loads((small_run / "scan.json").read_text())["room_size_m"]
    assert len(rays) > 3
    assert np.allclose(np.linalg.norm(rays[:, 3:], axis=1), 1, atol=0.01)
    assert (rays[:, :3] > -0.3).all() and (rays[:, :3] < np.array(size) + 0.3).all()


def test_points_lie_in_the_cells_that_were_hit(small_run):
    _, arrays = unpack(layer_bytes(small_run, "points"))
    evidence = read_evidence(small_run / "evidence.npz")
    hit = np.argwhere((evidence.hits > 0) & (evidence.log_odds > 0))
    tree = cKDTree(evidence.origin_m + (hit + 0.5) * evidence.voxel_m)
    away, _ = tree.query(arrays["position"], p=np.inf)
    assert len(arrays["position"]) == len(hit) and away.max() < 0.75 * evidence.voxel_m
    assert arrays["colour"].shape == arrays["position"].shape


def test_cells_show_the_inside_and_omit_what_is_hidden(small_run):
    header, arrays = unpack(layer_bytes(small_run, "cells"))
    grid, _ = read_room(small_run / "room.npz")
    assert header["voxel_m"] == grid.voxel_m
    cells = np.floor((arrays["position"] - grid.origin_m) / grid.voxel_m).astype(int)
    assert np.array_equal(grid.labels[tuple(cells.T)], arrays["label"][:, 0])
    walls = np.isin(arrays["label"][:, 0], (SemanticClass.WALL, SemanticClass.WINDOW))
    assert not (arrays["label"] == SemanticClass.CEILING).any()
    assert arrays["position"][walls, 2].max() < WALL_HEIGHT_M + 1e-6
    shown = {tuple(cell) for cell in cells}
    for cell in np.argwhere(grid.occupied):  # A slow reference of what must be shown.
        label = grid.labels[tuple(cell)]
        height = grid.origin_m[2] + (cell[2] + 0.5) * grid.voxel_m
        cut = label in (SemanticClass.WALL, SemanticClass.WINDOW) and height > WALL_HEIGHT_M
        if label == SemanticClass.CEILING or cut:
            assert tuple(cell) not in shown
        elif tuple(cell) not in shown:
            around = [cell + side * step for side in np.eye(3, dtype=int) for step in (-1, 1)]
            assert all(grid.occupied[tuple(other)] for other in around)


def test_things_have_names_and_boxes(small_run):
    header, _ = unpack(layer_bytes(small_run, "things"))
    rows = json.loads((small_run / "objects.json").read_text())
    assert [one["name"] for one in header["things"]] == [one["name"] for one in rows]
    assert all(len(one["size_m"]) == 3 for one in header["things"])


def test_blocks_are_a_mesh_of_the_build(small_run):
    header, arrays = unpack(layer_bytes(small_run, "blocks"), b"W2MB")
    assert header["blocks"] > 100 and len(arrays["position"]) == 4 * len(arrays["state"])


def test_unknown_and_unfinished_layers_say_so(tmp_path):
    with pytest.raises(UnknownNameError, match="layer"):
        layer_bytes(tmp_path, "../room")
    for layer in STAGES:
        with pytest.raises(InputError):
            layer_bytes(tmp_path, layer)


def test_damaged_files_of_a_run_are_no_layers(tmp_path):
    (tmp_path / "manifest.json").write_text('{"finished": 5}')
    assert finished_layers(tmp_path, 0.0) == []
    for text in ("[]", '{"cameras": [[1, 2]]}', '{"cameras": "x"}'):
        (tmp_path / "scan.json").write_text(text)
        with pytest.raises(DamagedFileError, match="invalid cameras"):
            layer_bytes(tmp_path, "cameras")


def test_the_page_is_served_the_layers_of_a_job(small_run, tmp_path):
    with served(home=tmp_path / "home") as server, client(server) as script:
        job = server.session.jobs.start("den", lambda report: None)
        server.workspace.note_job(job, "demo/den", small_run)
        assert script.get(f"/api/start/jobs/{job}/layers").json() == []  # It is older.
        later = time.time() + 1  # The clock of files lags that of time by milliseconds.
        os.utime(small_run / "manifest.json", (later, later))
        assert script.get(f"/api/start/jobs/{job}/layers").json() == list(STAGES)
        answer = script.get(f"/api/start/jobs/{job}/layers/things")
        assert unpack(answer.content)[0]["things"]
        assert script.get(f"/api/start/jobs/{job}/layers/other").status_code == 400
        unknown = script.get("/api/start/jobs/none/layers")
        assert unknown.status_code == 400 and "none" in unknown.json()["error"]
