"""Stored light and heightmaps, read by nbtlib and bits of our own, against a slow reference."""

import io

import nbtlib
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.minecraft.block_volumes import volume_of
from tests.rendering.light_worlds import PALETTE, random_world
from tests.rendering.test_render_light_flood import slow_light

from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.anvil import read_region
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

STONE, LANTERN, LEAVES = "minecraft:stone", "minecraft:lantern", "minecraft:oak_leaves"
NAMES = ("MOTION_BLOCKING", "MOTION_BLOCKING_NO_LEAVES", "OCEAN_FLOOR", "WORLD_SURFACE")


def chunks_of(volume: BlockVolume, folder, name: str = "1.20.1") -> dict[tuple[int, int], dict]:
    """Write a world and return its chunks by place as nbtlib reads them."""
    version = game_version(name)
    write_world(volume, folder, name="x", spawn=(0, 64, 0), spawn_yaw_deg=0, version=version)
    files = sorted((folder / "region").glob("r.*.mca"))
    read = {}
    for file in files:
        for place, data in read_region(file):
            root = nbtlib.File.parse(io.BytesIO(data))
            read[place] = root.get("Level", root)
    return read


def levels_of(chunk: dict, kind: str) -> dict[tuple[int, int, int], int]:
    """Return the stored light of a chunk by cell: x and z in the chunk, y in the world."""
    found = {}
    for section in chunk.get("sections", chunk.get("Sections")):
        if kind in section:
            data = np.array(section[kind]).astype(np.int64) & 255
            for index in range(4096):
                level = data[index // 2] >> (4 * (index % 2)) & 15
                y, z, x = index // 256, index // 16 % 16, index % 16
                found[x, int(section["Y"]) * 16 + y, z] = int(level)
    return found


def height_of(words, x: int, z: int, is_gapless: bool = True) -> int:
    """Return a height by the bits of the words, as one long number."""
    index = z * 16 + x
    values = [int(word) & (1 << 64) - 1 for word in words]
    if is_gapless:
        return values[index // 7] >> (index % 7 * 9) & 511
    return sum(v << (64 * n) for n, v in enumerate(values)) >> (9 * index) & 511


def with_surroundings(states: np.ndarray, low_y: int) -> tuple[np.ndarray, int]:
    """Return the states of a chunk's sections, one below and one above those of a volume."""
    first, last = (low_y >> 4) - 1, (low_y + states.shape[1] - 1 >> 4) + 1
    whole = np.zeros((16, 16 * (last - first + 1), 16), np.uint16)
    y = low_y - 16 * first
    whole[3 : 3 + states.shape[0], y : y + states.shape[1], 2 : 2 + states.shape[2]] = states
    return whole, 16 * first


@pytest.mark.parametrize("seed", range(4))
def test_light_is_that_of_a_slow_reference(seed, tmp_path):
    states, low_y = random_world(seed), (64, 59, -3, 70)[seed]
    chunk = chunks_of(volume_of(states, PALETTE, (3, low_y, 2)), tmp_path / "w")[0, 0]
    assert chunk["isLightOn"] == 1
    whole, start = with_surroundings(states, low_y)
    for kind, tag in (("sky", "SkyLight"), ("block", "BlockLight")):
        expected, stored = slow_light(whole, kind), levels_of(chunk, tag)
        default = 15 if kind == "sky" else 0
        for x, y, z in np.ndindex(whole.shape):
            assert stored.get((x, y + start, z), default) == expected[x, y, z], (kind, x, y, z)


def test_a_closed_room_is_lit_by_its_lamp_alone(tmp_path):
    states = np.ones((9, 5, 9), np.uint16)
    states[1:8, 1:4, 1:8] = 0
    states[4, 2, 4] = 2
    chunk = chunks_of(volume_of(states, (AIR, STONE, LANTERN), (0, 64, 0)), tmp_path / "w")[0, 0]
    sky, block = levels_of(chunk, "SkyLight"), levels_of(chunk, "BlockLight")
    assert [block[x, 66, 4] for x in range(4, 9)] == [15, 14, 13, 12, 0]
    assert (block[7, 67, 7], block[12, 66, 4]) == (8, 0)
    assert {sky[x, y, z] for x in range(1, 8) for y in range(65, 68) for z in range(1, 8)} == {0}
    assert (sky[12, 66, 4], sky[4, 69, 4], sky[4, 68, 4]) == (15, 15, 0)
    # Below the floor, light comes from the sides: 9 blocks wide, from all four of them.
    assert [sky[x, 63, 4] for x in range(10)] == [14, 13, 12, 11, 10, 11, 12, 13, 14, 15]
    assert sky[4, 48, 4] == 10


def test_a_section_below_and_one_above_are_stored(tmp_path):
    states = np.ones((16, 16, 16), np.uint16)
    states[8, 15, 8] = 2
    chunk = chunks_of(volume_of(states, (AIR, STONE, LANTERN), (0, 64, 0)), tmp_path / "w")[0, 0]
    stored = {int(s["Y"]): {*s} & {"SkyLight", "BlockLight"} for s in chunk["sections"]}
    assert stored == {3: {"SkyLight"}, 4: {"SkyLight", "BlockLight"}, 5: {"BlockLight"}}
    assert levels_of(chunk, "BlockLight")[8, 80, 8] == 14
    low = chunks_of(volume_of(states, (AIR, STONE, LANTERN), (0, -64, 0)), tmp_path / "low")[0, 0]
    assert [int(section["Y"]) for section in low["sections"]] == [-5, -4, -3]
    assert "block_states" not in low["sections"][0]  # It lies below the world.


COLUMNS = {  # What lies on stone at y 64, and the four heights above the bottom layer.
    (): (129, 129, 129, 129),
    ("minecraft:red_carpet",): (129, 129, 129, 130),
    ("minecraft:oak_slab[type=bottom]",): (130, 130, 130, 130),
    ("minecraft:oak_trapdoor[open=false]",): (130, 130, 130, 130),
    ("minecraft:water",): (130, 130, 129, 130),
    ("minecraft:rail[waterlogged=true]",): (130, 130, 129, 130),
    (LEAVES,): (130, 129, 130, 130),
    (LEAVES, "minecraft:torch"): (130, 129, 130, 131),
    (AIR, "minecraft:oak_fence", AIR): (131, 131, 131, 131),
    ("minecraft:oak_sign", "minecraft:ladder"): (130, 130, 130, 131),
    ("minecraft:snow[layers=8]",): (129, 129, 129, 130),
}


@pytest.mark.parametrize("name", ["1.15.2", "1.16.5", "1.20.1"])
def test_heights_are_those_of_columns_by_hand(name, tmp_path):
    palette = (AIR, STONE, *sorted({s for column in COLUMNS for s in column} - {AIR}))
    states = np.zeros((16, 5, len(COLUMNS) + 1), np.uint16)
    for z, column in enumerate(COLUMNS):
        states[5, 0, z] = 1
        for y, state in enumerate(column):
            states[5, 1 + y, z] = palette.index(state)
    chunk = chunks_of(volume_of(states, palette, (0, 64, 0)), tmp_path / "w", name)[0, 0]
    lowest = game_version(name).min_y
    maps = chunk["Heightmaps"]
    assert sorted(maps) == list(NAMES)
    assert {len(words) for words in maps.values()} == {36 if name == "1.15.2" else 37}
    for z, heights in enumerate(COLUMNS.values()):
        found = [height_of(maps[one], 5, z, name != "1.15.2") for one in NAMES]
        assert found == [height - 64 - lowest for height in heights]
    assert height_of(maps["WORLD_SURFACE"], 5, len(COLUMNS), name != "1.15.2") == 0
    assert height_of(maps["WORLD_SURFACE"], 4, 0, name != "1.15.2") == 0


@settings(max_examples=10)
@given(st.integers(0, 10_000), st.integers(-40, 40), st.integers(-30, 200), st.integers(-40, 40))
def test_worlds_with_light_come_back(tmp_path_factory, seed, x, y, z):
    folder = tmp_path_factory.mktemp("light")
    volume = volume_of(random_world(seed, most=20), PALETTE, (x, y, z))
    chunks = chunks_of(volume, folder / "w")
    again = read_world(folder / "w", box=(x, y, z, *np.add((x, y, z), volume.states.shape)))
    texts = [np.array(v.palette, object)[v.states] for v in (again, volume)]
    assert [text.split("[")[0] for text in texts[0].flat] == [
        text.split("[")[0] for text in texts[1].flat
    ]
    top = {}
    for cx, cy, cz in np.argwhere(volume.states > 0).tolist():
        top[cx, cz] = cy
    for (cx, cz), cy in top.items():
        words = chunks[(x + cx) >> 4, (z + cz) >> 4]["Heightmaps"]["WORLD_SURFACE"]
        assert height_of(words, (x + cx) & 15, (z + cz) & 15) == y + cy + 1 + 64
