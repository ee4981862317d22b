"""The rooms of a scene and the doors between them, in terms of the walk graph."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import BlockVolume, Layout
from world2minecraft.minecraft.physics.walk_graph import WalkGraph
from world2minecraft.minecraftocc.tours.rooms import TourRoom
from world2minecraft.procgen.sensors.navmesh import is_inside

NEAR_M = 1.5  # Maximum distance of a node from its room.
_APART = 3.0  # Weight of height differences in this distance.

# Names of kinds of generated rooms that differ from the kind.
ROOM_WORDS = {"bed": "bedroom", "living": "living room", "dining": "dining room"}


@dataclass(frozen=True, eq=False)
class Door:
    """A passage from one room to another.

    Attributes:
        to: The index of the other room.
        feet: The middle of the passage in world blocks.
    """

    to: int
    feet: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class SceneRoom:
    """A room of a scene.

    Attributes:
        number: The index of the room.
        name: The unique name of the room.
        places: The indices of its nodes in the walk graph as int64 [N].
        floor_m2: The floor area in square metres.
        center: The node closest to the centre of the room, in world blocks.
        doors: The passages to other rooms.
    """

    number: int
    name: str
    places: np.ndarray
    floor_m2: float
    center: tuple[float, float, float]
    doors: tuple[Door, ...] = ()


def rooms_of_places(graph: WalkGraph, rooms: list[TourRoom]) -> np.ndarray:
    """Return the room of each walk graph node as int64 [N], with -1 for nodes outside rooms."""
    number = np.full(len(graph), -1, np.int64)
    if not rooms:
        return number
    places = np.concatenate([room.places for room in rooms])
    owner = np.concatenate([np.full(len(room.places), room.number) for room in rooms])
    scaled = graph.feet * [1, _APART, 1]
    found = KDTree(scaled[places]).query(scaled)
    near = np.asarray(found[0]) <= NEAR_M * graph.blocks_per_metre
    number[near] = owner[np.asarray(found[1])[near]]
    return number


def scene_rooms(
    volume: BlockVolume,
    graph: WalkGraph,
    rooms: list[TourRoom],
    number: np.ndarray,
    layouts: tuple[Layout, ...],
) -> tuple[SceneRoom, ...]:
    """Return the rooms with names and doors.

    Args:
        volume: The blocks.
        graph: The walk graph.
        rooms: The result of ``find_rooms``.
        number: The room of each node, as returned by ``rooms_of_places``.
        layouts: Floor plans with room names. May be empty.
    """
    doors = _doors(graph, number, len(rooms))
    names = _names(
        [apply(volume.block_to_room, graph.feet[room.places]) for room in rooms], layouts
    )
    result = []
    for room in rooms:
        feet = graph.feet[room.places]
        middle = feet[((feet - feet.mean(axis=0)) ** 2).sum(axis=1).argmin()]
        name = names[room.number]
        x, y, z = (float(value) for value in middle)
        own = tuple(doors[room.number])
        result.append(SceneRoom(room.number, name, room.places, room.floor_m2, (x, y, z), own))
    return tuple(result)


def _names(rooms_m: list[np.ndarray], layouts: tuple[Layout, ...]) -> list[str]:
    """Return unique names. A room that is the only one of its kind needs no number."""
    kinds = [_kind(points_m, layouts) or "room" for points_m in rooms_m]
    total, seen, names = Counter(kinds), Counter[str](), []
    for kind in kinds:
        seen[kind] += 1
        names.append(kind if total[kind] == 1 else f"{kind} {seen[kind]}")
    return names


def _kind(points_m: np.ndarray, layouts: tuple[Layout, ...]) -> str:
    """Return the kind of the layout that contains most of the points, without a number."""
    best, most = "", 0
    for layout in layouts:
        level = abs(points_m[:, 2] - layout.floor_z_m) < layout.wall_height_m / 2
        count = int((level & is_inside(layout.floor_polygon_m, points_m[:, :2])).sum())
        if count > most:
            best, most = layout.name, count
    kind, _, last = best.rpartition(" ")
    word = kind if kind and last.isdigit() else best
    return ROOM_WORDS.get(word, word)


def _doors(graph: WalkGraph, number: np.ndarray, count: int) -> list[list[Door]]:
    """Return the doors of each room, merging adjacent graph edges between two rooms."""
    found: list[list[Door]] = [[] for _ in range(count)]
    begin, end = graph.edge_from, graph.edge_to
    crossing = (number[begin] != number[end]) & (number[begin] >= 0) & (number[end] >= 0)
    if not crossing.any():
        return found
    pairs = np.stack([number[begin[crossing]], number[end[crossing]]], axis=1)
    middles = (graph.feet[begin[crossing]] + graph.feet[end[crossing]]) / 2
    for one, other in np.unique(pairs, axis=0):
        points = middles[(pairs == [one, other]).all(axis=1)]
        for part in _clusters(points, 2 * graph.spacing):
            x, y, z = (float(value) for value in points[part].mean(axis=0))
            found[one].append(Door(int(other), (x, y, z)))
    return found


def _clusters(points: np.ndarray, max_gap: float) -> list[np.ndarray]:
    """Group points that are connected by distances of at most ``max_gap``."""
    near = KDTree(points).query_pairs(max_gap + 1e-6, output_type="ndarray")
    links = coo_matrix((np.ones(len(near)), tuple(near.T)), (len(points), len(points)))
    total, group = connected_components(links, directed=False)
    return [np.flatnonzero(group == one) for one in range(total)]
