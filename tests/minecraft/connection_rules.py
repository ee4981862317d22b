"""The rules of connection once more, slowly, a block at a time, for the tests of the fast ones."""

import numpy as np

from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of

STEP = {"north": (0, 0, -1), "east": (1, 0, 0), "south": (0, 0, 1), "west": (-1, 0, 0),
        "up": (0, 1, 0), "down": (0, -1, 0)}  # fmt: skip
ROUND = ("north", "east", "south", "west")
BACK = {**{side: ROUND[(i + 2) % 4] for i, side in enumerate(ROUND)}, "up": "down", "down": "up"}
STRANGE = ("_leaves", "barrier", "pumpkin", "jack_o_lantern", "melon", "shulker_box")
POSTS = ("torch", "_sign", "_banner", "_pressure_plate")


class World:
    """Complete states by place; air where nothing is."""

    def __init__(self, states, palette):
        whole = [complete(parse_state(text)) for text in palette]
        self.blocks = {
            tuple(cell): whole[states[tuple(cell)]]
            for cell in np.argwhere(states >= 0).tolist()
            if whole[states[tuple(cell)]].name != "minecraft:air"
        }
        self.air = complete(parse_state("air"))

    def at(self, cell, *ways):
        for way in ways:
            cell = tuple(a + b for a, b in zip(cell, STEP[way], strict=True))
        return self.blocks.get(cell, self.air)


def slowly_connected(states, palette):
    """What ``connected`` should give, as states by place."""
    world = World(states, palette)
    for rule in (door, stairs, gate, joint):
        world.blocks = {cell: rule(world, cell, state) for cell, state in world.blocks.items()}
    for cell in sorted(world.blocks, key=lambda cell: -cell[1]):
        world.blocks[cell] = wall(world, cell, world.blocks[cell])
    return world.blocks


def is_a(state, *ends):
    return state.name.endswith(ends)


def turned(side, quarters):
    return ROUND[(ROUND.index(side) + quarters) % 4]


def covers(state, way, low, high, shape=None):
    """Whether a face covers a rectangle, in sixteenths, of the two other axes in order."""
    boxes = boxes_of(str(state)) * 16 if shape is None else shape
    axis = {"x": 0, "y": 1, "z": 2}["zxzxyy"[list(STEP).index(way)]]
    level = 0.0001 if way in ("north", "west", "down") else 15.9999
    others = [a for a in range(3) if a != axis]
    points = [(u + 0.5, v + 0.5) for u in range(low[0], high[0]) for v in range(low[1], high[1])]
    return all(
        any(
            box[axis] < level < box[axis + 3]
            and box[others[0]] < u < box[others[0] + 3]
            and box[others[1]] < v < box[others[1] + 3]
            for box in boxes
        )
        for u, v in points
    )


def sturdy(state, way):
    if is_a(state, *STRANGE):
        return False
    return covers(state, way, (0, 0), (16, 16))


def door(world, cell, state):
    below = world.at(cell, "down")
    if not is_a(state, "_door") or state.get("half") == "lower":
        return state
    if below.name != state.name or below.get("half") == "upper":
        return state
    keys = ("facing", "hinge", "open", "powered")
    return state.having(**{key: below.get(key) for key in keys})


def stairs(world, cell, state):
    if not is_a(state, "_stairs"):
        return state
    own = state.get("facing")

    def free(way):
        other = world.at(cell, way)
        same = other.get("facing") == own and other.get("half") == state.get("half")
        return not (is_a(other, "_stairs") and same)

    for way, shape in ((own, "outer"), (BACK[own], "inner")):
        other = world.at(cell, way)
        if not is_a(other, "_stairs") or other.get("half") != state.get("half"):
            continue
        theirs = other.get("facing")
        if theirs in (own, BACK[own]):
            continue
        if free(BACK[theirs] if shape == "outer" else theirs):
            hand = "left" if theirs == turned(own, -1) else "right"
            return state.having(shape=f"{shape}_{hand}")
    return state.having(shape="straight")


def gate(world, cell, state):
    if not is_a(state, "_fence_gate"):
        return state
    ends = [world.at(cell, turned(state.get("facing"), quarter)) for quarter in (1, 3)]
    return state.having(in_wall="true" if any(is_a(end, "_wall") for end in ends) else "false")


def joins(world, cell, state, side):
    other = world.at(cell, side)
    through = is_a(other, "_fence_gate") and other.get("facing") in (turned(side, 1),
                                                                   turned(side, 3))  # fmt: skip
    if sturdy(other, BACK[side]):
        return True
    if is_a(state, "_pane", "_bars"):
        return is_a(other, "_pane", "_bars", "_wall")
    if is_a(state, "_wall"):
        return is_a(other, "_pane", "_bars", "_wall") or through
    alike = is_a(other, "_fence") and ("nether_brick" in other.name) == (
        "nether_brick" in state.name
    )
    return alike or through


def joint(world, cell, state):
    if not is_a(state, "_pane", "_bars", "_fence"):
        return state
    return state.having(
        **{side: "true" if joins(world, cell, state, side) else "false" for side in ROUND}
    )


def wall(world, cell, state):
    if not is_a(state, "_wall"):
        return state
    above = world.at(cell, "up")
    arms = {"north": ((7, 0), (9, 9)), "east": ((7, 7), (16, 9)),
            "south": ((7, 7), (9, 16)), "west": ((0, 7), (9, 9))}  # fmt: skip
    height = {
        side: ("tall" if covers(above, "down", *arms[side]) else "low")
        if joins(world, cell, state, side)
        else "none"
        for side in ROUND
    }
    return state.having(**height, up="true" if post(height, above) else "false")


def post(height, above):
    if is_a(above, "_wall") and above.get("up") == "true":
        return True
    is_open = [height[side] == "none" for side in ROUND]
    if all(is_open) or is_open[0] != is_open[2] or is_open[1] != is_open[3]:
        return True
    if height["north"] == height["south"] == "tall" or height["east"] == height["west"] == "tall":
        return False
    named = is_a(above, *POSTS) and not is_a(above, "wall_torch", "hanging_sign")
    return named or covers(above, "down", (7, 7), (9, 9))
