"""A sample and its files: there and back, always the same bytes, hostile ones refused."""

import io
import json
import struct
import tarfile
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from occ_samples import AIR, CAMERA, CHAIR, PLANKS, SHAPE, assert_same, sample
from PIL import Image

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.files import pack_npz
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.store.sample_files import (
    FineTable,
    SampleFiles,
    decode_depth,
    encode_colour,
    encode_depth,
    pack_sample,
    unpack_sample,
)
from world2minecraft.minecraftocc.store.shard import BLOCK, end_bytes, member_at, member_bytes
from world2minecraft.rendering.output.images import depth_bytes

TABLE = FineTable((AIR, CHAIR, PLANKS))


@pytest.mark.parametrize("kind", ["jpg", "png", "webp"])
@pytest.mark.parametrize("pictures", [True, False])
def test_a_sample_comes_back_as_it_was(kind, pictures):
    whole = sample(3, pictures=pictures)
    members = pack_sample(whole, TABLE, SampleFiles(kind, 100))
    kinds = [kind, "depth.png", "occ.npz", "json"] if pictures else ["occ.npz", "json"]
    assert list(members) == kinds
    assert_same(whole, unpack_sample(members, TABLE, "here"), colour=kind != "jpg")


def test_the_same_sample_gives_the_same_bytes():
    assert pack_sample(sample(3), TABLE, SampleFiles()) == pack_sample(
        sample(3), TABLE, SampleFiles()
    )


def test_the_json_tells_the_counts_of_cells():
    whole = sample(4)
    told = json.loads(pack_sample(whole, TABLE, SampleFiles())["json"])
    occ = whole.occ
    assert told["cells"]["visible"] == int((occ.hits > 0).sum())
    assert told["cells_by_class"][5] == int((occ.labels == 5).sum())
    assert told["visible_by_class"][5] == int(((occ.labels == 5) & (occ.hits > 0)).sum())
    slow = sum(
        inside and 0 < label < 255 and not hits
        for inside, label, hits in zip(
            occ.in_frustum.flat, occ.labels.flat, occ.hits.flat, strict=True
        )
    )
    assert told["cells"]["occluded"] == slow
    assert np.allclose(np.array(told["camera_to_block"])[:3, 3] * 0.25, whole.camera_to_room[:3, 3])


def test_numpy_alone_reads_the_labels():
    """What the docs tell those who read a shard without this program."""
    whole = sample(5)
    members = pack_sample(whole, TABLE, SampleFiles())
    told = json.loads(members["json"])
    with np.load(io.BytesIO(members["occ.npz"])) as arrays:
        free = np.unpackbits(arrays["free"], count=int(np.prod(told["region"]["shape"])))
        np.testing.assert_array_equal(free.reshape(told["region"]["shape"]), whole.occ.free)
        np.testing.assert_array_equal(arrays["labels"], whole.occ.labels)


# Depth.


@given(st.integers(1, 9), st.integers(1, 9), st.integers(0, 1 << 30))
def test_depth_is_the_png_that_pillow_writes(height, width, seed):
    rng = np.random.default_rng(seed)
    depth = (rng.uniform(0, 80, (height, width)) * (rng.random((height, width)) < 0.8)).astype(
        np.float32
    )
    ours = np.asarray(Image.open(io.BytesIO(encode_depth(depth))))
    assert ours.dtype == np.uint16
    np.testing.assert_array_equal(
        ours, np.asarray(Image.open(io.BytesIO(depth_bytes(depth, ".png"))))
    )
    camera = Camera(width, height, 5.0, 5.0, 1.0, 1.0)
    far = np.minimum(depth, 65.535)
    assert np.abs(decode_depth(encode_depth(depth), camera, "here") - far).max() <= 0.001


# Tar.


def test_members_are_what_tarfile_reads():
    data = member_bytes("a-b-000001.jpg", b"x" * 700) + member_bytes("a-b-000001.json", b"{}")
    data += end_bytes(len(data))
    assert len(data) % 10_240 == 0
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        entries = archive.getmembers()
        assert [(one.name, one.size, one.mtime, one.uid) for one in entries] == [
            ("a-b-000001.jpg", 700, 0, 0),
            ("a-b-000001.json", 2, 0, 0),
        ]
    stream = io.BytesIO(data)
    first = member_at(stream, 0, len(data))
    assert (first.key, first.kind, first.offset, first.size) == ("a-b-000001", "jpg", BLOCK, 700)
    assert member_at(stream, first.end, len(data)).kind == "json"


@pytest.mark.parametrize(
    "name", ["../a.jpg", "/etc/a.jpg", "a b.jpg", "a", "a.JPG", "a.tar.gz.exe"]
)
def test_a_member_of_a_strange_name_is_none(name):
    data = member_bytes(name, b"x")
    assert member_at(io.BytesIO(data), 0, len(data)) is None


def test_a_member_that_reaches_beyond_the_end_is_none():
    data = member_bytes("a.jpg", b"x" * 600)
    assert member_at(io.BytesIO(data), 0, len(data)) is not None
    for length in (0, 1, 511, 512, 513, len(data) - 1):
        assert member_at(io.BytesIO(data[:length]), 0, length) is None


def test_links_and_devices_are_none():
    info = tarfile.TarInfo("a.jpg")
    info.type, info.linkname = tarfile.SYMTYPE, "/etc/passwd"
    assert member_at(io.BytesIO(info.tobuf(tarfile.USTAR_FORMAT)), 0, 512) is None


# Hostile files.


def broken(**changes):
    members = pack_sample(sample(1), TABLE, SampleFiles())
    told = json.loads(members["json"])
    for name, value in changes.items():
        at = told
        *way, last = name.split("__")
        for step in way:
            at = at[step]
        at[last] = value
    members["json"] = json.dumps(told).encode()
    return members


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"format": 2}, "not the JSON of a sample in format 1"),
        ({"region__shape": [10**6, 10**6, 10**6]}, "a region must have from 1 to 16,777,216 cells"),
        ({"region__shape": [5, 4, 4]}, "must have shape|the packed bits of 80 cells"),
        ({"region__shape": [0, 4, 3]}, "a region must have from 1 to"),
        ({"region__shape": "abc"}, "not a valid sample"),
        ({"region__voxel_m": -1}, "voxel_m must be above 0"),
        ({"camera__width_px": 17}, "an image has 16x12 pixels, expected 17x12"),
        ({"camera__width_px": -1}, "not a valid sample"),
        ({"camera_to_room": [[1]]}, "camera_to_room must have shape"),
        ({"camera_to_room": None}, "not a valid sample"),
        ({"facts": 3}, "not a valid sample"),
        ({"frame": "x"}, "not a valid sample"),
        ({"key": None, "camera": []}, "not a valid sample"),
    ],
)
def test_an_inconsistent_json_is_reported_in_one_line(changes, text):
    with pytest.raises(DamagedFileError, match=text):
        unpack_sample(broken(**changes), TABLE, "here")


def test_no_json_at_all():
    for data in (b"", b"[]", b"{", b"[" * 100_000, b'{"format": 1}' + b" " * (2 << 20)):
        with pytest.raises(DamagedFileError, match="JSON"):
            unpack_sample({"json": data, "occ.npz": b""}, TABLE, "here")


def test_fine_numbers_beyond_the_table_are_refused():
    members = pack_sample(sample(1), TABLE, SampleFiles())
    with pytest.raises(DamagedFileError, match="fine must contain indices below 1, got 2"):
        unpack_sample(members, FineTable((AIR,)), "here")


def test_arrays_with_a_huge_header_are_refused():
    members = pack_sample(sample(1), TABLE, SampleFiles())
    huge = dict.fromkeys(("labels", "fine", "instance", "hits", "in_frustum", "free"))
    members["occ.npz"] = pack_npz({name: np.zeros(10**6, np.uint8) for name in huge})
    with pytest.raises(Exception, match="1,000,128 bytes, which exceeds the limit"):
        unpack_sample(members, TABLE, "here")


def test_an_image_with_a_huge_header_is_not_decoded():
    header = struct.pack(">IIBBBBB", 60_000, 60_000, 16, 0, 0, 0, 0)
    chunk = b"IHDR" + header
    png = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + chunk
    png += struct.pack(">I", zlib.crc32(chunk))
    with pytest.raises(DamagedFileError, match="an image"):
        decode_depth(png, CAMERA, "here")


def test_a_picture_of_another_kind_is_refused():
    grey = encode_colour(np.zeros((12, 16, 3), np.uint8), "png")
    with pytest.raises(DamagedFileError, match="must be a grey PNG"):
        decode_depth(grey, CAMERA, "here")


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("gif",), "one of jpg, png, webp, got 'gif'"),
        (("jpg", 0), "quality must be from 1 to 100, got 0"),
    ],
)
def test_unknown_choices_are_refused(words, text):
    with pytest.raises(UsageError, match=text):
        SampleFiles(*words)


def test_the_shape_is_what_the_tests_think():
    assert sample().occ.labels.shape == SHAPE
