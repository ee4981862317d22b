"""Things in chests and frames as each game keeps them."""

import numpy as np
import pytest
from block_volumes import volume_of

from world2minecraft.core.types import BlockEntity, Entity
from world2minecraft.minecraft.entity_conversion import convert_volume, count_lost_data
from world2minecraft.minecraft.file_format import Losses, WriteOptions
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.nbt import Byte

CHEST = "minecraft:chest[facing=north,type=single,waterlogged=false]"
SWORD = {"id": "minecraft:iron_sword", "Slot": Byte(3)}
OLD = {**SWORD, "Count": Byte(1), "tag": {"Damage": 7}}
NEW = {**SWORD, "count": 1, "components": {"minecraft:damage": 7}}
MANY = {"id": "minecraft:dirt", "count": 500}
LOST = "names, enchantments and other data of item stacks"


def volume_with(*stacks):
    chest = BlockEntity((1, 2, 3), "minecraft:chest", {"Items": list(stacks)})
    held = {"Item": stacks[0], "UUID": np.arange(4, dtype=np.int32), "Facing": Byte(2)}
    frame = Entity((1.5, 3.5, 3.5), "minecraft:item_frame", held)
    states = np.ones((1, 1, 1), np.uint16)
    holds = {"block_entities": (chest,), "entities": (frame,)}
    return volume_of(states, ("minecraft:air", CHEST), (1, 2, 3), **holds)


@pytest.mark.parametrize("name", ["a.schem", "a.litematic", "a.nbt", "a.mcfunction", "a.zip", "a"])
def test_every_writer_gives_a_game_the_stacks_that_it_knows(name, tmp_path):
    for version, stacks, expected in (
        ("1.20.4", (NEW, MANY), ({**SWORD, "Count": 1}, {"id": "minecraft:dirt", "Count": 127})),
        ("1.20.5", (OLD,), ({**SWORD, "count": 1},)),
        ("1.20.4", (OLD,), (OLD,)),
        ("1.21.8", (NEW, MANY), (NEW, MANY)),
    ):
        losses = Losses()
        path = tmp_path / version / str(len(expected)) / name
        write_blocks(volume_with(*stacks), path, WriteOptions(mc_version=version), losses)
        back = read_blocks(path)
        assert tuple(back.block_entities[0].nbt["Items"]) == expected
        assert back.entities[0].nbt["Item"] == expected[0]
        assert dict(losses) == ({} if expected == stacks else {LOST: 2})


def test_what_is_no_stack_stays():
    spawner = BlockEntity(
        (1, 2, 3), "minecraft:spawner", {"id": "x", "Count": "many", "tag": {"id": 7, "Count": 1}}
    )
    states = np.ones((1, 1, 1), np.uint16)
    volume = volume_of(states, ("minecraft:air", CHEST), (1, 2, 3), block_entities=(spawner,))
    assert convert_volume(volume, 4440) is volume
    assert convert_volume(volume_with(NEW), 4440).entities[0].nbt["Item"] is NEW
    losses = Losses()
    count_lost_data(volume, 4440, losses)
    assert not len(losses)
