"""Command lists and data packs, read back as what they build."""

import re
import zipfile
from contextlib import suppress

import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import AIR, Entity
from world2minecraft.minecraft.commands import parser as command_reading
from world2minecraft.minecraft.commands.parser import read_command_list, read_datapack
from world2minecraft.minecraft.commands.snbt import SnbtReader
from world2minecraft.minecraft.commands.writer import snbt
from world2minecraft.minecraft.file_format import Losses, WriteOptions
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.nbt import Byte, Float, Long, Short

VOLUME = random_volume((9, 6, 7), 6, (2, 60, -3))


@pytest.mark.parametrize("name", ["room.mcfunction", "room.zip"])
def test_blocks_come_back(name, tmp_path):
    write_blocks(VOLUME, tmp_path / name)
    losses = Losses()
    found = read_blocks(tmp_path / name, losses)
    assert found.corner == VOLUME.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(VOLUME))
    assert dict(losses) == {}


@pytest.mark.parametrize("name", ["room.mcfunction", "room.zip"])
def test_signs_and_displays_come_back(name, tmp_path):
    volume = furnished_volume()
    write_blocks(volume, tmp_path / name, WriteOptions(mc_version="1.20.4"))
    found = read_blocks(tmp_path / name)
    sign = found.block_entities[0]
    assert (sign.block_pos, sign.id) == ((0, 64, 0), "minecraft:sign")
    assert sign.nbt == volume.block_entities[0].nbt
    assert [e.id for e in found.block_entities] == ["minecraft:sign", "minecraft:chest"]
    assert found.entities[0].position == volume.entities[0].position
    assert found.entities[0].nbt == volume.entities[0].nbt


def built(text, tmp_path, losses=None):
    (tmp_path / "a.mcfunction").write_text(text)
    return read_command_list(tmp_path / "a.mcfunction", losses)


def test_a_list_by_hand_is_read(tmp_path):
    losses = Losses()
    found = built(
        "# A hut.\n\n"
        "/fill ~ ~ ~ ~2 ~ ~2 minecraft:stone replace\n"
        "setblock 1 1 1 oak_sign[rotation=8]{front_text:{messages:['\"hi\"','\"\"']}} destroy\n"
        "fill 2 0 2 2 0 2 air\n"
        "fill 0 0 0 2 2 2 glass hollow\n"
        "say hello\n"
        "forceload add 0 0\n"
        'summon cat 0.5 1 ~ {CustomName:\'"Tom"\',Tags:["w2m_0_0_0"]}\n'
        "summon minecraft:cow 0 1 0\n",
        tmp_path,
        losses,
    )
    texts = state_texts(found)
    assert found.states.shape == (3, 2, 3)
    assert (texts[:, 0] == "minecraft:stone").sum() == 8
    assert texts[2, 0, 2] == AIR
    assert texts[1, 1, 1] == "minecraft:oak_sign[rotation=8]"
    assert found.block_entities[0].nbt == {"front_text": {"messages": ['"hi"', '""']}}
    assert [e.id for e in found.entities] == ["minecraft:cat", "minecraft:cow"]
    assert found.entities[0].nbt == {"CustomName": '"Tom"'}
    assert dict(losses) == {
        "unsupported commands (say)": 1,
        "fill and setblock commands with the mode hollow": 1,
    }


def test_names_are_those_of_the_game_and_come_back(tmp_path):
    grass = volume_of(np.ones((1, 1, 1)), (AIR, "minecraft:grass"), (0, 0, 0))
    write_blocks(grass, tmp_path / "a.mcfunction", WriteOptions(mc_version="1.21.4"))
    assert (tmp_path / "a.mcfunction").read_text().endswith(" minecraft:short_grass\n")
    assert read_blocks(tmp_path / "a.mcfunction").palette == grass.palette


def test_blocks_that_the_game_does_not_know_are_counted(tmp_path):
    volume = volume_of(np.ones((1, 2, 1)), (AIR, "minecraft:pitcher_plant"), (0, 0, 0))
    losses, old = Losses(), WriteOptions(mc_version="1.19.4")
    write_blocks(volume, tmp_path / "a.mcfunction", old, losses)
    assert [count for _, count in losses] == [2]


def test_the_head_says_what_is_needed(tmp_path):
    write_blocks(VOLUME, tmp_path / "a.mcfunction")
    head = (tmp_path / "a.mcfunction").read_text().splitlines()[:3]
    assert head[0].endswith("commands for Minecraft 1.20.1, made by World2Minecraft.")
    assert head[2] == "# forceload add 2 -3 10 3"


def test_display_entities_need_a_game_that_has_them(tmp_path):
    with pytest.raises(UsageError, match="does not support display entities"):
        write_blocks(
            furnished_volume(), tmp_path / "a.mcfunction", WriteOptions(mc_version="1.19.2")
        )


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "contains no setblock or fill command, so there is nothing to read"),
        ("setblock 1 2 stone", "contains an invalid command: command '1 2 stone' must have 3"),
        ("setblock 1 2", "contains an invalid command: command '1 2' must have 3 coordinates"),
        ("setblock 1 2 3 No", "contains an invalid command: block name 'No' is invalid"),
        (
            "setblock 1 2 ^3 stone",
            "contains an invalid command: coordinates must be integers, got '1 2 ^3'",
        ),
        ("fill 0 0 0 9999 999 9999 stone", "exceeds the limit of"),
        (
            "setblock 0 0 0 a\nsetblock 9999999 0 99999 a",
            "declares a size of 10000000 x 1 x 100000 blocks",
        ),
        (
            "setblock 0 0 0 a{b:",
            "contains an invalid command: invalid SNBT text: expected a value, got",
        ),
        ("summon cat 1 2", "contains an invalid command: summon 'cat 1 2' must have the form"),
    ],
)
def test_what_is_wrong_is_named(text, reason, tmp_path):
    with pytest.raises(InputError) as caught:
        built(text, tmp_path)
    assert str(caught.value).startswith(f"{tmp_path / 'a.mcfunction'}: {reason}")


def test_a_pack_of_others_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("pack.mcmeta", "{}")
    with pytest.raises(
        InputError, match="is not a data pack written by .*other data packs are not supported"
    ):
        read_datapack(tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "c.zip", "w") as archive:
        archive.writestr("My World/level.dat", b"")
    with pytest.raises(InputError, match="contains a zipped world; extract it"):
        read_blocks(tmp_path / "c.zip")
    (tmp_path / "b.zip").write_bytes(b"no zip")
    with pytest.raises(InputError, match="is not a valid data pack"):
        read_datapack(tmp_path / "b.zip")


def test_the_limits_hold(tmp_path, monkeypatch):
    monkeypatch.setattr(command_reading, "MAX_LINES", 2)
    with pytest.raises(InputError, match="exceeds the limit of 2 lines"):
        built("setblock 0 0 0 a\n" * 3, tmp_path)
    monkeypatch.setattr(command_reading, "MAX_DATA", 1)
    with pytest.raises(InputError, match="exceeds the limit of 1 blocks and entities"):
        built("summon cat 0 0 0\nsummon cat 0 0 0", tmp_path)
    with pytest.raises(UsageError, match="exceeds the limit of"):
        SnbtReader(3).read("[1,2,3]")


@given(st.text(alphabet="setblockfill0123 ~-{}[]:,\"'\\=minecraft\n#/", max_size=120))
def test_any_text_is_read_or_refused(tmp_path_factory, text):
    with suppress(InputError):
        built("setblock 0 0 0 stone\n" + text, tmp_path_factory.mktemp("list"))


@pytest.mark.parametrize("name", ["a.mcfunction", "a.zip", "a.nbt"])
def test_invalid_tags_and_line_separators_do_no_harm(name, tmp_path):
    held = {"Tags": 7, "CustomName": "a\nsay hello\r\x0bb\x7f", "Air": float("nan")}
    cat = Entity((0.5, 1.0, 0.5), "minecraft:cat", held)
    volume = volume_of(np.ones((49, 1, 1)), (AIR, "minecraft:stone"), (0, 0, 0), entities=(cat,))
    write_blocks(volume, tmp_path / name)
    if name != "a.nbt":
        found = read_blocks(tmp_path / name).entities[0].nbt
        assert (found["CustomName"], found["Air"]) == ("a say hello  b ", 0.0)


def test_a_pack_s_namespace_is_made_of_any_name(tmp_path):
    write_blocks(VOLUME, tmp_path / "My Room.zip", WriteOptions(name="My Room"))
    with zipfile.ZipFile(tmp_path / "My Room.zip") as archive:
        assert "data/my_room/function/build.mcfunction" in archive.namelist()


# NBT as text.

_WORDS = st.text(max_size=10).filter(lambda t: not re.search(r"[\x00-\x1f\x7f]", t))
_LEAVES = st.one_of(
    st.integers(-(1 << 31), (1 << 31) - 1),
    st.integers(-128, 127).map(Byte),
    st.integers(-(1 << 15), (1 << 15) - 1).map(Short),
    st.integers(-(1 << 63), (1 << 63) - 1).map(Long),
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(allow_nan=False, allow_infinity=False, width=32).map(Float),
    _WORDS,
)


@given(st.recursive(_LEAVES, lambda inner: st.dictionaries(_WORDS, inner) | st.lists(inner)))
def test_text_of_nbt_is_read_as_it_was(value):
    found, end = SnbtReader().read(snbt(value))
    assert end == len(snbt(value))
    assert found == value
    assert type(found) is type(value)


def test_arrays_and_words_are_read():
    found, _ = SnbtReader().read(
        "{a:[I;1,2],b:[B;1b,-1b],c:[L;3L],d:word,e:true,f:1e3,g:.5f,h:99999999999}"
    )
    assert found["a"].dtype == np.int32 and found["a"].tolist() == [1, 2]
    assert found["b"].dtype == np.int8 and found["b"].tolist() == [1, -1]
    assert found["c"].dtype == np.int64
    assert (found["d"], found["e"], found["f"], found["g"]) == ("word", 1, 1000.0, 0.5)
    assert found["h"] == "99999999999"


@pytest.mark.parametrize("text", ["{", "[1", "{a}", "{a:1 b:2}", '"open', "", "[I;x]", "{:1}"])
def test_text_that_is_no_nbt_is_refused(text):
    with pytest.raises(UsageError, match="NBT"):
        SnbtReader().read(text)


def test_depth_is_bounded():
    with pytest.raises(UsageError, match="limit of 100 nested tags"):
        SnbtReader().read("[" * 5000)


def test_what_a_function_cannot_run_at_once_is_said(tmp_path):
    states = np.indices((64, 33, 64)).sum(0) % 2
    write_blocks(volume_of(states, (AIR, "minecraft:stone"), (0, 0, 0)), tmp_path / "a.mcfunction")
    assert "The game runs at most 65,536 commands" in (tmp_path / "a.mcfunction").read_text()[:300]
