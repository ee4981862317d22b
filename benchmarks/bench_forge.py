"""The server of SceneForge: latency of an edit to a second tab, and loading of three scene sizes.

The server is ``w2m forge`` in a process of its own, with its journal on disk. The rival is the
format in which tools based on D3, such as the paper's, load voxels: a JSON list of the occupied
cells, [x, y, z, label] each, written and read in the same run.
"""

import gzip
import json
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import numpy as np
from websockets.sync.client import ClientConnection, connect

from benchmarks.rows import Row
from world2minecraft.formats.objects_and_placements import write_objects, write_placements
from world2minecraft.formats.occupancy_files import labels_grid
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.sceneforge.array_messages import HEADER

ROOM, HOUSE, BUILDING = (60, 60, 36), (240, 180, 36), (660, 600, 36)
FILLED = {ROOM: 1.0, HOUSE: 0.27, BUILDING: 0.273}  # 130 k, 421 k and 3.9 M occupied cells.
NAMES = {ROOM: "130 k", HOUSE: "421 k", BUILDING: "3.9 M"}
EDITS = 200
STROKE = 12  # Cells of an edit: those of a brush.
ARRAYS = ("labels", "instance", "confidence")  # What the page loads.


def run() -> list[Row]:
    """Measure; one server for each size."""
    rows = []
    for shape in (ROOM, HOUSE, BUILDING):
        labels = scene(shape)
        with tempfile.TemporaryDirectory() as folder, served(labels, Path(folder)) as link:
            rows += loading(link, labels)
            if shape != BUILDING:
                budget = 20.0 if shape == ROOM else None
                what = f"an edit reaches a second tab, {NAMES[shape]} cells, median"
                rows.append(Row(what, edit_ms(link), "ms", budget))
    return rows


def scene(shape: tuple[int, int, int]) -> np.ndarray:
    """Return labels uint8 of walls, floors and noisy pieces, as full as ``FILLED`` says."""
    rng = np.random.default_rng(0)
    labels = np.zeros(shape, np.uint8)
    blocks = rng.integers(3, 12, [-(-side // 12) for side in shape], np.uint8)
    pieces = np.kron(blocks, np.ones((12, 12, 12), np.uint8))[: shape[0], : shape[1], : shape[2]]
    kept = rng.random(shape) < FILLED[shape]
    labels[kept] = pieces[kept]
    return labels


@contextmanager
def served(labels: np.ndarray, folder: Path) -> Iterator[httpx.URL]:
    """Serve a scene from a run's folder, by the command line; yield its link."""
    write_room(folder / "room.npz", labels_grid(labels), np.eye(4))
    write_objects(folder / "objects.json", ())
    write_placements(folder / "placements.json", ())
    words = ["forge", str(folder), "--no-browser", "--port", "0"]
    command = [sys.executable, "-m", "world2minecraft", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout
        try:
            yield httpx.URL(re.findall(r"http://\S+", server.stdout.readline())[0])
        finally:
            server.terminate()


def edit_ms(link: httpx.URL) -> float:
    """Return the median from sending an edit to its change at another tab."""
    taken = []
    with tab(link) as one, tab(link) as other:
        for number in range(EDITS):
            fields = {"cells": [[40 + number % 7, STROKE]], "class_id": 5 + number % 2}
            command = {"op": "set_cells", **fields}
            text = json.dumps({"type": "do", "seq": number, "command": command})
            begun = time.perf_counter()
            one.send(text)
            other.recv()
            taken.append(time.perf_counter() - begun)
            one.recv(), one.recv()  # The change and that it is done.
    return round(statistics.median(taken) * 1000, 2)


@contextmanager
def tab(link: httpx.URL) -> Iterator[ClientConnection]:
    """Open a tab's websocket and read its hello."""
    headers = {"Authorization": f"Bearer {link.params['token']}"}
    with connect(f"ws://{link.host}:{link.port}/api/live", additional_headers=headers) as opened:
        opened.recv()
        yield opened


def loading(link: httpx.URL, labels: np.ndarray) -> list[Row]:
    """Measure what a page gets before it draws: scene and arrays, and labels beside JSON."""
    headers = {"Authorization": f"Bearer {link.params['token']}"}
    with httpx.Client(base_url=link.join("/"), headers=headers, timeout=120) as client:
        begun = time.perf_counter()
        client.get("/api/scene").json()
        for what in ARRAYS:
            volume(client, what)
        whole_s = time.perf_counter() - begun
        begun = time.perf_counter()
        held = volume(client, "labels")
        ours_s = time.perf_counter() - begun
    assert np.array_equal(held.reshape(labels.shape), labels)
    theirs_s, size = json_list(labels)
    name = NAMES[labels.shape]
    return [
        Row(f"scene and all its cells, {name}, first tab", round(whole_s, 3), "s"),
        Row(
            f"labels alone, {name}, next tab",
            round(ours_s, 4),
            "s",
            rival=f"JSON list of cells ({size / 1e6:.1f} MB, {theirs_s:.2f} s)",
            ratio=round(theirs_s / ours_s, 1),
        ),
    ]


def volume(client: httpx.Client, what: str) -> np.ndarray:
    """Return the values of one array of the scene."""
    data = client.get("/api/volume", params={"what": what}).content
    return np.frombuffer(data, np.uint16 if data[6] else np.uint8, offset=HEADER.size)


def json_list(labels: np.ndarray) -> tuple[float, int]:
    """Return the seconds to make, pack and read a JSON list of cells, and its bytes unpacked."""
    begun = time.perf_counter()
    at = np.argwhere(labels)
    rows = np.column_stack([at, labels[tuple(at.T)]]).tolist()
    text = json.dumps(rows, separators=(",", ":")).encode()
    json.loads(gzip.decompress(gzip.compress(text, 1)))
    return time.perf_counter() - begun, len(text)
