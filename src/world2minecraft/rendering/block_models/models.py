"""From a block state to its model: the rule that fits, its parts, and how the state turns them."""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.blocks import block_table
from world2minecraft.minecraft.glow import is_luminous
from world2minecraft.minecraft.rules.light import BRIGHTEST, light_of
from world2minecraft.minecraft.visual import visual_boxes_of
from world2minecraft.rendering.block_elements import BlockModel, Element
from world2minecraft.rendering.block_models.parts import PLAIN, Dress, box_element, elements_of
from world2minecraft.rendering.block_models.rules import LookRule, rule_for
from world2minecraft.rendering.block_models.texture_recipes import values_of
from world2minecraft.rendering.block_models.turning import along, quarter, sixteenth, tipped, turned


@lru_cache(maxsize=1 << 16)
def model_of(state: str) -> BlockModel:
    """Return the model of a block state; missing properties count as the defaults.

    One that no rule knows is drawn by the boxes that are seen of it, in its own colour, and marked
    as a stand-in.

    Raises:
        UsageError: the text is no block state.
    """
    whole = complete(parse_state(state))
    rule = rule_for(whole)
    dress = _dress(whole, rule)
    if rule is None or rule.parts is None:
        elements = _seen_boxes(whole, dress, glows=rule is not None and rule.glow)
        return BlockModel(tuple(elements), not dress.light, stand_in=rule is None)
    turn = _turn(rule, dress)
    drawn = [one for part in rule.parts for one in elements_of(_lit(part, rule), dress)]
    flat = any("cross" in part or "hash" in part for part in rule.parts)
    elements = drawn if np.array_equal(turn, np.eye(4)) else [turned(one, turn) for one in drawn]
    return BlockModel(tuple(elements), ambient_occlusion=not (flat or dress.light))


def _dress(state: BlockState, rule: LookRule | None) -> Dress:
    values = values_of(state.name, _known_values(state))
    light = BRIGHTEST if is_luminous(str(state)) else light_of(str(state))
    skin = PLAIN if rule is None or rule.skin is None else rule.skin
    return Dress(state.name, values, skin, {} if rule is None else rule.skins, light)


def _known_values(state: BlockState) -> dict[str, str]:
    """Return a state's properties; a value that the game does not know is the default's."""
    values = dict(state.properties)
    block = block_table().blocks.get(state.name)
    return values if block is None else values | block.values_at(block.index_of(values))


def _seen_boxes(state: BlockState, dress: Dress, glows: bool) -> list[Element]:
    boxes = visual_boxes_of(str(state)).astype(float) * 16
    return [box_element(box[:3], box[3:], {"glow": glows}, dress) for box in boxes.tolist()]


def _lit(part, rule: LookRule):
    return {"glow": True, **part} if rule.glow else part


def _turn(rule: LookRule, dress: Dress) -> np.ndarray:
    """Return the matrix that carries the written model to the state's."""
    matrix = np.eye(4)
    for kind, key in rule.turns:
        value = dress.values[key].partition("_")[0]  # A jigsaw's "down_east" points down.
        if kind == "turn":
            matrix = quarter(value) @ matrix
        elif kind == "point":
            matrix = tipped(value) @ matrix
        elif kind == "axis":
            matrix = along(value) @ matrix
        else:
            matrix = sixteenth(value, "south" if kind == "rotation" else "north") @ matrix
    return matrix
