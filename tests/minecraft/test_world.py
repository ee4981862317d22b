import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import anvil
import nbtlib
import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of

from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    LimitError,
    OutputError,
    UsageError,
)
from world2minecraft.core.types import AIR, Entity
from world2minecraft.minecraft.nbt import write_nbt
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds import anvil as our_anvil
from world2minecraft.minecraft.worlds import world_writer as our_world
from world2minecraft.minecraft.worlds.anvil import pack_region, read_region
from world2minecraft.minecraft.worlds.level_dat import GAME_RULES
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

VOLUMES = {
    "one chunk": random_volume((16, 16, 16), 10, (0, 64, 0)),
    "many regions": random_volume((40, 20, 530), 12, (-20, 50, -520), seed=1),
    "a thousand states": random_volume((33, 17, 20), 1000, (5, -64, -7), seed=2),
    "one layer": volume_of(np.ones((20, 1, 3)), (AIR, "minecraft:stone"), (-1, 319, -1)),
}
each_volume = pytest.mark.parametrize("volume", VOLUMES.values(), ids=VOLUMES.keys())


def write(volume, folder, **options):
    settings = {"name": "A room", "spawn": (1.5, 64.0, -2.5), "spawn_yaw_deg": 90.0} | options
    write_world(volume, folder, **settings)
    return folder


@each_volume
def test_a_world_comes_back_block_for_block(volume, tmp_path):
    found = read_world(write(volume, tmp_path / "world"))
    assert found.corner == volume.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))


@each_volume
def test_anvil_parser_reads_the_same_blocks(volume, tmp_path):
    folder = write(volume, tmp_path / "world") / "region"
    texts = state_texts(volume)
    rng = np.random.default_rng(3)
    cells = rng.integers(0, volume.states.shape, (120, 3))
    chunks: dict[tuple[int, int], anvil.Chunk] = {}
    for cell in cells.tolist():
        x, y, z = np.add(volume.corner, cell).tolist()
        place = (x >> 4, z >> 4)
        if place not in chunks:
            region = anvil.Region.from_file(str(folder / f"r.{x >> 9}.{z >> 9}.mca"))
            chunks[place] = region.get_chunk(*place)
        assert_same_block(chunks[place].get_block(x & 15, y, z & 15), texts[tuple(cell)])


def assert_same_block(block: anvil.Block, text: str) -> None:
    properties = ",".join(f"{key}={block.properties[key]}" for key in sorted(block.properties))
    found = f"{block.namespace}:{block.id}" + (f"[{properties}]" if properties else "")
    assert found == text


def test_anvil_parser_reads_a_whole_chunk(tmp_path):
    volume = VOLUMES["one chunk"]
    folder = write(volume, tmp_path / "world")
    chunk = anvil.Region.from_file(str(folder / "region" / "r.0.0.mca")).get_chunk(0, 0)
    texts = state_texts(volume)
    for index, block in enumerate(chunk.stream_blocks(section=4)):
        y, z, x = np.unravel_index(index, (16, 16, 16))
        assert_same_block(block, texts[x, y, z])


def test_a_box_of_a_world_is_read(tmp_path):
    volume = VOLUMES["many regions"]
    folder = write(volume, tmp_path / "world")
    found = read_world(folder, box=(-18, 55, -500, 12, 72, -3))
    assert found.corner == (-18, 55, -500)
    np.testing.assert_array_equal(state_texts(found)[:, :15], state_texts(volume)[2:32, 5:, 20:517])
    assert not found.states[:, 15:].any()


def test_of_a_box_nothing_else_of_the_world_is_read(tmp_path):
    volume = VOLUMES["many regions"]
    stands = Entity((-10.5, 60.0, -510.5), "minecraft:armor_stand", {"CustomName": "far"})
    near = Entity((-10.5, 60.0, -490.5), "minecraft:armor_stand", {"CustomName": "near"})
    folder = write(replace(volume, entities=(stands, near)), tmp_path / "world")
    broken = bytearray(8192)
    broken[3] = 1  # A chunk on the head.
    for kind in ("region", "entities"):
        (folder / kind / "r.7.7.mca").write_bytes(broken)
        path = folder / kind / "r.-1.-1.mca"
        chunks = dict(read_region(path))
        changed = {place: b"no NBT" if place[1] == -32 else data for place, data in chunks.items()}
        assert changed != chunks
        path.write_bytes(pack_region(changed)[0])
    found = read_world(folder, box=(-18, 55, -496, 12, 72, -3))
    np.testing.assert_array_equal(state_texts(found)[:, :15], state_texts(volume)[2:32, 5:, 24:517])
    assert [entity.nbt["CustomName"] for entity in found.entities] == ["near"]
    with pytest.raises(DamagedFileError):
        read_world(folder)


def test_a_world_of_air_can_be_written_and_read(tmp_path):
    empty = volume_of(np.zeros((5, 5, 5)), (AIR,), (0, 64, 0))
    found = read_world(write(empty, tmp_path / "world"))
    assert not found.states.any()


def test_block_entities_and_entities_come_back(tmp_path):
    volume = furnished_volume()
    found = read_world(write(volume, tmp_path / "world"))
    assert sorted(found.block_entities, key=str) == sorted(volume.block_entities, key=str)
    (entity,) = found.entities
    assert (entity.position, entity.id) == (volume.entities[0].position, volume.entities[0].id)
    assert entity.nbt.items() >= volume.entities[0].nbt.items()
    assert entity.nbt["UUID"].dtype == np.int32 and len(entity.nbt["UUID"]) == 4


def test_level_dat_opens_a_calm_creative_world(tmp_path):
    folder = write(VOLUMES["one chunk"], tmp_path / "world")
    data = nbtlib.load(folder / "level.dat")["Data"]
    assert data["LevelName"] == "A room"
    assert (data["GameType"], data["allowCommands"], data["Difficulty"]) == (1, 1, 0)
    assert (data["version"], data["DataVersion"], data["Version"]["Id"]) == (19133, 3465, 3465)
    assert (data["DayTime"], data["raining"], data["thundering"]) == (6000, 0, 0)
    rules = dict(data["GameRules"])
    for rule in ("doMobSpawning", "doDaylightCycle", "doWeatherCycle", "doFireTick", "mobGriefing"):
        assert rules[rule] == "false"
    assert rules["randomTickSpeed"] == rules["spawnRadius"] == "0"
    assert rules == GAME_RULES
    dimensions = data["WorldGenSettings"]["dimensions"]
    assert set(dimensions) == {f"minecraft:{n}" for n in ("overworld", "the_nether", "the_end")}
    flat = dimensions["minecraft:overworld"]["generator"]
    assert flat["type"] == "minecraft:flat"
    assert flat["settings"]["biome"] == "minecraft:the_void"
    assert flat["settings"]["layers"] == [{"block": "minecraft:air", "height": 1}]


def test_the_player_stands_in_the_room_and_looks_into_it(tmp_path):
    folder = write(VOLUMES["one chunk"], tmp_path / "world", spawn=(-1.5, 64.0, 2.25))
    data = nbtlib.load(folder / "level.dat")["Data"]
    assert (data["SpawnX"], data["SpawnY"], data["SpawnZ"]) == (-2, 64, 2)
    assert data["SpawnAngle"] == 90.0
    player = data["Player"]
    assert list(player["Pos"]) == [-1.5, 64.0, 2.25]
    assert list(player["Rotation"]) == [90.0, 0.0]
    assert player["Dimension"] == "minecraft:overworld"
    assert (player["abilities"]["flying"], player["abilities"]["mayfly"]) == (0, 1)


def test_chunks_are_full_lie_in_the_void_and_are_lit(tmp_path):
    folder = write(VOLUMES["one chunk"], tmp_path / "world")
    ((place, data),) = read_region(folder / "region" / "r.0.0.mca")
    from world2minecraft.minecraft.nbt import read_nbt

    root = read_nbt(data, "chunk")[1]
    assert place == (0, 0)
    assert (root["Status"], root["isLightOn"], root["yPos"]) == ("minecraft:full", 1, -4)
    assert root["DataVersion"] == 3465
    biomes = [section["biomes"]["palette"] for section in root["sections"]]
    assert biomes == [["minecraft:the_void"]] * len(biomes)


@pytest.mark.parametrize("name", ["1.20", "1.20.4", "1.21.4", "26.3"])
def test_a_world_for_another_version_says_so_and_reads_back(name, tmp_path):
    version = game_version(name)
    volume = volume_of(np.ones((2, 2, 2)), (AIR, "minecraft:grass"), (0, 0, 0))
    folder = write(volume, tmp_path / "world", version=version)
    data = nbtlib.load(folder / "level.dat")["Data"]
    assert data["DataVersion"] == min(version.data_version, 4440)
    expected = "minecraft:grass" if version.data_version < 3698 else "minecraft:short_grass"
    assert set(read_world(folder).palette) == {AIR, "minecraft:grass"}
    ((_, chunk),) = read_region(folder / "region" / "r.0.0.mca")
    assert expected.encode() in chunk


def test_the_same_volume_gives_the_same_bytes_in_any_process(tmp_path):
    script = (
        "import sys; sys.path.insert(0, sys.argv[1]);"
        "from block_volumes import *;"
        "from world2minecraft.minecraft.worlds.world_writer import write_world;"
        "from world2minecraft.minecraft.schematics.sponge import write_schem;"
        "from world2minecraft.minecraft.commands.datapack import write_datapack;"
        "v = furnished_volume(); out = sys.argv[2];"
        "write_world(v, out + '/w', name='x', spawn=(0, 64, 0), spawn_yaw_deg=0);"
        "[write_schem(v, f'{out}/{n}.schem', schem_version=n) for n in (2, 3)];"
        "write_datapack(v, out + '/p.zip', name='x')"
    )
    contents = []
    for seed, threads in (("0", "1"), ("77", "2")):
        out = tmp_path / seed
        out.mkdir()
        environment = {**os.environ, "PYTHONHASHSEED": seed, "NUMBA_NUM_THREADS": threads}
        command = [sys.executable, "-c", script, str(Path(__file__).parent), str(out)]
        subprocess.run(command, check=True, env=environment)
        files = sorted(path for path in out.rglob("*") if path.is_file())
        contents.append({str(path.relative_to(out)): path.read_bytes() for path in files})
    assert len(contents[0]) == 10
    assert contents[0] == contents[1]


def test_a_chunk_over_a_mebibyte_lies_in_a_file_of_its_own(tmp_path):
    noise = np.random.default_rng(0).integers(-(2**62), 2**62, 200_000)
    big, small = write_nbt({"noise": noise}), write_nbt({"a": 1})
    data, outside = pack_region({(33, -1): big, (34, -1): small})
    folder = tmp_path / "region"
    folder.mkdir()
    (folder / "r.1.-1.mca").write_bytes(data)
    assert list(outside) == ["c.33.-1.mcc"]
    (folder / "c.33.-1.mcc").write_bytes(outside["c.33.-1.mcc"])
    assert dict(read_region(folder / "r.1.-1.mca")) == {(33, -1): big, (34, -1): small}


# What is in the way.


def test_an_untouched_world_is_replaced_whole(tmp_path):
    folder = write(VOLUMES["many regions"], tmp_path / "world")
    write(VOLUMES["one chunk"], folder)
    assert [path.name for path in (folder / "region").iterdir()] == ["r.0.0.mca"]
    assert [path.name for path in tmp_path.iterdir()] == ["world"]


def test_a_world_that_was_played_in_is_left_alone(tmp_path):
    folder = write(VOLUMES["one chunk"], tmp_path / "world")
    level = nbtlib.load(folder / "level.dat")
    del level["Data"]["MadeBy"]
    level.save()
    before = (folder / "region" / "r.0.0.mca").read_bytes()
    with pytest.raises(OutputError, match="played in or created by another program; move it away"):
        write(VOLUMES["one layer"], folder)
    assert (folder / "region" / "r.0.0.mca").read_bytes() == before


def test_a_world_that_was_built_into_is_left_alone(tmp_path):
    folder = write(VOLUMES["one chunk"], tmp_path / "world")
    (folder / "w2m_undo" / "0001").mkdir(parents=True)
    with pytest.raises(OutputError, match="changed with w2m build --into.*w2m undo"):
        write(VOLUMES["one layer"], folder)
    assert (folder / "w2m_undo" / "0001").is_dir()
    (folder / "w2m_undo" / "0001").rmdir()
    write(VOLUMES["one layer"], folder)  # An empty one is what undo may leave.


def test_a_folder_with_other_files_and_a_file_are_left_alone(tmp_path):
    folder = tmp_path / "papers"
    folder.mkdir()
    (folder / "thesis.txt").write_text("years of work")
    with pytest.raises(OutputError, match="contains other files"):
        write(VOLUMES["one chunk"], folder)
    with pytest.raises(OutputError, match="contains other files"):
        write(VOLUMES["one chunk"], folder / "thesis.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["papers"]


def test_a_full_disk_leaves_the_old_world_and_nothing_else(tmp_path, monkeypatch):
    folder = write(VOLUMES["one chunk"], tmp_path / "world")
    before = (folder / "region" / "r.0.0.mca").read_bytes()

    def full(path, data):
        raise OutputError(path, "cannot be written: No space left on device")

    monkeypatch.setattr(our_world, "write_bytes", full)
    with pytest.raises(OutputError) as caught:
        write(VOLUMES["one layer"], folder)
    assert str(caught.value) == f"{folder}: cannot be written: No space left on device"
    assert (folder / "region" / "r.0.0.mca").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["world"]


def test_a_build_above_the_height_limit_is_refused_unwritten(tmp_path):
    tall = volume_of(np.ones((1, 300, 1)), (AIR, "minecraft:stone"), (0, 63, 0))
    with pytest.raises(UsageError, match=r"has layers 63 to 362.*-64 to 319; use fewer"):
        write(tall, tmp_path / "world")
    assert not list(tmp_path.iterdir())


# Damaged worlds.


@pytest.fixture
def world(tmp_path) -> Path:
    return write(VOLUMES["one chunk"], tmp_path / "world")


def test_a_folder_that_is_no_world_is_refused(tmp_path):
    with pytest.raises(InputError, match="is not a world folder: level.dat not found"):
        read_world(tmp_path)
    with pytest.raises(InputError, match="is not a world folder"):
        read_world(tmp_path / "missing")


def test_bedrock_worlds_and_parents_of_worlds_are_reported(world):
    with pytest.raises(InputError, match=rf"level.dat not found; use {world} instead$"):
        read_world(world.parent)
    shutil.rmtree(world / "region")
    (world / "db").mkdir()
    (world / "level.dat").write_bytes(b"\x0a\0\0\0\x10\0\0\0\x0a\0\0")
    with pytest.raises(InputError, match="is a Bedrock Edition world, but only Java Edition"):
        read_world(world)


def test_a_world_without_regions_is_refused(world):
    shutil.rmtree(world / "region")
    with pytest.raises(InputError, match="contains no region files"):
        read_world(world)


def test_a_world_of_26_1_has_its_regions_elsewhere(world):
    moved = world / "dimensions" / "minecraft" / "overworld" / "region"
    moved.parent.mkdir(parents=True)
    (world / "region").rename(moved)
    found = read_world(world)
    np.testing.assert_array_equal(state_texts(found), state_texts(VOLUMES["one chunk"]))


def damage(data: bytes, at: int, value: bytes) -> bytes:
    return data[:at] + value + data[at + len(value) :]


REGION_DAMAGE = {
    "cut in the head": lambda data: data[:5000],
    "cut in the chunk": lambda data: data[: 2 * 4096 + 100],
    "cut to the head": lambda data: data[: 2 * 4096],
    "a chunk on the head": lambda data: damage(data, 0, b"\0\0\0\1"),
    "two chunks at one place": lambda data: damage(data, 4, data[:4]),
    "a chunk beyond the end": lambda data: damage(data, 0, b"\0\xff\xff\1"),
    "a length of nothing": lambda data: damage(data, 8192, bytes(4)),
    "a length too long": lambda data: damage(data, 8192, b"\x7f\xff\xff\xff"),
    "an unknown packing": lambda data: damage(data, 8196, b"\x09"),
    "a packing that is not so": lambda data: damage(data, 8197, b"\0\0"),
    "a broken stream": lambda data: damage(data, 8250, b"\x55\xaa\x55\xaa"),
    "a chunk in another's slot": lambda data: damage(damage(data, 0, bytes(4)), 4, data[:4]),
    "an external file that is missing": lambda data: damage(data, 8196, b"\x82"),
}


@pytest.mark.parametrize("change", REGION_DAMAGE.values(), ids=REGION_DAMAGE.keys())
def test_a_damaged_region_is_refused_by_name(world, change):
    path = world / "region" / "r.0.0.mca"
    path.write_bytes(change(path.read_bytes()))
    with pytest.raises(InputError) as caught:
        read_world(world)
    assert str(caught.value).startswith((str(path), str(path.with_name("c.0.0.mcc"))))
    assert "\n" not in str(caught.value)


def chunk_with(section: dict, **changes) -> bytes:
    root = {"DataVersion": 3465, "xPos": 0, "zPos": 0, "sections": [section]}
    return write_nbt(root | changes)


STONE = {"Name": "minecraft:stone"}
CHUNK_DAMAGE = {
    "a palette index out of range": chunk_with(
        {"Y": 0, "block_states": {"palette": [STONE] * 3, "data": np.full(256, -1)}}
    ),
    "too few words": chunk_with(
        {"Y": 0, "block_states": {"palette": [STONE] * 2, "data": np.zeros(9, np.int64)}}
    ),
    "no words": chunk_with({"Y": 0, "block_states": {"palette": [STONE] * 2}}),
    "no palette": chunk_with({"Y": 0, "block_states": {}}),
    "an empty palette": chunk_with({"Y": 0, "block_states": {"palette": []}}),
    "a state without a name": chunk_with({"Y": 0, "block_states": {"palette": [{"a": "b"}]}}),
    "a name that is none": chunk_with({"Y": 0, "block_states": {"palette": [{"Name": "A b"}]}}),
    "a property that is a number": chunk_with(
        {"Y": 0, "block_states": {"palette": [{"Name": "a", "Properties": {"b": 1}}]}}
    ),
    "words of another kind": chunk_with(
        {"Y": 0, "block_states": {"palette": [STONE] * 2, "data": "text"}}
    ),
    "sections that are no list": chunk_with({}, sections=5),
    "a section that is a number": chunk_with({}, sections=[5]),
    "a game before 1.18": chunk_with({}, DataVersion=2586),
    "no version": write_nbt({"xPos": 0, "zPos": 0}),
    "another place": chunk_with({}, xPos=7),
    "a block entity without a place": chunk_with({}, block_entities=[{"id": "x"}]),
    "block entities that are no list": chunk_with({}, block_entities=5),
    "no NBT": b"hello",
}


@pytest.mark.parametrize("data", CHUNK_DAMAGE.values(), ids=CHUNK_DAMAGE.keys())
def test_a_damaged_chunk_is_refused_by_name(world, data):
    path = world / "region" / "r.0.0.mca"
    path.write_bytes(pack_region({(0, 0): data})[0])
    with pytest.raises(InputError) as caught:
        read_world(world)
    assert str(caught.value).startswith(str(world))
    assert "\n" not in str(caught.value)


def test_a_chunk_bomb_is_refused(world):
    path = world / "region" / "r.0.0.mca"
    path.write_bytes(pack_region({(0, 0): bytes(our_anvil.MAX_CHUNK_BYTES + 1)})[0])
    with pytest.raises(LimitError, match="exceeds the limit of"):
        read_world(world)


def test_a_world_too_wide_to_hold_asks_for_a_box(world):
    stone = write_nbt(
        {
            "DataVersion": 3465,
            "xPos": 31 + 32 * 900,
            "zPos": 0,
            "sections": [{"Y": 0, "block_states": {"palette": [STONE]}}],
        }
    )
    far = world / "region" / "r.900.0.mca"
    far.write_bytes(pack_region({(31 + 32 * 900, 0): stone})[0])
    with pytest.raises(LimitError, match=r"blocks, the limit is 67,108,864; use a box"):
        read_world(world)
    assert read_world(world, box=(0, 64, 0, 16, 80, 16)).states.any()


def test_a_broken_level_dat_is_refused(world):
    path = world / "level.dat"
    path.write_bytes(path.read_bytes()[:50])
    with pytest.raises(DamagedFileError, match="level.dat: the gzip stream ends too early"):
        read_world(world)


def test_a_region_of_another_name_is_refused(tmp_path):
    (tmp_path / "r.a.0.mca").write_bytes(bytes(8192))
    with pytest.raises(DamagedFileError, match="not named like a region file"):
        list(read_region(tmp_path / "r.a.0.mca"))
