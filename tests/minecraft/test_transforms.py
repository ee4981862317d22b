"""The laws of turning and mirroring, held against the public shape table for every state."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from world2minecraft.core.coordinates import apply as carried
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.block_states import known_blocks, parse_state, states_of
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.nbt import Byte, Float
from world2minecraft.minecraft.rules.attached_entities import named_block
from world2minecraft.minecraft.turn_and_mirror import mirror_state, turn_state, turn_volume

# Blocks that have no property for a direction, though their boxes are not the same from all sides:
# the game cannot turn them.
LOPSIDED = ["bamboo", "candle", "pointed_dripstone", "turtle_egg"]
LOPSIDED += [f"{colour}_candle" for colour in ("black", "blue", "brown", "cyan", "gray", "green")]
LOPSIDED += [f"light_{colour}_candle" for colour in ("blue", "gray")]
LOPSIDED += [f"{colour}_candle" for colour in ("lime", "magenta", "orange", "pink", "purple")]
LOPSIDED += [f"{colour}_candle" for colour in ("red", "white", "yellow")]
TURN_EXCEPTIONS = {
    **{f"minecraft:{name}": "stands off the middle and has no direction" for name in LOPSIDED},
    "minecraft:cake": "is eaten from the west and has no direction",
    "minecraft:sniffer_egg": "is wider along x and has no direction",
}
MIRROR_EXCEPTIONS = {
    "x": {name: why for name, why in TURN_EXCEPTIONS.items() if "sniffer" not in name},
    "z": {
        name: why
        for name, why in TURN_EXCEPTIONS.items()
        if name not in ("minecraft:sniffer_egg", "minecraft:cake")
    },
}


@cache
def every_state() -> tuple[str, ...]:
    return tuple(str(state) for name in known_blocks() for state in states_of(name))


def turned_boxes(boxes: np.ndarray) -> np.ndarray:
    """A quarter turn counter-clockwise from above about the block's middle: x' = z, z' = 1 - x."""
    x0, y0, z0, x1, y1, z1 = boxes.T
    return np.stack([z0, y0, 1 - x1, z1, y1, 1 - x0], axis=1)


def mirrored_boxes(boxes: np.ndarray, axis: str) -> np.ndarray:
    x0, y0, z0, x1, y1, z1 = boxes.T
    if axis == "x":
        return np.stack([1 - x1, y0, z0, 1 - x0, y1, z1], axis=1)
    return np.stack([x0, y0, 1 - z1, x1, y1, 1 - z0], axis=1)


def same_space(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two sets of boxes fill the same space, however it is cut."""
    edges = [np.unique(np.round(np.r_[first, second][:, [a, a + 3]], 5)) for a in range(3)]
    filled = []
    for boxes in (first, second):
        mask = np.zeros([max(len(e) - 1, 0) for e in edges], bool)
        for box in np.round(boxes, 5):
            lows = [np.searchsorted(e, box[a]) for a, e in enumerate(edges)]
            highs = [np.searchsorted(e, box[a + 3]) for a, e in enumerate(edges)]
            mask[lows[0] : highs[0], lows[1] : highs[1], lows[2] : highs[2]] = True
        filled.append(mask)
    return bool(np.array_equal(*filled))


class Law:
    """Compares shapes by their numbers in the table, each pair once."""

    def __init__(self, move):
        self.move = move
        self.seen: dict[tuple[int, int], bool] = {}

    def holds(self, before: str, after: str) -> bool:
        first, second = boxes_of(before), boxes_of(after)
        key = (id(first), id(second))
        if key not in self.seen:
            self.seen[key] = same_space(self.move(first), second)
        return self.seen[key]


def breakers(law: Law, change) -> dict[str, list[str]]:
    """The states that break the law, by block."""
    found: dict[str, list[str]] = {}
    for state in every_state():
        if not law.holds(state, change(state)):
            found.setdefault(state.partition("[")[0], []).append(state)
    return found


def explain(kind: str, found: dict[str, list[str]], expected: dict[str, str]) -> None:
    count = sum(map(len, found.values()))
    print(f"\n{kind}: {len(every_state())} states, {count} exceptions of {len(found)} blocks")  # noqa: T201
    for name, states in found.items():
        print(f"  {name} ({len(states)} states): {expected.get(name, 'NOT EXPECTED')}")  # noqa: T201


def test_the_table_has_every_state_of_the_game():
    assert len(known_blocks()) == 1003
    assert len(every_state()) == len(set(every_state())) == 24135


def test_a_quarter_turn_turns_the_boxes_of_every_state():
    found = breakers(Law(turned_boxes), lambda state: turn_state(state, 1))
    explain("a quarter turn", found, TURN_EXCEPTIONS)
    assert sorted(found) == sorted(TURN_EXCEPTIONS)
    # An exception is one that cannot be turned, never one that is turned wrongly.
    assert all(turn_state(s, 1) == s for states in found.values() for s in states)


@pytest.mark.parametrize("axis", ["x", "z"])
def test_mirroring_mirrors_the_boxes_of_every_state(axis):
    law = Law(lambda boxes: mirrored_boxes(boxes, axis))
    found = breakers(law, lambda state: mirror_state(state, axis))
    explain(f"mirroring {axis}", found, MIRROR_EXCEPTIONS[axis])
    assert sorted(found) == sorted(MIRROR_EXCEPTIONS[axis])
    assert all(mirror_state(s, axis) == s for states in found.values() for s in states)


def test_a_state_with_unsymmetric_boxes_changes():
    unmoved = {
        state.partition("[")[0]
        for state in every_state()
        if turn_state(state, 1) == state
        and not same_space(turned_boxes(boxes_of(state)), boxes_of(state))
    }
    assert unmoved == set(TURN_EXCEPTIONS)


def test_four_turns_are_the_identity_and_turns_add_up():
    for state in every_state():
        once = turn_state(state, 1)
        assert turn_state(state, 4) == turn_state(once, 3) == state
        assert turn_state(once, 1) == turn_state(state, 2)
        assert turn_state(state, -1) == turn_state(state, 3)


def test_two_mirrors_are_identity_or_half_turn():
    for state in every_state():
        mirrored = mirror_state(state, "x")
        assert mirror_state(mirrored, "x") == state
        assert mirror_state(mirror_state(state, "z"), "z") == state
        assert mirror_state(mirrored, "z") == turn_state(state, 2)


def test_a_mirror_undoes_the_sense_of_a_turn():
    for state in every_state():
        first = mirror_state(turn_state(state, 1), "x")
        assert first == turn_state(mirror_state(state, "x"), -1)


def test_turned_and_mirrored_states_are_valid_states():
    known = set(every_state())
    for change in (
        lambda state: turn_state(state, 1),
        lambda state: mirror_state(state, "x"),
        lambda state: mirror_state(state, "z"),
    ):
        assert {change(state) for state in every_state()} == known


def test_every_state_that_names_a_horizontal_side_is_turned():
    for state in every_state():
        value = dict(parse_state(state).properties)
        names_a_side = value.get("facing") in ("north", "east", "south", "west")
        if names_a_side or "rotation" in value or value.get("axis") in ("x", "z"):
            assert turn_state(state, 1) != state


def test_sides_that_have_no_box_are_turned_too():
    turned = {
        "wall_torch[facing=east]": "wall_torch[facing=north]",
        "oak_sign[rotation=12]": "oak_sign[rotation=8]",
        "rail[shape=south_east]": "rail[shape=north_east]",
        "rail[shape=ascending_west]": "rail[shape=ascending_south]",
        "rail[shape=north_south]": "rail[shape=east_west]",
        "jigsaw[orientation=down_east]": "jigsaw[orientation=down_north]",
        "redstone_wire[east=up,north=none,south=side,west=none]": (
            "redstone_wire[east=side,north=up,south=none,west=none]"
        ),
        "vine[east=true,north=false,south=false,west=false]": (
            "vine[east=false,north=true,south=false,west=false]"
        ),
        "mod:sofa_corner[facing=south]": "mod:sofa_corner[facing=east]",
    }
    for before, after in turned.items():
        assert turn_state(before, 1) == str(parse_state(after))


def test_left_and_right_change_places_in_a_mirror():
    mirrored = {
        "oak_stairs[facing=north,shape=inner_left]": "oak_stairs[facing=north,shape=inner_right]",
        "oak_door[facing=east,hinge=left]": "oak_door[facing=west,hinge=right]",
        "chest[facing=south,type=left]": "chest[facing=south,type=right]",
        "oak_slab[type=top]": "oak_slab[type=top]",
        "rail[shape=north_east]": "rail[shape=north_west]",
        "skeleton_skull[rotation=3]": "skeleton_skull[rotation=13]",
        "chiseled_bookshelf[slot_0_occupied=true]": "chiseled_bookshelf[slot_2_occupied=true]",
    }
    for before, after in mirrored.items():
        assert mirror_state(before, "x") == str(parse_state(after))
    # From 3 sixteenths past the south to 3 before the north.
    assert mirror_state("oak_sign[rotation=3]", "z") == str(parse_state("oak_sign[rotation=5]"))


def test_a_text_that_is_no_state_is_refused():
    with pytest.raises(UsageError, match="is invalid; expected text such as minecraft:oak_log"):
        turn_state("oak_log[axis=x", 1)


def test_a_turned_volume_keeps_every_block_at_its_room_point():
    volume = an_unsymmetric_volume()
    before, after = blocks_by_room_point(volume), blocks_by_room_point(turn_volume(volume, 1))
    assert before.keys() == after.keys()
    for point, (state, label, instance) in before.items():
        assert after[point] == (turn_state(state, 1), label, instance)


def test_four_turns_of_a_volume_are_the_identity():
    volume = an_unsymmetric_volume()
    turned = volume
    for _ in range(4):
        turned = turn_volume(turned, 1)
    np.testing.assert_array_equal(turned.states, volume.states)
    np.testing.assert_allclose(turned.block_to_room, volume.block_to_room, atol=1e-12)
    assert turned.palette == volume.palette
    assert turned.corner == volume.corner
    assert turned.block_entities == volume.block_entities
    assert turned.entities == volume.entities


@pytest.mark.parametrize(("turns", "same"), [(2, 2), (3, 3), (-1, 3), (5, 1), (4, 0)])
def test_a_volume_is_turned_as_often_as_asked(turns, same):
    volume = once = an_unsymmetric_volume()
    for _ in range(same):
        once = turn_volume(once, 1)
    turned = turn_volume(volume, turns)
    np.testing.assert_array_equal(turned.states, once.states)
    np.testing.assert_array_equal(turned.block_to_room, once.block_to_room)
    assert (turned.palette, turned.entities) == (once.palette, once.entities)


def test_what_lies_in_a_volume_turns_with_it():
    volume = an_unsymmetric_volume()
    turned = turn_volume(volume, 1)
    for old, new in (
        (np.add(volume.block_entities[0].block_pos, 0.5), turned.block_entities[0].block_pos),
        (volume.entities[0].position, np.subtract(turned.entities[0].position, 0.5)),
    ):
        expected = carried(volume.block_to_room, np.array(old, float))
        found = carried(turned.block_to_room, np.add(new, 0.5))
        np.testing.assert_allclose(found, expected, atol=1e-12)
    assert turned.entities[0].nbt["Rotation"][0] == -180.0  # From east to north.
    assert isinstance(turned.entities[0].nbt["Rotation"][0], Float)


@pytest.mark.parametrize(
    ("kind", "key", "sides"),
    [("item_frame", "Facing", (5, 2, 4, 3)), ("painting", "facing", (3, 2, 1, 0))],
)
def test_what_hangs_turns_with_the_block_that_it_names(kind, key, sides):
    volume = an_unsymmetric_volume()  # Its corner is -2 60 7, and it is 3 wide and 5 long.
    tile = dict(zip(("TileX", "TileY", "TileZ"), (-1, 61, 10), strict=True))
    new = {"block_pos": np.array((-1, 61, 10), np.int32)}
    held = tuple(
        Entity((-0.5, 61.5, 10.03), f"minecraft:{kind}", {**named, key: Byte(sides[0])})
        for named in (tile, new)
    )
    turned = replace(volume, entities=held)
    for side in (*sides[1:], sides[0]):
        turned = turn_volume(turned, 1)
        for entity in turned.entities:
            named = named_block(entity.nbt)
            assert named == tuple(np.floor(entity.position).astype(int).tolist())
            assert entity.nbt[key] == side and isinstance(entity.nbt[key], Byte)
    assert turned.entities[0].nbt.items() >= held[0].nbt.items()
    up = Entity((0.5, 61, 9), "minecraft:item_frame", {"Facing": Byte(1)})
    (still,) = turn_volume(replace(volume, entities=(up,)), 1).entities
    assert still.nbt["Facing"] == 1 and still.nbt["Rotation"][0] == -90


def an_unsymmetric_volume() -> BlockVolume:
    rng = np.random.default_rng(5)
    palette = ("minecraft:air", *every_state()[100:140:4], "minecraft:oak_stairs[facing=east]")
    shape = (3, 2, 5)
    return BlockVolume(
        states=rng.integers(0, len(palette), shape).astype(np.uint16),
        palette=palette,
        semantic=rng.integers(0, 12, shape).astype(np.uint8),
        instance=rng.integers(0, 9, shape).astype(np.uint16),
        corner=(-2, 60, 7),
        block_to_room=block_to_room(np.array([1.0, 2.0]), 4.0),
        block_entities=(BlockEntity((0, 61, 8), "minecraft:chest"),),
        entities=(Entity((-0.75, 60.5, 9.0), "minecraft:cow", {"Rotation": [Float(-90), 0.0]}),),
    )


def blocks_by_room_point(volume: BlockVolume) -> dict[tuple, tuple]:
    found = {}
    for cell in np.ndindex(volume.states.shape):
        point = carried(volume.block_to_room, np.add(volume.corner, cell) + 0.5)
        state = volume.palette[volume.states[cell]]
        found[tuple(np.round(point, 6))] = (state, volume.semantic[cell], volume.instance[cell])
    return found
