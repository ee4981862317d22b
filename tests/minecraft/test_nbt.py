import io
import re
import struct
import zlib

import nbtlib
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.minecraft.nbt import (
    Byte,
    Float,
    Long,
    NbtLimits,
    Short,
    pack_gzip,
    read_nbt,
    unpack,
    write_nbt,
)

single = st.floats(width=32, allow_nan=False)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
# One strategy a kind, because a list holds values of one kind.
SCALARS = {
    Byte: st.integers(-128, 127).map(Byte),
    Short: st.integers(-(2**15), 2**15 - 1).map(Short),
    int: st.integers(-(2**31), 2**31 - 1),
    Long: st.integers(-(2**63), 2**63 - 1).map(Long),
    Float: single.map(Float),
    float: st.floats(allow_nan=False),
    str: texts,
}
ARRAYS = [
    st.lists(st.integers(np.iinfo(kind).min, np.iinfo(kind).max), max_size=5).map(
        lambda values, kind=kind: np.array(values, kind)
    )
    for kind in (np.int8, np.int32, np.int64)
]


def wider(values):
    lists = [st.lists(kind, max_size=4) for kind in (*SCALARS.values(), *ARRAYS)]
    compounds = st.dictionaries(texts, values, max_size=4)
    return st.one_of(compounds, st.lists(compounds, max_size=3), *lists)


trees = st.dictionaries(
    texts, st.recursive(st.one_of(*SCALARS.values(), *ARRAYS), wider, max_leaves=12), max_size=5
)


def plain(value):
    """The value with its tag's type beside it, so that equality speaks of both."""
    if isinstance(value, np.ndarray):
        return (value.dtype.str, value.tolist())
    if isinstance(value, dict):
        return {key: plain(held) for key, held in value.items()}
    if isinstance(value, list):
        return [plain(held) for held in value]
    return (type(value).__name__, value)


def as_nbtlib(value):
    """What nbtlib's own value says, in our types."""
    kinds = {
        nbtlib.Byte: Byte,
        nbtlib.Short: Short,
        nbtlib.Int: int,
        nbtlib.Long: Long,
        nbtlib.Float: Float,
        nbtlib.Double: float,
        nbtlib.String: str,
    }
    for kind, ours in kinds.items():
        if isinstance(value, kind):
            return ours(value)
    if isinstance(value, dict):
        return {str(key): as_nbtlib(held) for key, held in value.items()}
    if isinstance(value, np.ndarray):
        return np.array(value).astype(value.dtype.newbyteorder("="))
    return [as_nbtlib(held) for held in value]


@given(trees, texts)
def test_a_tree_comes_back_as_it_was(tree, name):
    found_name, found = read_nbt(write_nbt(tree, name), "tree.nbt")
    assert found_name == name
    assert list(found) == list(tree)
    assert plain(found) == plain(tree)


@given(trees)
def test_nbtlib_reads_the_same_tree(tree):
    shown = "".join(map(str, plain(tree).items()))
    if not shown.isascii() or re.search(r"\\(x00|x[89a-f]|u|U)", shown):
        return  # nbtlib knows plain UTF-8 alone.
    found = nbtlib.File.parse(io.BytesIO(write_nbt(tree)))
    assert plain(as_nbtlib(dict(found))) == plain(tree)


@given(st.binary(max_size=200))
def test_random_bytes_are_refused_or_read(data):
    try:
        read_nbt(data, "random.nbt")
    except InputError as error:
        assert str(error).startswith("random.nbt: ")


@settings(max_examples=300)
@given(trees, st.data())
def test_a_damaged_tree_is_refused_or_read(tree, draw):
    data = bytearray(write_nbt(tree))
    for _ in range(draw.draw(st.integers(1, 3))):
        data[draw.draw(st.integers(0, len(data) - 1))] = draw.draw(st.integers(0, 255))
    try:
        read_nbt(bytes(data), "damaged.nbt", NbtLimits(values=10_000, depth=40))
    except (DamagedFileError, LimitError) as error:
        assert str(error).startswith("damaged.nbt: ")


@given(trees, st.data())
def test_a_tree_cut_short_is_refused(tree, draw):
    data = write_nbt(tree)
    with pytest.raises(DamagedFileError):
        read_nbt(data[: draw.draw(st.integers(0, len(data) - 1))], "short.nbt")


def nested(depth: int, kind: str) -> bytes:
    if kind == "list":
        return b"\x0a\0\0\x09\0\0" + b"\x09\0\0\0\x01" * depth + b"\0\0\0\0\0" + b"\0"
    return b"\x0a\0\0" * depth + b"\0" * depth


BOMBS = {
    "33 bytes of two billion nothings": b"\x0a\0\0\x09\0\x01a\0\x7f\xff\xff\xff\0" + bytes(20),
    "a list of two billion compounds": b"\x0a\0\0\x09\0\x01a\x0a\x7f\xff\xff\xff\0\0",
    "an array of two billion longs": b"\x0a\0\0\x0c\0\x01a\x7f\xff\xff\xff\0\0",
    "a negative array": b"\x0a\0\0\x0b\0\x01a\xff\xff\xff\xff\0",
    "ten thousand lists in each other": nested(10_000, "list"),
    "ten thousand compounds in each other": nested(10_000, "compound"),
    "a million empty compounds and more": (
        b"\x0a\0\0\x09\0\x01a\x0a" + struct.pack(">i", 4_000_000) + bytes(4_000_001)
    ),
    "a tag of no kind": b"\x0a\0\0\x0d\0\x01a\0\0",
    "a name twice": b"\x0a\0\0\x01\0\x01a\x05\x01\0\x01a\x06\0",
    "a list at the root": b"\x09\0\0\x01\0\0\0\0",
    "bytes after the end": b"\x0a\0\0\0\0",
    "a text that is no UTF-8": b"\x0a\0\0\x08\0\x01a\0\x02\xff\xfe\0",
    "nothing at all": b"",
}


@pytest.mark.parametrize("data", BOMBS.values(), ids=BOMBS.keys())
def test_a_bomb_is_refused_with_the_name_of_the_file(data):
    with pytest.raises((DamagedFileError, LimitError)) as caught:
        read_nbt(data, "bomb.nbt")
    assert str(caught.value).startswith("bomb.nbt: ")
    assert "\n" not in str(caught.value)


def test_what_the_errors_say():
    cases = {
        "nothing at all": "bomb.nbt: is not valid NBT: the root is not a compound tag (at byte 0)",
        "33 bytes of two billion nothings": "bomb.nbt: is not valid NBT: invalid list of 2147483647"
        " tags of type 0 (at byte 12)",
        "ten thousand compounds in each other": "bomb.nbt: exceeds the limit of 100 nested tags",
        "a million empty compounds and more": "bomb.nbt: exceeds the limit of 500,000 NBT values",
    }
    for name, text in cases.items():
        with pytest.raises(InputError) as caught:
            read_nbt(BOMBS[name], "bomb.nbt")
        assert str(caught.value) == text


def test_gzip_and_zlib_and_plain_bytes_unpack():
    import gzip
    import zlib

    data = write_nbt({"a": 1})
    for packed in (data, gzip.compress(data), zlib.compress(data), pack_gzip(data)):
        assert unpack(packed, "x") == data
    assert gzip.decompress(pack_gzip(data)) == data


def test_packed_bytes_do_not_depend_on_the_time():
    assert pack_gzip(b"room") == pack_gzip(b"room")
    assert pack_gzip(b"room")[4:8] == bytes(4)


def test_a_gzip_bomb_is_refused():
    packed = pack_gzip(bytes(20 << 20))
    with pytest.raises(LimitError, match=r"bomb.schem: exceeds the limit of 1,048,576 bytes"):
        unpack(packed, "bomb.schem", 1 << 20)


@pytest.mark.parametrize("change", ["cut", "flipped", "longer"])
def test_a_broken_gzip_stream_is_refused(change):
    packed = pack_gzip(bytes(range(256)) * 50)
    broken = {
        "cut": packed[:-20],
        "flipped": packed[:-6] + bytes([packed[-6] ^ 255]) + packed[-5:],
        "longer": packed + b"more",
    }[change]
    with pytest.raises(DamagedFileError, match=r"^file.dat: "):
        unpack(broken, "file.dat")


@pytest.mark.parametrize(
    "value",
    [Byte(128), Short(-40_000), 2**31, Long(2**63), Float(1e39), [1, "a"], None, "x" * 70_000],
    ids=str,
)
def test_a_value_without_a_tag_is_refused(value):
    with pytest.raises(UsageError):
        write_nbt({"value": value})


def test_java_writes_zeros_and_far_planes_in_its_own_way():
    data = write_nbt({"t": "\0😀"})
    assert b"\xc0\x80\xed\xa0\xbd\xed\xb8\x80" in data
    assert read_nbt(data, "x")[1] == {"t": "\0😀"}


@pytest.mark.parametrize("size", [0, 1, 65_535, (1 << 20) - 1, 1 << 20, (1 << 20) + 1, 5 << 20])
@pytest.mark.parametrize("kind", ["zeros", "noise", "both"])
def test_unpacking_gives_every_byte_of_any_size(size, kind):
    noise = np.random.default_rng(size).bytes(size)
    data = {"zeros": bytes(size), "noise": noise, "both": (noise[: size // 2] + bytes(size))[:size]}
    for packed in (pack_gzip(data[kind]), zlib.compress(data[kind], 9)):
        assert unpack(packed, "file") == data[kind]
        with pytest.raises(DamagedFileError, match="ends too early"):
            unpack(packed[:-1], "file")
        with pytest.raises(DamagedFileError, match="bytes after its end"):
            unpack(packed + b"x", "file")
        if size:
            with pytest.raises(LimitError, match="exceeds the limit of"):
                unpack(packed, "file", size - 1)
