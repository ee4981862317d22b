"""Pictures as files: what is written comes back by readers that are not ours."""

import io
import struct
import zlib

import numpy as np
import OpenEXR
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from PIL import Image
from scenes import CAMERA, random_pose, random_volume

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.rendering import render_volume
from world2minecraft.rendering.output import (
    LAYERS,
    FileFormats,
    colour_bytes,
    depth_bytes,
    exr_bytes,
    file_name,
    id_names,
    index_bytes,
    number_bytes,
    parse_layers,
    required_outputs,
)

depths = hnp.arrays(
    np.float32,
    hnp.array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=40),
    elements=st.one_of(st.just(0.0), st.floats(1 / 1024, 60, width=32)),
)


def image(data):
    return Image.open(io.BytesIO(data))


def slow_exr(data):
    """Channels of an EXR, read byte by byte after the format's description."""
    assert struct.unpack_from("<ii", data) == (20000630, 2)
    at, header = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), end + 1
        at = data.index(b"\0", at) + 1
        (size,) = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    names = [part[-1] for part in header["channels"].split(b"\0") if part[-1:].isalpha()]
    _, _, right, lowest = struct.unpack("<iiii", header["dataWindow"])
    lines = 16 if header["compression"] == b"\3" else 1
    result = np.zeros((len(names), lowest + 1, right + 1), np.float32)
    for n in range(-(-(lowest + 1) // lines)):
        (place,) = struct.unpack_from("<Q", data, at + 1 + 8 * n)
        top, size = struct.unpack_from("<ii", data, place)
        block = data[place + 8 : place + 8 + size]
        rows = min(lines, lowest + 1 - top)
        raw = rows * len(names) * (right + 1) * 4
        if size < raw:
            steps = zlib.decompress(block)
            parted = [steps[0]]
            for step in steps[1:]:
                parted.append((parted[-1] + step - 128) % 256)
            half = (raw + 1) // 2
            whole = [parted[k // 2 + (k % 2) * half] for k in range(raw)]
            block = bytes(whole)
        values = np.frombuffer(block, "<f4").reshape(rows, len(names), right + 1)
        result[:, top : top + rows] = values.transpose(1, 0, 2)
    return result


@settings(deadline=None, max_examples=25)
@given(depths, st.booleans())
def test_an_exr_is_what_its_description_says(depth, compress):
    data = exr_bytes({"Z": depth, "A": -depth}, compress=compress)
    assert np.array_equal(slow_exr(data), [-depth, depth])


@pytest.mark.parametrize("compress", [True, False])
def test_an_exr_is_read_by_openexr(tmp_path, compress):
    depth = np.linspace(0, 9, 37 * 23, dtype=np.float32).reshape(37, 23)
    depth[5:20] = 2.5
    path = tmp_path / "z.exr"
    path.write_bytes(exr_bytes({"Z": depth}, compress=compress, notes={"comments": "metres"}))
    file = OpenEXR.File(str(path), separate_channels=True)
    assert np.array_equal(file.channels()["Z"].pixels, depth)
    assert file.header()["comments"] == "metres"


def test_an_exr_needs_channels_of_one_size():
    with pytest.raises(ValueError, match="of the same size"):
        exr_bytes({"Z": np.zeros((2, 3), np.float32), "A": np.zeros((3, 2), np.float32)})


@given(depths)
def test_depth_is_kept_to_half_a_millimetre(depth):
    back = np.asarray(image(depth_bytes(depth, ".png"))).astype(np.float64) / 1000
    assert np.array_equal(back == 0, depth == 0)
    np.testing.assert_allclose(back[depth > 0], depth[depth > 0], atol=0.5001e-3)


def test_depth_png_saturates_and_keeps_near_depths_nonzero():
    depth = np.array([[0, 1e-5, 65.0, 70.0]], np.float32)
    assert np.asarray(image(depth_bytes(depth, ".png"))).tolist() == [[0, 1, 65000, 65535]]
    assert np.asarray(image(depth_bytes(depth, ".png", 500))).tolist() == [[0, 1, 32500, 35000]]


def test_depth_npy_is_exact():
    depth = np.array([[0, 1.25]], np.float32)
    assert np.array_equal(np.load(io.BytesIO(depth_bytes(depth, ".npy"))), depth)


@given(hnp.arrays(np.int32, (3, 4), elements=st.integers(-1, 2**31 - 1)))
def test_an_index_comes_back_from_rgba(index):
    packed = np.asarray(image(index_bytes(index)))
    assert np.array_equal(packed.view("<u4")[..., 0].astype(np.int64) - 1, index)
    red, green, blue, alpha = packed.astype(np.int64).transpose(2, 0, 1)
    assert np.array_equal(red + 256 * green + 65536 * blue + 16777216 * alpha - 1, index)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_numbers_come_back_from_grey(dtype):
    numbers = np.array([[0, 7, np.iinfo(dtype).max]], dtype)
    assert np.array_equal(np.asarray(image(number_bytes(numbers))), numbers)


def test_colour_is_exact_in_png_and_in_webp_at_full_quality():
    colour = np.random.default_rng(0).integers(0, 256, (12, 16, 3), np.uint8)
    for suffix in (".png", ".webp"):
        assert np.array_equal(np.asarray(image(colour_bytes(colour, suffix, 100))), colour)
    smooth = np.repeat(np.arange(0, 240, 15, dtype=np.uint8)[None, :, None], 12, 0).repeat(3, 2)
    back = np.asarray(image(colour_bytes(smooth, ".jpg", 95))).astype(int)
    assert np.abs(back - smooth).max() < 8


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: colour_bytes(np.zeros((1, 1, 3), np.uint8), ".bmp"),
         "a colour image must end in .png, .jpg, .jpeg, .webp, got '.bmp'"),
        (lambda: depth_bytes(np.zeros((1, 1), np.float32), ".jpg"),
         "a depth image must end in .png, .exr, .npy, got '.jpg'"),
    ],
)  # fmt: skip
def test_another_suffix_is_told(make, text):
    with pytest.raises(UsageError) as told:
        make()
    assert str(told.value) == text


# Layers.


def test_lists_of_layers_are_read_in_their_order_each_once():
    assert parse_layers("depth, RGB,id,class") == ("depth", "rgb", "state", "class", "instance")
    assert parse_layers("all") == tuple(LAYERS)
    with pytest.raises(UnknownNameError, match="no output is named 'dept'; did you mean 'depth'"):
        parse_layers("rgb,dept")
    with pytest.raises(UnknownNameError, match="no output is named ','"):
        parse_layers(",")


def test_all_layers_of_a_picture_come_back():
    rng = np.random.default_rng(6)
    volume = random_volume(rng)
    picture = render_volume(
        volume, CAMERA, random_pose(rng, volume), outputs=required_outputs(parse_layers("all"))
    )
    choice = FileFormats(depth_suffix=".npy")
    data = {name: layer.make(picture, volume, choice) for name, layer in LAYERS.items()}
    met = picture.block_index >= 0
    assert np.array_equal(np.asarray(image(data["rgb"])), picture.colour)
    assert np.array_equal(np.load(io.BytesIO(data["depth"])), picture.depth_m)
    assert np.array_equal(np.load(io.BytesIO(data["range"])), picture.range_m)
    states = np.asarray(image(data["state"]))
    assert np.array_equal(states[met], volume.states.reshape(-1)[picture.block_index[met]])
    assert (states[~met] == 0).all()
    for name, values in (("class", picture.semantic), ("instance", picture.instance),
                         ("face", picture.face)):  # fmt: skip
        assert np.array_equal(np.asarray(image(data[name])), values)


def test_layers_have_their_files():
    choice = FileFormats(colour_suffix=".jpg", depth_suffix=".exr")
    assert [file_name("000001", name, choice) for name in ("rgb", "depth", "range", "class")] == [
        "000001.jpg", "000001.depth.exr", "000001.range.exr", "000001.class.png",
    ]  # fmt: skip


def test_the_table_says_what_numbers_mean():
    volume = random_volume(np.random.default_rng(1))
    table = id_names(volume)
    assert table["state"]["0"] == "minecraft:air"
    assert table["state"]["6"] == "minecraft:red_concrete"
    assert table["class"]["5"] == "chair"
    assert table["block"]["size"] == [9, 7, 8]
