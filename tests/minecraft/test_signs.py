"""Signs as each game keeps them."""

import json

import numpy as np
import pytest
from block_volumes import volume_of

from world2minecraft.errors import UsageError
from world2minecraft.minecraft.nbt import read_nbt, write_nbt
from world2minecraft.minecraft.signs import LINE_LETTERS, sign_entity, signs_for, wrapped
from world2minecraft.minecraft.versions import game_version, game_versions, old_versions
from world2minecraft.types import BlockEntity

STATE = "minecraft:oak_wall_sign[facing=north,waterlogged=false]"
ENTITY = sign_entity((1, 2, 3), ["Küche", 'the "red" one'], "/function w2m:human_size")


def written(version):
    states = np.ones((1, 1, 1), np.uint16)
    volume = volume_of(states, ("minecraft:air", STATE), (1, 2, 3), block_entities=(ENTITY,))
    return signs_for(volume, game_version(version)).block_entities[0].nbt


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


def test_other_block_entities_stay_as_they_are():
    chest = BlockEntity((1, 2, 3), "minecraft:chest", {"Items": []})
    states = np.ones((1, 1, 1), np.uint16)
    volume = volume_of(states, ("minecraft:air", "minecraft:chest"), (1, 2, 3))
    assert signs_for(volume, game_version("1.19.4")) is volume
    old = BlockEntity((1, 2, 3), "minecraft:sign", {"Text1": "x"})
    both = volume_of(states, ("minecraft:air", STATE), (1, 2, 3), block_entities=(chest, old))
    assert signs_for(both, game_version("1.21.5")).block_entities == (chest, old)


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
    rows = wrapped(text, lines)
    assert rows == expected
    assert all(len(row) <= LINE_LETTERS for row in rows)


def test_a_fifth_line_is_refused():
    with pytest.raises(UsageError, match="a sign has 4 lines, not 5"):
        sign_entity((0, 0, 0), ["a"] * 5)
