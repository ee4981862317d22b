"""A reader beside a writer sees one whole state or an error: 50 reads for each kind of folder."""

import json
import os
import subprocess
import sys
import time

import numpy as np
import pytest

import world2minecraft as w2m
from world2minecraft.core.errors import ConflictError, InputError
from world2minecraft.core.output_folders import FolderKind, draft_of, output_folder
from world2minecraft.core.whole_reads import CHANGING, changing, read_whole, unchanged

READS = 50
# A process that alternates between two states of a folder until its input ends.
WRITER = """
import sys, threading
from pathlib import Path
from world2minecraft.core.output_folders import FolderKind, draft_of, output_folder
from world2minecraft.core.whole_reads import changing
kind, folder = sys.argv[1], Path(sys.argv[2])
ended = threading.Event()
threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
KIND = FolderKind({"a.txt": ""}, ("a.txt",), in_place=kind == "in place")
number = 0
def write(place):
    for name in ("a.txt", "b/c.txt", "d.txt"):
        (place / name).parent.mkdir(exist_ok=True)
        part = place / f".{number}"
        part.write_text(str(number))
        part.replace(place / name)
while not ended.wait(0.01):
    number += 1
    with output_folder(folder, KIND, "built"):
        if kind == "in place":
            write(folder)
        else:
            with draft_of(folder) as draft:
                write(draft)
    if number == 1:
        print("begun", flush=True)
"""
NAMES = ("a.txt", "b/c.txt", "d.txt")


def read_slowly(folder):
    found = []
    for name in NAMES:
        found.append((folder / name).read_text())
        time.sleep(0.001)
    return found


@pytest.mark.parametrize("kind", ["in place", "draft"])
def test_a_reader_beside_a_writer_sees_no_mixture(kind, tmp_path, monkeypatch):
    monkeypatch.setattr("world2minecraft.core.whole_reads.PATIENCE_S", 0.1)
    writer = start(WRITER, kind, tmp_path)
    mixed, seen = 0, set()
    for _ in range(READS):
        try:
            mixed += len(set(read_slowly(tmp_path))) > 1
        except OSError:
            mixed += 1
        try:
            found = read_whole(tmp_path, lambda: read_slowly(tmp_path))
        except ConflictError as error:
            assert "\n" not in str(error)
            continue
        assert len(set(found)) == 1, found
        seen.add(found[0])
    writer.communicate("")
    assert mixed and len(seen) > 1  # Without the check there are mixtures; with it, states.
    assert len(set(read_whole(tmp_path, lambda: read_slowly(tmp_path)))) == 1


def start(code, *words):
    process = subprocess.Popen(
        [sys.executable, "-c", code, *map(str, words)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout.readline() == "begun\n"
    return process


def mark(folder, pid=1):
    (folder / CHANGING).write_text(json.dumps({"pid": pid, "host": "", "work": "reconstructed"}))


def test_a_marked_folder_is_refused_with_who_changes_it(tmp_path):
    mark(tmp_path)
    with pytest.raises(ConflictError) as caught, unchanged(tmp_path):
        pass
    assert str(caught.value) == (
        f"{tmp_path}: is being reconstructed by process 1; read it when that has finished, or "
        "repeat that command if it was stopped"
    )
    with changing(tmp_path, "built"):  # The next writer removes the mark of a killed one.
        pass
    with unchanged(tmp_path):
        pass


def test_a_change_during_a_read_is_an_error(tmp_path):
    (tmp_path / "a.txt").write_text("1")
    changed = pytest.raises(ConflictError, match="was changed by another process while it was read")
    with changed, unchanged(tmp_path):
        (tmp_path / "new").write_text("2")
        os.replace(tmp_path / "new", tmp_path / "a.txt")
    with pytest.raises(ConflictError), unchanged(tmp_path):
        (tmp_path / "a.txt").unlink()
        raise InputError(tmp_path / "a.txt", "not found")
    with pytest.raises(InputError, match="damaged"), unchanged(tmp_path):
        raise InputError(tmp_path / "a.txt", "damaged")


def test_a_failed_change_leaves_the_mark_only_if_it_wrote(tmp_path):
    (tmp_path / "a.txt").write_text("1")
    for writes in (False, True):
        with pytest.raises(KeyboardInterrupt), changing(tmp_path, "built"):
            if writes:
                (tmp_path / "b.txt").write_text("2")
            raise KeyboardInterrupt
        assert (tmp_path / CHANGING).exists() == writes


def test_a_writer_reads_its_own_folder(tmp_path):
    with changing(tmp_path, "built"), changing(tmp_path, "built"), unchanged(tmp_path):
        (tmp_path / "a.txt").write_text("1")
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_folders_that_were_empty_are_not_marked(tmp_path):
    kind = FolderKind({"a.txt": ""}, ("a.txt",), in_place=True)
    for is_marked in (False, True):
        with output_folder(tmp_path / "out", kind, "built"):
            assert (tmp_path / "out" / CHANGING).exists() == is_marked
            (tmp_path / "out/a.txt").write_text("1")
    with draft_of(tmp_path / "out") as draft:
        (draft / "a.txt").write_text("2")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["a.txt"]


def test_a_failed_command_that_keeps_nothing_leaves_no_mark(tmp_path):
    out, kind = tmp_path / "out", FolderKind({}, ("a.txt",))
    command = output_folder(out, kind, "written", keep=False)
    with pytest.raises(KeyboardInterrupt), command, changing(out, "written"):
        (out / "a.txt").write_text("1")
        raise KeyboardInterrupt
    assert not out.exists()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run of a bare room."""
    labels = np.zeros((20, 20, 12), np.uint8)
    labels[:, :, 0], labels[0], labels[:, 0] = 2, 3, 3
    path = tmp_path_factory.mktemp("runs") / "room.npy"
    np.save(path, labels)
    return w2m.build(path, path.with_name("OUT")).folder


READERS = {
    "objects": lambda run, out: w2m.load(run).objects,
    "blocks": lambda run, out: w2m.convert(run, out / "room.schem"),
    "build": lambda run, out: w2m.build(run, out / "again"),
}


@pytest.mark.parametrize("reader", READERS)
def test_a_run_that_is_being_changed_is_not_read(reader, run, tmp_path, monkeypatch):
    monkeypatch.setattr("world2minecraft.core.whole_reads.PATIENCE_S", 0.0)
    mark(run)
    with pytest.raises(ConflictError, match="is being reconstructed by process 1; read it when"):
        READERS[reader](run, tmp_path)
    (run / CHANGING).unlink()
    READERS[reader](run, tmp_path)
