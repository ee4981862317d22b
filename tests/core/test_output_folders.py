"""Only folders of the program are written, by one process, and a failure leaves what was there."""

import json
import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import ConflictError, DamagedFileError, OutputError, UsageError
from world2minecraft.core.locks import Lock
from world2minecraft.core.output_folders import FolderKind, draft_of, output_folder

KIND = FolderKind({"run.json": "program", "build/scene.json": ""}, ("build", "room.npz"))


def contents(folder):
    """The files of a folder with their bytes, and None for folders."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() if path.is_file() else None
        for path in folder.rglob("*")
    }


def fill(folder, files):
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


def test_new_and_empty_folders_are_written(tmp_path):
    for place in (tmp_path / "new" / "deep", tmp_path):
        with output_folder(place, KIND, "built"):
            assert (place / ".lock").is_file()
            (place / "run.json").write_text('{"program": 1}')
        assert contents(place)["run.json"] == b'{"program": 1}'
        assert not (place / ".lock").exists()
        with output_folder(place, KIND, "built"):  # Again, into its own output.
            pass
        (place / "run.json").unlink()
        place.rmdir() if place != tmp_path else None
        (tmp_path / "new").rmdir() if place != tmp_path else None


@pytest.mark.parametrize(
    ("files", "text"),
    [
        (
            ["notes.txt", "room.npz"],
            "contains other files (notes.txt, room.npz); choose another folder, or use --force "
            "to replace room.npz there",
        ),
        (
            [f"{n}.jpg" for n in range(9)],
            "contains other files (0.jpg, 1.jpg, 2.jpg, 3.jpg and 5 more); choose another folder, "
            "or use --force to write beside them",
        ),
        (
            ["run.json"],  # Of another program.
            "contains other files (run.json); choose another folder, or use --force to "
            "write beside them",
        ),
    ],
)
def test_a_foreign_folder_is_refused_with_what_is_there(tmp_path, files, text):
    fill(tmp_path, dict.fromkeys(files, b"{}"))
    before = contents(tmp_path)
    with pytest.raises(UsageError) as caught, output_folder(tmp_path, KIND, "built"):
        pass
    assert str(caught.value) == f"{tmp_path} {text}"
    assert contents(tmp_path) == before
    with output_folder(tmp_path, KIND, "built", force=True):
        pass
    assert contents(tmp_path) == before


def test_what_a_command_reads_may_lie_in_its_folder(tmp_path):
    source = tmp_path / "capture" / "frames"
    source.mkdir(parents=True)
    with (
        pytest.raises(KeyboardInterrupt),
        output_folder(tmp_path, KIND, "built", keep=False, source=source),
    ):
        (tmp_path / "room.npz").write_text("half")
        raise KeyboardInterrupt
    assert contents(tmp_path).keys() == {"capture", "capture/frames"}
    with pytest.raises(UsageError), output_folder(source.parent, KIND, "built", source=tmp_path):
        pass


def test_a_file_in_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "out").write_text("x")
    with (
        pytest.raises(OutputError, match="is a file"),
        output_folder(tmp_path / "out", KIND, "built", force=True),
    ):
        pass


def test_a_second_writer_is_refused_and_changes_nothing(tmp_path):
    out = tmp_path / "out"
    with output_folder(out, KIND, "joined"):
        (out / "half").write_text("x")
        lock = Lock(out / ".lock")  # As another process would.
        with pytest.raises(ConflictError) as caught:
            lock.acquire()
        assert caught.value.reason == f"is being joined by {lock.holder()}"
        assert contents(out).keys() == {".lock", "half"}


def test_what_fails_to_begin_leaves_no_folder(tmp_path):
    with pytest.raises(KeyboardInterrupt), output_folder(tmp_path / "a" / "b", KIND, "built"):
        raise KeyboardInterrupt
    assert not list(tmp_path.iterdir())


def test_a_failed_first_run_leaves_nothing_or_can_continue(tmp_path):
    out = tmp_path / "out"
    for keep in (False, True):
        with pytest.raises(ValueError), output_folder(out, KIND, "built", keep=keep):
            (out / "stage").mkdir()
            raise ValueError
        assert out.exists() == keep
    assert json.loads((out / ".lock").read_text())["pid"] == os.getpid()  # It marks the folder.
    with output_folder(out, KIND, "built"):
        pass
    assert contents(out) == {"stage": None}


def test_a_failed_later_run_keeps_what_was_there(tmp_path):
    fill(tmp_path, {"run.json": b'{"program": 1}', "own.txt": b"mine"})
    before = contents(tmp_path)
    with pytest.raises(ValueError), output_folder(tmp_path, KIND, "built", keep=False):
        raise ValueError
    assert contents(tmp_path) == before


names = st.sampled_from(["room.npz", "build/a", "build/b", "notes.txt", "build/scene.json"])
files = st.dictionaries(names, st.binary(max_size=3), max_size=5)


@given(there=files, written=files, fails=st.booleans())
def test_a_draft_replaces_all_or_nothing(tmp_path_factory, there, written, fails):
    out = tmp_path_factory.mktemp("out")
    fill(out, there)
    before = contents(out)
    try:
        with output_folder(out, KIND, "built", force=True), draft_of(out, ("build",)) as draft:
            fill(draft, written)
            if fails:
                raise DamagedFileError(draft / "room.npz", "is damaged")
    except DamagedFileError as error:
        assert str(error) == f"{out / 'room.npz'}: is damaged"
    after = before if fails else {**before, **dict.fromkeys(written)}
    found = contents(out)
    assert found.keys() - {"build"} == after.keys() - {"build"}
    for name, data in {**there, **({} if fails else written)}.items():
        assert found[name] == data


def test_the_draft_of_a_killed_process_is_removed(tmp_path):
    fill(tmp_path, {".part/room.npz": b"half", ".lock": b'{"pid": 1, "host": ""}'})
    with output_folder(tmp_path, KIND, "built"):
        assert contents(tmp_path).keys() == {".lock"}
