"""Names of uploaded files: whatever passes stays below its folder, on every system."""

from pathlib import Path, PurePosixPath, PureWindowsPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import LimitError, UsageError
from world2minecraft.sceneforge.uploads import (
    MAX_FILES,
    UploadFile,
    check_files,
    check_path,
    common_folder,
)

HOSTILE = (
    "/etc/passwd",
    "../up",
    "a/../../up",
    "a/..",
    "..",
    "",
    ".",
    "C:/x",
    "c:x",
    "a\\..\\b",
    "\\\\server\\share",
    "//server/share",
    "a\0b",
    "a\nb",
    "aux",
    "sub/NUL.txt",
    "COM1.png",
    "name.",
    " name",
    "name ",
    "a|b",
    "a*",
    'a"b',
    "x" * 201,
    "/".join(["deep"] * 13),
    "\ud800",
    "a\u202eb",
)
GOOD = ("0.jpg", "kitchen/rgb/0.jpg", "Küche/Bild 1.JPEG", ".hidden/x", "a...b", "深度/0.png")


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_names_are_refused(name):
    with pytest.raises(UsageError, match="invalid file name"):
        check_path(name)


@pytest.mark.parametrize("name", GOOD)
def test_plain_names_stay(name):
    assert check_path(name) == name


@given(st.text(max_size=60) | st.text(alphabet="./\\:ab ", max_size=20))
def test_what_passes_stays_below_its_folder(name):
    try:
        path = check_path(name)
    except UsageError:
        return
    root = Path("/home/of/captures")
    assert (root / path).resolve().is_relative_to(root)
    assert ".." not in PureWindowsPath(path).parts
    assert not PureWindowsPath(path).drive and not PureWindowsPath(path).is_absolute()
    assert PurePosixPath(path).as_posix() == path


def one(path, size=1):
    return {"path": path, "size": size}


def test_what_systems_leave_in_folders_is_left_out():
    files = check_files([one("a/0.jpg"), one("a/.DS_Store"), one("a/Thumbs.db")], 100)
    assert files == (UploadFile("a/0.jpg", 1),)
    with pytest.raises(UsageError, match="no files found"):
        check_files([one("a/.DS_Store")], 100)


@pytest.mark.parametrize(
    ("files", "error", "words"),
    [
        (None, UsageError, "must be a list"),
        ([], UsageError, "must be a list"),
        (["0.jpg"], UsageError, "each file must be"),
        ([one("a", -1)], UsageError, "must be an integer"),
        ([one("a", True)], UsageError, "must be an integer"),
        ([one("a", 1.5)], UsageError, "must be an integer"),
        ([one("a"), one("A")], UsageError, "occurs twice"),
        ([one("a"), one("a/b")], UsageError, "is used for both a file and a folder"),
        ([one("a", 1 << 30)], LimitError, "is 1,024 MB, the upload limit is 512 MB"),
        ([one("a", 300 << 20), one("b", 300 << 20)], LimitError, "is 600 MB"),
        ([one("a", 1 << 80)], LimitError, "the upload limit is 512 MB"),
        ([one("a")] * (MAX_FILES + 1), LimitError, "contains 20,001 files, the limit is 20,000"),
    ],
)
def test_lists_that_cannot_be_taken_say_why(files, error, words):
    with pytest.raises(error, match=words):
        check_files(files, 512 << 20)


def test_the_one_folder_of_a_dropped_folder_is_found():
    def files(*paths):
        return [UploadFile(path, 1) for path in paths]

    assert common_folder(files("kitchen/a.jpg", "kitchen/rgb/b.jpg")) == "kitchen"
    assert common_folder(files("kitchen/a.jpg", "b.jpg")) == ""
    assert common_folder(files("a.jpg")) == ""
