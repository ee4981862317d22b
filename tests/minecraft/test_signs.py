"""Signs as each game keeps them."""

import json

import numpy as np
import pytest
from block_volumes import volume_of

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockEntity
from world2minecraft.minecraft.commands import parser
from world2minecraft.minecraft.commands.datapack import datapack_files
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import WriteOptions
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.nbt import Byte, read_nbt, write_nbt
from world2minecraft.minecraft.schematics import litematic, sponge, structure
from world2minecraft.minecraft.server.server_build import plan_build
from world2minecraft.minecraft.signs import LINE_LETTERS, sign_entity, upgrade_signs, wrap_sign_text
from world2minecraft.minecraft.versions import game_version, game_versions, old_versions
from world2minecraft.minecraft.worlds import world_reader

STATE = "minecraft:oak_wall_sign[facing=north,waterlogged=false]"
ENTITY = sign_entity((1, 2, 3), ["Küche", 'the "red" one'], "/function w2m:human_size")


def volume_with(*held):
    states = np.ones((1, 1, 1), np.uint16)
    return volume_of(states, ("minecraft:air", STATE), (1, 2, 3), block_entities=held)


def written(version, entity=ENTITY):
    data_version = game_version(version).data_version
    return convert_volume(volume_with(entity), data_version).block_entities[0].nbt


def test_from_1_20_on_a_sign_has_two_sides_of_json():
    nbt = written("1.20.1")
    assert nbt == ENTITY.nbt and nbt["is_waxed"] == 1
    front = [json.loads(line) for line in nbt["front_text"]["messages"]]
    assert [line["text"] for line in front] == ["Küche", 'the "red" one', "", ""]
    assert front[0]["clickEvent"]["value"] == "/function w2m:human_size"
    assert len(nbt["back_text"]["messages"]) == 4


def test_before_1_20_a_sign_has_four_texts():
    nbt = written("1.19.4")
    assert set(nbt) == {"Text1", "Text2", "Text3", "Text4", "Color", "GlowingText"}
    assert json.loads(nbt["Text2"])["text"] == 'the "red" one'


def test_from_1_21_5_on_texts_are_nbt():
    front = written("1.21.5")["front_text"]["messages"]
    assert front[1] == {"text": 'the "red" one'}
    assert front[0]["click_event"] == {
        "action": "run_command",
        "command": "/function w2m:human_size",
    }


def test_every_game_s_sign_is_nbt_that_reads_back():
    for version in (*old_versions(), *game_versions()):
        nbt = dict(written(version.name))
        assert read_nbt(write_nbt(nbt), "sign.nbt")[1] == nbt


@pytest.mark.parametrize("name", ["a.schem", "a.litematic", "a.nbt", "a.mcfunction", "a.zip", "a"])
@pytest.mark.parametrize("version", ["1.20.1", "1.21.5", "1.21.8"])
def test_every_format_keeps_a_sign_as_its_game_has_it(tmp_path, name, version, monkeypatch):
    write_blocks(volume_with(ENTITY), tmp_path / name, WriteOptions(mc_version=version))
    (back,) = read_blocks(tmp_path / name).block_entities
    lines = [json.loads(line) for line in back.nbt["front_text"]["messages"]]
    assert lines == [json.loads(line) for line in ENTITY.nbt["front_text"]["messages"]]
    # Without the readers' part the lines are what lies in the file.
    for reader in (world_reader, sponge, structure, litematic):
        monkeypatch.setattr(reader, "upgrade_signs", lambda held, _: tuple(held))
    monkeypatch.setattr(parser, "upgrade_command_signs", tuple)
    (raw,) = read_blocks(tmp_path / name).block_entities
    kind = str if version == "1.20.1" else dict
    assert {type(line) for line in raw.nbt["front_text"]["messages"]} == {kind}


def test_commands_for_a_game_before_1_20_set_its_four_texts():
    commands = plan_build(volume_with(ENTITY), game_version("1.19.4")).work
    (data,) = [command for command in commands if command.startswith("data merge")]
    assert '"Text2":' in data and "front_text" not in data
    files = datapack_files(volume_with(ENTITY), game_version("1.21.5"), "room")
    (part,) = [
        text for name, text in files.items() if name.endswith("function/build/part_0.mcfunction")
    ]
    assert '"messages":[{"text":"Küche"' in part


def test_lines_of_mixed_parts_round_trip_as_nbt_of_one_kind():
    line = json.dumps(
        ["", {"text": "my ", "bold": True, "extra": ["red", {"text": " room"}]}, 7, None]
    )
    deep = '{"extra":[' * 60 + '""' + "]}" * 60
    click = '{"clickEvent":{"action":"change_page","value":"2"}}'
    lines = [line, "not JSON", deep, click]
    held = BlockEntity((1, 2, 3), "minecraft:hanging_sign", {"front_text": {"messages": lines}})
    nbt = written("1.21.6", held)
    turns = {"action": "change_page", "page": 2}
    assert nbt["front_text"]["messages"][3] == {"click_event": turns}
    raw = read_nbt(write_nbt(dict(nbt)), "sign.nbt")[1]
    (back,) = upgrade_signs([BlockEntity((1, 2, 3), held.id, raw)], 4435)
    first, second, _, last = map(json.loads, back.nbt["front_text"]["messages"])
    assert first["extra"][0] == {
        "text": "my ", "bold": True, "extra": [{"text": "red"}, {"text": " room"}]
    }  # fmt: skip
    assert second == {"text": "not JSON"}
    assert last == {"clickEvent": {"action": "change_page", "value": "2"}}


def test_a_sign_of_1_21_5_is_read_as_1_20_has_it():
    lines = ["plain", {"": "in a mixed list"}, {"text": "b", "bold": Byte(1)}, [""]]
    new = BlockEntity((0, 0, 0), "minecraft:sign", {"front_text": {"messages": lines}})
    (read,) = upgrade_signs([new], 4325)
    assert read.nbt["front_text"]["messages"] == [
        '{"text":"plain"}', '"in a mixed list"', '{"text":"b","bold":true}', '[""]'
    ]  # fmt: skip


def test_other_block_entities_stay_as_they_are():
    chest = BlockEntity((1, 2, 3), "minecraft:chest", {"Items": []})
    states = np.ones((1, 1, 1), np.uint16)
    volume = volume_of(states, ("minecraft:air", "minecraft:chest"), (1, 2, 3))
    assert convert_volume(volume, 3337) is volume
    old = BlockEntity((1, 2, 3), "minecraft:sign", {"Text1": "x"})
    both = volume_of(states, ("minecraft:air", STATE), (1, 2, 3), block_entities=(chest, old))
    assert convert_volume(both, 4325).block_entities == (chest, old)


@pytest.mark.parametrize(
    ("text", "lines", "expected"),
    [
        ("Room", 2, ["Room"]),
        ("Grandmother's kitchen", 2, ["Grandmother's", "kitchen"]),
        ("Donaudampfschifffahrt", 2, ["Donaudampfschif", "ffahrt"]),
        ("one two three four five six seven eight", 2, ["one two three", "four five six.."]),
        ("", 2, []),
    ],
)
def test_names_fit_the_sign(text, lines, expected):
    rows = wrap_sign_text(text, lines)
    assert rows == expected
    assert all(len(row) <= LINE_LETTERS for row in rows)


def test_a_fifth_line_is_refused():
    with pytest.raises(UsageError, match="a sign must have at most 4 lines of text, got 5"):
        sign_entity((0, 0, 0), ["a"] * 5)
