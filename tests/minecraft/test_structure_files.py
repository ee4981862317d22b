import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path

import nbtlib
import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of
from hypothesis import given
from hypothesis import strategies as st
from nbt_equality import same_block_entities, same_entities

from world2minecraft.core.errors import InputError, LimitError, UsageError
from world2minecraft.core.types import AIR, Entity
from world2minecraft.minecraft.file_format import Losses, WriteOptions
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.nbt import (
    Byte,
    Float,
    Long,
    NbtReader,
    Short,
    pack_gzip,
    read_nbt,
    unpack,
    write_nbt,
)
from world2minecraft.minecraft.schematics import structure as our_structure
from world2minecraft.minecraft.schematics import structure_pack
from world2minecraft.minecraft.schematics.structure import (
    _SIZES,
    parse_structure,
    read_structure,
    skip_value,
    write_structure,
)
from world2minecraft.minecraft.schematics.structure_pack import (
    split_into_pieces,
    write_structure_pack,
)
from world2minecraft.minecraft.state_nbt import state_text
from world2minecraft.minecraft.versions import GameVersion, game_version

STONE = "minecraft:stone"
VOLUMES = {
    "small": random_volume((5, 4, 3), 10, (-2, 63, 8)),
    "of 300 states": random_volume((23, 9, 31), 300, (0, 64, 0), seed=4),
    "one block": volume_of(np.ones((1, 1, 1)), (AIR, STONE), (0, 0, 0)),
    "air": volume_of(np.zeros((3, 1, 2)), (AIR,), (0, 0, 0)),
}
each_volume = pytest.mark.parametrize("volume", VOLUMES.values(), ids=VOLUMES.keys())


def texts_slowly(path: Path) -> dict[tuple[int, ...], str]:
    """The listed blocks of a file by their place, read by nbtlib."""
    root = nbtlib.load(path)
    names = [state_text(entry.unpack()) for entry in root["palette"]]
    return {tuple(map(int, b["pos"])): names[int(b["state"])] for b in root["blocks"]}


def tree_of(path: Path) -> dict:
    return read_nbt(unpack(path.read_bytes(), path), path)[1]


@each_volume
def test_a_structure_comes_back_block_for_block(volume, tmp_path):
    write_structure(volume, tmp_path / "a.nbt")
    losses = Losses()
    found = read_structure(tmp_path / "a.nbt", losses)
    assert found.corner == volume.corner
    assert not len(losses)
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))


@each_volume
def test_nbtlib_reads_the_same_blocks(volume, tmp_path):
    write_structure(volume, tmp_path / "a.nbt")
    texts = state_texts(volume)
    assert texts_slowly(tmp_path / "a.nbt") == {p: texts[p] for p in np.ndindex(texts.shape)}
    root = nbtlib.load(tmp_path / "a.nbt")
    assert list(root["size"]) == list(volume.states.shape)
    assert root["DataVersion"] == 3465


def test_air_may_be_left_out_so_that_what_stands_there_stays(tmp_path):
    volume = VOLUMES["small"]
    write_structure(volume, tmp_path / "a.nbt", clears=False)
    texts = state_texts(volume)
    listed = {place: texts[place] for place in np.ndindex(texts.shape) if texts[place] != AIR}
    assert texts_slowly(tmp_path / "a.nbt") == listed
    losses = Losses()
    found = read_structure(tmp_path / "a.nbt", losses)
    np.testing.assert_array_equal(state_texts(found), texts)
    count = texts.size - len(listed)
    assert list(losses) == [("positions that the structure leaves unchanged", count)]


def test_block_entities_and_entities_come_back(tmp_path):
    volume = furnished_volume()
    write_structure(volume, tmp_path / "a.nbt")
    found = read_structure(tmp_path / "a.nbt")
    assert same_block_entities(found, volume)
    (entity,) = found.entities
    assert (entity.position, entity.id) == (volume.entities[0].position, volume.entities[0].id)
    assert entity.nbt.items() >= volume.entities[0].nbt.items()
    root = nbtlib.load(tmp_path / "a.nbt")
    held = {str(b["nbt"]["id"]): list(b["pos"]) for b in root["blocks"] if "nbt" in b}
    assert held == {"minecraft:sign": [3, 1, 2], "minecraft:chest": [4, 1, 3]}
    assert list(root["entities"][0]["pos"]) == [1.75, 1.5, 4.75]
    assert list(root["entities"][0]["blockPos"]) == [1, 1, 4]


def test_of_several_palettes_one_is_read(tmp_path):
    write_structure(VOLUMES["one block"], tmp_path / "a.nbt")
    tree = tree_of(tmp_path / "a.nbt")
    first = tree.pop("palette")
    tree["palettes"] = [first, [{"Name": AIR}, {"Name": "minecraft:dirt"}]]
    (tmp_path / "b.nbt").write_bytes(pack_gzip(write_nbt(tree)))
    losses = Losses()
    assert read_structure(tmp_path / "b.nbt", losses).palette == (AIR, STONE)
    assert list(losses) == [("other palettes of the structure", 1)]
    assert read_structure(tmp_path / "b.nbt", variant=1).palette == (AIR, "minecraft:dirt")
    with pytest.raises(UsageError, match=r"variant of .*b.nbt must be 0 to 1, got 2"):
        read_structure(tmp_path / "b.nbt", variant=2)


def test_a_block_list_of_another_order_is_read_too(tmp_path):
    """Others write the keys in another order, with more of them, or places as an array."""
    volume = furnished_volume()
    write_structure(volume, tmp_path / "a.nbt")
    tree = tree_of(tmp_path / "a.nbt")
    for change in (
        lambda b: dict(reversed(b.items())),
        lambda b: {**b, "note": "mine"},
        lambda b: {**b, "pos": np.array(b["pos"], np.int32)},
    ):
        changed = {**tree, "blocks": [change(block) for block in tree["blocks"]]}
        (tmp_path / "b.nbt").write_bytes(pack_gzip(write_nbt(changed)))
        found = read_structure(tmp_path / "b.nbt")
        np.testing.assert_array_equal(state_texts(found), state_texts(volume))
        assert same_block_entities(found, volume)


def test_the_list_may_be_the_last_of_the_file(tmp_path):
    tree = {
        "size": [1, 1, 1],
        "palette": [{"Name": STONE}],
        "blocks": [{"pos": [0, 0, 0], "nbt": {}, "state": 0}],
    }
    for block in ({"pos": [0, 0, 0], "state": 0}, {"pos": [0, 0, 0], "state": 0, "nbt": {}}):
        data = write_nbt({**tree, "blocks": [block]})
        assert parse_structure(data, tmp_path).palette == (AIR, STONE)


# The kernel that skips values.

numbers = st.one_of(
    st.integers(-128, 127).map(Byte),
    st.integers(-(2**15), 2**15 - 1).map(Short),
    st.integers(-(2**31), 2**31 - 1),
    st.integers(-(2**63), 2**63 - 1).map(Long),
    st.floats(width=32, allow_nan=False).map(Float),
    st.floats(allow_nan=False),
)
arrays = st.sampled_from([np.int8, np.int32, np.int64]).flatmap(
    lambda kind: st.lists(st.integers(-100, 100), max_size=5).map(lambda v: np.array(v, kind))
)
names = st.text(st.characters(min_codepoint=32, max_codepoint=400), max_size=6)
leaves = st.one_of(numbers, arrays, names)
compounds = st.recursive(
    st.dictionaries(names, leaves, max_size=4),
    lambda inner: st.dictionaries(
        names, st.one_of(leaves, inner, st.lists(inner, max_size=3)), max_size=4
    ),
    max_leaves=12,
)


@given(compounds)
def test_a_value_is_skipped_as_it_is_read(tree):
    data = write_nbt({"value": tree, "end": 1})
    reader = NbtReader(data, "test", our_structure.LIMITS)
    reader.at = 3 + 1 + 2 + len("value")
    start = reader.at
    reader.compound(2)
    found = skip_value(np.frombuffer(data, np.uint8), start, 10, _SIZES)
    assert found == reader.at


@given(compounds, st.data())
def test_a_value_cut_short_is_never_skipped_beyond_its_end(tree, data):
    whole = write_nbt({"value": tree})
    start = 3 + 1 + 2 + len("value")
    cut = data.draw(st.integers(start, len(whole) - 1))
    found = skip_value(np.frombuffer(whole[:cut], np.uint8), start, 10, _SIZES)
    assert found == -1 or (found == len(whole) - 1 == cut)


# Pieces.


def test_a_large_volume_comes_in_pieces_of_48(tmp_path):
    volume = random_volume((100, 50, 30), 40, (-7, 60, 9), seed=5)
    parts = split_into_pieces(volume)
    assert sorted(parts) == [(x, y, 0) for x in range(3) for y in range(2)]
    joined = np.full(volume.states.shape, "", object)
    for part in parts.values():
        assert max(part.states.shape) <= 48
        low = np.subtract(part.corner, volume.corner)
        box = tuple(slice(a, a + n) for a, n in zip(low, part.states.shape, strict=True))
        joined[box] = state_texts(part)
    np.testing.assert_array_equal(joined, state_texts(volume))


def test_a_pack_of_pieces_places_each_where_it_belongs(tmp_path):
    chair = Entity((-6.5, 61.0, 10.5), "minecraft:block_display", {"Tags": ["chair"]})
    beside = Entity((93.2, 61.0, 10.5), "minecraft:block_display", {})
    base = random_volume((100, 50, 30), 40, (-7, 60, 9), seed=5)
    volume = volume_of(base.states, base.palette, base.corner, entities=(chair, beside))
    write_structure_pack(volume, tmp_path / "pack.zip", name="My Room!")
    with zipfile.ZipFile(tmp_path / "pack.zip") as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    json.loads(files["pack.mcmeta"])
    lines = files["data/my_room_/functions/place/part_0.mcfunction"].decode().splitlines()
    assert lines[0] == "kill @e[tag=w2m_-7_60_9]"
    placed = [line.split() for line in lines if line.startswith("place template ")]
    assert len(placed) == 6
    texts, entities = {}, []
    for _, _, title, *place in placed:
        name = title.partition(":")[2]
        data = files[f"data/my_room_/structures/{name}.nbt"]
        assert data == files[f"data/my_room_/structure/{name}.nbt"]
        part = parse_structure(data, Path(name))
        entities += part.entities
        low = np.subtract(list(map(int, place)), volume.corner)
        for cell, text in np.ndenumerate(state_texts(part)):
            texts[tuple(np.add(low, cell).tolist())] = text
    stated = state_texts(volume)
    assert texts == {cell: stated[cell] for cell in np.ndindex(stated.shape)}
    assert sorted(entity.position for entity in entities) == [chair.position, beside.position]
    assert all(entity.nbt["Tags"][-1] == "w2m_-7_60_9" for entity in entities)


def test_a_pack_of_pieces_is_read_back_whole(tmp_path):
    held = furnished_volume()
    base = random_volume((100, 50, 30), 40, (-7, 60, 9), seed=5)
    chair = Entity((60.5, 61.0, 10.5), "minecraft:block_display", {"Tags": ["chair"]})
    sign = replace(held.block_entities[0], block_pos=(50, 70, 20))
    volume = replace(base, entities=(chair,), block_entities=(sign,))
    write_structure_pack(volume, tmp_path / "pack.zip")
    found = read_blocks(tmp_path / "pack.zip")
    assert found.corner == volume.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))
    assert [entity.position for entity in found.entities] == [chair.position]
    assert [entity.block_pos for entity in found.block_entities] == [(50, 70, 20)]


def repacked(path: Path, change) -> Path:
    """The pack with its files changed."""
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in change(files).items():
            archive.writestr(name, data)
    return path


PACK_DAMAGE = {
    "no pieces": (
        lambda files: {name: data for name, data in files.items() if not name.endswith(".nbt")},
        "places a structure piece that it does not contain",
    ),
    "pieces elsewhere": (
        lambda files: {name: data.replace(b" 60 9", b" 61 9") for name, data in files.items()},
        "but the piece states the position",
    ),
    "nothing placed": (
        lambda files: {
            name: data.replace(b"place template", b"say") for name, data in files.items()
        },
        "contains no command that places a structure",
    ),
    "a piece that is text": (
        lambda files: {n: b"text" if n.endswith(".nbt") else data for n, data in files.items()},
        "is not valid NBT",
    ),
}


@pytest.mark.parametrize(("change", "reason"), PACK_DAMAGE.values(), ids=PACK_DAMAGE.keys())
def test_a_damaged_pack_is_refused_by_name(change, reason, tmp_path):
    path = tmp_path / "pack.zip"
    write_structure_pack(random_volume((50, 3, 3), 4, (0, 60, 9)), path)
    with pytest.raises(InputError) as caught:
        read_blocks(repacked(path, change))
    text = str(caught.value)
    assert text.startswith(f"{path}: ") and reason in text and "\n" not in text


def test_a_pack_of_pieces_too_large_together_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "pack.zip"
    write_structure_pack(random_volume((130, 3, 3), 4, (0, 60, 9)), path)
    limit = 3 * (48 * 3 * 3) - 1
    monkeypatch.setattr(structure_pack, "MAX_CELLS", limit)
    assert read_blocks(path).states.size <= limit  # 130 of 144 cells a row.
    monkeypatch.setattr(structure_pack, "MAX_CELLS", 130 * 9 - 1)
    with pytest.raises(LimitError, match="has pieces that exceed the limit of 1,169 blocks"):
        read_blocks(path)


def test_a_large_structure_gets_its_pack_beside_it(tmp_path):
    volume = random_volume((49, 3, 3), 4, (0, 60, 0))
    write_blocks(volume, tmp_path / "room.nbt", WriteOptions(name="room"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["room.nbt", "room_pieces.zip"]
    np.testing.assert_array_equal(
        state_texts(read_blocks(tmp_path / "room.nbt")), state_texts(volume)
    )


def test_a_game_without_place_template_is_refused(tmp_path):
    old = GameVersion("1.18.2", 2975, 9)
    with pytest.raises(UsageError, match=r"Minecraft 1.18.2 cannot place structures by command"):
        write_structure_pack(VOLUMES["small"], tmp_path / "a.zip", version=old)


def test_the_same_volume_gives_the_same_pack(tmp_path):
    for name in ("a.zip", "b.zip"):
        write_structure_pack(furnished_volume(), tmp_path / name, version=game_version("1.21.4"))
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()
    assert zipfile.ZipFile(io.BytesIO((tmp_path / "a.zip").read_bytes())).testzip() is None


# Files of others.


def test_structures_made_by_others_come_back_as_they_are(shared_data, tmp_path):
    strange = 0
    for path in sorted((shared_data / "mvs_structures_nbt").glob("*.nbt")):
        found = read_structure(path)
        texts = state_texts(found)
        slow = texts_slowly(path)
        for place in np.ndindex(texts.shape):
            assert texts[place] == slow.get(place, AIR)
        root = nbtlib.load(path)
        assert len(found.entities) == len(root["entities"])
        assert len(found.block_entities) == sum("nbt" in block for block in root["blocks"])
        write_structure(found, tmp_path / "again.nbt")
        again = read_structure(tmp_path / "again.nbt")
        np.testing.assert_array_equal(state_texts(again), texts)
        assert same_block_entities(again, found) and same_entities(again, found)
        strange += len(found.block_entities)
    assert strange


# Damaged files.


def tree_with(**changes) -> dict:
    tree = {
        "size": [2, 1, 1],
        "palette": [{"Name": AIR}, {"Name": STONE}],
        "blocks": [{"pos": [0, 0, 0], "state": 1}, {"pos": [1, 0, 0], "state": 0}],
        "entities": [],
    }
    return {key: value for key, value in (tree | changes).items() if value is not None}


DAMAGED = {
    "nothing": ({}, "is not a valid structure file ('size' is missing)"),
    "no palette": (tree_with(palette=None), "is not a valid structure file ('palette' is missing)"),
    "no blocks": (tree_with(blocks=None), "is not a valid structure file ('blocks' is missing)"),
    "a size of two": (tree_with(size=[1, 1]), "is not a valid structure file"),
    "a size of nothing": (tree_with(size=[1, 0, 1]), "a size of 1 x 0 x 1 blocks"),
    "a huge size": (tree_with(size=[2**31 - 1] * 3), "expected 1 to 67,108,864 blocks"),
    "a number out of range": (
        tree_with(blocks=[{"pos": [0, 0, 0], "state": 2}]),
        "contains a block index that is not in its palette of 2 states",
    ),
    "a negative number": (
        tree_with(blocks=[{"pos": [0, 0, 0], "state": -1}]),
        "contains a block index that is not in its palette of 2 states",
    ),
    "a block outside": (
        tree_with(blocks=[{"pos": [2, 0, 0], "state": 0}]),
        "contains a block outside its declared size (2, 1, 1)",
    ),
    "a block without a place": (
        tree_with(blocks=[{"state": 0}]),
        "contains a block without position",
    ),
    "a block that is a number": (
        tree_with(blocks=[1]),
        "contains a block without position or index",
    ),
    "blocks that are text": (tree_with(blocks="a"), "contains a block without position or index"),
    "no palettes": (tree_with(palettes=[]), "has 0 palettes; expected 1 to 1,000"),
    "a palette of texts": (tree_with(palette=["stone"]), "contains an invalid palette entry"),
    "an entity without a place": (
        tree_with(entities=[{"nbt": {"id": "a"}}]),
        "is not a valid structure file ('pos' is missing)",
    ),
}


@pytest.mark.parametrize(("tree", "reason"), DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_structure_is_refused_by_name(tree, reason, tmp_path):
    path = tmp_path / "bad.nbt"
    path.write_bytes(pack_gzip(write_nbt(tree)))
    with pytest.raises(InputError) as caught:
        read_structure(path)
    text = str(caught.value)
    assert text.startswith(f"{path}: ") and reason in text and "\n" not in text


def test_a_list_of_many_empty_blocks_is_refused_unread(tmp_path):
    data = write_nbt(tree_with(blocks=[{}]))
    at = data.index(b"blocks") + len(b"blocks") + 1
    many = data[:at] + (5_000_000).to_bytes(4, "big") + bytes(5_000_000) + data[at + 5 :]
    (tmp_path / "bad.nbt").write_bytes(many)
    with pytest.raises(LimitError, match="limit of 500,000 NBT values"):
        read_structure(tmp_path / "bad.nbt")


def test_a_volume_of_too_many_blocks_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(our_structure, "MAX_BLOCKS", 50)
    with pytest.raises(UsageError, match="must have 1 to 50 blocks, got 60; write a .schem"):
        write_structure(VOLUMES["small"], tmp_path / "a.nbt")
