"""Two processes never write one folder, foreign folders are left alone, and failures leave none."""

import subprocess
import sys
import threading

import numpy as np
import pytest

import world2minecraft as w2m
from world2minecraft import cli
from world2minecraft.api.navigation import reword_navigation_set
from world2minecraft.api.repairs import undo_repair
from world2minecraft.core.errors import ConflictError, InputError, UsageError
from world2minecraft.core.locks import Lock
from world2minecraft.sceneforge.editor import Editor

# A process that holds the lock of a folder until its input ends.
HOLD = """
import sys
from pathlib import Path
from world2minecraft.core.locks import Lock
Lock(Path(sys.argv[1]) / ".lock", "built").acquire()
print("held", flush=True)
sys.stdin.read()
"""
# A process that builds a room, and whose last stage lasts until its input ends.
SLOW_BUILD = """
import sys
from world2minecraft import cli
from world2minecraft.core import precompile
from world2minecraft.reconstruction import build_without_capture as module
precompile.needs_compiling = lambda work: False
run_stage = module.run_stage
def slow(stage, *rest):
    run_stage(stage, *rest)
    if stage == "build":
        print("held", flush=True)
        sys.stdin.read()
module.run_stage = slow
sys.exit(cli.run(["build", sys.argv[1], "--out", sys.argv[2]]))
"""


def start(code, *words):
    """Start a process of Python, and return it once it prints that it holds its lock."""
    process = subprocess.Popen(
        [sys.executable, "-c", code, *map(str, words)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "held\n"
    return process


def contents(folder):
    """The files of a folder with their bytes."""
    paths = [path for path in folder.rglob("*") if path.is_file() and path.name != ".lock"]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    """A room as an array of class ids, with a table."""
    labels = np.zeros((24, 24, 18), np.uint8)
    labels[:, :, 0], labels[0], labels[:, 0] = 2, 3, 3
    labels[8:14, 8:14, 9] = 8
    path = tmp_path_factory.mktemp("rooms") / "room.npy"
    np.save(path, labels)
    return path


@pytest.fixture(scope="module")
def run(room, tmp_path_factory):
    """A run that was built of another room: without the table."""
    labels = np.load(room)
    labels[8:14, 8:14, 9] = 0
    np.save(room.with_name("bare.npy"), labels)
    return w2m.build(room.with_name("bare.npy"), tmp_path_factory.mktemp("runs") / "OUT").folder


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    """Two images as npz files, to import."""
    place = tmp_path_factory.mktemp("images")
    data = w2m.api.datasets.build_photo_dataset(place / "DATA", rooms=2, images=2, size=(32, 24))
    w2m.export_dataset(data, place / "NPZ", "npz")
    return place / "NPZ"


@pytest.fixture
def held(tmp_path):
    """A folder whose lock another process holds, and that process."""
    process = start(HOLD, tmp_path)
    yield tmp_path, process
    process.communicate("")


WRITERS = {
    "reconstruct": lambda out, run: w2m.reconstruct(run, out),
    "build": lambda out, run: w2m.build(run, out),
    "join": lambda out, run: w2m.join_rooms([run, run], out),
    "demo": lambda out, run: w2m.demo(out),
    "occupy": lambda out, run: w2m.predict_occupancy(run, run_folder=out),
    "generate": lambda out, run: w2m.generate_room("study", out=out),
    "scan": lambda out, run: w2m.scan_room(w2m.generate_room("study"), out, frames=3),
    "dataset build": lambda out, run: w2m.build_dataset(
        out, worlds=run, images=1, size=(32, 24), test_share=0, jobs=1
    ),
    "dataset rooms": lambda out, run: w2m.api.datasets.build_photo_dataset(
        out, rooms=2, images=2, size=(32, 24)
    ),
    "vln build": lambda out, run: w2m.build_navigation_set([run], out, size=(64, 36)),
    "render": lambda out, run: w2m.render_files(run, out, view="orbit", frames=2, size=(64, 36)),
}


@pytest.mark.parametrize("writer", WRITERS)
def test_a_folder_in_use_is_refused_and_unchanged(writer, held, run):
    folder, process = held
    (folder / "half.json").write_text("{}")
    with pytest.raises(ConflictError) as caught:
        WRITERS[writer](folder, run)
    who = Lock(folder / ".lock").holder()
    assert str(caught.value) == f"{folder}: is being built by {who}"
    assert who.startswith(f"process {process.pid} since ")
    assert contents(folder) == {"half.json": b"{}"}


EDITORS = {
    "repair": w2m.repair,
    "undo a repair": undo_repair,
    "build again": lambda folder: w2m.build(folder.parent / "room.npy", folder),
    "open": Editor.open,
}


@pytest.mark.parametrize("editor", EDITORS)
def test_a_run_in_use_is_not_edited(editor, run, room, tmp_path):
    folder = copy_of(run, tmp_path)
    (tmp_path / "room.npy").write_bytes(room.read_bytes())
    before, process = contents(folder), start(HOLD, folder)
    with pytest.raises(ConflictError, match=f"is being built by process {process.pid} since"):
        EDITORS[editor](folder)
    assert contents(folder) == before and not folder.with_name("OUT.forge").exists()
    process.communicate("")


def copy_of(run, place):
    import shutil

    return shutil.copytree(run, place / "OUT")


def test_a_world_in_use_is_named_and_not_changed(run, tmp_path, capsys):
    world = copy_of(run, tmp_path) / "build" / "world"
    before, process = contents(world), start(HOLD, world)
    words = ["build", str(run), "--into", str(world), "--at", "0", "70", "0"]
    for command in (words, ["undo", str(world)]):
        assert cli.run(command) == 3
        text = f"error: {world}: is being built by process {process.pid} since "
        assert text in capsys.readouterr().err
    assert contents(world) == before
    process.communicate("")
    assert cli.run([*words, "--new-chunks"]) == 0 and cli.run(["undo", str(world)]) == 0
    assert contents(world) == before


def test_a_navigation_set_in_use_is_not_reworded(held):
    folder, _ = held
    (folder / "items.jsonl").write_text("")
    with pytest.raises(ConflictError, match="is being built by process"):
        reword_navigation_set(folder, plain=True)


def test_a_navigation_set_is_exported_into_an_empty_folder(run, tmp_path):
    with pytest.raises(InputError, match="items.jsonl"):  # The folder itself is accepted.
        w2m.export_navigation_set(run, tmp_path / "out", "trl")
    assert not (tmp_path / "out").exists()


def test_the_second_of_two_builds_is_refused_or_waits(run, room, tmp_path, capsys):
    out = tmp_path / "out"
    first = start(SLOW_BUILD, run, out)
    assert [path.name for path in out.iterdir() if path.name[0] != "."] == []
    assert cli.run(["build", str(room), "--out", str(out)]) == 3
    error = capsys.readouterr().err
    assert f"error: {out}: is being built by process {first.pid} since " in error

    def end_first():
        while "waiting" not in "".join(said):
            said.append(capsys.readouterr().err)
        first.communicate("")

    said = []
    waiter = threading.Thread(target=end_first)
    waiter.start()
    assert cli.run(["build", str(room), "--out", str(out), "--wait"]) == 0
    waiter.join()
    assert f"waiting for process {first.pid} since " in "".join(said)
    assert first.returncode == 0
    alone = w2m.build(room, tmp_path / "alone").folder
    for name in ("room.npz", "objects.json", "placements.json", "build/scene.npz"):
        assert (out / name).read_bytes() == (alone / name).read_bytes()


def test_a_killed_build_holds_nothing_and_is_repeated(run, room, tmp_path):
    out = tmp_path / "out"
    first = start(SLOW_BUILD, run, out)
    first.kill()
    first.communicate()
    assert (out / ".lock").exists() and (out / ".part").exists()
    assert w2m.build(room, out).world.is_dir()
    assert not [path for path in out.iterdir() if path.name[0] == "."]


def test_a_room_open_in_the_editor_is_not_built_over(run, room, tmp_path, capsys):
    folder = copy_of(run, tmp_path)
    editor = Editor.open(folder)
    assert cli.run(["build", str(room), "--out", str(folder)]) == 3
    assert f"error: {folder}: is being edited by process " in capsys.readouterr().err
    editor.close()
    assert cli.run(["build", str(room), "--out", str(folder)]) == 0


@pytest.mark.parametrize("verb", ["reconstruct", "build", "join", "dataset import"])
def test_a_folder_of_somebody_else_is_left_alone(verb, run, images, tmp_path, capsys):
    folder = tmp_path / "mine"
    folder.mkdir()
    for name in ("objects.json", "room.npz", "notes.txt"):
        (folder / name).write_text("mine")
    before = contents(folder)
    sources = [str(run)] * (1 + (verb == "join"))
    if verb == "dataset import":
        sources = [str(images)]
    assert cli.run([*verb.split(), *sources, "--out", str(folder)]) == 2
    error = capsys.readouterr().err
    replaced = "write beside them" if verb == "dataset import" else "replace objects.json, room.npz"
    assert f"error: {folder} contains other files (notes.txt, objects.json, room.npz); " in error
    assert f"choose another folder, or use --force to {replaced}" in error
    assert contents(folder) == before and not (folder / ".lock").exists()


def test_pictures_of_somebody_else_are_left_alone(run, tmp_path, capsys):
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "000000.png").write_text("mine")
    words = ["render", str(run), "--orbit", "--frames", "2", "--size", "64x36", "-o", str(folder)]
    assert cli.run(words) == 2
    error = capsys.readouterr().err
    assert "contains other files (000000.png); choose another folder, or use --force" in error
    assert contents(folder) == {"000000.png": b"mine"}
    assert cli.run([*words, "--force"]) == 0
    assert (folder / "000000.png").read_bytes() != b"mine"
    assert cli.run(words) == 0  # It is the program's own now.


def test_force_replaces_what_was_told_and_keeps_the_rest(run, tmp_path):
    (tmp_path / "room.npz").write_text("mine")
    (tmp_path / "notes.txt").write_text("mine")
    assert cli.run(["build", str(run), "--out", str(tmp_path), "--force"]) == 0
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert (tmp_path / "room.npz").read_bytes() == (run / "room.npz").read_bytes()
    assert cli.run(["build", str(run), "--out", str(tmp_path)]) == 0  # It is ours now.


def fail(*args, **kwargs):
    raise KeyboardInterrupt


@pytest.mark.parametrize("is_there", [False, True])
def test_a_failed_build_leaves_what_was_there(is_there, run, room, tmp_path, monkeypatch):
    out = copy_of(run, tmp_path) if is_there else tmp_path / "deep" / "out"
    before = contents(out) if is_there else {}
    monkeypatch.setattr("world2minecraft.reconstruction.file_stages.write_build", fail)
    assert cli.run(["build", str(room), "--out", str(out)]) == 130
    assert contents(out) == before if is_there else not list(tmp_path.iterdir())


def test_a_failed_import_leaves_no_folder(images, tmp_path, monkeypatch):
    monkeypatch.setattr("world2minecraft.minecraftocc.store.writer.finish_store", fail)
    with pytest.raises(KeyboardInterrupt):
        w2m.import_dataset(images, tmp_path / "new" / "AGAIN")
    assert not (tmp_path / "new").exists()
    monkeypatch.undo()
    assert len(w2m.import_dataset(images, tmp_path / "new" / "AGAIN")) == 2


@pytest.mark.parametrize("target", ["room.schem", "world", "room.habitat"])
def test_a_failed_conversion_leaves_no_folder(target, run, tmp_path, monkeypatch):
    monkeypatch.setattr("world2minecraft.formats.volume_formats.write_volume", fail)
    with pytest.raises(KeyboardInterrupt):
        w2m.convert(run, tmp_path / "new" / "deep" / target)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("target", ["room.html", "room.gif"])
def test_a_failed_share_leaves_no_file(target, run, tmp_path, monkeypatch):
    monkeypatch.setattr("world2minecraft.sceneforge.share.page.room_page", fail)
    monkeypatch.setattr("world2minecraft.sceneforge.share.film.animation_writer", fail)
    with pytest.raises((KeyboardInterrupt, UsageError)):
        w2m.share(run, tmp_path / "new" / target)
    assert not list(tmp_path.iterdir())
