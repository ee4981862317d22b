"""One house as a world: planned, furnished and lit, from a seed to blocks with exact labels."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from world2minecraft.build.lights import put_lights
from world2minecraft.build.spawn import Spawn, find_spawn
from world2minecraft.rooms.house_rooms import furnish_cells
from world2minecraft.rooms.style import choose_style
from world2minecraft.rooms.worlds.canvas import WorldCanvas
from world2minecraft.rooms.worlds.furnishing import Furnisher, Thing
from world2minecraft.rooms.worlds.house import BlockHouse, plan_block_house
from world2minecraft.rooms.worlds.looks import draw_look, styles
from world2minecraft.rooms.worlds.shell import put_shell, put_stairs
from world2minecraft.types import BlockVolume

SCALES = (2.0, 6.0)  # Blocks per metre: designs are made of blocks from two to six.


@dataclass(frozen=True, eq=False)
class HouseWorld:
    """A house in blocks: the volume, which design each block is of, and what stands where."""

    volume: BlockVolume
    design: np.ndarray  # uint16 [X, Y, Z] in block axes, into ``designs``
    designs: tuple[str, ...]
    house: BlockHouse
    things: tuple[Thing, ...]
    spawn: Spawn
    style: str
    light: dict[str, Any] = field(default_factory=dict)


def generate_world(
    seed: int,
    *,
    rooms: int = 6,
    storeys: int = 1,
    style: str | None = None,
    blocks_per_metre: float = 4.0,
    clutter: float = 0.3,
) -> HouseWorld:
    """Return the world of a seed: the same seed and numbers give the same blocks.

    Args:
        seed: 0 or more.
        rooms: how many rooms in all, 3 to 14, the hall of each storey among them.
        storeys: 1 or 2; two need 4 rooms or more.
        style: one of ``styles()``; drawn where none is given.
        blocks_per_metre: 2 to 6.
        clutter: 0 (tidy) to 1.

    Raises:
        ValueError: a number is out of its range. UnknownNameError: no style has this name.
    """
    names = list(styles())
    rng = np.random.default_rng([seed, rooms, storeys, 3])
    drawn = names[int(rng.integers(len(names)))]
    chosen = styles()[style or drawn]
    house = plan_block_house((seed, 2), rooms, storeys, blocks_per_metre)
    canvas = WorldCanvas(house)
    looks = tuple(draw_look(chosen, room.kind, rng) for room in house.rooms)
    put_shell(canvas, house, looks)
    furnisher = Furnisher(canvas, house)
    if house.flight is not None:
        first = furnisher.next_instance()
        furnisher.next_instance()
        put_stairs(canvas, house, looks[0], first)
    _furnish(furnisher, looks, clutter, (seed, rooms, storeys, 4))
    canvas.settle()
    shape = canvas.states.shape[:2]
    footprints = tuple(
        np.any(
            [
                np.pad(room.floor(house.size), canvas.margin)
                for room in house.rooms
                if room.storey == storey
            ],
            axis=0,
        ).reshape(shape)
        for storey in range(storeys)
    )
    put_lights(canvas, footprints)
    volume, design, designs = canvas.finished()
    hour = chosen.hours[int(rng.integers(len(chosen.hours)))]
    light = {"hour": hour, "lamps": True}
    spawn = find_spawn(volume)
    return HouseWorld(
        volume, design, designs, house, tuple(furnisher.things), spawn, chosen.name, light
    )


def _furnish(furnisher: Furnisher, looks, clutter: float, seed: tuple[int, ...]) -> None:
    house = furnisher.house
    rng = np.random.default_rng(seed)
    metric = [choose_style(rng) for _ in house.plan.cells]
    items, _ = furnish_cells(house.plan, house.gaps_m, metric, clutter, seed)
    for room, held in zip(house.rooms, items, strict=True):
        own = np.random.default_rng([*seed, room.number])
        for item in sorted(held, key=lambda item: (item.z_m, -item.model.size_m[0])):
            furnisher.put_item(item, room, looks[room.number], own)
