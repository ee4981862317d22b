"""The ways to pack a chunk: each that the game has, LZ4 against known values of its checksum."""

import gzip
import shutil
import struct
import zlib

import lz4.block
import numpy as np
import pytest
from block_volumes import random_volume, state_texts
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.minecraft.nbt import write_nbt
from world2minecraft.minecraft.worlds.anvil import (
    COMPRESSIONS,
    MAX_CHUNK_BYTES,
    SECTOR,
    checksum,
    pack_lz4,
    pack_region,
    read_region,
    unpack_lz4,
    xxhash32,
)
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

each_way = pytest.mark.parametrize("compression", COMPRESSIONS)


@each_way
def test_a_region_comes_back_however_it_is_packed(compression, tmp_path):
    chunks = {(x, 0): write_nbt({"x": x, "blocks": np.zeros(900 * x, np.int64)}) for x in range(4)}
    data, outside = pack_region(chunks, compression=compression)
    path = tmp_path / "r.0.0.mca"
    path.write_bytes(data)
    assert not outside
    assert dict(read_region(path)) == chunks
    assert {data[2 * SECTOR + 4]} == {COMPRESSIONS[compression]}


@each_way
def test_a_chunk_over_a_mebibyte_lies_in_a_file_of_its_own(compression, tmp_path):
    noise = np.random.default_rng(0).integers(-(2**62), 2**62, 200_000)
    big, small = write_nbt({"noise": noise}), write_nbt({"a": 1})
    data, outside = pack_region({(33, -1): big, (34, -1): small}, compression=compression)
    (tmp_path / "r.1.-1.mca").write_bytes(data)
    assert list(outside) == ["c.33.-1.mcc"]
    (tmp_path / "c.33.-1.mcc").write_bytes(outside["c.33.-1.mcc"])
    assert dict(read_region(tmp_path / "r.1.-1.mca")) == {(33, -1): big, (34, -1): small}


def test_the_packed_bytes_are_what_their_names_say():
    data = write_nbt({"a": np.arange(99)})

    def body(compression: str) -> bytes:
        whole = pack_region({(0, 0): data}, compression=compression)[0][2 * SECTOR :]
        return whole[5 : 4 + struct.unpack(">I", whole[:4])[0]]

    assert gzip.decompress(body("gzip")) == zlib.decompress(body("zlib")) == body("none") == data
    packed = body("lz4")
    magic, how, packed_size, size, stated = struct.unpack_from("<8sBiiI", packed)
    assert (magic, how, size, stated) == (b"LZ4Block", 0x26, len(data), checksum(data))
    block = packed[21 : 21 + packed_size]
    assert lz4.block.decompress(block, uncompressed_size=size) == data
    assert packed[21 + packed_size :] == b"LZ4Block" + bytes([0x16]) + bytes(12)


def test_an_unknown_compression_is_refused():
    with pytest.raises(
        UsageError, match="compression must be one of gzip, zlib, none, lz4, got 'zstd'"
    ):
        pack_region({}, compression="zstd")


@each_way
def test_a_world_reads_the_same_however_it_is_packed(compression, tmp_path):
    volume = random_volume((20, 9, 20), 30, (0, 60, 0))
    folder = tmp_path / "world"
    write_world(volume, folder, name="x", spawn=(0, 64, 0), spawn_yaw_deg=0)
    path = folder / "region" / "r.0.0.mca"
    path.write_bytes(pack_region(dict(read_region(path)), compression=compression)[0])
    np.testing.assert_array_equal(state_texts(read_world(folder)), state_texts(volume))


def test_both_places_of_the_regions_are_looked_into(tmp_path):
    volume = random_volume((5, 5, 5), 3, (0, 60, 0))
    folder = tmp_path / "world"
    write_world(volume, folder, name="x", spawn=(0, 64, 0), spawn_yaw_deg=0)
    moved = folder / "dimensions" / "minecraft" / "overworld"
    moved.mkdir(parents=True)
    shutil.move(folder / "region", moved / "region")
    (folder / "region").mkdir()  # Left behind empty by the game's upgrade.
    np.testing.assert_array_equal(state_texts(read_world(folder)), state_texts(volume))


def one_chunk(kind: int, packed: bytes) -> bytes:
    record = struct.pack(">IB", len(packed) + 1, kind) + packed
    record += bytes(-len(record) % SECTOR)
    head = np.zeros(2048, ">u4")
    head[0] = 2 << 8 | len(record) // SECTOR
    return head.tobytes() + record


def read_one(tmp_path, kind: int, packed: bytes) -> bytes:
    (tmp_path / "r.0.0.mca").write_bytes(one_chunk(kind, packed))
    ((_, data),) = read_region(tmp_path / "r.0.0.mca")
    return data


def test_a_servers_own_way_is_named(tmp_path):
    name = b"example:zstd"
    with pytest.raises(
        InputError, match="uses the custom compression 'example:zstd', which is not"
    ):
        read_one(tmp_path, 127, len(name).to_bytes(2, "big") + name + b"...")
    with pytest.raises(InputError, match="uses compression type 127, which is not supported"):
        read_one(tmp_path, 127, b"")
    with pytest.raises(InputError, match="uses compression type 9, which is not supported"):
        read_one(tmp_path, 9, b"data")


# LZ4.

# From the algorithm's own test vectors and widely published values.
HASHES = [
    (b"", 0, 0x02CC5D05),
    (b"", 0x9E3779B1, 0x36B78AE7),
    (b"a", 0, 0x550D7456),
    (b"abc", 0, 0x32D153FF),
    (b"Nobody inspects the spammish repetition", 0, 0xE2293B2F),
]


@pytest.mark.parametrize(("data", "seed", "expected"), HASHES)
def test_the_checksum_is_xxhash32(data, seed, expected):
    assert xxhash32(np.frombuffer(data, np.uint8), np.uint32(seed)) == expected


@given(st.binary(max_size=300), st.integers(0, 3))
def test_lz4_comes_back(data, times):
    whole = data * 10**times
    assert unpack_lz4(pack_lz4(whole), "file", len(whole)) == whole


def test_blocks_that_do_not_shrink_lie_as_they_are():
    noise = np.random.default_rng(0).bytes(100_000)
    packed = pack_lz4(noise)
    assert packed[8] == packed[8 + 21 + 65536] == 0x16
    assert unpack_lz4(packed, "file", 1 << 20) == noise


GOOD = pack_lz4(b"chunk " * 2000)


def changed(at: int, value: bytes) -> bytes:
    return GOOD[:at] + value + GOOD[at + len(value) :]


DAMAGED = {
    "nothing": (b"", "contains an LZ4 stream that ends too early"),
    "no end": (GOOD[:-21], "contains an LZ4 stream that ends too early"),
    "bytes after the end": (GOOD + b"x", "contains extra bytes after the end of an LZ4 stream"),
    "no mark": (changed(0, b"ZL"), "contains an LZ4 block with an invalid signature"),
    "an unknown method": (changed(8, b"\x36"), "does not match its checksum"),
    "a checksum of another": (changed(17, b"\1"), "does not match its checksum"),
    "a size too long": (changed(9, b"\xff\xff\xff\x7f"), "an LZ4 block with an invalid size"),
    "a negative size": (changed(9, b"\xff\xff\xff\xff"), "an LZ4 block with an invalid size"),
    "larger than a block may be": (changed(8, b"\x20"), "an LZ4 block with an invalid size"),
    "a broken block": (changed(21, b"\xff\xff\xff"), "contains a damaged LZ4 block"),
}


@pytest.mark.parametrize(("data", "reason"), DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_lz4_stream_is_refused_by_name(data, reason):
    with pytest.raises(DamagedFileError) as caught:
        unpack_lz4(data, "file.mca", 1 << 20)
    assert str(caught.value).startswith("file.mca: ") and reason in str(caught.value)


def test_an_lz4_bomb_is_refused():
    with pytest.raises(LimitError, match="exceeds the limit of 100 bytes after decompression"):
        unpack_lz4(GOOD, "file.mca", 100)
    block = struct.pack("<8sBiiI", b"LZ4Block", 0x2F, 10, 1 << 25, 0) + bytes(10)
    with pytest.raises(LimitError):
        unpack_lz4(block, "file.mca", MAX_CHUNK_BYTES)


def test_a_chunk_of_lz4_that_is_broken_is_refused_by_name(tmp_path):
    with pytest.raises(
        DamagedFileError, match="r.0.0.mca: contains an LZ4 stream that ends too early"
    ):
        read_one(tmp_path, 4, GOOD[:-5])
