"""Screenshots with poses from sidecars, names and PNG texts; and what hostile ones are told."""

import json
import struct
import time
import zlib

import numpy as np
import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.minecraftocc.screenshots import (
    MAX_TEXT,
    NamePattern,
    read_png_facts,
    read_screenshots,
)
from world2minecraft.rendering.views.cameras import GamePose

POSE = {"x": 1.5, "y": 64.0, "z": -3.25, "yaw": 90.0, "pitch": 12.5}


def picture(path, size=(32, 18), texts=None):
    info = PngInfo()
    for add, keyword, text in texts or []:
        getattr(info, add)(keyword, text, zip=add == "add_text" and len(text) > 60)
    Image.fromarray(np.zeros((size[1], size[0], 3), np.uint8)).save(path, pnginfo=info)
    return path


def chunk(kind, data):
    return struct.pack(">I4s", len(data), kind) + data + struct.pack(">I", zlib.crc32(kind + data))


def raw(path, *chunks, size=(8, 8)):
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", *size, 8, 2, 0, 0, 0))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + head + b"".join(chunks) + chunk(b"IEND", b""))
    return path


def one_line(error):
    text = str(error.value)
    assert text and "\n" not in text
    return text


# The three kinds.


@pytest.mark.parametrize("suffix", ["jsonl", "csv"])
def test_a_sidecar_tells_poses(tmp_path, suffix):
    picture(tmp_path / "b.png")
    picture(tmp_path / "a.png", (64, 36))
    picture(tmp_path / "not told.png")
    rows = [{"file": name, **POSE, "x": n} for n, name in enumerate(("b.png", "a.png"))]
    if suffix == "jsonl":
        text = "".join(json.dumps(row) + "\n" for row in rows)
    else:
        text = "\n".join([",".join(rows[0]), *(",".join(map(str, row.values())) for row in rows)])
    (tmp_path / f"poses.{suffix}").write_text(text)
    views = read_screenshots(tmp_path, at="feet")
    assert [view.image.name for view in views] == ["b.png", "a.png"]
    assert [view.pose.x for view in views] == [0, 1] and [view.frame for view in views] == [0, 1]
    assert {view.pose_source for view in views} == {f"poses.{suffix}"}
    assert (views[1].camera.width_px, views[1].camera.height_px) == (64, 36)
    assert views[1].camera.fy_px == pytest.approx(18 / np.tan(np.radians(35)))
    named = read_screenshots(tmp_path, at="feet", poses=tmp_path / f"poses.{suffix}")
    assert [view.pose for view in named] == [view.pose for view in views]


def test_a_line_may_say_its_own_fov_size_and_place(tmp_path):
    picture(tmp_path / "a.png")
    row = {"image": "a.png", **POSE, "at": "eye", "vertical_fov_deg": 90, "tour_id": "t7", "t": 2.5}
    (tmp_path / "tour.jsonl").write_text(json.dumps(row))
    (view,) = read_screenshots(tmp_path, at="feet")
    assert view.pose.at == "eye" and view.tour_id == "t7" and view.t_s == 2.5
    assert view.camera.fy_px == pytest.approx(9)
    (tmp_path / "tour.jsonl").write_text(json.dumps({**row, "width": 99, "height": 18}))
    with pytest.raises(DamagedFileError) as raised:
        read_screenshots(tmp_path, at="feet")
    assert "states 99x18 pixels for a.png, which has 32x18" in one_line(raised)


@pytest.mark.parametrize(
    ("name", "pattern"),
    [
        ("1.5_64.0_-3.25_90.0_12.5", None),
        ("2026-01-05_11.22.33_1.5_64.0_-3.25_90_12.5", None),
        ("shot 1.5,64,-3.25,90,12.5", None),
        ("x1.5_y64_z-3.25_r90_p12.5", "x{x}_y{y}_z{z}_r{yaw}_p{pitch}"),
        ("90-12.5@1.5+64-3.25!!", "{yaw}-{pitch}@{x}+{y}{z}!!"),
        ("at 1.5 64 -3.25 (90 12.5)", "*{x} {y} {z} ({yaw} {pitch})"),
        (
            "s-1.5-64--3.25-90-12.5",
            r"s-(?P<x>[\d.]+)-(?P<y>\d+)-(?P<z>-?\d+(?:\.\d+)?)-(?P<yaw>\d+)-(?P<pitch>[\d.]+)",
        ),
    ],
)
def test_a_name_tells_a_pose(tmp_path, name, pattern):
    if pattern and "}{" in pattern:
        with pytest.raises(UsageError, match="must have a separator between two fields"):
            NamePattern(pattern)
        return
    picture(tmp_path / f"{name}.png")
    (view,) = read_screenshots(tmp_path, at="eye", pattern=pattern)
    assert view.pose == GamePose(*POSE.values(), at="eye")
    assert view.pose_source.startswith("file name with pattern ")


@pytest.mark.parametrize(
    "texts",
    [
        [("add_text", key, str(value)) for key, value in POSE.items()],
        [("add_itxt", key.upper(), f" {value} ") for key, value in POSE.items()],
        [("add_text", "Comment", "X: 1.5, Y: 64, Z: -3.25; Yaw=90, pitch = 12.5")],
        [("add_text", "pose", json.dumps(POSE) + " " * 80)],
        [("add_itxt", "pose", json.dumps({"world": "höhe", **POSE}))],
    ],
)
def test_a_pngs_texts_tell_a_pose(tmp_path, texts):
    picture(tmp_path / "a.png", texts=texts)
    (view,) = read_screenshots(tmp_path, at="feet")
    assert view.pose == GamePose(*POSE.values(), at="feet") and view.pose_source == "PNG texts"


def test_pictures_come_in_the_order_of_their_names(tmp_path):
    for x in (3, 1, 2):
        picture(tmp_path / f"{x}_64_0_0_0.png")
    views = read_screenshots(tmp_path, at="eye")
    assert [view.pose.x for view in views] == [1, 2, 3]
    assert [view.frame for view in views] == [0, 1, 2]


def test_feet_are_lifted_by_a_player_of_the_worlds_scale(tmp_path):
    picture(tmp_path / "0_64_0_0_0.png")
    (feet,) = read_screenshots(tmp_path, at="feet")
    (eye,) = read_screenshots(tmp_path, at="eye")
    for scale in (1.0, 4.0):
        room = block_to_room(np.zeros(2), scale)
        up = feet.camera_to_room(room) - eye.camera_to_room(room)
        np.testing.assert_allclose(up[:3, 3], [0, 0, 1.62], atol=1e-12)


# What is refused, each in one line.


def test_feet_or_eye_must_be_said(tmp_path):
    with pytest.raises(TypeError):
        read_screenshots(tmp_path)  # type: ignore[call-arg]
    with pytest.raises(UsageError) as raised:
        read_screenshots(tmp_path, at="head")  # type: ignore[arg-type]
    assert one_line(raised) == (
        "at must be feet (as shown by F3 and most mods) or eye (1.62 above), got 'head'"
    )


def test_folders_without_pictures_or_poses(tmp_path):
    with pytest.raises(InputError, match="expected a folder of screenshots"):
        read_screenshots(tmp_path / "none", at="eye")
    with pytest.raises(InputError, match="contains no screenshots"):
        read_screenshots(tmp_path, at="eye")
    picture(tmp_path / "2026-01-05_11.22.33.png")
    with pytest.raises(InputError) as raised:
        read_screenshots(tmp_path, at="eye")
    text = one_line(raised)
    assert "no pose found in a sidecar file (poses.jsonl" in text
    assert "add a sidecar file or a pattern" in text
    with pytest.raises(UsageError, match="use only one of them"):
        read_screenshots(tmp_path, at="eye", poses="p.csv", pattern="{x}")
    with pytest.raises(InputError, match="read from file name with pattern"):
        read_screenshots(tmp_path, at="eye", pattern="{x}_{y}_{z}_{yaw}_{pitch}")


@pytest.mark.parametrize(
    ("row", "text"),
    [
        ({}, "without an image file name"),
        ({"image": "../a.png"}, "is not inside the folder"),
        ({"image": "/etc/passwd"}, "is not inside the folder"),
        ({"image": "C:\\a.png"}, "is not inside the folder"),
        ({"image": "b.png"}, "lists b.png, which does not exist"),
        ({"image": "a.png", "x": float("nan")}, "line 1 is not a valid pose"),
        ({"image": "a.png", "y": 1e12}, "line 1 is not a valid pose"),
        ({"image": "a.png", "pitch": 100}, "pitch must be -90 (up) to 90 (down)"),
        ({"image": "a.png", "at": "knee"}, "at must be 'feet' or 'eye', got 'knee'"),
        ({"image": "a.png", "vertical_fov_deg": "wide"}, "line 1 is not a valid pose"),
    ],
)
def test_lines_of_a_sidecar_that_cannot_be(tmp_path, row, text):
    picture(tmp_path / "a.png")
    (tmp_path / "poses.jsonl").write_text(json.dumps({**POSE, **row}))
    with pytest.raises((InputError, UsageError)) as raised:
        read_screenshots(tmp_path, at="feet")
    assert text in one_line(raised)


def test_a_picture_is_named_once(tmp_path):
    picture(tmp_path / "a.png")
    (tmp_path / "poses.jsonl").write_text(json.dumps({"image": "a.png", **POSE}) + "\n" * 2 +
                                          json.dumps({"image": "./a.png", **POSE}))  # fmt: skip
    with pytest.raises(DamagedFileError, match="twice"):
        read_screenshots(tmp_path, at="feet")


@pytest.mark.parametrize(
    ("pattern", "text"),
    [
        ("{x}_{y}_{z}", "does not contain yaw"),
        ("{x}_{x}_{y}_{z}_{yaw}_{pitch}", "contains {x} twice"),
        ("{x}_{height}", "contains the unknown field {height}; known: x, y, z, yaw, pitch"),
        ("*{x}*{y}*{z}_{yaw}_{pitch}", "may contain * at most 2 times"),
        ("a" * 500, "a pattern may have at most 400 characters, got 500"),
        (r"(?P<x>(\d+)+)_(?P<y>\d)", "contains nested repeats"),
        (r"(?P<x>\d+)(?=_)", "uses lookaround"),
        (r".*.*.*(?P<x>\d+)", "contains 3 wildcards"),
        (r"(?P<x>\d+", "is not a valid regular expression"),
        (r"(?P<x>aa|bc)", "branches"),
    ],
)
def test_patterns_that_are_refused(pattern, text):
    with pytest.raises(UsageError) as raised:
        NamePattern(pattern)
    assert text in one_line(raised)


def test_no_name_takes_long():
    began = time.perf_counter()
    regex = r".*?(?P<x>-?\d+)_(?P<y>\d+)_.*?(?P<z>\d+)_(?P<yaw>\d+)_(?P<pitch>\d+)"
    for pattern in ("*{x}_{y}_{z}_{yaw}_{pitch}", "*{x} *{y}_{z}_{yaw}_{pitch}", regex):
        for name in ("1_" * 127, "1" * 255, "-1.0_" * 51 + "a", " " * 255, "1" * 100_000):
            NamePattern(pattern).read(name)
    assert time.perf_counter() - began < 5


def test_pngs_that_cannot_be(tmp_path):
    path = tmp_path / "0_64_0_0_0.png"
    good = picture(path).read_bytes()
    cases = [
        (b"", "not a PNG file"),
        (b"GIF89a" * 9, "not a PNG file"),
        (good[:20], "the file is truncated"),
        (good[:-9], "the file is truncated"),
        (good[:8] + chunk(b"IDAT", b"x" * 13), "the header (IHDR) is missing"),
        (good[:18] + b"\xff" + good[19:], "wrong checksum in PNG chunk IHDR"),
    ]
    for data, text in cases:
        path.write_bytes(data)
        with pytest.raises(DamagedFileError) as raised:
            read_screenshots(tmp_path, at="eye")
        assert text in one_line(raised)
    raw(path, size=(1 << 30, 8))
    with pytest.raises(DamagedFileError, match="pixels, got 1073741824x8"):
        read_screenshots(tmp_path, at="eye")


def test_texts_are_bounded(tmp_path):
    path = tmp_path / "0_64_0_0_0.png"
    bomb = zlib.compress(b"0" * (1 << 24))
    for kind, body in ((b"zTXt", b"k\0\0" + bomb), (b"iTXt", b"k\0\1\0\0\0" + bomb)):
        raw(path, chunk(kind, body))
        with pytest.raises(LimitError, match=f"a text of more than {MAX_TEXT:,} bytes"):
            read_png_facts(path)
    raw(path, chunk(b"tEXt", b"k\0" + b"0" * (MAX_TEXT + 1)))
    with pytest.raises(LimitError, match="exceeds the limit of"):
        read_png_facts(path)
    raw(path, *[chunk(b"tEXt", b"k\0v")] * 65)
    with pytest.raises(LimitError, match="exceeds the limit of 64 texts"):
        read_png_facts(path)
    raw(path, chunk(b"zTXt", b"k\0\0no zlib"))
    with pytest.raises(DamagedFileError, match="cannot be decompressed"):
        read_png_facts(path)


def test_a_pose_told_twice_is_none(tmp_path):
    picture(tmp_path / "a.png", texts=[("add_text", "x", "1"), ("add_text", "note", "x=2")])
    with pytest.raises(DamagedFileError, match="contains two values for x in its PNG texts"):
        read_screenshots(tmp_path, at="eye")


@pytest.mark.parametrize("seed", range(200))
def test_random_bytes_are_read_or_refused(tmp_path, seed):
    rng = np.random.default_rng(seed)
    path = tmp_path / "0_64_0_0_0.png"
    data = bytearray(picture(path, texts=[("add_text", "x", "1")]).read_bytes())
    for at in rng.integers(0, len(data), 3):
        data[at] = rng.integers(256)
    path.write_bytes(bytes(data[: rng.integers(1, len(data))] if seed % 2 else data))
    try:
        read_screenshots(tmp_path, at="eye")
    except InputError as error:
        assert "\n" not in str(error)
