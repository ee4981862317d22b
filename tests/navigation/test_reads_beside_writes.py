"""Readers beside a command that writes: 50 reads of each kind of folder, and never a mixture."""

import hashlib
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest

import world2minecraft as w2m
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.errors import InputError
from world2minecraft.evaluation.scoring import read_truth
from world2minecraft.minecraft.worlds.world_reader import read_world
from world2minecraft.minecraftocc.store import open_store
from world2minecraft.navigation.data.rewording import read_set
from world2minecraft.procgen import scan_room

READS = 50
BEGIN = """
import shutil, sys, threading
from pathlib import Path
import world2minecraft as w2m
from world2minecraft.api.generation import save_room
from world2minecraft.api.navigation import reword_navigation_set
from world2minecraft.core import precompile
from world2minecraft.procgen import scan_room
precompile.needs_compiling = lambda work: False
ended = threading.Event()
threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
one, other, out = map(Path, sys.argv[1:])
"""
LOOP = """
    if not number:
        print("begun", flush=True)
    number += 1
"""
WRITERS = {
    "run": "w2m.build((one, other)[number % 2], out)",
    "world": "w2m.convert((one, other)[number % 2], out, force=True)",
    "world edit": (
        "w2m.undo_build(out) if number % 2 else w2m.build_into_world(one, out, at=(0, 70, 0), "
        "new_chunks=True)"
    ),
    "generated room": "save_room(w2m.load((one, other)[number % 2]), out); ended.wait(0.3)",
    "new capture": (
        "room = w2m.load(one); number and shutil.move(out, out.with_name(str(number))); "
        "scan_room(room, out, sensor='photos', frames=4, width=320, height=240); ended.wait(0.3)"
    ),
    "capture": (
        "scan_room(w2m.load((one, other)[number % 2]), out, frames=1, width=32, height=24); "
        "ended.wait(0.3)"
    ),
    "data set": ("w2m.import_dataset(one, out / str(number)) if number < 30 else ended.wait(0.1)"),
    "navigation set": "reword_navigation_set(out, **({'plain': True} if number % 2 else "
    "{'annotations': one}))",
}


def start(kind, one, other, out):
    code = f"{BEGIN}number = 0\nwhile not ended.is_set():\n    {WRITERS[kind]}{LOOP}"
    process = subprocess.Popen(
        [sys.executable, "-c", code, *map(str, (one, other, out))],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout.readline() == "begun\n"
    return process


def states_beside(process, read):
    """The states that 50 reads find beside a writer; None stands for an error."""
    found = set()
    for _ in range(READS):
        try:
            found.add(read())
        except InputError as error:
            assert "\n" not in str(error)
            found.add(None)
    assert process.poll() is None
    process.communicate("")
    return found - {None}


def digest(*arrays):
    return hashlib.sha256(b"".join(np.ascontiguousarray(one).tobytes() for one in arrays)).digest()


def run_state(folder):
    run = w2m.load(folder)
    return digest(run.room.labels), tuple(map(repr, run.objects))


def blocks_state(folder):
    blocks = w2m.load(folder).blocks
    return digest(blocks.states, blocks.semantic, blocks.instance), tuple(blocks.palette)


def world_state(folder):
    volume = read_world(folder)
    return digest(volume.states), tuple(volume.palette)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Two runs of one size: a bare room, and one with a table."""
    labels = np.zeros((24, 24, 18), np.uint8)
    labels[:, :, 0], labels[0], labels[:, 0] = 2, 3, 3
    place = tmp_path_factory.mktemp("runs")
    np.save(place / "bare.npy", labels)
    labels[8:14, 8:14, 9] = 8
    np.save(place / "table.npy", labels)
    return [w2m.build(place / f"{name}.npy", place / name).folder for name in ("bare", "table")]


def generated_state(folder):
    room = w2m.load(folder)
    return room.kind, room.seed, digest(room.labels, room.instance, room.colour)


def capture_state(folder):
    return tuple(one.name for one in find_capture(folder).frames)


def truth_state(folder):
    truth = read_truth(folder)
    return digest(truth.labels), tuple(map(repr, truth.objects))


@pytest.fixture
def impatient(monkeypatch):
    """Readers end with an error soon, because these writers write most of the time."""
    monkeypatch.setattr("world2minecraft.core.whole_reads.PATIENCE_S", 0.3)


@pytest.fixture(scope="module")
def generated(tmp_path_factory):
    """Two generated rooms."""
    place = tmp_path_factory.mktemp("generated")
    for kind in ("study", "bathroom"):
        w2m.generate_room(kind, out=place / kind)
    return place / "study", place / "bathroom"


def test_a_generated_room_is_read_whole_beside_saves(generated, tmp_path, impatient):
    out = tmp_path / "room"
    shutil.copytree(generated[0], out)
    found = states_beside(start("generated room", *generated, out), lambda: generated_state(out))
    assert found and found <= {generated_state(room) for room in generated}


def test_a_new_capture_is_read_whole_beside_its_scan(generated, tmp_path, impatient):
    out = tmp_path / "capture"

    def read():
        while not out.exists():
            time.sleep(0.01)
        return capture_state(out)

    found = states_beside(start("new capture", *generated, out), read)
    assert found == {tuple(f"frame-{number:06d}" for number in range(4))}


def test_true_rooms_are_read_whole_beside_scans(generated, tmp_path, impatient):
    known = set()
    for room in generated:
        scan_room(w2m.load(room), tmp_path / room.name, frames=1, width=32, height=24)
        known.add(truth_state(tmp_path / room.name))
    out = tmp_path / "study"
    found = states_beside(start("capture", *generated, out), lambda: truth_state(out))
    assert found and found <= known


@pytest.mark.parametrize("state", [run_state, blocks_state])
def test_a_run_is_read_whole_beside_builds(state, runs, tmp_path):
    out = w2m.build(runs[1], tmp_path / "out").folder
    found = states_beside(start("run", *runs, out), lambda: state(out))
    assert found and found <= {state(run) for run in runs}


def test_a_world_is_read_whole_beside_conversions(runs, tmp_path):
    out = w2m.convert(runs[1], tmp_path / "world").path
    known = {world_state(w2m.convert(run, tmp_path / run.name).path) for run in runs}
    found = states_beside(start("world", *runs, out), lambda: world_state(out))
    assert found and found <= known


def test_a_world_is_read_whole_beside_edits(runs, tmp_path):
    out = w2m.convert(runs[1], tmp_path / "world").path
    known = {world_state(out)}
    w2m.build_into_world(runs[0], out, at=(0, 70, 0), new_chunks=True)
    known.add(world_state(out))
    w2m.undo_build(out)
    found = states_beside(start("world edit", *runs, out), lambda: world_state(out))
    assert found and found <= known


def test_a_data_set_is_read_whole_beside_imports(tmp_path):
    photos = w2m.api.datasets.build_photo_dataset(
        tmp_path / "PHOTO", rooms=2, images=4, size=(32, 24)
    )
    w2m.export_dataset(photos, tmp_path / "NPZ", "npz")
    writer = start("data set", tmp_path / "NPZ", tmp_path, tmp_path / "out")

    def read():
        last = max((tmp_path / "out").iterdir(), key=lambda path: int(path.name))
        store = open_store(last)
        return tuple(one.key for one in store.samples())

    assert states_beside(writer, read) <= {tuple(photos.keys())}


def test_a_navigation_set_is_read_whole_beside_rewordings(flat_path, tmp_path):
    out = tmp_path / "SET"
    made = w2m.build_navigation_set(
        [flat_path], out, trajectories=2, size=(64, 36), seed=2, workers=1
    )
    walks = {item.trajectory_id for item in made.items}
    words = tmp_path / "words.csv"
    rows = [f"{walk},Walk over to the piano and stop." for walk in sorted(walks)]
    words.write_text("\n".join(["trajectory_id,instruction", *rows]))

    def read():
        found = read_set(out)
        sources = {one.instruction.source for one in found.items}
        return tuple(sorted(sources | {one.instruction.source for one in found.episodes}))

    found = states_beside(start("navigation set", words, words, out), read)
    assert found and found <= {("human",), ("template",)}
