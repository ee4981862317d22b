"""The laws of our own models: every state has one, and a state turns what is written for north."""

import numpy as np
import pytest

from world2minecraft.minecraft.block_states import known_blocks, states_of
from world2minecraft.minecraft.visual_shapes import visual_boxes
from world2minecraft.rendering.block_elements import BlockModel, Element
from world2minecraft.rendering.block_models import BuiltinModels, stand_in_share, stand_ins
from world2minecraft.rendering.block_models.models import (
    QUARTERS,
    model_of,
    rotate_element,
    rotation_from_north,
)

STATES_EACH = 9  # Spread over all of a block: every facing, half and shape comes up somewhere.
UNSEEN = ("air", "barrier", "light", "structure_void", "moving_piston")
# Their looks reach out of the cell, or their visual boxes are of something simpler.
FREE_BOUNDS = ("banner", "redstone_wire", "lava", "tripwire_hook", "cluster", "fan", "sculk_s")
FREE_BOUNDS += ("mushroom", "fungus")


def some_states(block: str) -> list[str]:
    states = states_of(block)
    return [str(state) for state in states[:: max(1, len(states) // STATES_EACH)]]


def every_state() -> list[str]:
    return [state for block in known_blocks() for state in some_states(block)]


def corners(element: Element) -> np.ndarray:
    """The eight corners, blocks, float64 [8, 3]."""
    ends = np.array([element.low, element.high])
    points = np.array([[ends[i >> k & 1, k] for k in range(3)] for i in range(8)])
    if element.turn is None:
        return points
    return points @ element.turn[:3, :3].T + element.turn[:3, 3]


def painted(model: BlockModel) -> set:
    """All corners of all faces with their textures and (u, v): what is seen, whatever its order."""
    seen = set()
    for element in model.elements:
        to_block = np.eye(4) if element.turn is None else element.turn
        for side, face in enumerate(element.faces):
            if face is None:
                continue
            ends = np.array([element.low, element.high])
            for i in range(8):
                if (i >> (side // 2) & 1) == side % 2:
                    point = np.array([*(ends[i >> k & 1, k] for k in range(3)), 1.0])
                    place = (to_block @ point)[:3]
                    spot = (*place.round(6) + 0.0, *(face.uv @ point).round(6) + 0.0)
                    seen.add((face.texture, *map(float, spot)))
    return seen


def test_every_block_has_a_model_that_is_known():
    for block in known_blocks():
        model = model_of(block)
        assert not model.stand_in, block
    empty = {state for state in every_state() if not model_of(state).elements}
    named = {state.partition(":")[2].partition("[")[0] for state in empty}
    flat = {"vine", "glow_lichen", "sculk_vein"}  # With no face that is stated, nothing is there.
    assert not {name for name in named - flat if not name.endswith(UNSEEN)} - {"pitcher_crop"}


def test_all_faces_lie_somewhere():
    for state in every_state():
        for element in model_of(state).elements:
            assert len(element.faces) == 6
            assert any(element.faces)
            assert all(low <= high for low, high in zip(element.low, element.high, strict=True))
            for face in filter(None, element.faces):
                assert np.isfinite(face.uv).all()
                assert face.uv.shape == (2, 4)


def test_models_fill_about_the_boxes_that_are_seen():
    for state in every_state():
        boxes, model = visual_boxes(state), model_of(state)
        if not len(boxes) or not model.elements or any(word in state for word in FREE_BOUNDS):
            continue
        points = np.concatenate([corners(element) for element in model.elements])
        assert np.abs(points.min(0) - boxes[:, :3].min(0)).max() < 0.51, state
        assert np.abs(points.max(0) - boxes[:, 3:].max(0)).max() < 0.51, state


def test_no_two_faces_of_a_model_lie_in_one_place():
    for state in every_state():
        flat: dict[tuple[int, float], list] = {}
        for element in model_of(state).elements:
            for side, face in enumerate(element.faces):
                if face is None or element.turn is not None:
                    continue
                across = [axis for axis in range(3) if axis != side // 2]
                at = round((element.low, element.high)[side % 2][side // 2], 5)
                low, high = np.array(element.low)[across], np.array(element.high)[across]
                for other, its_low, its_high in flat.get((side, at), ()):
                    overlap = (np.minimum(high, its_high) - np.maximum(low, its_low)).min()
                    assert other == face.texture or overlap < 1e-6, state
                flat.setdefault((side, at), []).append((face.texture, low, high))


@pytest.mark.parametrize(
    "state",
    [
        "furnace[facing={},lit=true]",
        "oak_door[facing={},half=upper,hinge=right,open=true]",
        "red_bed[facing={},part=head]",
        "chest[facing={},type=left]",
        "wall_torch[facing={}]",
        "lectern[facing={},has_book=true]",
        "creeper_wall_head[facing={}]",
        "light_blue_glazed_terracotta[facing={}]",
        "grindstone[facing={},face=wall]",
    ],
)
def test_each_facing_is_the_northern_one_turned(state):
    north = model_of(state.format("north"))
    for facing in QUARTERS:
        turn = rotation_from_north(facing)
        moved = BlockModel(tuple(rotate_element(one, turn) for one in north.elements))
        assert painted(moved) == painted(model_of(state.format(facing)))


def test_four_quarter_turns_are_none():
    for state in ("oak_stairs[facing=east]", "poppy", "oak_sign[rotation=3]", "lever"):
        model = model_of(state)
        elements = model.elements
        for _ in range(4):
            elements = tuple(rotate_element(one, rotation_from_north("east")) for one in elements)
        assert painted(BlockModel(elements)) == painted(model)


def test_signs_turn_by_sixteenths_and_heads_look_the_other_way():
    south = painted(model_of("oak_wall_sign[facing=south]"))
    assert south
    for name in ("oak_sign", "red_banner", "oak_hanging_sign"):
        there = model_of(f"{name}[rotation=4]")
        moved = BlockModel(
            tuple(
                rotate_element(one, rotation_from_north("east"))
                for one in model_of(f"{name}[rotation=0]").elements
            )
        )
        assert painted(moved) == painted(there)
        assert all(one.turn is not None for one in model_of(f"{name}[rotation=1]").elements)
    face = model_of("creeper_head[rotation=0]").elements[0].faces[4]  # North.
    assert face is not None
    assert "creeper" in face.texture


def test_plants_are_two_crossed_pictures():
    for name in ("poppy", "oak_sapling", "fern", "tall_grass[half=upper]", "red_mushroom"):
        model = model_of(name)
        assert len(model.elements) == 2
        assert not model.ambient_occlusion
        for element in model.elements:
            assert element.turn is not None
            assert not element.shade
            assert [face is not None for face in element.faces] == [False] * 4 + [True] * 2
            assert corners(element).min() > -1e-9
            assert corners(element).max() < 1 + 1e-9


def test_hinges_mirror_a_door():
    left, right = (
        painted(model_of(f"oak_door[facing=north,half=lower,hinge={hinge},open=false]"))
        for hinge in ("left", "right")
    )
    leaf = [spot for spot in left if "door" in spot[0]]
    mirrored = {(name, round(1 - x, 6), y, z, u, v) for name, x, y, z, u, v in leaf}
    assert mirrored == {spot for spot in right if "door" in spot[0]}


def test_an_open_door_stands_on_its_hinge():
    hinge = model_of("oak_door[facing=north,hinge=left,open=true]").elements[0]
    assert (hinge.low, hinge.high) == ((0, 0, 0), (3 / 16, 1, 1))
    hinge = model_of("oak_door[facing=north,hinge=right,open=true]").elements[0]
    assert (hinge.low, hinge.high) == ((13 / 16, 0, 0), (1, 1, 1))


def test_the_grain_of_a_log_goes_along_its_axis():
    for axis, side in (("x", 1), ("y", 3), ("z", 4)):
        (log,) = model_of(f"oak_log[axis={axis}]").elements
        ends = [face is not None and "rings" in face.texture for face in log.faces]
        assert ends == [number // 2 == side // 2 for number in range(6)]


def test_lights_shine_and_burnt_out_ones_do_not():
    def brightest(state):
        return max(element.emission for element in model_of(state).elements)

    assert brightest("glowstone") == brightest("lantern") == brightest("lava") == 15
    assert brightest("candle[candles=2,lit=true]") == 15
    assert brightest("candle[candles=2,lit=false]") == brightest("redstone_lamp[lit=false]") == 0
    assert brightest("stone") == brightest("furnace[lit=true]") == 0


@pytest.mark.parametrize(
    "state",
    [
        "furnace[lit=maybe]",
        "cauldron[level=3]",  # As games before 1.17 have it.
        "cake[bites=99]",
        "oak_door[hinge=none,half=none,open=none,facing=up]",
        "redstone_wire[power=999999]",
        "oak_sign[rotation=77777]",
        "mod:lamp_barrel[facing=sideways,open=ajar]",
        "copper_chest[type=triple,facing=none]",
        "oak_hanging_sign[attached=1,rotation=x]",
    ],
)
def test_values_that_no_game_has_do_no_harm(state):
    looks = BuiltinModels()
    for element in looks.model(state).elements:
        for face in filter(None, element.faces):
            assert looks.texture(face.texture) is not None


def test_a_block_that_no_rule_knows_is_drawn_and_marked():
    model = BuiltinModels().model("mod:oddity")
    assert model.stand_in
    assert len(model.elements) == 1
    states = ["minecraft:stone", "mod:oddity", "mod:oddity", "mod:red_glass_slab[type=top]"]
    assert stand_ins(states) == ["mod:oddity"]
    assert stand_in_share(states) == pytest.approx(1 / 3)
    assert stand_in_share([]) == 0


def test_blocks_of_newer_games_are_known_by_their_names():
    newer = "short_grass pale_oak_planks pale_oak_stairs tuff_bricks crafter heavy_core"
    assert stand_ins(newer.split()) == []
    half = model_of("mod:cherry_brick_slab[type=top,waterlogged=false]")
    assert [element.low[1] for element in half.elements] == [0.5]


def test_real_builds_have_no_stand_in(shared_data):
    from world2minecraft.minecraft.formats import read_blocks

    for path in sorted(shared_data.glob("*_*/*.schem"))[:4]:
        assert stand_ins(read_blocks(path).palette) == [], path.name
