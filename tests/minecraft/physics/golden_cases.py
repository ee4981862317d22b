"""The walks that Python and TypeScript must agree on, and what writes them down.

``python -m tests.minecraft.physics.golden_cases`` writes ``golden.json`` next to this file: for
each walk the boxes, the keys and where the player is after every fourth tick.
"""

import json
from pathlib import Path

import numpy as np

from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.physics import Body, BoxWorld, Keys, step

GOLDEN = Path(__file__).with_name("golden.json")
EVERY = 4  # Ticks between the places written down.
FLAGS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")
FLOOR = [[-200, -1, -200, 200, 0, 200]]
WALL_AHEAD = [[-5, 0, 3, 5, 3, 4]]


def block(state: str, x: int, y: int, z: int) -> list[list[float]]:
    """The boxes of a block in its place."""
    return (boxes_of(f"minecraft:{state}") + np.tile([x, y, z], 2)).tolist()


def row(state: str, x: range, y: int, z: int) -> list[list[float]]:
    return [box for at in x for box in block(state, at, y, z)]


def stairs(facing: str, steps: int = 3) -> list[list[float]]:
    """Stairs that go up to the south, each upon a full block, and a floor at their end."""
    boxes = []
    for number in range(steps):
        boxes += row(f"oak_stairs[facing={facing}]", range(-1, 1), number, 2 + number)
        boxes += [[-1, 0, 2 + number, 1, number, 3 + number]] if number else []
    return [*boxes, [-3, 0, 2 + steps, 3, steps, 12]]


def crowd(seed: int) -> list[list[float]]:
    """A floor with blocks of many shapes at random."""
    random = np.random.default_rng(seed)
    states = ("stone", "oak_slab", "oak_stairs[facing=west]", "oak_fence", "white_carpet",
              "oak_trapdoor[half=bottom,open=false]", "oak_door[facing=south]",
              "oak_slab[type=top]", "glass_pane[north=true,south=true]")  # fmt: skip
    boxes = []
    for x, z in random.integers(-6, 7, (60, 2)).tolist():
        if not (x in (-1, 0) and z in (-1, 0)):  # The start is free.
            boxes += block(states[random.integers(len(states))], x, int(random.integers(2)), z)
    return boxes


def case(name, boxes, keys, start=(0.0, 0.0, 0.0), scale=1.0, floor=True):
    return {
        "name": name,
        "scale": scale,
        "start": list(start),
        "boxes": [[float(v) for v in box] for box in ([*FLOOR, *boxes] if floor else boxes)],
        "keys": [
            {"ticks": ticks, "down": held.split(), "yaw_deg": float(yaw)}
            for ticks, held, yaw in keys
        ],
    }


def scaled(boxes, scale):
    return [[value * scale for value in box] for box in boxes]


def random_keys(seed: int, spells: int = 25) -> list[tuple[int, str, float]]:
    random = np.random.default_rng(seed)
    return [
        (
            int(random.integers(2, 14)),
            " ".join(flag for flag in FLAGS if random.random() < 0.3),
            round(float(random.uniform(-180, 180)), 1),
        )
        for _ in range(spells)
    ]


DOOR = "oak_door[facing=south,half=lower,open={}]"
DOORWAY = [[-5, 0, 2, -0.5, 3, 3], [0.5, 0, 2, 5, 3, 3]]
LOW = [[-1, 1.6, 2, 1, 3, 6]]

CASES = [
    case("walk on a floor", [], [(40, "forward", 0)]),
    case("walk backwards and aside", [], [(20, "back", 30), (20, "left", 30), (20, "right", 30)]),
    case("walk aslant is no faster", [], [(40, "forward left", 0)]),
    case("sprint, then let go", [], [(30, "forward sprint", -75), (20, "", -75)]),
    case("sneak", [], [(40, "forward sneak", 200)]),
    case("opposite keys stand still", [], [(8, "forward back left right", 0)]),
    case("jump on the spot", [], [(1, "jump", 0), (15, "", 0)]),
    case("jump held down", [], [(40, "jump", 0)]),
    case("sprint and jump", [], [(10, "forward sprint", 90), (30, "forward sprint jump", 90)]),
    case("steer in the air", [], [(6, "forward jump", 0), (10, "left", 0), (10, "back", 0)]),
    case("a wall stops", WALL_AHEAD, [(40, "forward", 0)]),
    case("slide along a wall", WALL_AHEAD, [(40, "forward", -50)]),
    case("stuck in a corner", [*WALL_AHEAD, [2, 0, -5, 3, 3, 4]], [(60, "forward sprint", -40)]),
    case("graze an outer corner", [[0.3, 0, 1, 2, 3, 2]], [(40, "forward", 0)]),
    case("walk into a corner's edge", [[0.2, 0, 1, 2, 3, 2]], [(40, "forward", -20)]),
    case("a slab is a step", row("oak_slab", range(-2, 2), 0, 2), [(40, "forward", 0)]),
    case("a carpet is a step", row("white_carpet", range(-2, 2), 0, 2), [(24, "forward", 0)]),
    case("a block is no step", row("stone", range(-2, 2), 0, 2), [(24, "forward", 0)]),
    case("jump onto a block", [[-2, 0, 2, 2, 1, 8]], [(12, "forward", 0), (40, "forward jump", 0)]),
    case("a fence cannot be jumped", row("oak_fence[east=true,west=true]", range(-3, 3), 0, 2),
         [(60, "forward jump", 0)]),
    case("stairs go up", stairs("south"), [(60, "forward", 0)]),
    case("stairs go up at a sprint", stairs("south"), [(40, "forward sprint", 3)]),
    case("stairs from behind are a wall", stairs("north", 1), [(30, "forward", 0)]),
    case("stairs go down", stairs("south"), [(60, "forward", 180)], (0.0, 3.0, 7.0)),
    case("a slab under a slab's ceiling", [*row("oak_slab", range(-2, 2), 0, 2),
         [-2, 2.2, 2, 2, 3, 3]], [(30, "forward", 0)]),
    case("off a ledge", [[-2, -1, -2, 2, 3, 2]], [(50, "forward", 0)], (0.0, 3.0, 0.0)),
    case("a long fall", [], [(60, "", 0)], (0.0, 30.0, 0.0)),
    case("a ceiling ends a jump", [[-3, 2.2, -3, 3, 3, 9]], [(40, "forward jump", 0)]),
    case("a closed door stops", [*DOORWAY, *block(DOOR.format("false"), 0, 0, 2)],
         [(40, "forward", 0)], (0.5, 0.0, 0.0)),
    case("through an open door", [[-5, 0, 2, 0, 3, 3], [1, 0, 2, 5, 3, 3],
         *block(DOOR.format("true"), 0, 0, 2)], [(40, "forward", 0)], (0.5, 0.0, 0.0)),
    case("through a doorway one wide", DOORWAY, [(40, "forward sprint", 0)]),
    case("past a doorway's post", DOORWAY, [(40, "forward", 12)]),
    case("sneak to an edge", [[-2, -1, -2, 2, 3, 2]], [(80, "forward sneak", 0)], (0.0, 3.0, 0.0)),
    case("sneak into an edge's corner", [[-2, -1, -2, 2, 3, 2]], [(120, "forward sneak", -40)],
         (0.0, 3.0, 0.0)),
    case("sneak down a slab", row("oak_slab", range(-1, 1), 0, 0), [(60, "forward sneak", 0)],
         (0.0, 0.5, 0.5)),
    case("no room to stand up", LOW, [(60, "forward sneak", 0), (40, "forward", 0),
         (100, "forward", 0)]),
    case("upright under a low ceiling", LOW, [(30, "forward", 0)]),
    case("between panes", [*block("glass_pane[north=true,south=true]", -1, 0, 1),
         *block("glass_pane[north=true,south=true]", 0, 0, 1)], [(40, "forward", 0)],
         (0.0, 0.0, 0.0)),
    case("a person's size at 4 blocks a metre", row("stone", range(-9, 9), 0, 8) +
         row("stone", range(-9, 9), 1, 8) + row("stone", range(-9, 9), 0, 9),
         [(40, "forward", 0)], scale=4.0),
    case("stairs four times as large", scaled(stairs("south"), 4), [(60, "forward", 0)], scale=4.0),
    case("one voxel a block", scaled([*WALL_AHEAD, [-2, 0, 1, 2, 0.5, 2]], 12.5),
         [(40, "forward", 0), (20, "forward jump", 20)], scale=12.5),
    case("inside a box one walks out", [[-1, 0, -1, 1, 1, 1]], [(40, "forward", 0)]),
    *(case(f"a crowd of shapes, {seed}", crowd(seed), random_keys(seed)) for seed in range(6)),
]  # fmt: skip


def walked(one: dict) -> list[list[float]]:
    """Where a case's player is after every fourth tick and the last, and whether it stands."""
    world = BoxWorld(one["boxes"])
    body, path, tick = Body(tuple(one["start"])), [], 0
    ticks = sum(spell["ticks"] for spell in one["keys"])
    for spell in one["keys"]:
        keys = Keys(**dict.fromkeys(spell["down"], True), yaw_deg=spell["yaw_deg"])
        for _ in range(spell["ticks"]):
            body, tick = step(world, body, keys, one["scale"]), tick + 1
            if tick % EVERY == 0 or tick == ticks:
                rounded = [round(value, 10) for value in (*body.position, *body.velocity)]
                flags = [int(body.on_ground), int(body.crouched), int(body.hit_wall)]
                path.append([*rounded, *flags])
    return path


def write() -> None:
    """Write the golden walks, one a line."""
    lines = [json.dumps({**one, "path": walked(one)}) for one in CASES]
    GOLDEN.write_text("[\n" + ",\n".join(lines) + "\n]\n")


if __name__ == "__main__":
    write()
