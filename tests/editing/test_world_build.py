"""Building into a world: what is built is there, all else stays, and every byte comes back."""

import json
import subprocess
import sys
from dataclasses import replace
from io import BytesIO

import anvil
import nbtlib
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import (
    SIGN,
    blocks_by_place,
    plain,
    room,
    tree,
    world_blocks,
    write_ground,
)

from world2minecraft.core.errors import ConflictError, InputError, UsageError
from world2minecraft.core.types import AIR
from world2minecraft.editing.build_into_world import affected_mask, build_into_world, remove_build
from world2minecraft.editing.file_backups import list_steps, revert_step
from world2minecraft.editing.volume_relocation import place_volume, translate_volume, trim_air
from world2minecraft.minecraft import bit_packing as section_words
from world2minecraft.minecraft.nbt import pack_gzip, read_nbt, write_nbt
from world2minecraft.minecraft.signs import sign_entity
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds import in_place_editing as region_edit
from world2minecraft.minecraft.worlds.anvil import pack_region, read_region
from world2minecraft.minecraft.worlds.in_place_editing import read_region_file
from world2minecraft.minecraft.worlds.level_dat import level_data
from world2minecraft.minecraft.worlds.world_reader import read_world


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A world that tests only read."""
    return write_ground(tmp_path_factory.mktemp("home") / "world")


@pytest.fixture
def world(tmp_path):
    return write_ground(tmp_path / "world")


def slowly(before, volume, air="room"):
    """The readable twin: the blocks of a world by place, after a volume is put in."""
    after = dict(before)
    sizes = volume.states.shape
    for x in range(sizes[0]):
        for z in range(sizes[2]):
            is_over = False
            for y in range(sizes[1]):
                state = volume.palette[volume.states[x, y, z]]
                is_over |= state != AIR
                place = tuple(int(v) for v in np.array(volume.corner) + np.array((x, y, z)))
                if state != AIR:
                    after[place] = state
                elif air == "box" or (air == "room" and is_over):
                    after.pop(place, None)
    return after


@pytest.mark.parametrize("air", ["room", "box", "none"])
@pytest.mark.parametrize("corner", [(-8, 60, -20), (-40, 70, -30), (10, 40, 3)])
def test_the_world_holds_what_was_built_and_all_else(world, air, corner):
    before = world_blocks(world)
    volume = room(corner)
    done = build_into_world(world, volume, air=air, new_chunks=True)
    after = world_blocks(world)
    assert after == slowly(before, volume, air)
    places = before.keys() | after.keys()
    assert done.blocks == sum(before.get(p) != after.get(p) for p in places)


def test_an_independent_reader_finds_the_blocks(world):
    volume = room()
    build_into_world(world, volume)
    for (x, y, z), state in list(blocks_by_place(volume).items())[::7]:
        region = anvil.Region.from_file(str(world / f"region/r.{x >> 9}.{z >> 9}.mca"))
        block = anvil.Chunk.from_region(region, x >> 4, z >> 4).get_block(x & 15, y, z & 15)
        assert f"{block.namespace}:{block.id}" == state.partition("[")[0]


def test_untouched_chunks_keep_bytes_and_touched_ones_keep_tags(home, world):
    build_into_world(world, room())
    touched = {(x, z) for x in (-1, 0) for z in (-2, -1)}
    for path in sorted((world / "region").glob("*.mca")):
        old, new = read_region_file(home / "region" / path.name), read_region_file(path)
        assert old.records.keys() == new.records.keys()
        for place, record in new.records.items():
            assert (record == old.records[place]) == (place not in touched)
            before = nbtlib.File.parse(BytesIO(old.chunk(place)))
            after = nbtlib.File.parse(BytesIO(new.chunk(place)))
            assert before.keys() == after.keys()
            free = ("sections", "Heightmaps", "isLightOn", "block_entities")
            assert {k: v for k, v in before.items() if k not in free} == {
                k: v for k, v in after.items() if k not in free
            }
            if place in touched:
                assert (int(after["isLightOn"]), dict(after["Heightmaps"])) == (0, {})
                assert not any("SkyLight" in section for section in after["sections"])
                assert [int(s["Y"]) for s in after["sections"]] == sorted(
                    int(s["Y"]) for s in after["sections"]
                )


def test_data_and_entities_are_merged(world):
    volume = room((-14, 58, -16))  # Over the chest at (-12, 60, -12).
    build_into_world(world, volume)
    found = read_world(world)
    ids = {e.block_pos: e.id for e in found.block_entities}
    assert ids == {(20, 66, 20): "minecraft:chest", (-9, 59, -11): "minecraft:sign"}
    kinds = sorted(e.id for e in found.entities)
    assert kinds == ["minecraft:armor_stand", "minecraft:block_display", "minecraft:block_display"]


@pytest.mark.parametrize(
    ("data_version", "is_as_wanted"),
    [
        (2975, lambda nbt: json.loads(nbt["Text1"]) == {"text": "Küche"}),
        (3337, lambda nbt: "front_text" not in nbt),
        (3465, lambda nbt: json.loads(nbt["front_text"]["messages"][0]) == {"text": "Küche"}),
        (4440, lambda nbt: nbt["front_text"]["messages"][0] == {"text": "Küche"}),
    ],
)
def test_a_sign_is_written_as_the_game_of_its_chunk_has_it(world, data_version, is_as_wanted):
    path = world / "region" / "r.-1.-1.mca"
    region = read_region_file(path)
    chunks = {}
    for place in region.records:
        root = read_nbt(region.chunk(place), path)[1]
        chunks[place] = write_nbt(root | {"DataVersion": data_version})
    path.write_bytes(pack_region(chunks)[0])
    volume = room()
    (sign,) = volume.block_entities
    text = sign_entity(sign.block_pos, ["Küche"])
    build_into_world(world, replace(volume, block_entities=(text,), entities=()))
    x, _, z = sign.block_pos
    root = read_nbt(read_region_file(path).chunk((x >> 4, z >> 4)), path)[1]
    (held,) = [nbt for nbt in root["block_entities"] if nbt["id"] == "minecraft:sign"]
    assert is_as_wanted(held)


def test_entity_chunk_keeps_its_version_with_foreign_entities(world):
    path = world / "entities" / "r.0.0.mca"
    (place,) = read_region_file(path).records  # Of the armor stand.
    root = read_nbt(read_region_file(path).chunk(place), path)[1]
    old = write_nbt(root | {"DataVersion": 3463, "mod:tag": "kept"})
    path.write_bytes(pack_region({place: old})[0])
    volume = room((-6, 60, 2))  # Its displays stand to both sides of x 0 or 1.
    build_into_world(world, volume)
    chunks = {
        (x >> 4, z >> 4): read_nbt(read_region_file(file).chunk((x >> 4, z >> 4)), file)[1]
        for x, _, z in (np.floor(e.position).astype(int).tolist() for e in volume.entities)
        for file in (world / "entities" / f"r.{x >> 9}.{z >> 9}.mca",)
    }
    assert {at: int(held["DataVersion"]) for at, held in chunks.items()} == {(0, 0): 3463}
    assert chunks[place]["mod:tag"] == "kept"
    assert sorted(nbt["id"] for nbt in chunks[place]["Entities"]) == [
        "minecraft:armor_stand", "minecraft:block_display", "minecraft:block_display"
    ]  # fmt: skip


def test_sections_with_more_bits_than_needed_are_edited(world):
    path = world / "region" / "r.-1.-1.mca"
    region, before = read_region_file(path), world_blocks(world)
    chunks = {place: read_nbt(region.chunk(place), path)[1] for place in region.records}
    for root in chunks.values():
        for section in root["sections"]:
            blocks = section["block_states"]
            if "data" not in blocks:
                continue  # Air that holds light.
            cells = section_words._padded_cells(blocks["data"].view(np.uint64), 4)
            blocks["data"] = section_words._pack_padded(cells, 7).view(np.int64)
    path.write_bytes(pack_region({place: write_nbt(root) for place, root in chunks.items()})[0])
    volume = room()
    build_into_world(world, volume)
    assert world_blocks(world) == slowly(before, volume)


def test_the_same_build_again_changes_nothing(world):
    build_into_world(world, room())
    once = tree(world)
    done = build_into_world(world, room())
    assert (done.step, done.blocks, done.entities) == (None, 0, 0)
    assert tree(world) == once


def test_another_build_in_the_place_takes_over_its_entities(world):
    build_into_world(world, room())
    volume = room()
    build_into_world(world, replace(volume, entities=volume.entities[:1]))
    held = [e for e in read_world(world).entities if e.id == "minecraft:block_display"]
    assert len(held) == 1


def test_undo_brings_back_every_byte_step_by_step(world):
    states = [tree(world)]
    for corner in [(-8, 60, -20), (0, 62, -18), (-25, 60, 5)]:
        build_into_world(world, room(corner), what=f"built at {corner}")
        states.append(tree(world))
    assert len(list_steps(world)) == 3
    for state in reversed(states[:-1]):
        revert_step(list_steps(world)[-1])
        assert tree(world) == state


def test_the_same_build_gives_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        build_into_world(write_ground(tmp_path / name), room())
        steps = list_steps(tmp_path / name)
        revert_step(steps[-1])
        build_into_world(tmp_path / name, room())
    a, b = tree(tmp_path / "a"), tree(tmp_path / "b")
    manifest = "w2m_undo/0001/manifest.json"  # It holds the times of the old files.
    assert {k: v for k, v in a.items() if k != manifest} == {
        k: v for k, v in b.items() if k != manifest
    }


def test_blocks_are_taken_out_of_a_world_that_was_played_in(world):
    before = world_blocks(world)
    pack = {"datapacks/player_size.zip": b"another size"}
    old_pack = (world / "datapacks/player_size.zip").read_bytes()
    build_into_world(world, room(), extra=pack)
    # Someone breaks a wall, and builds a tower elsewhere in the same chunk.
    x, y, z = -6, 62, -20
    hole = plain(np.zeros((1, 1, 1)), (AIR,), (x, y, z))
    build_into_world(world, hole, air="box", what="played")
    tower = plain(np.ones((1, 9, 1)), (AIR, "minecraft:gold_block"), (-10, 70, -18))
    build_into_world(world, tower, what="played")
    for step in list_steps(world)[1:]:
        for path in sorted(step.folder.rglob("*"), reverse=True):
            path.unlink() if path.is_file() else path.rmdir()
        step.folder.rmdir()
    done = remove_build(world)
    assert done.kept == 1
    expected = before | {(-10, 70 + n, -18): "minecraft:gold_block" for n in range(9)}
    expected.pop((x, y, z), None)
    assert world_blocks(world) == expected
    found = read_world(world)
    assert [e.id for e in found.entities] == ["minecraft:armor_stand"]
    assert sorted(e.block_pos for e in found.block_entities) == [(-12, 60, -12), (20, 66, 20)]
    assert not (world / "w2m_undo").exists()
    assert (world / "datapacks/player_size.zip").read_bytes() == old_pack


def test_a_chest_that_was_built_over_comes_back_with_its_things(world):
    volume = room((-14, 58, -16))
    build_into_world(
        world, replace(volume, block_entities=(), states=volume.states * 0 + 1), air="none"
    )
    done = remove_build(world)
    assert done.kept == 0
    chest = next(e for e in read_world(world).block_entities if e.block_pos == (-12, 60, -12))
    assert chest.nbt["CustomName"] == "chest 0"


def test_missing_chunks_are_refused_outside_void_worlds(world):
    path = world / "level.dat"
    data = level_data("Home", (0, 80, 0), 0.0, game_version())
    overworld = data["Data"]["WorldGenSettings"]["dimensions"]["minecraft:overworld"]
    overworld["generator"] = {"type": "minecraft:noise"}
    path.write_bytes(pack_gzip(write_nbt(data)))
    before = tree(world)
    far = room((200, 60, 5))
    with pytest.raises(ConflictError) as raised:
        build_into_world(world, far)
    assert str(raised.value) == (
        f"{world}: the game has not generated 4 of the chunks, such as the one at x 192, "
        "z 0; visit the place in the game, or add --new-chunks to create them filled with air"
    )
    assert tree(world) == before
    build_into_world(world, far, new_chunks=True)
    assert blocks_by_place(far).items() <= world_blocks(world).items()


@pytest.mark.parametrize(
    ("corner", "text"),
    [
        ((0, -65, 0), "would span y -65 to -60, but the world spans y -64 to 319"),
        ((0, 316, 0), "would span y 316 to 321"),
        ((31_000_000, 60, 0), "beyond the world border"),
    ],
)
def test_a_build_out_of_the_world_is_refused(home, corner, text):
    before = tree(home)
    with pytest.raises(UsageError, match=text):
        build_into_world(home, room(corner), new_chunks=True)
    assert tree(home) == before


def test_no_world_is_refused(tmp_path):
    with pytest.raises(InputError, match="is not a world folder: level.dat not found$"):
        build_into_world(tmp_path, room())


HOLD = """
import fcntl, sys
stream = open(sys.argv[1], "w+b")
stream.write("\\u2603".encode())
stream.flush()
fcntl.lockf(stream, fcntl.LOCK_EX)
print("held", flush=True)
sys.stdin.read()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="locks of POSIX")
def test_a_world_that_is_open_in_the_game_is_left_alone(world):
    before = tree(world)
    words = [sys.executable, "-c", HOLD, str(world / "session.lock")]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as game:
        game.stdout.readline()
        for act in (lambda: build_into_world(world, room()), lambda: remove_build(world)):
            with pytest.raises(ConflictError) as raised:
                act()
            assert str(raised.value) == (
                f"{world}: is open in the game, a server or another program; close the "
                "world, then try again"
            )
        game.stdin.close()
    assert tree(world) == before
    assert (world / "session.lock").read_bytes() == "\u2603".encode()
    build_into_world(world, room())
    assert (world / "session.lock").read_bytes() == "\u2603".encode()


def test_an_oversized_chunk_moves_to_its_own_file_and_back(tmp_path, monkeypatch):
    monkeypatch.setattr(region_edit, "MAX_SECTORS", 3)
    rng = np.random.default_rng(1)
    names = [f"mod:{rng.integers(1 << 60)}_{rng.integers(1 << 60)}_{n}" for n in range(2000)]
    states = np.arange(16 * 96 * 16).reshape(16, 96, 16) % 2000 + 1
    noisy = plain(states, (AIR, *names), (0, -64, 0))
    small = plain(np.ones((3, 3, 3)), (AIR, "minecraft:stone"), (0, 20, 0))
    world = write_ground(tmp_path / "world", volume=small)
    before = tree(world)
    build_into_world(world, noisy)
    outside = world / "region" / "c.0.0.mcc"
    assert outside.is_file()
    assert world_blocks(world) == blocks_by_place(noisy)
    calm = plain(np.ones((16, 96, 16)), (AIR, "minecraft:stone"), (0, -64, 0))
    build_into_world(world, calm)
    assert not outside.exists()
    assert world_blocks(world) == blocks_by_place(calm)
    for _ in range(2):
        revert_step(list_steps(world)[-1])
    assert tree(world) == before


@pytest.mark.parametrize("way", ["gzip", "none", "lz4"])
def test_chunks_packed_in_any_way_are_edited(world, way):
    for path in sorted((world / "region").glob("*.mca")):
        path.write_bytes(pack_region(dict(read_region(path)), compression=way)[0])
    before, expected = tree(world), slowly(world_blocks(world), room())
    build_into_world(world, room())
    assert world_blocks(world) == expected
    revert_step(list_steps(world)[-1])
    assert tree(world) == before


def test_the_folders_of_newer_games_are_found(world):
    modern = world / "dimensions" / "minecraft" / "overworld"
    modern.mkdir(parents=True)
    for name in ("region", "entities"):
        (world / name).rename(modern / name)
    before = tree(world)
    build_into_world(world, room())
    assert not (world / "region").exists()
    assert blocks_by_place(room()).items() <= world_blocks(world).items()
    revert_step(list_steps(world)[-1])
    assert tree(world) == before


@settings(max_examples=25)
@given(st.integers(0, 1000), st.integers(-3, 3), st.sampled_from(["room", "box", "none"]))
def test_the_mask_is_that_of_the_readable_twin(seed, turns, air):
    rng = np.random.default_rng(seed)
    volume = plain(rng.random((4, 5, 3)) < 0.2, (AIR, SIGN), (3, 60, -4))
    if not volume.states.any():
        return
    put = place_volume(volume, (7, 70, 9), turns, None)
    assert put.corner == (7, 70, 9)
    solid = {
        place: "minecraft:dirt"
        for place in map(tuple, (np.argwhere(np.ones(put.states.shape)) + put.corner).tolist())
    }
    left = slowly(solid, put, air)
    mask = affected_mask(put, air)
    for cell in np.argwhere(np.ones(mask.shape)):
        place = tuple((cell + put.corner).tolist())
        assert mask[tuple(cell)] == (left.get(place) != "minecraft:dirt")


def test_a_moved_volume_keeps_its_room_points():
    volume = room()
    point = np.array([*volume.entities[0].position, 1.0])
    gone = translate_volume(volume, np.array([5, -3, 11]))
    there = np.array([*gone.entities[0].position, 1.0])
    assert np.allclose(gone.block_to_room @ there, volume.block_to_room @ point)
    assert gone.block_entities[0].block_pos == (2, 58, -4)
    with pytest.raises(UsageError, match="the volume contains no blocks to build"):
        trim_air(plain(np.zeros((2, 2, 2)), (AIR,), (0, 0, 0)))


def test_the_ground_of_a_room_comes_to_the_height_that_is_asked():
    put = place_volume(room((-8, 63, -20)), (100, 70, -5), 0, 64)
    assert put.corner == (100, 69, -5)
