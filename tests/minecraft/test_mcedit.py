from pathlib import Path

import numpy as np
import pytest
from block_volumes import state_texts, volume_of

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import AIR, BlockEntity
from world2minecraft.minecraft.block_states import check_state, complete, parse_state
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.nbt import Byte, Short, pack_gzip, write_nbt
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.schematics.mcedit import read_schematic
from world2minecraft.minecraft.schematics.pre_flattening import legacy_state
from world2minecraft.minecraft.signs import upgrade_sign


def schematic(
    blocks: dict[tuple[int, int, int], tuple[int, int]], size: tuple[int, int, int], **changes
) -> bytes:
    """A file with blocks (number, data value) at places, made by plain arithmetic."""
    width, height, length = size
    count = width * height * length
    numbers, values, more = bytearray(count), bytearray(count), bytearray(-(-count // 2))
    for (x, y, z), (number, value) in blocks.items():
        at = (y * length + z) * width + x
        numbers[at], values[at] = number & 255, value
        more[at // 2] |= (number >> 8) << (0 if at % 2 == 0 else 4)
    tree = {
        "Materials": "Alpha",
        "Width": Short(width),
        "Height": Short(height),
        "Length": Short(length),
        "Blocks": np.frombuffer(bytes(numbers), np.int8),
        "Data": np.frombuffer(bytes(values), np.int8),
        "Entities": [],
        "TileEntities": [],
    }
    if any(more):
        tree["AddBlocks"] = np.frombuffer(bytes(more), np.int8)
    tree = {key: value for key, value in (tree | changes).items() if value is not None}
    return pack_gzip(write_nbt(tree, "Schematic"))


def read(data: bytes, tmp_path: Path, losses: Losses | None = None):
    (tmp_path / "a.schematic").write_bytes(data)
    return read_schematic(tmp_path / "a.schematic", losses)


def one(number: int, value: int, tmp_path: Path, **tags) -> str:
    """The state of a block that stands alone, with the tags of its block entity."""
    held = {"id": "Any", "x": 0, "y": 0, "z": 0, **tags}
    changes = {"TileEntities": [held]} if tags else {}
    found = read(schematic({(0, 0, 0): (number, value)}, (1, 1, 1), **changes), tmp_path)
    return str(state_texts(found)[0, 0, 0])


# The table.


def test_every_legacy_number_maps_to_a_known_state():
    for number in range(256):
        for value in range(16):
            text, is_known = legacy_state(number, value, {})
            assert is_known == (number not in (253, 254))
            if is_known:
                state = parse_state(text)
                assert complete(check_state(state)) == state


# Each from the lists of block numbers and data values that the game's players kept.
KNOWN = [
    (1, 5, "andesite"),
    (3, 2, "podzol[snowy=false]"),
    (5, 3, "jungle_planks"),
    (17, 4, "oak_log[axis=x]"),
    (17, 9, "spruce_log[axis=z]"),
    (24, 1, "chiseled_sandstone"),
    (35, 11, "blue_wool"),
    (43, 0, "smooth_stone_slab[type=double,waterlogged=false]"),
    (44, 9, "sandstone_slab[type=top,waterlogged=false]"),
    (50, 5, "torch"),
    (50, 1, "wall_torch[facing=east]"),
    (53, 6, "oak_stairs[facing=south,half=top,shape=straight,waterlogged=false]"),
    (54, 2, "chest[facing=north,type=single,waterlogged=false]"),
    (60, 7, "farmland[moisture=7]"),
    (63, 12, "oak_sign[rotation=12,waterlogged=false]"),
    (68, 4, "oak_wall_sign[facing=west,waterlogged=false]"),
    (96, 12, "oak_trapdoor[facing=north,half=top,open=true,powered=false,waterlogged=false]"),
    (118, 0, "cauldron"),
    (118, 2, "water_cauldron[level=2]"),
    (126, 8, "oak_slab[type=top,waterlogged=false]"),
    (155, 3, "quartz_pillar[axis=x]"),
    (159, 14, "red_terracotta"),
    (171, 13, "green_carpet"),
    (198, 1, "end_rod[facing=up]"),
    (251, 15, "black_concrete"),
    (1, 15, "stone"),
]


@pytest.mark.parametrize(("number", "value", "state"), KNOWN)
def test_numbers_become_states(number, value, state):
    assert legacy_state(number, value, {}) == (f"minecraft:{state}", True)


# Whole files.


def test_a_file_is_read_cell_by_cell(tmp_path):
    rng = np.random.default_rng(0)
    size = (5, 4, 3)
    blocks = {cell: (int(rng.integers(1, 6)), int(rng.integers(0, 6))) for cell in np.ndindex(size)}
    found = read(schematic(blocks, size), tmp_path)
    for cell, (number, value) in blocks.items():
        assert state_texts(found)[cell] == legacy_state(number, value, {})[0]


def test_where_it_was_copied_from_is_its_corner(tmp_path):
    data = schematic({}, (2, 2, 2), WEOriginX=-7, WEOriginY=64, WEOriginZ=100)
    assert read(data, tmp_path).corner == (-7, 64, 100)
    assert read(schematic({}, (2, 2, 2)), tmp_path).corner == (0, 0, 0)


def test_blocks_of_mods_keep_number_or_name_and_are_counted(tmp_path):
    losses = Losses()
    blocks = {(0, 0, 0): (1, 0), (1, 0, 0): (300, 3), (2, 0, 0): (4095, 0), (3, 0, 0): (301, 0)}
    names = {"Shop:Shelf": Short(300), "minecraft:stone": Short(1), "no name": Short(301)}
    data = schematic(blocks, (4, 1, 1), SchematicaMapping=names, Biomes=np.zeros(4, np.int8))
    found = read(data, tmp_path, losses)
    assert state_texts(found)[:, 0, 0].tolist() == [
        "minecraft:stone",
        "shop:shelf[data=3]",
        "legacy:4095_0",
        "legacy:301_0",
    ]
    told = "mod blocks, kept with their legacy ID or name"
    assert list(losses) == [("biomes", 1), (told, 3)]
    data = schematic(blocks, (4, 1, 1), BlockIDs={"4095": "shop:till"})
    assert state_texts(read(data, tmp_path))[2, 0, 0] == "shop:till"


def test_it_can_be_converted_and_not_written(tmp_path):
    data = schematic({(1, 1, 1): (5, 1), (0, 0, 0): (1, 0)}, (2, 2, 2))
    (tmp_path / "a.schematic").write_bytes(data)
    found = read_blocks(tmp_path / "a.schematic")
    write_blocks(found, tmp_path / "b.schem")
    np.testing.assert_array_equal(
        state_texts(read_blocks(tmp_path / "b.schem")), state_texts(found)
    )
    with pytest.raises(UsageError, match="unknown file suffix for blocks"):
        write_blocks(found, tmp_path / "c.schematic")


# What stood in the neighbours.


def test_the_halves_of_a_door_tell_each_other(tmp_path):
    # The lower half: facing west (2), open (4). The upper half: hinge on the right (9).
    found = read(schematic({(0, 0, 0): (64, 6), (0, 1, 0): (64, 9)}, (1, 2, 1)), tmp_path)
    rest = "facing=west,half={},hinge=right,open=true,powered=false"
    halves = state_texts(found)[0, :, 0].tolist()
    assert halves == [f"minecraft:oak_door[{rest.format(h)}]" for h in ("lower", "upper")]
    found = read(schematic({(0, 0, 0): (71, 1), (0, 1, 0): (71, 10)}, (1, 2, 1)), tmp_path)
    lower = parse_state(str(state_texts(found)[0, 0, 0]))
    assert (lower.get("hinge"), lower.get("powered")) == ("left", "true")


def test_the_upper_half_of_a_plant_is_of_its_kind(tmp_path):
    found = read(schematic({(0, 0, 0): (175, 4), (0, 1, 0): (175, 10)}, (1, 2, 1)), tmp_path)
    halves = state_texts(found)[0, :, 0].tolist()
    assert halves == [f"minecraft:rose_bush[half={half}]" for half in ("lower", "upper")]


@pytest.mark.parametrize(
    ("value", "along_x", "first"),
    [(2, True, "left"), (3, True, "right"), (4, False, "right"), (5, False, "left")],
)
def test_two_chests_side_by_side_are_one(value, along_x, first, tmp_path):
    other = (1, 0, 0) if along_x else (0, 0, 1)
    found = read(schematic({(0, 0, 0): (54, value), other: (54, value)}, (2, 1, 2)), tmp_path)
    texts = state_texts(found)
    second = "right" if first == "left" else "left"
    assert parse_state(str(texts[0, 0, 0])).get("type") == first
    assert parse_state(str(texts[other])).get("type") == second
    np.testing.assert_array_equal(
        *(np.array(update_connections(found.states, found.palette)[0]), found.states)
    )


def test_connected_blocks_take_shape_from_their_neighbours(tmp_path):
    blocks = {(0, 0, 0): (85, 0), (1, 0, 0): (85, 0), (2, 0, 0): (1, 0), (0, 0, 2): (102, 0)}
    blocks |= {(1, 0, 2): (53, 0), (2, 0, 2): (53, 2)}
    texts = state_texts(read(schematic(blocks, (3, 1, 3)), tmp_path))
    fence = parse_state(str(texts[1, 0, 0]))
    assert (fence.get("east"), fence.get("west"), fence.get("north")) == ("true", "true", "false")
    assert parse_state(str(texts[1, 0, 2])).get("shape") != ""


# What stood in the block entities.


def test_the_colour_of_a_bed(tmp_path):
    assert one(26, 8, tmp_path, color=11).startswith("minecraft:blue_bed[facing=south")
    assert one(26, 8, tmp_path).startswith("minecraft:red_bed[")


def test_heads(tmp_path):
    wall = one(144, 4, tmp_path, SkullType=Byte(3), Rot=Byte(5))
    assert wall == "minecraft:player_wall_head[facing=west]"
    stands = one(144, 1, tmp_path, SkullType=Byte(1), Rot=Byte(5))
    assert stands == "minecraft:wither_skeleton_skull[rotation=5]"


def test_flower_pots(tmp_path):
    assert (
        one(140, 0, tmp_path, Item="minecraft:red_flower", Data=4) == "minecraft:potted_red_tulip"
    )
    assert one(140, 0, tmp_path, Item=81, Data=0) == "minecraft:potted_cactus"
    assert one(140, 0, tmp_path, Item="minecraft:air", Data=0) == "minecraft:flower_pot"
    assert one(140, 0, tmp_path, Item="minecraft:tallgrass", Data=2) == "minecraft:potted_fern"


def test_banners_count_their_colours_from_black(tmp_path):
    assert one(176, 4, tmp_path, Base=1) == "minecraft:red_banner[rotation=4]"
    assert one(177, 3, tmp_path, Base=15) == "minecraft:white_wall_banner[facing=south]"


def test_block_entities_and_entities_have_the_names_of_today(tmp_path):
    held = [
        {"id": "Sign", "x": 0, "y": 0, "z": 0, "Text1": "Exit", "Text2": '{"text":"this way"}'},
        {"id": "EnderChest", "x": 1, "y": 0, "z": 0},
        {"id": "minecraft:chest", "x": 2, "y": 0, "z": 0, "Items": []},
        {"id": "FlowerPot", "x": 0, "y": 0, "z": 1, "Item": 0, "Data": 0},
        {"id": "RecordPlayer", "x": 1, "y": 0, "z": 1},
    ]
    entities = [{"id": "ItemFrame", "Pos": [0.5, 0.5, 0.03], "TileX": 0, "TileY": 0, "TileZ": 0}]
    data = schematic({}, (3, 1, 2), TileEntities=held, Entities=entities, WEOriginY=64)
    found = read(data, tmp_path)
    names = {entity.block_pos: entity.id for entity in found.block_entities}
    assert names == {
        (0, 64, 0): "minecraft:sign",
        (1, 64, 0): "minecraft:ender_chest",
        (2, 64, 0): "minecraft:chest",
        (1, 64, 1): "minecraft:jukebox",
    }
    front = found.block_entities[0].nbt["front_text"]
    assert front["messages"][:2] == ['{"text": "Exit"}', '{"text":"this way"}']
    (frame,) = found.entities
    assert (frame.id, frame.position) == ("minecraft:item_frame", (0.5, 64.5, 0.03))
    assert (frame.nbt["TileX"], frame.nbt["TileY"], frame.nbt["TileZ"]) == (0, 64, 0)


# Signs.


def test_signs_go_to_older_games_and_back():
    old = {"Text1": '{"text":"a"}', "Color": "red", "GlowingText": Byte(1)}
    today = upgrade_sign(old)
    assert today["front_text"]["color"] == "red"
    assert upgrade_sign(today) == today
    sign = BlockEntity((0, 0, 0), "minecraft:sign", today)
    volume = volume_of(
        np.ones((1, 1, 1)), (AIR, "minecraft:oak_sign"), (0, 0, 0), block_entities=(sign,)
    )
    assert convert_volume(volume, 3465) is volume
    (back,) = convert_volume(volume, 2586).block_entities
    assert back.nbt.items() >= {**old, "Text4": '{"text":""}'}.items()
    assert upgrade_sign(back.nbt) == today


# Damaged files.

SIZE = (2, 1, 2)
DAMAGED = {
    "too few blocks": ({"Blocks": np.zeros(3, np.int8)}, "declares 4 blocks but contains fewer"),
    "too few values": ({"Data": np.zeros(3, np.int8)}, "declares 4 blocks but contains fewer"),
    "too few high bits": (
        {"AddBlocks": np.zeros(1, np.int8)},
        "declares 4 blocks but contains fewer",
    ),
    "no blocks": ({"Blocks": None}, "is not a valid legacy schematic ('Blocks' is missing)"),
    "blocks of text": ({"Blocks": "stone"}, "is not a valid legacy schematic"),
    "no width": ({"Width": None}, "is not a valid legacy schematic ('Width' is missing)"),
    "a width of nothing": ({"Width": Short(0)}, "a size of 0 x 1 x 2 blocks"),
    "a huge size": (
        {"Width": Short(-1), "Height": Short(-1), "Length": Short(-1)},
        "declares a size of 65535 x 65535 x 65535 blocks; expected 1 to 67,108,864 blocks",
    ),
    "another game": (
        {"Materials": "Pocket"},
        "has the materials 'Pocket'; only 'Alpha' (Java) is supported",
    ),
    "a block entity without a place": (
        {"TileEntities": [{"id": "Sign"}]},
        "is not a valid legacy schematic ('x' is missing)",
    ),
    "an entity without a place": (
        {"Entities": [{"id": "Pig"}]},
        "is not a valid legacy schematic ('Pos' is missing)",
    ),
    "a mapping of texts": (
        {"SchematicaMapping": {"a": "b"}},
        "is not a valid legacy schematic",
    ),
}


@pytest.mark.parametrize(("changes", "reason"), DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_schematic_is_refused_by_name(changes, reason, tmp_path):
    with pytest.raises(InputError) as caught:
        read(schematic({}, SIZE, **changes), tmp_path)
    text = str(caught.value)
    assert text.startswith(f"{tmp_path / 'a.schematic'}: ") and reason in text and "\n" not in text
