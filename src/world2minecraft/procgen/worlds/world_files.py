"""Writing of generated houses to folders, each with a world, its scene and its designs."""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.files import write_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Layout, LayoutObject, Opening
from world2minecraft.formats.layout import write_layouts
from world2minecraft.formats.world_labels import scene_from_volume, write_scene
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.world_writer import write_world
from world2minecraft.procgen.worlds.block_house import BlockGap, BlockHouse, BlockRoom
from world2minecraft.procgen.worlds.furnishing import PlacedFurniture
from world2minecraft.procgen.worlds.house_world import HouseWorld, generate_world

ROOMS, STOREYS_SHARE = (4, 9), 0.35  # 156 houses have about 1,000 rooms.
WARES_A_HOUSE = 37  # By so many the order of wares is further on from house to house.


def house_layouts(house: BlockHouse, things: tuple[PlacedFurniture, ...]) -> tuple[Layout, ...]:
    """Return one layout per room, in order, with objects named by their designs."""
    return tuple(_layout(house, room, things) for room in house.rooms)


def _layout(house: BlockHouse, room: BlockRoom, things: tuple[PlacedFurniture, ...]) -> Layout:
    scale = house.blocks_per_metre
    own = [gap for gap in house.gaps if room.number in gap.rooms]
    return Layout(
        floor_polygon_m=_outline(room) / scale,
        wall_height_m=room.height / scale,
        openings=tuple(_opening(gap, room, scale) for gap in own),
        objects=tuple(_object(thing, scale) for thing in things if thing.room == room.number),
        floor_z_m=room.ground / scale,
        name=f"{room.kind} {room.number + 1}",
    )


def _outline(room: BlockRoom) -> np.ndarray:
    """Return the corners of a room's floor, counter-clockwise, float64 [N, 2] in blocks."""
    (x0, y0), (x1, y1) = room.low, room.high
    if not room.blocked:
        return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], np.float64)
    bay, top = room.blocked[0][:2]  # The corridor runs to x1, the bay of the stairs to y1.
    corners = [[x0, y0], [x1, y0], [x1, top], [bay, top], [bay, y1], [x0, y1]]
    return np.array(corners, np.float64)


def _opening(gap: BlockGap, room: BlockRoom, scale: float) -> Opening:
    """Return an opening at the wall face towards the room."""
    across, along = gap.turn % 2, 1 - gap.turn % 2
    faces_up = (gap.turn < 2) == (room.number == gap.rooms[0])
    at = gap.high[across] if faces_up else gap.low[across]
    ends = np.zeros((2, 2))
    ends[:, across] = at
    ends[:, along] = gap.low[along], gap.high[along]
    sill, head = (gap.bottom - room.ground) / scale, (gap.top - room.ground) / scale
    return Opening(gap.kind, ends[0] / scale, ends[1] / scale, sill, head)


def _object(thing: PlacedFurniture, scale: float) -> LayoutObject:
    low, high = np.array(thing.low) / scale, np.array(thing.high) / scale
    sides = high - low
    size = sides[[1, 0, 2]] if thing.quarter_turns % 2 else sides
    yaw = 90.0 * thing.quarter_turns
    return LayoutObject(thing.class_id, (low + high) / 2, size, yaw, thing.design)


def write_house(made: HouseWorld, folder: str | Path, *, name: str) -> None:
    """Write the world, scene, designs, layout and description of a house to a folder.

    The folder contains ``world/``, ``scene.json``, ``scene.npz``, ``designs.json``, ``layout.json``
    (the rooms and their openings) and ``house.json`` (the style, lighting, kinds of rooms and
    furniture).

    Raises:
        OutputError: If the folder cannot be written.
    """
    target, version = Path(folder), game_version()
    spawn = made.spawn
    write_world(
        made.volume,
        target / "world",
        name=name,
        spawn=spawn.position,
        spawn_yaw_deg=spawn.yaw_deg,
        version=version,
        hour=float(made.light["hour"]),
    )
    scene = scene_from_volume(
        made.volume,
        mc_version=version.name,
        data_version=version.data_version,
        spawn=spawn.position,
        spawn_yaw_deg=spawn.yaw_deg,
        design=made.design,
        designs=made.designs,
        light=made.light,
    )
    write_scene(target, scene)
    write_layouts(target / "layout.json", house_layouts(made.house, made.things))
    write_json(target / "house.json", _facts(made))


def _facts(made: HouseWorld) -> dict[str, Any]:
    layouts = house_layouts(made.house, made.things)
    rooms = [
        {"kind": room.kind, "storey": room.storey, "name": layout.name}
        for room, layout in zip(made.house.rooms, layouts, strict=True)
    ]
    things = [
        {
            "instance": thing.instance,
            "design": thing.design,
            "class": CLASS_NAMES[thing.class_id],
            "room": thing.room,
            "center_m": [round(float(v), 4) for v in stated.center_m],
            "size_m": [round(float(v), 4) for v in stated.size_m],
            "yaw_deg": stated.yaw_deg,
        }
        for layout, room in zip(layouts, made.house.rooms, strict=True)
        for thing, stated in zip(
            (one for one in made.things if one.room == room.number), layout.objects, strict=True
        )
    ]
    return {"style": made.style, "light": made.light, "rooms": rooms, "things": things}


def write_worlds(
    folder: str | Path,
    houses: int,
    seed: int,
    *,
    style: str | None = None,
    progress: Progress = no_progress,
) -> list[Path]:
    """Generate a series of houses as the folders ``house_0001`` to ``house_N``.

    A longer series starts with the houses of a shorter one.

    Args:
        folder: The output folder, which is created if it does not exist.
        houses: Number of houses.
        seed: Seed of the series.
        style: The style of all houses. The default is a random style per house.
        progress: Callback for each house.

    Raises:
        OutputError: If the folder cannot be written.
        UnknownNameError: If the style is unknown.
    """
    target, written = Path(folder), []
    for number in range(1, houses + 1):
        progress("houses", number - 1, houses, f"house_{number:04d}")
        name = f"house_{number:04d}"
        made = house_of(seed, number, style=style)
        write_house(made, target / name, name=name.replace("_", " "))
        written.append(target / name)
    progress("houses", houses, houses)
    return written


def house_of(seed: int, number: int, *, style: str | None = None) -> HouseWorld:
    """Generate one house of a series, by its number from 1. The default style is random."""
    rng = np.random.default_rng([seed, number])
    rooms = int(rng.integers(ROOMS[0], ROOMS[1] + 1))
    storeys = 2 if rng.random() < STOREYS_SHARE else 1
    deck = (seed, number * WARES_A_HOUSE)
    own = int(rng.integers(1 << 31))
    return generate_world(own, rooms=rooms, storeys=storeys, style=style, deck=deck)
