"""Detection of rooms in a volume, and of the positions in each where a person can stand.

If ``layout.json`` exists for the scene, it defines the rooms. Otherwise a room is a connected
region directly below a ceiling; at this height, doorways are closed by the wall above them and
furniture does not interfere. Regions are split where they are narrower than a wide door. Positions
without a ceiling above, such as in doorways, are assigned to the nearest room.
"""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply
from world2minecraft.core.jit import njit
from world2minecraft.core.types import BlockVolume, Layout
from world2minecraft.formats.layout import read_layouts
from world2minecraft.minecraft.physics.player_body import HEIGHT
from world2minecraft.minecraft.physics.shortest_paths import connected_parts, reachable
from world2minecraft.minecraft.physics.walk_graph import CollisionGrid, WalkGraph
from world2minecraft.minecraftocc.tours.types import TourRule
from world2minecraft.procgen.sensors.navmesh import is_inside

_NAME = "layout.json"
NARROW_M = 1.1  # Rooms are split where they are narrower than this.
MIN_ROOM_M2 = 1.2  # Smaller areas are not separate rooms.
MIN_ROOM_FLOOR_M2 = 0.4  # Rooms with less walkable floor are not visited.
LEVEL_M = 0.3  # Maximum height difference to the main floor of a room.
WALLED_SHARE = 0.7  # Minimum share of horizontal rays indoors that hit something within FAR_M.
FAR_M = 15.0
RAYS = 16
_APART = 3.0  # Weight of height differences when positions are assigned to rooms.


def find_layouts(path: str | Path) -> tuple[Layout, ...]:
    """Return the room layouts of the run that a path belongs to, or an empty tuple if none.

    Args:
        path: Run folder, its ``build`` folder, its world, or any other path.

    Raises:
        DamagedFileError: If ``layout.json`` is not a valid layout.
    """
    place = Path(path)
    for folder in (place, place.parent, place.parent.parent):
        if (folder / _NAME).is_file() and (folder / "build").is_dir():
            return read_layouts(folder / _NAME)
    return ()


@dataclass(frozen=True, eq=False)
class TourRoom:
    """A room to visit.

    Attributes:
        number: Number of the room.
        places: Indices of its positions in the walk graph, int64 [N].
        floor_m2: Free floor area in square metres.
        classes: Number of classes of furniture and objects in the room.
        objects: Number of objects in the room.
    """

    number: int
    places: np.ndarray
    floor_m2: float
    classes: int
    objects: int

    @property
    def worth(self) -> float:
        """Relative number of views for this room, based on its size and contents."""
        return float(np.sqrt(self.floor_m2) * (2 + self.classes) + np.sqrt(self.objects))


def find_rooms(
    volume: BlockVolume, graph: WalkGraph, solid: CollisionGrid, rule: TourRule
) -> list[TourRoom]:
    """Find the rooms of a volume in which a person can stand, in a fixed order.

    Args:
        volume: Volume of blocks.
        graph: Walk graph of the volume.
        solid: Collision grid of the volume.
        rule: Tour settings, with optional layouts and start position.
    """
    if not len(graph):
        return []
    above = int(np.ceil(2 * volume.blocks_per_metre))  # A person can stand on the highest block.
    things = (volume.semantic >= SemanticClass.CHAIR) & (volume.semantic != 255)
    # Lamps and tall cupboards do not separate rooms.
    blocked = np.pad((solid.kinds != 0) & ~things, ((0, 0), (0, above), (0, 0)))
    cells = np.floor(graph.feet - np.array(volume.corner) + [0, 1e-6, 0]).astype(np.int64)
    roof = _roofs(blocked)[tuple(cells.T)]
    usable = _indoors(graph, blocked, cells, roof)
    usable &= graph.headroom >= HEIGHT * graph.blocks_per_metre - 1e-6  # Also for a slim body.
    if rule.start is not None and rule.reachable_only:
        usable &= reachable(graph, graph.nearest(rule.start))
    number = _by_layouts(volume, graph, rule)
    if not (usable & (number >= 0)).any():
        number = _by_ceilings(graph, blocked, cells, roof, usable)
    rooms = []
    for one in np.unique(number[usable & (number >= 0)]):
        places = _main_floor(graph, np.flatnonzero(usable & (number == one)))
        floor_m2 = len(places) * (graph.spacing / graph.blocks_per_metre) ** 2
        if floor_m2 >= MIN_ROOM_FLOOR_M2:
            seen = _contents(volume, cells[places], roof[places])
            rooms.append(TourRoom(len(rooms), places, floor_m2, *seen))
    return rooms


def _roofs(blocked: np.ndarray) -> np.ndarray:
    """Return the layer of the first blocked cell at or above each cell, or Y for none."""
    layers = np.arange(blocked.shape[1])[None, :, None]
    first = np.where(blocked, layers, blocked.shape[1])
    return np.minimum.accumulate(first[:, ::-1], axis=1)[:, ::-1]


def _indoors(
    graph: WalkGraph, blocked: np.ndarray, cells: np.ndarray, roof: np.ndarray
) -> np.ndarray:
    """Return the positions below a roof and between walls, or only between walls without roofs."""
    walled = _enclosed_by_walls(graph, blocked, cells)
    inside = walled & (roof < blocked.shape[1])
    least = MIN_ROOM_M2 / (graph.spacing / graph.blocks_per_metre) ** 2
    for choice in (
        inside,
        walled,
        connected_parts(graph) == np.bincount(connected_parts(graph)).argmax(),
    ):
        if choice.sum() >= least:
            return choice
    return np.ones(len(graph), bool)


def _enclosed_by_walls(graph: WalkGraph, blocked: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return the positions from which most horizontal rays at eye level hit something."""
    eyes = np.add(cells, [0.5, 0.0, 0.5])
    eyes[:, 1] += 1.5 * graph.blocks_per_metre
    reach = FAR_M * graph.blocks_per_metre
    return _blocked_share(blocked, eyes, reach, RAYS) >= WALLED_SHARE


@njit
def _blocked_share(blocked, eyes, reach, rays):
    """Return the fraction of horizontal rays from each eye, float64 [N, 3] in cells, that hit."""
    result = np.zeros(len(eyes))
    for n in range(len(eyes)):
        y = int(eyes[n, 1])
        for ray in range(rays):
            dx, dz = np.cos(ray * 2 * np.pi / rays), np.sin(ray * 2 * np.pi / rays)
            for step in range(1, int(2 * reach)):
                x = int(np.floor(eyes[n, 0] + dx * step / 2))
                z = int(np.floor(eyes[n, 2] + dz * step / 2))
                if x < 0 or z < 0 or x >= blocked.shape[0] or z >= blocked.shape[2]:
                    break
                if blocked[x, y, z]:
                    result[n] += 1 / rays
                    break
    return result


def _by_layouts(volume: BlockVolume, graph: WalkGraph, rule: TourRule) -> np.ndarray:
    """Return the room of each position according to the floor plans, int64 [N]; -1 for none."""
    points = apply(volume.block_to_room, graph.feet)
    number = np.full(len(graph), -1)
    for n, layout in enumerate(rule.layouts):
        level = (points[:, 2] > layout.floor_z_m - 0.5) & (
            points[:, 2] < layout.floor_z_m + layout.wall_height_m - 1
        )
        number[level & is_inside(layout.floor_polygon_m, points[:, :2])] = n
    return number


def _by_ceilings(
    graph: WalkGraph,
    blocked: np.ndarray,
    cells: np.ndarray,
    roof: np.ndarray,
    usable: np.ndarray,
) -> np.ndarray:
    """Return the room of each position according to connected ceilings; -1 for none."""
    cell_m = 1 / graph.blocks_per_metre
    under = np.zeros_like(blocked)
    under[:, :-1] = ~blocked[:, :-1] & blocked[:, 1:]
    level = np.zeros((3, 3, 3), bool)
    level[1, 1, :] = level[:, 1, 1] = True
    label = _label_parts(under, level)
    top = np.clip(roof - 1, 0, blocked.shape[1] - 1)
    number = np.where(usable, label[cells[:, 0], top, cells[:, 2]], 0)
    areas = np.bincount(label.reshape(-1)) * cell_m**2
    large = [n for n in np.unique(number) if n and areas[n] >= MIN_ROOM_M2]
    result, count = np.full(len(graph), -1), 0
    for one in large:
        own = number == one
        layer = int(top[own][0])
        cut, pieces = _cut_at_necks(label[:, layer] == one, cell_m)
        result[own] = cut[cells[own, 0], cells[own, 2]] + count
        count += pieces
    return _assign_remaining(graph, result, usable)


def _cut_at_necks(room: np.ndarray, cell_m: float) -> tuple[np.ndarray, int]:
    """Split a room at narrow places into pieces.

    Returns:
        The piece of each cell, int64 [X, Z], and the number of pieces.
    """
    away = np.asarray(ndimage.distance_transform_edt(np.pad(room, 1)))[1:-1, 1:-1]
    cores = _label_parts(away * cell_m > NARROW_M / 2, np.ones((3, 3), bool))
    sizes = np.bincount(cores.reshape(-1)) * cell_m**2
    large = [n for n in range(1, len(sizes)) if sizes[n] >= MIN_ROOM_M2 / 2]
    if len(large) < 2:
        return np.zeros(room.shape, np.int64), 1
    numbered = np.zeros(room.shape, np.int64)
    for n, one in enumerate(large):
        numbered[cores == one] = n + 1
    nearest = ndimage.distance_transform_edt(
        numbered == 0, return_distances=False, return_indices=True
    )
    return numbered[tuple(np.asarray(nearest))] - 1, len(large)


def _label_parts(mask: np.ndarray, joined: np.ndarray) -> np.ndarray:
    """Return the number of the connected part of each cell, starting at 1; 0 outside the mask."""
    return np.asarray(ndimage.label(mask, joined)[0])  # pyright: ignore[reportIndexIssue]


def _assign_remaining(graph: WalkGraph, number: np.ndarray, usable: np.ndarray) -> np.ndarray:
    """Assign positions without a room to the room of the nearest position that has one."""
    known, remaining = np.flatnonzero(number >= 0), np.flatnonzero(usable & (number < 0))
    if not len(known):
        return np.where(usable, 0, -1)
    if len(remaining):
        scaled = graph.feet * [1, _APART, 1]
        _, nearest = KDTree(scaled[known]).query(scaled[remaining])
        number[remaining] = number[known[nearest]]
    return number


def _main_floor(graph: WalkGraph, places: np.ndarray) -> np.ndarray:
    """Return the positions of a room that are on its main level."""
    heights = graph.feet[places, 1] / graph.blocks_per_metre
    levels = np.sort(np.unique(np.round(heights / LEVEL_M)))
    counts = [(np.abs(heights / LEVEL_M - level) <= 1).sum() for level in levels]
    main = levels[int(np.argmax(counts))]
    return places[np.abs(heights / LEVEL_M - main) <= 1]


def _contents(volume: BlockVolume, cells: np.ndarray, roof: np.ndarray) -> tuple[int, int]:
    """Return the numbers of classes and of objects in the box around a room's positions."""
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    high[1] = max(int(np.median(roof)), int(low[1]) + 1)
    around = max(1, round(volume.blocks_per_metre / 2))
    low[[0, 2]] = np.maximum(low[[0, 2]] - around, 0)
    high[[0, 2]] += around
    box = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    semantic = volume.semantic[box]
    things = (semantic >= SemanticClass.CHAIR) & (semantic != 255)
    if not volume.semantic.any():  # Without labels, block states are counted instead of classes.
        return min(len(np.unique(volume.states[box])) - 1, 12), 0
    return len(np.unique(semantic[things])), len(np.unique(volume.instance[box][things]))


def share_views(rooms: list[TourRoom], count: int) -> list[int]:
    """Distribute a number of views among rooms in proportion to their ``worth``.

    Example:
        >>> share_views([], 3)
        []
    """
    if not rooms:
        return []
    worth = np.array([room.worth for room in rooms])
    ends = np.round(np.concatenate([[0], np.cumsum(worth)]) / worth.sum() * count).astype(int)
    return [int(b - a) for a, b in pairwise(ends)]
