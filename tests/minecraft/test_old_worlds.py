"""Worlds of 1.13 to 1.19: written, and read by a second reader made from the format's pages."""

from pathlib import Path

import anvil
import nbtlib
import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of

from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.bit_packing import (
    pack_straddled,
    repack_section_words,
    straddle_section_words,
    straddled_word_count,
    word_count,
)
from world2minecraft.minecraft.block_renames import (
    count_mod_blocks,
    count_unknown_blocks,
    is_unknown,
    read_state,
    write_state,
)
from world2minecraft.minecraft.commands.datapack import write_datapack
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import Byte, read_nbt, write_nbt
from world2minecraft.minecraft.versions import game_version, game_versions, old_versions
from world2minecraft.minecraft.worlds.anvil import pack_region, read_region
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

VOLUME = random_volume((40, 20, 37), 1, (-20, 50, -5), seed=1)
OLD = ("1.13", "1.13.2", "1.14.4", "1.15.2", "1.16", "1.16.5", "1.17.1", "1.18.2", "1.19.4")
MANY = volume_of(
    np.arange(40 * 20 * 37).reshape(40, 20, 37) % 1000,
    (AIR, *(f"mod:block_{number}" for number in range(999))),
    (-20, 50, -5),
)


def write(volume, folder: Path, name: str) -> Path:
    spawn = {"spawn": (1.5, 64.0, -2.5), "spawn_yaw_deg": 90.0}
    write_world(volume, folder, name="A room", version=game_version(name), **spawn)
    return folder


def chunk_texts_slowly(data: bytes) -> dict[tuple[int, int, int], str]:
    """The blocks of an old chunk that are not air, read by nbtlib and one long number."""
    import io

    root = nbtlib.File.parse(io.BytesIO(data))
    version, level = int(root["DataVersion"]), root["Level"]
    found = {}
    for section in level["Sections"]:
        names = []
        if "Palette" not in section:
            continue  # It holds light alone.
        for entry in section["Palette"]:
            pairs = sorted(f"{k}={v}" for k, v in entry.get("Properties", {}).items())
            names.append(str(entry["Name"]) + (f"[{','.join(pairs)}]" if pairs else ""))
        words = [int(word) & (1 << 64) - 1 for word in section["BlockStates"]]
        bits = max(4, (len(names) - 1).bit_length())
        whole = sum(word << (64 * at) for at, word in enumerate(words)) if version < 2529 else 0
        for index in range(4096):
            if version < 2529:
                number = whole >> (index * bits) & ((1 << bits) - 1)
            else:
                word, place = divmod(index, 64 // bits)
                number = words[word] >> (place * bits) & ((1 << bits) - 1)
            if names[number] != AIR:
                y, rest = divmod(index, 256)
                place = (rest % 16, y + 16 * int(section["Y"]), rest // 16)
                found[place] = names[number]
    return found


@pytest.mark.parametrize("name", OLD)
@pytest.mark.parametrize("volume", [VOLUME, MANY], ids=["few states", "a thousand states"])
def test_a_world_for_an_old_game_comes_back(volume, name, tmp_path):
    found = read_world(write(volume, tmp_path / "world", name))
    texts = state_texts(volume)
    cut = tuple(slice(a - b, None) for a, b in zip(found.corner, volume.corner, strict=True))
    size = found.states.shape
    cut = tuple(slice(c.start, c.start + n) for c, n in zip(cut, size, strict=True))
    np.testing.assert_array_equal(state_texts(found), texts[cut])
    assert (texts != AIR).sum() == (found.states > 0).sum()


@pytest.mark.parametrize("name", ["1.13.2", "1.15.2", "1.16.5"])
def test_another_reader_finds_the_same_blocks(name, tmp_path):
    volume = random_volume((16, 20, 16), 40, (0, 50, 0), seed=3)
    volume = volume_of(volume.states, (AIR, *(f"mod:b{n}" for n in range(1, 60))), (0, 50, 0))
    folder = write(volume, tmp_path / "world", name) / "region"
    ((_, data),) = read_region(folder / "r.0.0.mca")
    texts = state_texts(volume)
    expected = {
        (x, y + 50, z): texts[x, y, z]
        for x, y, z in np.ndindex(texts.shape)
        if texts[x, y, z] != AIR
    }
    assert chunk_texts_slowly(data) == expected


@pytest.mark.parametrize("name", ["1.13.2", "1.16.5", "1.17.1"])
def test_block_entities_and_entities_come_back(name, tmp_path):
    volume = furnished_volume()
    folder = write(volume, tmp_path / "world", name)
    found = read_world(folder)
    chests = [[e for e in v.block_entities if "sign" not in e.id] for v in (found, volume)]
    assert chests[0] == chests[1]
    (sign,) = (e for e in found.block_entities if "sign" in e.id)
    said = volume.block_entities[0].nbt["front_text"]["messages"]
    assert sign.nbt["front_text"]["messages"] == said
    (entity,) = found.entities
    assert (entity.position, entity.id) == (volume.entities[0].position, volume.entities[0].id)
    assert entity.nbt.items() >= volume.entities[0].nbt.items()
    assert (folder / "entities").exists() == (name == "1.17.1")


@pytest.mark.parametrize(("name", "status"), [("1.13", "postprocessed"), ("1.14", "full")])
def test_what_an_old_chunk_holds(name, status, tmp_path):
    folder = write(VOLUME, tmp_path / "world", name)
    for _, data in read_region(folder / "region" / "r.0.0.mca"):
        root = read_nbt(data, "chunk")[1]
        level = root["Level"]
        assert (root["DataVersion"], level["Status"]) == (game_version(name).data_version, status)
        assert set(level["Biomes"].tolist()) == {127} and len(level["Biomes"]) == 256
        assert level.get("isLightOn", 1) == 1
        filled = [section for section in level["Sections"] if "Palette" in section]
        assert all("SkyLight" in section for section in filled)
        if name == "1.13":  # Its sections all have blocks and both kinds of light.
            assert filled == level["Sections"]
            assert all("BlockLight" in section for section in filled)


@pytest.mark.parametrize("name", ["1.13", "1.15.2", "1.16", "1.18.2", "1.19"])
def test_an_old_world_is_a_void(name, tmp_path):
    data = nbtlib.load(write(VOLUME, tmp_path / "world", name) / "level.dat")["Data"]
    if game_version(name).data_version < 2554:
        assert (data["generatorName"], data["Player"]["Dimension"]) == ("flat", 0)
        settings = data["generatorOptions"]
        assert "WorldGenSettings" not in data
    else:
        dimensions = data["WorldGenSettings"]["dimensions"]
        settings = dimensions["minecraft:overworld"]["generator"]["settings"]
        nether = dimensions["minecraft:the_nether"]["generator"]
        has_seeds = name != "1.19"
        assert ("seed" in nether, "structures" in settings) == (has_seeds, has_seeds)
    assert settings["biome"] == "minecraft:the_void"
    assert settings["layers"] == [{"block": "minecraft:air", "height": 1}]


def test_a_build_below_an_old_games_floor_is_refused(tmp_path):
    deep = volume_of(np.ones((1, 3, 1)), (AIR, "minecraft:stone"), (0, -1, 0))
    with pytest.raises(
        UsageError, match=r"has layers -1 to 1, but Minecraft 1.16.5 has layers 0 to 255"
    ):
        write(deep, tmp_path / "world", "1.16.5")


def test_data_packs_are_not_written_for_old_games(tmp_path):
    with pytest.raises(UsageError, match=r"data packs require Minecraft 1.20 or later, got 1.16.5"):
        write_datapack(VOLUME, tmp_path / "a.zip", version=game_version("1.16.5"))


# The words of a section.


@pytest.mark.parametrize("states", [1, 2, 16, 17, 33, 100, 256, 257, 1000, 4096])
def test_words_of_old_games_are_turned_and_back(states):
    rng = np.random.default_rng(states)
    cells = rng.integers(0, states, 4096).astype(np.uint16)
    for bits in range(max(4, (states - 1).bit_length()), 15):
        old = np.zeros(straddled_word_count(4096, bits), np.uint64)
        pack_straddled(cells, bits, old)
        today = repack_section_words(old, states, straddles=True)
        assert today is not None and len(today) == word_count(states)
        again = repack_section_words(straddle_section_words(today, states), states, straddles=True)
        np.testing.assert_array_equal(again, today)


def test_more_bits_than_needed_are_read():
    cells = np.arange(4096) % 7
    per_word, bits = 12, 5
    rows = np.zeros((-(-4096 // per_word), per_word), np.uint64)
    rows.ravel()[:4096] = cells
    wide = (rows << (np.arange(per_word, dtype=np.uint64) * np.uint64(bits))).sum(axis=1)
    today = repack_section_words(wide, 7, straddles=False)
    assert today is not None and len(today) == 256
    assert [int(today[0]) >> (4 * n) & 15 for n in range(16)] == cells[:16].tolist()


def test_words_that_fit_no_count_of_bits_are_refused():
    for count in (0, 9, 255, 257, 5000):
        assert repack_section_words(np.zeros(count, np.uint64), 2, straddles=True) is None
        assert repack_section_words(np.zeros(count, np.uint64), 2, straddles=False) is None
    full = np.full(320, -1, np.int64).view(np.uint64)  # Five bits, all set: number 31.
    assert repack_section_words(full, 20, straddles=True) is None


# The names.

NAMES = [
    ("minecraft:grass", 3698, "minecraft:short_grass"),
    ("minecraft:chain[axis=y]", 4554, "minecraft:iron_chain[axis=y]"),
    ("minecraft:oak_sign[rotation=4]", 1631, "minecraft:sign[rotation=4]"),
    ("minecraft:oak_wall_sign[facing=east]", 1519, "minecraft:wall_sign[facing=east]"),
    ("minecraft:smooth_stone_slab[type=top]", 1631, "minecraft:stone_slab[type=top]"),
    ("minecraft:stone_slab[type=top]", 1952, "minecraft:stone_slab[type=top]"),
    ("minecraft:dirt_path", 2586, "minecraft:grass_path"),
    ("minecraft:cauldron", 2586, "minecraft:cauldron[level=0]"),
    ("minecraft:water_cauldron[level=2]", 2586, "minecraft:cauldron[level=2]"),
    ("minecraft:water_cauldron[level=2]", 2724, "minecraft:water_cauldron[level=2]"),
    (
        "minecraft:stone_brick_wall[east=low,north=none,south=low,up=true,west=none]",
        2230,
        "minecraft:stone_brick_wall[east=true,north=false,south=true,up=true,west=false]",
    ),
    ("mod:thing_wall[east=low]", 9999, "mod:thing_wall[east=low]"),
]


@pytest.mark.parametrize(("state", "version", "written"), NAMES)
def test_a_name_goes_to_another_game_and_back(state, version, written):
    assert write_state(state, version) == written
    assert read_state(written, version) == state


def test_blocks_that_a_game_does_not_know_are_counted():
    palette = (
        AIR,
        "minecraft:light[level=9]",
        "minecraft:oak_sign",
        "mod:shelf",
        "minecraft:light",
    )
    volume = volume_of(np.array([0, 1, 1, 2, 3, 4]).reshape(6, 1, 1), palette, (0, 0, 0))
    losses = Losses()
    count_unknown_blocks(volume, game_version("1.16.5"), losses)
    assert list(losses) == [("blocks minecraft:light, which Minecraft 1.16.5 does not have", 3)]
    count_unknown_blocks(volume, game_version("1.17"), losses)
    assert len(losses) == 1
    told = Losses()
    count_unknown_blocks(furnished_volume(), game_version("1.19.3"), told)
    assert list(told) == [("display entities, which Minecraft 1.19.3 does not support", 1)]
    count_unknown_blocks(furnished_volume(), game_version("1.19.4"), told)
    assert len(told) == 1
    assert is_unknown("minecraft:stone_slab", 1631) and not is_unknown("minecraft:stone", 1519)
    assert is_unknown("minecraft:cherry_planks", 3218)
    assert not is_unknown("minecraft:cherry_planks", 3337)


def test_blocks_of_mods_are_counted_by_mod():
    palette = (AIR, "tmeo:bed", "minecraft:stone", "shop:shelf", "tmeo:bed[facing=east]", "a:b")
    volume = volume_of(np.array([1, 4, 2, 3, 0, 1]).reshape(6, 1, 1), palette, (0, 0, 0))
    assert list(count_mod_blocks(volume).items()) == [("shop", 1), ("tmeo", 3)]


def test_old_versions_come_before_the_others():
    numbers = [v.data_version for v in (*old_versions(), *game_versions())]
    assert numbers == sorted(set(numbers))
    assert {(v.min_y, v.max_y) for v in old_versions() if v.data_version < 2860} == {(0, 255)}
    assert game_version("1.18").min_y == -64
    with pytest.raises(UnknownNameError, match="no Minecraft version is named '1.12'"):
        game_version("1.12")


# Damaged old chunks.

STONE = {"Name": "minecraft:stone"}


def old_chunk(section: dict | int, **changes) -> bytes:
    level = {"xPos": 0, "zPos": 0, "Sections": [section], "TileEntities": [], "Entities": []}
    return write_nbt({"DataVersion": 2586, "Level": level | changes})


DAMAGED = {
    "no Level": write_nbt({"DataVersion": 2586}),
    "a Level of text": write_nbt({"DataVersion": 2586, "Level": "high"}),
    "too few words": old_chunk(
        {"Y": Byte(0), "Palette": [STONE] * 2, "BlockStates": np.zeros(9, np.int64)}
    ),
    "no words": old_chunk({"Y": Byte(0), "Palette": [STONE] * 2}),
    "words of another kind": old_chunk(
        {"Y": Byte(0), "Palette": [STONE] * 2, "BlockStates": np.zeros(256, np.int32)}
    ),
    "an empty palette": old_chunk({"Y": Byte(0), "Palette": []}),
    "sections that are no list": old_chunk({}, Sections=5),
    "a section that is a number": old_chunk(5),
    "a game before 1.13": write_nbt({"DataVersion": 1343, "Level": {"xPos": 0, "zPos": 0}}),
    "an entity without a place": old_chunk({"Y": Byte(0)}, Entities=[{"id": "x"}]),
    "another place": old_chunk({"Y": Byte(0)}, xPos=3),
}


@pytest.mark.parametrize("data", DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_old_chunk_is_refused_by_name(data, tmp_path):
    folder = write(VOLUME, tmp_path / "world", "1.16.5")
    for path in (folder / "region").iterdir():
        path.unlink()
    (folder / "region" / "r.0.0.mca").write_bytes(pack_region({(0, 0): data})[0])
    with pytest.raises(InputError) as caught:
        read_world(folder)
    assert str(caught.value).startswith(str(folder)) and "\n" not in str(caught.value)


def test_a_section_of_light_alone_is_passed_over(tmp_path):
    folder = write(VOLUME, tmp_path / "world", "1.16.5")
    for path in (folder / "region").iterdir():
        path.unlink()
    data = old_chunk({"Y": Byte(-1), "SkyLight": np.zeros(2048, np.int8)})
    (folder / "region" / "r.0.0.mca").write_bytes(pack_region({(0, 0): data})[0])
    assert not read_world(folder).states.any()


@pytest.mark.parametrize("name", ["1.13.2", "1.14.4", "1.15.2", "1.16.5", "1.17.1", "1.18.2"])
def test_anvil_parser_reads_the_same_blocks(name, tmp_path):
    volume = random_volume((16, 32, 16), 1, (0, 48, 0), seed=6)
    volume = volume_of(volume.states, (AIR, *(f"mod:b{n}" for n in range(1, 60))), (0, 48, 0))
    folder = write(volume, tmp_path / "world", name) / "region"
    chunk = anvil.Region.from_file(str(folder / "r.0.0.mca")).get_chunk(0, 0)
    texts = state_texts(volume)
    for section in (3, 4):
        for index, block in enumerate(chunk.stream_blocks(section=section)):
            y, z, x = np.unravel_index(index, (16, 16, 16))
            expected = texts[x, y + 16 * (section - 3), z]
            assert f"{block.namespace}:{block.id}" == expected
