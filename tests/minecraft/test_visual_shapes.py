"""What is seen of block states."""

from itertools import combinations

import numpy as np
import pytest

from world2minecraft.minecraft.block_states import complete, known_blocks, parse_state, states_of
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.turn_and_mirror import turn_state
from world2minecraft.minecraft.visual_shapes import (
    find_visual_family,
    visual_boxes,
    visual_families,
)

# They have six plates, which overlap at the edges of the cube.
PLATES = ("vine", "glow_lichen", "sculk_vein")
# They stand off the middle, or look one way, and no property says so.
LOPSIDED = ("candle", "cake", "turtle_egg", "sniffer_egg", "sunflower")
UNSEEN = {"air", "cave_air", "void_air", "barrier", "light", "structure_void", "moving_piston"}


def samples():
    """Every state of the blocks of each hand-made family (one block a pattern), and more."""
    found = {}
    for name in known_blocks():
        family = find_visual_family(complete(parse_state(name)))
        if family is None:
            continue
        pattern = next(i for i, one in enumerate(visual_families()) if one is family)
        found.setdefault((pattern, tuple(complete(parse_state(name)).properties)), name)
    return [str(state) for name in found.values() for state in states_of(name)]


STATES = samples()


def sixteenths(state):
    return (visual_boxes(state) * 16).round(3).tolist()


def volume(boxes):
    return np.prod(boxes[:, 3:] - boxes[:, :3], axis=1)


def solid(boxes, steps=32):
    """The cells of a fine grid in the unit cube that boxes cover: bool [S, S, S]."""
    filled = np.zeros((steps,) * 3, bool)
    for box in np.rint(boxes * steps).astype(int).tolist():
        filled[box[0] : box[3], box[1] : box[4], box[2] : box[5]] = True
    return filled


def test_families_are_many_and_each_has_a_block_of_the_game():
    families = visual_families()
    assert len(families) >= 26
    met = {find_visual_family(complete(parse_state(name))) for name in known_blocks()} - {None}
    assert [family.name for family in families if family not in met] == []


def test_boxes_lie_in_the_cube_and_share_no_volume():
    for state in STATES:
        boxes = visual_boxes(state)
        assert boxes.dtype == np.float32
        assert (boxes >= 0).all() and (boxes <= 1).all(), state
        assert (boxes[:, 3:] > boxes[:, :3]).all(), state
        if any(name in state for name in PLATES):
            continue
        for one, other in combinations(boxes, 2):
            depth = np.minimum(one[3:], other[3:]) - np.maximum(one[:3], other[:3])
            assert (depth <= 1e-6).any(), (state, one, other)


def test_all_that_is_not_air_is_seen():
    empty = {
        name.partition(":")[2]
        for name in known_blocks()
        if not len(visual_boxes(name)) and len(states_of(name)) < 20_000
    }
    # Vines without a side and plants that have not come up yet have nothing to show by default.
    assert empty <= UNSEEN | {"vine", "glow_lichen", "sculk_vein"}


def test_a_quarter_turn_turns_what_is_seen():
    for state in STATES:
        if any(name in state for name in LOPSIDED):
            continue
        turned = solid(visual_boxes(turn_state(state, 1)))
        assert np.array_equal(turned, np.rot90(solid(visual_boxes(state)), 1, (2, 0))), state


def test_what_is_not_written_by_hand_looks_as_it_collides():
    for name in ("stone", "oak_stairs", "oak_slab", "oak_trapdoor", "glass_pane", "hopper"):
        assert find_visual_family(complete(parse_state(name))) is None
        assert np.array_equal(visual_boxes(name), np.clip(boxes_of(name), 0, 1))


@pytest.mark.parametrize(
    ("state", "expected"),
    [
        ("red_carpet", [[0, 0, 0, 16, 1, 16]]),
        ("oak_pressure_plate", [[1, 0, 1, 15, 1, 15]]),
        ("oak_button[face=wall,facing=north]", [[5, 6, 14, 11, 10, 16]]),
        ("oak_button[face=wall,facing=east]", [[0, 6, 5, 2, 10, 11]]),
        ("oak_wall_sign[facing=south]", [[0, 4.5, 0, 16, 12.5, 2]]),
        ("torch", [[7, 0, 7, 9, 10, 9]]),
        ("oak_fence", [[6, 0, 6, 10, 16, 10]]),
        ("end_rod[facing=up]", [[6, 0, 6, 10, 1, 10], [7, 1, 7, 9, 16, 9]]),
        ("end_rod[facing=down]", [[6, 15, 6, 10, 16, 10], [7, 0, 7, 9, 15, 9]]),
        ("end_rod[facing=east]", [[0, 6, 6, 1, 10, 10], [1, 7, 7, 16, 9, 9]]),
        ("soul_sand", [[0, 0, 0, 16, 16, 16]]),
        ("snow[layers=3]", [[0, 0, 0, 16, 6, 16]]),
        ("vine[east=true]", [[15, 0, 0, 16, 16, 16]]),
        ("glow_lichen[down=true]", [[0, 0, 0, 16, 1, 16]]),
        ("glow_lichen[up=true]", [[0, 15, 0, 16, 16, 16]]),
        ("air", []),
        ("light", []),
    ],
)
def test_known_looks(state, expected):
    assert sixteenths(state) == expected


def test_walls_are_one_block_high_and_low_differs_from_tall():
    low = visual_boxes("cobblestone_wall[up=false,north=low,south=low]")
    tall = visual_boxes("cobblestone_wall[up=false,north=tall,south=tall]")
    post = visual_boxes("cobblestone_wall")
    assert (low[:, 4].max(), tall[:, 4].max(), post[:, 4].max()) == (0.875, 1, 1)
    assert volume(low).sum() < volume(tall).sum()
    assert not visual_boxes("cobblestone_wall[up=false,north=low,south=low]")[:, 0].min() < 0.3


def test_fences_join_with_two_rails():
    alone, joined = visual_boxes("oak_fence"), visual_boxes("oak_fence[east=true]")
    assert len(joined) == len(alone) + 2
    assert joined[:, 3].max() == 1


def test_signs_turn_with_their_rotation():
    wide = [np.ptp(np.array(sixteenths(f"oak_sign[rotation={r}]"))[1, [0, 3]]) for r in range(16)]
    assert [width > 8 for width in wide[0::4]] == [True, False, True, False]


def test_unknown_blocks_look_like_those_with_like_names():
    state = "[facing=north,half=bottom,open=true]"
    assert sixteenths(f"minecraft:copper_trapdoor{state}") == sixteenths(f"oak_trapdoor{state}")
    assert sixteenths("mod:wardrobe") == [[0, 0, 0, 16, 16, 16]]
    assert sixteenths("mod:green_carpet") == [[0, 0, 0, 16, 1, 16]]
    assert sixteenths("mod:odd_wall") == [[0, 0, 0, 16, 16, 16]]  # No property says its sides.


def test_boxes_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        visual_boxes("torch")[0] = 2
    with pytest.raises(ValueError, match="read-only"):
        visual_boxes("stone")[0] = 2
