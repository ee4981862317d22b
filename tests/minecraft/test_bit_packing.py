import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.minecraft.bit_packing import (
    pack_section,
    read_varints,
    skip_text_compounds,
    unpack_section,
    write_varints,
)


def packed_slowly(cells: list[int]) -> tuple[list[int], list[int]]:
    """A section's palette and words by the text of the format: no value across two words."""
    palette = list(dict.fromkeys(cells))
    if len(palette) == 1:
        return palette, []
    bits = max(4, (len(palette) - 1).bit_length())
    words, word, shift = [], 0, 0
    for cell in cells:
        if shift + bits > 64:
            words.append(word)
            word, shift = 0, 0
        word |= palette.index(cell) << shift
        shift += bits
    return palette, [*words, word]


def varint_slowly(value: int) -> bytes:
    out = []
    while value >= 128:
        out.append(value % 128 + 128)
        value //= 128
    return bytes([*out, value])


@pytest.mark.parametrize("kinds", [1, 2, 3, 16, 17, 33, 65, 300, 4096])
def test_a_section_is_packed_as_the_format_says(kinds):
    rng = np.random.default_rng(kinds)
    states = rng.permutation(np.arange(4096) % kinds).astype(np.uint16).reshape(16, 16, 16)
    palette, words = np.zeros(4096, np.uint16), np.zeros(1024, np.uint64)
    numbers = np.full(kinds, -1, np.int32)
    count, used = pack_section(states, np.zeros(3, np.int64), numbers, palette, words)
    cells = [int(states[x, y, z]) for y in range(16) for z in range(16) for x in range(16)]
    assert (palette[:count].tolist(), words[:used].tolist()) == packed_slowly(cells)
    assert (numbers == -1).all()
    back = np.full((16, 16, 16), 9999, np.uint16)
    assert unpack_section(words[:used], palette[:count], back, np.zeros(3, np.int64))
    np.testing.assert_array_equal(back, states)


@pytest.mark.parametrize("origin", [(-5, -9, -12), (3, 4, 5), (-16, 0, 0), (20, 20, 20)])
def test_a_section_that_hangs_over_the_volume_has_air_there(origin):
    rng = np.random.default_rng(1)
    states = rng.integers(0, 5, (10, 11, 12)).astype(np.uint16)
    palette, words = np.zeros(4096, np.uint16), np.zeros(1024, np.uint64)
    at = np.array(origin, np.int64)
    count, used = pack_section(states, at, np.full(5, -1, np.int32), palette, words)
    section = np.zeros((16, 16, 16), np.uint16)
    unpack_section(words[:used], palette[:count], section, np.zeros(3, np.int64))
    for cell in np.ndindex(16, 16, 16):
        place = tuple(np.add(origin, cell))
        inside = all(0 <= p < size for p, size in zip(place, states.shape, strict=True))
        assert section[cell] == (states[place] if inside else 0)
    back = np.zeros_like(states)
    unpack_section(words[:used], palette[:count], back, at)
    low = np.clip(at, 0, states.shape)
    high = np.clip(at + 16, 0, states.shape)
    window = tuple(map(slice, low, high))
    np.testing.assert_array_equal(back[window], states[window])
    assert back.sum() == back[window].sum()


def test_a_cell_outside_the_palette_is_told():
    words = np.full(256, np.uint64(0xFFFF_FFFF_FFFF_FFFF))
    out = np.zeros((16, 16, 16), np.uint16)
    assert not unpack_section(words, np.zeros(3, np.uint16), out, np.zeros(3, np.int64))


@given(st.lists(st.integers(0, 65_535), max_size=50))
def test_varints_are_leb128_and_come_back(values):
    out = np.zeros(3 * len(values), np.uint8)
    data = out[: write_varints(np.array(values, np.uint16), out)]
    assert data.tobytes() == b"".join(map(varint_slowly, values))
    back = np.zeros((1, 1, len(values)), np.uint16)
    same = np.arange(65_536, dtype=np.int32)
    assert read_varints(data, same, back) == len(data)
    assert back.ravel().tolist() == values


@pytest.mark.parametrize("shape", [(3, 70, 5), (1, 129, 2), (2, 64, 3), (4, 1, 130)])
def test_varints_fill_any_box_in_their_order(shape):
    values = np.random.default_rng(0).integers(0, 65_536, shape).astype(np.uint16)
    out = np.zeros(3 * values.size, np.uint8)
    data = out[: write_varints(values.ravel(), out)]
    back = np.zeros((shape[2], shape[0], shape[1]), np.uint16).transpose(1, 2, 0)
    assert read_varints(data, np.arange(65_536, dtype=np.int32), back) == len(data)
    np.testing.assert_array_equal(back, values)


def test_broken_varints_are_told():
    back, lookup = np.zeros((1, 1, 1), np.uint16), np.array([0, -1, 7], np.int32)
    for data, code in (([0x80], -1), ([0x80] * 9, -2), ([1], -4), ([3], -6), ([2], 1)):
        assert read_varints(np.array(data, np.uint8), lookup, back) == code
    assert back.ravel().tolist() == [7]


@given(st.binary(max_size=60), st.integers(0, 4))
def test_skipping_never_leaves_the_bytes(data, count):
    ends = np.zeros(count, np.int64)
    held = np.frombuffer(data, np.uint8)
    if skip_text_compounds(held, 0, ends):
        assert (ends <= len(data)).all()
