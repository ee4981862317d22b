"""Generation of one house as a world from a seed: plan, furniture, lighting and block labels."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from world2minecraft.construction.lighting import put_lights
from world2minecraft.construction.spawn import Spawn, find_spawn
from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics.shortest_paths import connected_parts
from world2minecraft.minecraft.physics.walk_graph import WalkGraph, walk_graph
from world2minecraft.procgen.houses.house import check_house
from world2minecraft.procgen.houses.room_furnishing import furnish_cells
from world2minecraft.procgen.rooms.colour_scheme import choose_style
from world2minecraft.procgen.rooms.placement import Item
from world2minecraft.procgen.worlds.block_house import BlockHouse, BlockRoom, plan_block_house
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.clear_paths import ClearPaths
from world2minecraft.procgen.worlds.decoration import (
    dress_windows,
    hang_lamps,
    hang_leaves,
    lay_rugs,
)
from world2minecraft.procgen.worlds.exterior import (
    draw_exterior,
    put_facade,
    put_roof,
    roof_layers,
)
from world2minecraft.procgen.worlds.furnishing import Furnisher, PlacedFurniture
from world2minecraft.procgen.worlds.garden import (
    draw_garden,
    garden_blocks,
    plant_trees,
    put_garden,
)
from world2minecraft.procgen.worlds.recipes import (
    BLOCK_RECIPES,
    RecipeContext,
    add_furniture,
    assign_room_kinds,
)
from world2minecraft.procgen.worlds.shell import put_shell, put_stairs, rails
from world2minecraft.procgen.worlds.styles import RoomLook, Style, draw_look, styles
from world2minecraft.procgen.worlds.wares_and_stands import StandBuilder, WareDeck

LEVEL = 0.5  # Blocks: carpets lie on a floor, slabs stand on it.
# 0.24 m a block: three of the cells that pictures are labelled with, so no cell holds two blocks.
BLOCKS_PER_METRE = 25 / 6
SCALES = (2.0, 6.0)  # Blocks per metre that the library's designs are made for in blocks.
DAWN, DUSK = 7, 18  # Before and after, rooms are lit by more lamps.


def find_walkable_spawn(volume: BlockVolume, house: BlockHouse) -> Spawn:
    """Find a spawn position on the lowest storey from which most of the house can be reached.

    The result is the suitable place nearest to the position with the best view. If a person fits
    nowhere, it is the position with the best view itself.
    """
    best = find_spawn(volume)
    graph = walk_graph(volume)
    floors = np.array([floor_places(graph, house, room) for room in house.rooms])
    lowest = floors[[room.storey == 0 for room in house.rooms]].any(axis=0)
    if not lowest.any():
        return best
    part = connected_parts(graph)
    largest = np.bincount(part[floors.any(axis=0)], minlength=part.max() + 1)
    most = largest[part] == largest[part[lowest]].max()
    places = np.flatnonzero(lowest & most)
    off = graph.feet[places] - np.array(best.position)
    x, y, z = graph.feet[places[int((off**2).sum(axis=1).argmin())]].tolist()
    return Spawn((x, y, z), best.yaw_deg)


def floor_places(graph: WalkGraph, house: BlockHouse, room: BlockRoom) -> np.ndarray:
    """Return which places of a walkable graph are on the floor of a room, as bool [N]."""
    east, up, south = np.array(ROOM_CORNER_BLOCK)
    x = np.floor(graph.feet[:, 0]).astype(int) - east
    y = house.size[1] - 1 - (np.floor(graph.feet[:, 2]).astype(int) - south)
    above = graph.feet[:, 1] - up - room.ground
    found = (above >= 0) & (above < LEVEL)
    found &= (x >= 0) & (y >= 0) & (x < house.size[0]) & (y < house.size[1])
    found[found] = room.floor(house.size)[x[found], y[found]]
    return found


@dataclass(frozen=True, eq=False)
class HouseWorld:
    """A generated house in blocks, with the design of each block and the placed furniture."""

    volume: BlockVolume
    design: np.ndarray  # uint16 [X, Y, Z] in block axes, indices into ``designs``.
    designs: tuple[str, ...]
    house: BlockHouse
    things: tuple[PlacedFurniture, ...]
    spawn: Spawn
    style: str
    light: dict[str, Any] = field(default_factory=dict)


def generate_world(
    seed: int,
    *,
    rooms: int = 6,
    storeys: int = 1,
    style: str | None = None,
    blocks_per_metre: float = BLOCKS_PER_METRE,
    deck: tuple[int, int] | None = None,
) -> HouseWorld:
    """Generate the world of a house from a seed. The same arguments give the same blocks.

    Args:
        seed: The random seed, at least 0.
        rooms: Number of rooms, 3 to 14, including one hall per storey.
        storeys: Number of storeys, 1 or 2. Two storeys need at least 4 rooms.
        style: One of ``styles()``. The default is random.
        blocks_per_metre: Scale of the house, from 2 to below 6.
        deck: The seed of the order of decorative blocks and the number already used. The default is
            random.

    Raises:
        ValueError: If an argument is out of range.
        UnknownNameError: If the style is unknown.
    """
    check_house(seed, rooms, storeys, 0.0)
    _check(blocks_per_metre, style)
    rng = np.random.default_rng([seed, rooms, storeys, 3])
    drawn = list(styles())[int(rng.integers(len(styles())))]
    chosen = styles()[style or drawn]
    plan = plan_block_house((seed, 2), rooms, storeys, blocks_per_metre)
    house = assign_room_kinds(plan, rng)
    light = {"hour": _hour(chosen, rng), "lamps": True}
    wood = chosen.woods[int(rng.integers(len(chosen.woods)))]
    looks = tuple(draw_look(chosen, room.kind, wood, rng) for room in house.rooms)
    outside = np.random.default_rng([seed, rooms, storeys, 7])
    exterior = draw_exterior(chosen, looks[0], outside)
    depth, high = garden_blocks(blocks_per_metre), roof_layers(house, exterior)
    canvas, ways = WorldCanvas(house, depth, high), ClearPaths(house)
    put_shell(canvas, house, looks)
    furnisher = Furnisher(canvas, house, looks, ways)
    dealt = WareDeck(*(deck or (seed, int(rng.integers(1000)))))
    show = StandBuilder(furnisher, dealt, np.random.default_rng([seed, rooms, storeys, 6]))
    _put_flight(furnisher, house, looks[0])
    hang_leaves(furnisher, house.gaps, rng)
    _furnish(furnisher, show, (seed, rooms, storeys, 4), _is_night(light["hour"]))
    put_facade(canvas, house, exterior)
    garden = draw_garden(chosen.name, outside)
    put_garden(canvas, house, garden, dealt, outside)
    canvas.settle()
    put_lights(canvas, _footprints(canvas, house))
    put_roof(canvas, house, exterior)  # After the lights, which are for rooms and not for attics.
    plant_trees(canvas, house, garden, outside)
    volume, design, designs = canvas.finished()
    spawn = find_walkable_spawn(volume, house)
    things = tuple(furnisher.things)
    return HouseWorld(volume, design, designs, house, things, spawn, chosen.name, light)


def _check(blocks_per_metre: float, style: str | None) -> None:
    if not SCALES[0] <= blocks_per_metre < SCALES[1]:
        low, high = SCALES
        raise ValueError(
            f"blocks_per_metre must be from {low:g} to below {high:g}, got {blocks_per_metre:g}"
        )
    if style is not None and style not in styles():
        raise UnknownNameError("style", style, styles())


def _hour(style: Style, rng: np.random.Generator) -> int:
    return style.hours[int(rng.integers(len(style.hours)))]


def _put_flight(furnisher: Furnisher, house: BlockHouse, look: RoomLook) -> None:
    """Set the stairs, and keep the paths to their bottom and top free."""
    flight = house.flight
    if flight is None:
        return
    lower, upper = house.rooms[0], next(room for room in house.rooms if room.storey == 1)
    first = furnisher.next_instance()
    furnisher.next_instance()
    put_stairs(furnisher.canvas, house, look, first)
    wide, high = furnisher.ways.body, furnisher.ways.head
    furnisher.ways.close(lower, (flight.x0, flight.y0, flight.x1, flight.end))
    furnisher.ways.close(upper, (flight.x0, flight.hole, flight.x1, flight.end - 1))
    for (x0, y0), (x1, y1) in rails(house):
        furnisher.ways.close(upper, (x0, y0, x1, y1))
    middle = (flight.x0 + flight.x1 - wide) // 2
    furnisher.ways.end(lower, (middle, flight.y0 - wide))
    furnisher.ways.end(upper, (middle, flight.end - 1))
    box = furnisher.canvas.box(
        (flight.x0, flight.y0 - wide, 0), (flight.x1, flight.end + wide - 1, upper.ground + high)
    )
    furnisher.reserved[box] = True


def _is_night(hour: int) -> bool:
    return not DAWN <= hour < DUSK


def _furnish(furnisher: Furnisher, show: StandBuilder, seed: Sequence[int], by_night: bool) -> None:
    """Furnish metric rooms by their layouts and other rooms by their recipes."""
    house = furnisher.house
    rng = np.random.default_rng(seed)
    metric = [choose_style(rng) for _ in house.plan.cells]
    own_kinds = [room.number for room in house.rooms if room.kind in BLOCK_RECIPES]
    items, _ = furnish_cells(house.plan, house.gaps_m, metric, 0.0, tuple(seed), own_kinds)
    for room, held in zip(house.rooms, items, strict=True):
        own = np.random.default_rng([*seed, room.number])
        task = RecipeContext(furnisher, show, room, own)
        if room.kind in BLOCK_RECIPES:
            hang_lamps(furnisher, room, own, by_night=by_night)
            BLOCK_RECIPES[room.kind](task)
        else:
            _put_items(furnisher, room, held, own)
            hang_lamps(furnisher, room, own, by_night=by_night)
        dress_windows(furnisher, room, own)
        if room.kind not in BLOCK_RECIPES:
            add_furniture(task, by_night=by_night)
        lay_rugs(furnisher, room, own)


def _put_items(
    furnisher: Furnisher, room: BlockRoom, held: Sequence[Item], rng: np.random.Generator
) -> None:
    for item in sorted(held, key=lambda item: (item.z_m, -item.model.size_m[0])):
        if item.model.name != "curtain":
            furnisher.put_item(item, room, rng)


def _footprints(canvas: WorldCanvas, house: BlockHouse) -> tuple[np.ndarray, ...]:
    """Return the floor columns of each storey, bool [X, Y] of the canvas."""
    floors = []
    for storey in range(len(house.grounds)):
        rooms = [room.floor(house.size) for room in house.rooms if room.storey == storey]
        floors.append(np.pad(np.any(rooms, axis=0), canvas.margin))
    return tuple(floors)
