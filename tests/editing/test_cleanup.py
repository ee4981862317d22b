"""The clean-up mends what was planted, leaves what is right, and can be taken back."""

from dataclasses import replace

import numpy as np
import pytest
from edit_volumes import seen
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume
from world2minecraft.editing.cleanup.floating import floating_cells
from world2minecraft.editing.cleanup.passes import RULES, repair_volume
from world2minecraft.editing.volume_draft import Draft, apply_edits
from world2minecraft.minecraft.rules.stability import find_unstable

FLOOR, WALL, PANE = "minecraft:oak_planks", "minecraft:white_concrete", "minecraft:glass"
WOOD, RED = "minecraft:spruce_planks", "minecraft:red_concrete"
LOWER, UPPER = (f"minecraft:oak_slab[type={kind},waterlogged=false]" for kind in ("bottom", "top"))
STAIRS = "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]"
PALETTE = (AIR, FLOOR, WALL, PANE, WOOD, RED, LOWER, UPPER, STAIRS)
NUMBER = {state: number for number, state in enumerate(PALETTE)}
CEILING_CLASS, FLOOR_CLASS, WALL_CLASS, WINDOW_CLASS = 1, 2, 3, 4
CHAIR, TABLE, FURN, OBJS = 5, 8, 10, 11


class Room:
    """A closed room, 4 x 3 x 4 m inside at 4 blocks a metre, to put things into."""

    def __init__(self, scale=4.0):
        shape = (18, 14, 18)
        self.scale = scale
        self.states = np.zeros(shape, np.uint16)
        self.semantic = np.zeros(shape, np.uint8)
        self.instance = np.zeros(shape, np.uint16)
        for part in ((0,), (-1,)):
            for index in ((part[0], slice(None)), (slice(None), part[0])):
                self._set((index[0], slice(None), index[1]), WALL, WALL_CLASS, 0)
        self._set((slice(None), 0, slice(None)), FLOOR, FLOOR_CLASS, 0)
        self._set((slice(None), -1, slice(None)), WALL, CEILING_CLASS, 0)
        self._set((slice(6, 10), slice(5, 9), 0), PANE, WINDOW_CLASS, 0)
        self.put((slice(3, 9), 3, slice(3, 7)), LOWER, TABLE, 1)
        for x in (3, 8):
            for z in (3, 6):
                self.put((x, slice(1, 4), z), WOOD, TABLE, 1)

    def _set(self, at, state, class_id, instance):
        self.states[at], self.semantic[at] = NUMBER[state], class_id
        self.instance[at] = instance

    def put(self, at, state, class_id, instance):
        self._set(at, state, class_id, instance)
        return self

    def clear(self, *at):
        self._set(at, AIR, 0, 0)
        return self

    def volume(self, **held):
        return BlockVolume(
            self.states,
            PALETTE,
            self.semantic,
            self.instance,
            (0, 63, 0),
            block_to_room(np.array([0.0, 4.5]), self.scale),
            **held,
        )


def mend(room, *rules, **held):
    volume = room.volume(**held)
    result, edits = repair_volume(volume, rules or tuple(RULES))
    assert seen(apply_edits(result, *[e.inverse() for e in reversed(edits)])) == seen(volume)
    assert repair_volume(result, rules or tuple(RULES))[1] == ()
    return result, edits


def kinds(edits):
    return [edit.kind for edit in edits]


def test_a_room_without_faults_is_left_as_it_is():
    volume = Room().volume()
    assert repair_volume(volume) == (volume, ())


@pytest.mark.parametrize(
    ("at", "class_id"),
    [((0, 5, 5), WALL_CLASS), ((9, 0, 9), FLOOR_CLASS), ((9, 13, 9), CEILING_CLASS)],
)
def test_a_hole_in_a_shell_is_filled_as_the_shell_is(at, class_id):
    room = Room()
    expected = PALETTE[room.states[at]]
    result, edits = mend(room.clear(*at))
    assert kinds(edits) == ["fill"]
    assert result.palette[result.states[at]] == expected
    assert result.semantic[at] == class_id


def test_a_hole_of_two_by_two_is_one_edit_and_a_doorway_stays():
    room = Room().clear(0, slice(4, 6), slice(9, 11))
    room.clear(17, slice(1, 9), slice(6, 10))
    result, edits = mend(room)
    assert [(e.kind, len(e.cells)) for e in edits] == [("fill", 4)]
    assert not result.states[17, 1:9, 6:10].any()


def test_what_hangs_in_a_hole_is_left_alone():
    room = Room().put((0, slice(4, 6), slice(9, 11)), RED, OBJS, 7)
    assert mend(room, "holes")[1] == ()


def test_a_crumb_beside_its_object_is_dropped():
    result, edits = mend(Room().put((13, 9, 13), WOOD, TABLE, 1))
    assert kinds(edits) == ["drop"]
    assert edits[0].instance == 1
    assert not result.states[13, 9, 13]


def test_a_chair_that_hangs_in_the_air_is_put_down_with_its_sign():
    sign = BlockEntity((12, 67, 12), "minecraft:sign", {"Text1": "hello"})
    room = Room().put((slice(12, 14), slice(4, 8), slice(12, 14)), WOOD, CHAIR, 5)
    result, edits = mend(room, block_entities=(sign,))
    assert kinds(edits) == ["move"]
    assert edits[0].reason == "floating piece, 3 blocks too high"
    assert (result.instance[12:14, 1:5, 12:14] == 5).all()
    assert not result.states[12:14, 5:8, 12:14].any()
    assert result.block_entities == (replace(sign, block_pos=(12, 64, 12)),)


def test_a_lamp_under_the_ceiling_gets_its_cord():
    room = Room().put((slice(11, 14), slice(9, 11), slice(11, 14)), RED, OBJS, 6)
    result, edits = mend(room)
    assert kinds(edits) == ["hang"]
    assert "minecraft:chain[axis=y,waterlogged=false]" in result.palette
    assert (result.instance[12, 11:13, 12] == 6).all()


def test_a_part_beside_its_object_is_joined_to_it():
    room = Room().put((slice(12, 15), slice(1, 5), 12), WOOD, FURN, 4)
    room.put((slice(12, 15), slice(6, 9), 12), WOOD, FURN, 4)
    result, edits = mend(room)
    assert kinds(edits) == ["join"]
    assert (result.instance[12:15, 5, 12] == 4).sum() == 1


def test_an_upper_slab_over_the_floor_is_put_down():
    result, edits = mend(Room().put((13, 1, 13), UPPER, OBJS, 9))
    assert kinds(edits) == ["settle"]
    assert result.palette[result.states[13, 1, 13]] == LOWER


def test_a_slab_under_a_thing_is_made_whole():
    result, edits = mend(Room().put((5, 4, 5), RED, OBJS, 9))
    assert kinds(edits) == ["settle"]
    assert result.palette[result.states[5, 3, 5]] == LOWER.replace("bottom", "double")
    assert result.semantic[5, 3, 5] == TABLE


def test_a_bit_of_wall_in_the_air_is_dropped():
    assert kinds(mend(Room().put((9, 9, slice(9, 12)), WALL, WALL_CLASS, 0))[1]) == ["drop"]


def test_a_piece_behind_a_wall_is_taken_away():
    room = Room()
    room.put((slice(8, 17), slice(1, 3), 9), WALL, WALL_CLASS, 0)
    room.put((slice(12, 15), slice(1, 3), slice(10, 14)), WOOD, FURN, 4)
    room.put((13, 1, 8), WOOD, FURN, 4)
    result, edits = mend(room)
    assert kinds(edits) == ["trim"]
    assert edits[0].reason == "piece behind or inside a wall"
    assert not result.states[13, 1, 8]


def test_a_chair_through_furniture_loses_the_part_beyond():
    room = Room()
    room.put((slice(11, 15), slice(1, 6), 11), RED, FURN, 3)
    room.put((slice(11, 13), slice(1, 4), slice(12, 15)), WOOD, CHAIR, 4)
    room.put((12, 2, 10), WOOD, CHAIR, 4)
    result, edits = mend(room)
    assert kinds(edits) == ["trim"]
    assert not result.states[12, 2, 10]


def test_a_cupboard_goes_on_beyond_what_stands_before_it():
    room = Room().put((slice(11, 17), slice(1, 4), 12), WOOD, FURN, 3)
    room.put((15, slice(1, 4), 12), RED, OBJS, 4)
    assert mend(room)[1] == ()


def test_the_wall_comes_back_where_an_object_lets_one_see_out():
    room = Room().put((17, 3, 9), STAIRS, CHAIR, 4)
    room.put((slice(13, 17), slice(1, 4), 9), WOOD, CHAIR, 4)
    result, edits = mend(room)
    assert kinds(edits) == ["wall"]
    assert result.palette[result.states[17, 3, 9]] == WALL
    assert result.semantic[17, 3, 9] == WALL_CLASS


def test_a_full_block_in_the_wall_is_a_picture():
    room = Room().put((17, slice(4, 7), slice(8, 12)), RED, OBJS, 4)
    assert mend(room)[1] == ()


def test_what_would_pop_off_goes_and_connections_are_set():
    room = Room()
    volume = room.volume()
    torch = "minecraft:wall_torch[facing=east]"
    pane = "minecraft:glass_pane[east=false,north=false,south=false,waterlogged=false,west=false]"
    states = volume.states.copy()
    states[9, 3, 9] = len(PALETTE)  # No wall beside it.
    states[0, 3, 9] = len(PALETTE) + 1
    semantic = volume.semantic.copy()
    semantic[9, 3, 9], semantic[0, 3, 9] = OBJS, WINDOW_CLASS
    broken = replace(volume, states=states, semantic=semantic, palette=(*PALETTE, torch, pane))
    result, edits = repair_volume(broken, ("steady",))
    assert sorted(kinds(edits)) == ["connect", "drop"]
    assert find_unstable(result) == []
    assert not result.states[9, 3, 9]
    assert "north=true" in result.palette[result.states[0, 3, 9]]


def test_an_exact_copy_of_cells_is_left_as_it_is():
    volume = Room(scale=12.5).clear(0, 5, 5).volume()
    assert repair_volume(volume) == (volume, ())


def test_an_unknown_rule_is_named():
    with pytest.raises(UnknownNameError, match="no clean-up rule is named 'holse'; did you mean"):
        repair_volume(Room().volume(), ("holse",))


def test_unlabelled_blocks_lose_only_what_floats():
    room = Room()
    room.put((9, 6, 9), RED, 0, 0)
    room.semantic[:], room.instance[:] = 0, 0
    result, edits = mend(room)
    assert kinds(edits) == ["drop"]
    assert not result.states[9, 6, 9]


@settings(max_examples=15)
@given(st.integers(0, 10_000))
def test_whatever_is_planted_nothing_floats_in_the_end(seed):
    rng = np.random.default_rng(seed)
    room = Room()
    for number in range(int(rng.integers(1, 7))):
        low = rng.integers((1, 1, 1), (14, 11, 14))
        high = low + rng.integers(1, 4, 3)
        part = tuple(map(slice, low, np.minimum(high, (17, 13, 17))))
        free = room.states[part] == 0
        state = PALETTE[rng.choice([4, 5, 6, 7, 8])]
        for name, value in (
            ("states", NUMBER[state]),
            ("semantic", rng.choice([CHAIR, TABLE, FURN, OBJS])),
            ("instance", number % 3 + 2),
        ):
            getattr(room, name)[part][free] = value
    for _ in range(int(rng.integers(0, 3))):
        room.clear(*rng.integers((0, 1, 1), (1, 12, 17)))
    volume = room.volume()
    result, edits = repair_volume(volume)
    assert seen(apply_edits(result, *[e.inverse() for e in reversed(edits)])) == seen(volume)
    assert not floating_cells(Draft(result)).any()
    assert find_unstable(result) == []
