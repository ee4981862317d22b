"""Where one comes to on foot in a house, by the same walkable graph that tours go by."""

import numpy as np

from world2minecraft.construction.spawn import Spawn, find_spawn
from world2minecraft.core.coordinates import ROOM_CORNER_BLOCK
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics.shortest_paths import parts, reachable
from world2minecraft.minecraft.physics.walk_graph import WalkGraph, walk_graph
from world2minecraft.procgen.worlds.house import BlockHouse, BlockRoom

LEVEL = 0.5  # Blocks: carpets lie on a floor, slabs stand on it.


def reached_floors(
    volume: BlockVolume, house: BlockHouse, spawn: tuple[float, float, float]
) -> list[tuple[int, int]]:
    """Return for each room how many places on its floor are reached, and how many there are.

    Args:
        volume: the blocks of the house.
        house: its rooms.
        spawn: the feet of who walks, in world block coordinates; they begin at the nearest place
            where a person has room.
    """
    graph = walk_graph(volume)
    if not len(graph):
        return [(0, 0)] * len(house.rooms)
    found = reachable(graph, graph.nearest(spawn))
    floors = [on_floor(graph, house, room) for room in house.rooms]
    return [(int((found & floor).sum()), int(floor.sum())) for floor in floors]


def spawn_on_foot(volume: BlockVolume, house: BlockHouse) -> Spawn:
    """Return where to stand on the lowest storey, with a way to as much of the house as may be.

    It is the place that is nearest to the one with the best sight; that one itself where a person
    fits nowhere.
    """
    best = find_spawn(volume)
    graph = walk_graph(volume)
    floors = np.array([on_floor(graph, house, room) for room in house.rooms])
    lowest = floors[[room.storey == 0 for room in house.rooms]].any(axis=0)
    if not lowest.any():
        return best
    part = parts(graph)
    largest = np.bincount(part[floors.any(axis=0)], minlength=part.max() + 1)
    most = largest[part] == largest[part[lowest]].max()
    places = np.flatnonzero(lowest & most)
    off = graph.feet[places] - np.array(best.position)
    x, y, z = graph.feet[places[int((off**2).sum(axis=1).argmin())]].tolist()
    return Spawn((x, y, z), best.yaw_deg)


def on_floor(graph: WalkGraph, house: BlockHouse, room: BlockRoom) -> np.ndarray:
    """Return which places of a graph of a house are on the floor of a room, bool [N]."""
    east, up, south = np.array(ROOM_CORNER_BLOCK)
    x = np.floor(graph.feet[:, 0]).astype(int) - east
    y = house.size[1] - 1 - (np.floor(graph.feet[:, 2]).astype(int) - south)
    above = graph.feet[:, 1] - up - room.ground
    found = (above >= 0) & (above < LEVEL)
    found &= (x >= 0) & (y >= 0) & (x < house.size[0]) & (y < house.size[1])
    found[found] = room.floor(house.size)[x[found], y[found]]
    return found
