"""Worlds from elsewhere: whatever their bytes say, a typed error or a build, never half a one."""

import random
import zlib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import room, tree, write_ground

from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.editing.build_into_world import build_into_world
from world2minecraft.editing.file_backups import list_steps, revert_step
from world2minecraft.minecraft.nbt import read_nbt, write_nbt
from world2minecraft.minecraft.worlds.anvil import pack_region
from world2minecraft.minecraft.worlds.in_place_editing import read_region_file

REGION = "region/r.-1.-1.mca"


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    world = write_ground(tmp_path_factory.mktemp("hostile") / "world")
    return world, {name: (world / name).read_bytes() for name in tree(world) if "." in name}


def built_or_refused(world):
    """Build; where that works, undo it. Either way the world must be as it was."""
    before = tree(world)
    try:
        done = build_into_world(world, room())
    except World2MinecraftError as error:
        assert "\n" not in str(error)
        assert tree(world) == before
        return False
    if done.step is not None:
        revert_step(list_steps(world)[-1])
    assert tree(world) == before
    return True


def put_back(world, files):
    for name, data in files.items():
        (world / name).write_bytes(data)


@settings(max_examples=60)
@given(st.integers(0, 1 << 30), st.sampled_from(["region", "chunk", "level", "entities"]))
def test_any_changed_bytes_are_refused_or_built_around(home, seed, where):
    world, files = home
    put_back(world, files)
    chance = random.Random(seed)
    if where == "chunk":
        region = read_region_file(world / REGION)
        chunks = {}
        for place in region.records:
            data = bytearray(region.chunk(place))
            for _ in range(chance.randint(1, 4)):
                data[chance.randrange(len(data))] = chance.randrange(256)
            chunks[place] = bytes(data)
        (world / REGION).write_bytes(pack_region(chunks)[0])
    else:
        name = {"region": REGION, "level": "level.dat", "entities": "entities/r.0.0.mca"}[where]
        data = bytearray(files[name])
        if chance.random() < 0.3:
            del data[chance.randrange(len(data)) :]
        for _ in range(chance.randint(1, 6) if data else 0):
            data[chance.randrange(min(len(data), 9000))] = chance.randrange(256)
        (world / name).write_bytes(bytes(data))
    built_or_refused(world)


def changed_chunks(world, change):
    region = read_region_file(world / REGION)
    chunks = {}
    for place in region.records:
        _, root = read_nbt(region.chunk(place), "chunk")
        change(root)
        chunks[place] = write_nbt(root)
    (world / REGION).write_bytes(pack_region(chunks)[0])


@pytest.mark.parametrize(
    "change",
    [
        lambda root: root.pop("sections"),
        lambda root: root.update(sections=[]),
        lambda root: root.update(sections=7),
        lambda root: root.update(sections=[{}]),
        lambda root: root.update(sections=[{"Y": "high"}]),
        lambda root: root.update(sections=["text"]),
        lambda root: root["sections"][0].update(block_states={"palette": []}),
        lambda root: root["sections"][0].update(block_states={"palette": [{"Name": 5}]}),
        lambda root: root["sections"][0].pop("biomes"),
        lambda root: root.update(block_entities=[{"id": "a"}]),
        lambda root: root.update(block_entities=3),
        lambda root: root.update(Status=9),
        lambda root: root.pop("DataVersion"),
        lambda root: root.update(DataVersion="new"),
        lambda root: root.update(xPos=99),
        lambda root: root.clear(),
    ],
)
def test_chunks_of_other_shapes_are_refused_or_built_around(home, change):
    world, files = home
    put_back(world, files)
    changed_chunks(world, change)
    built_or_refused(world)


def test_a_small_file_that_unpacks_to_much_is_refused(home):
    world, files = home
    put_back(world, files)
    bomb = zlib.compress(bytes(200 << 20), 9)
    record = (len(bomb) + 1).to_bytes(4, "big") + b"\2" + bomb
    sectors = -(-len(record) // 4096)
    head = bytearray(8192)
    for slot in range(1024):
        head[slot * 4 : slot * 4 + 4] = (2 << 8 | min(sectors, 255)).to_bytes(4, "big")
    (world / REGION).write_bytes(bytes(head) + record + bytes(-len(record) % 4096))
    assert not built_or_refused(world)
