"""Zips read in place: the same answers as the folder they were made from, and refusals."""

import stat
import zipfile

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture.images import check_whole, read_colour, read_header, read_raw
from world2minecraft.core.archives import ArchivePath, is_zip
from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    LimitError,
    World2MinecraftError,
)
from world2minecraft.core.files import read_bytes, read_json

FILES = {
    "a.json": b'{"x": 1}',
    "rgb/1.txt": b"one",
    "rgb/2.txt": b"two",
    "rgb/deep/3.txt": b"three",
    "seq-01/frame-0.txt": b"f",
}


@pytest.fixture
def folder(tmp_path):
    root = tmp_path / "folder"
    for name, data in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_bytes(data)
    return root


@pytest.fixture
def packed(tmp_path):
    with zipfile.ZipFile(tmp_path / "x.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in FILES.items():
            archive.writestr(name, data)
    return ArchivePath(tmp_path / "x.zip")


def names(found, root):
    return sorted(str(path).removeprefix(str(root)) for path in found)


@pytest.mark.parametrize(
    "pattern", ["*", "rgb/*", "rgb/*.txt", "seq-*/frame-*", "none/*", "a.json"]
)
def test_a_zip_globs_as_its_folder(folder, packed, pattern):
    assert names(packed.glob(pattern), packed) == names(folder.glob(pattern), folder)


@pytest.mark.parametrize("pattern", ["*.txt", "*", "3.*"])
def test_a_zip_globs_deep_as_its_folder(folder, packed, pattern):
    assert names(packed.rglob(pattern), packed) == names(folder.rglob(pattern), folder)


@pytest.mark.parametrize("name", ["a.json", "rgb", "rgb/deep/3.txt", "rgb/none", "none"])
def test_a_zip_answers_as_its_folder(folder, packed, name):
    inside, outside = packed / name, folder / name
    assert inside.is_file() == outside.is_file()
    assert inside.is_dir() == outside.is_dir()
    assert inside.exists() == outside.exists()
    assert (inside.name, inside.stem, inside.suffix) == (outside.name, outside.stem, outside.suffix)
    assert inside.parent.name == (outside.parent.name if "/" in name else "x.zip")
    if outside.is_file():
        assert inside.read_bytes() == inside.open().read() == outside.read_bytes()
        assert inside.stat().st_size == outside.stat().st_size


def test_files_and_images_are_read_from_inside(tmp_path):
    pixels = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)
    Image.fromarray(pixels).save(tmp_path / "c.png")
    np.save(tmp_path / "d.npy", np.ones((2, 3), np.float32))
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        for name in ("c.png", "d.npy"):
            archive.write(tmp_path / name, f"in/{name}")
        archive.writestr("a.json", FILES["a.json"])
    inside = ArchivePath(tmp_path / "x.zip")
    assert read_json(inside / "a.json") == {"x": 1}
    assert read_header(inside / "in/c.png").size == (4, 4)
    check_whole(inside / "in/c.png")
    assert (read_colour(inside / "in/c.png") == pixels).all()
    assert (read_raw(inside / "in/d.npy") == 1).all()
    with pytest.raises(InputError, match="x.zip/none: cannot be read"):
        read_bytes(inside / "none", 10)
    with pytest.raises(LimitError, match="the limit is 3"):
        read_bytes(inside / "a.json", 3)


def test_a_zip_is_known_by_its_first_bytes(tmp_path, packed):
    (tmp_path / "fake.zip").write_bytes(b"no zip")
    assert is_zip(packed.path)
    assert not is_zip(tmp_path / "fake.zip")
    assert not is_zip(tmp_path / "none.zip")


def write_named(path, name, mode=0):
    with zipfile.ZipFile(path, "w") as archive:
        entry = zipfile.ZipInfo(name)
        entry.external_attr = mode << 16
        archive.writestr(entry, b"x")


@pytest.mark.parametrize("name", ["../up.txt", "/etc/x", "a/../../b", "C:/x", "..\\x"])
def test_names_that_leave_the_zip_are_refused(tmp_path, name):
    write_named(tmp_path / "x.zip", name)
    with pytest.raises(DamagedFileError, match="a member with an unsafe name"):
        ArchivePath(tmp_path / "x.zip").exists()


def test_links_are_refused(tmp_path):
    write_named(tmp_path / "x.zip", "link", stat.S_IFLNK | 0o777)
    with pytest.raises(DamagedFileError, match="a member with an unsafe name: 'link'"):
        ArchivePath(tmp_path / "x.zip").exists()


def test_a_bomb_is_refused_before_it_is_unpacked(tmp_path):
    with zipfile.ZipFile(tmp_path / "x.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("bomb", bytes(40 << 20))
    with pytest.raises(LimitError, match="would unpack to 41,943,040 bytes"):
        (ArchivePath(tmp_path / "x.zip") / "bomb").read_bytes()


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.9, 0.99])
def test_a_zip_cut_short_is_refused(packed, share):
    data = packed.path.read_bytes()
    packed.path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(DamagedFileError, match="is not a complete zip file .*copy it again"):
        packed.exists()


@pytest.mark.parametrize("at", [10, 30, 60, 120, 200])
def test_damage_is_an_error_of_ours_or_no_harm(packed, at):
    data = bytearray(packed.path.read_bytes())
    data[at] ^= 0xFF
    packed.path.write_bytes(bytes(data))
    try:
        held = {str(path): path.read_bytes() for path in packed.rglob("*") if path.is_file()}
    except World2MinecraftError as error:
        assert "\n" not in str(error)
    else:
        assert set(held.values()) <= set(FILES.values())
