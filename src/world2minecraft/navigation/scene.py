"""A world as a walker has it: floor to walk on, distances on foot, things with names, and a view.

In: the path of any place that holds blocks. Out: ``VlnScene``; each of its parts is made when it is
first asked for. Doors that a player can open stand open, to body and eye alike. ``FloorTable`` has
the walkable graph by columns, so that a place between those of the graph finds its neighbours.
"""

from collections import OrderedDict
from collections.abc import Collection, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply, focal_px_of_fov, invert
from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.core.jit import njit
from world2minecraft.core.types import BlockVolume, Camera, Layout
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.volume_formats import find_blocks
from world2minecraft.furniture.library import TEMPLATES
from world2minecraft.minecraft.physics.any_angle_paths import (
    Lattice,
    build_lattice,
    straight_distances_m,
)
from world2minecraft.minecraft.physics.player_body import EYE
from world2minecraft.minecraft.physics.shortest_paths import connected_parts
from world2minecraft.minecraft.physics.walk_graph import (
    CollisionGrid,
    WalkGraph,
    WalkRule,
    collision_grid,
    open_all_doors,
    walk_graph,
)
from world2minecraft.minecraftocc.scene_sources import SceneSource, open_scene_source
from world2minecraft.minecraftocc.tours.rooms import TourRoom, find_rooms
from world2minecraft.minecraftocc.tours.types import TourRule
from world2minecraft.navigation.landmarks import Landmark, landmarks_of
from world2minecraft.navigation.rooms_and_doors import SceneRoom, rooms_of_places, scene_rooms
from world2minecraft.navigation.types import Stance
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS, Picture, render_volume
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.shading_parameters import DAY
from world2minecraft.rendering.views.cameras import GamePose

REACH_SPACINGS = 1.5  # Spacings: places so near to a body are on its own side of any wall,
LEVEL_SIZES = 0.6  # and so near in height, in sizes of the body, are on its own floor.
BODIES = (1.0, 0.6, 0.4)  # Of a person: one who fits is chosen; a cluttered scan has small ones.
MIN_FLOOR_M2 = 1.0  # Of all rooms: with less a smaller body is tried.
STOREY_M = 2.8  # What is so far over a floor, or beside it, is not of its room.
REACH_M = 1.0  # One stands before a thing where it is no farther than this,
RING_M = 0.25  # and about as near as one can come.
MAX_GOALS = 32
MAX_FIELDS = 64  # Kept of those last used.


class FloorTable(NamedTuple):
    """The places of a graph by columns of a regular grid; of each column those in a row."""

    origin: np.ndarray  # float64 [2], x and z of the first column, world blocks
    shape: np.ndarray  # int64 [2], columns along x and z
    start: np.ndarray  # int64 [C + 1]
    place: np.ndarray  # int32 [N]
    feet: np.ndarray  # float64 [N, 3], by place
    spacing: float  # blocks from a column to the next
    level: float  # blocks
    metres_per_block: float


def build_floor_table(graph: WalkGraph) -> FloorTable:
    """Return the table of a graph with one place or more."""
    origin = graph.feet[:, [0, 2]].min(axis=0)
    at = np.round((graph.feet[:, [0, 2]] - origin) / graph.spacing).astype(np.int64)
    shape = at.max(axis=0) + 1
    column = at[:, 0] * shape[1] + at[:, 1]
    counts = np.bincount(column, minlength=int(shape.prod()))
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    place = np.argsort(column, kind="stable").astype(np.int32)
    return FloorTable(
        origin, shape, start, place, graph.feet, graph.spacing, LEVEL_SIZES * graph.scale,
        1 / graph.blocks_per_metre,
    )  # fmt: skip


@njit
def distance_from_field(floor, field, x, y, z):
    """Return the way in metres from feet by a field over places, float64 [N]; inf off the floor."""
    i = int(np.floor((x - floor.origin[0]) / floor.spacing))
    k = int(np.floor((z - floor.origin[1]) / floor.spacing))
    reach = REACH_SPACINGS * floor.spacing
    best = np.inf
    for column_x in range(max(0, i - 1), min(floor.shape[0] - 1, i + 2) + 1):
        for column_z in range(max(0, k - 1), min(floor.shape[1] - 1, k + 2) + 1):
            column = column_x * floor.shape[1] + column_z
            for n in range(floor.start[column], floor.start[column + 1]):
                place = floor.place[n]
                there = floor.feet[place]
                dx, dy, dz = there[0] - x, there[1] - y, there[2] - z
                if abs(dy) > floor.level or dx * dx + dz * dz > reach * reach:
                    continue
                away = np.sqrt(dx * dx + dy * dy + dz * dz) * floor.metres_per_block
                best = min(best, away + field[place])
    return best


class VlnScene:
    """A world to walk in.

    ``volume`` has its doors open. ``graph`` are the places of a body ``body`` times as large as a
    person. Places are feet in world blocks, lengths on foot are metres of the room.
    """

    def __init__(self, source: SceneSource, body: float | None = None, *, opens_doors: bool = True):
        self.source = source
        self.path, self.scene_id = str(source.path), source.scene_id
        volume = source.volume()
        self.volume: BlockVolume = open_all_doors(volume) if opens_doors else volume
        self.solid: CollisionGrid = collision_grid(self.volume, opens_doors)
        self._opens_doors = opens_doors
        self.body, self.graph, self._found = self._walkable(body)
        self._fields: OrderedDict[tuple[tuple[float, ...], ...], np.ndarray] = OrderedDict()

    @property
    def blocks_per_metre(self) -> float:
        """The scale of the build."""
        return self.volume.blocks_per_metre

    @property
    def metres_per_block(self) -> float:
        """The length of a block in the room."""
        return 1 / self.volume.blocks_per_metre

    @property
    def scale(self) -> float:
        """How many times larger the body is than the game's player, in blocks."""
        return self.body * self.blocks_per_metre

    @property
    def eye_blocks(self) -> float:
        """How high the eye is over the feet, blocks."""
        return EYE * self.scale

    @cached_property
    def corner(self) -> np.ndarray:
        """The world place of the volume's first cell, int64 [3]."""
        return np.array(self.volume.corner, np.int64)

    @cached_property
    def corner_graph(self) -> WalkGraph:
        """The graph again, with the places at corners where shortest ways bend."""
        return walk_graph(self.volume, WalkRule(scale=self.scale, at_corners=True))

    @cached_property
    def floor(self) -> FloorTable:
        """The ways as a table, for places between their own."""
        return build_floor_table(self.corner_graph)

    @cached_property
    def _lattice(self) -> Lattice:
        return build_lattice(self.corner_graph)

    @cached_property
    def _own_places(self) -> np.ndarray:
        """The place in the ways of each place of the graph, int64 [N]."""
        return np.asarray(KDTree(self.corner_graph.feet).query(self.graph.feet)[1])

    @cached_property
    def render_scene(self) -> BlockScene:
        """What pictures are taken of."""
        return prepare_scene(self.volume)

    @cached_property
    def layouts(self) -> tuple[Layout, ...]:
        """The floor plans that lie beside the blocks; none of worlds of others."""
        return layouts_beside(Path(self.path))

    @cached_property
    def room_of_places(self) -> np.ndarray:
        """The room of each place of the graph, int64 [N], -1 for none."""
        return rooms_of_places(self.graph, self._found)

    @cached_property
    def rooms(self) -> tuple[SceneRoom, ...]:
        """The rooms in which one can stand, with their doors."""
        return scene_rooms(self.volume, self.graph, self._found, self.room_of_places, self.layouts)

    @cached_property
    def landmarks(self) -> tuple[Landmark, ...]:
        """The things of the scene, named apart."""
        designs = self.source.designs()
        return landmarks_of(self.volume, designs, _titles(designs[1]), self._room_of_point)

    @cached_property
    def main_places(self) -> np.ndarray:
        """The places of rooms that hang together most, int64 [N]: where episodes begin and end."""
        places = np.concatenate([room.places for room in self._found])
        number = connected_parts(self.graph)[places]
        return np.sort(places[number == np.bincount(number).argmax()])

    @property
    def start(self) -> Stance:
        """Where a player of the world begins, moved to the nearest place of the rooms."""
        spawn = self.source.start()
        rooms = self.graph.feet[self.main_places]
        target = rooms.mean(axis=0) if spawn is None else np.array(spawn)
        x, y, z = rooms[((rooms - target) ** 2).sum(axis=1).argmin()]
        return Stance(float(x), float(y), float(z))

    def landmark(self, name: str) -> Landmark:
        """Return the landmark of a name; a noun or a part of it will do where it means one thing.

        Raises:
            UnknownNameError: no thing is called so. UsageError: several are.
        """
        wanted = name.strip().lower().removeprefix("the ")
        words = set(wanted.split())
        found = (
            [one for one in self.landmarks if one.name.lower() == wanted]
            or [one for one in self.landmarks if one.noun.lower() == wanted]
            or [one for one in self.landmarks if words and words <= set(one.noun.lower().split())]
        )
        if len(found) == 1:
            return found[0]
        if not found:
            raise UnknownNameError("landmark", wanted, [one.name for one in self.landmarks])
        names = ", ".join(repr(one.name) for one in found[:6])
        raise UsageError(f"{len(found)} things are called {wanted!r}; say one of {names}")

    def goals_at(self, landmark: Landmark) -> tuple[tuple[float, float, float], ...]:
        """Return the places right before a landmark, feet in world blocks; none where none is.

        They are places of the rooms from which no wall hides it, the nearest ones.
        """
        feet = self.graph.feet[self.main_places]
        points = apply(self.volume.block_to_room, feet)
        gap = np.maximum(0.0, np.maximum(landmark.low_m - points, points - landmark.high_m))
        away = np.hypot(gap[:, 0], gap[:, 1])
        level = (points[:, 2] > landmark.low_m[2] - 2.2) & (points[:, 2] < landmark.high_m[2] + 0.3)
        near = np.flatnonzero(level & (away <= REACH_M))
        near = near[[self._sees(points[n], landmark) for n in near]] if len(near) else near
        if not len(near):
            return ()
        ring = near[away[near] <= away[near].min() + RING_M]
        picked = ring[np.linspace(0, len(ring) - 1, min(len(ring), MAX_GOALS)).round().astype(int)]
        return tuple((float(x), float(y), float(z)) for x, y, z in feet[picked])

    def distances_m(self, goals: Sequence[tuple[float, float, float]]) -> np.ndarray:
        """Return how far it is on foot from each place to the nearest goal, float64 [N].

        Ways are straight wherever a body can walk straight. Infinite where none leads.
        """
        return self.corner_distances_m(goals)[self._own_places]

    def corner_distances_m(self, goals: Sequence[tuple[float, float, float]]) -> np.ndarray:
        """Return the same for each place of ``corner_graph``.

        The last fields are kept: one serves a whole episode.
        """
        key = tuple(map(tuple, goals))
        if key in self._fields:
            self._fields.move_to_end(key)
            return self._fields[key]
        places = np.array(sorted({self.corner_graph.nearest(goal) for goal in goals}))
        field, _ = straight_distances_m(self.corner_graph, self._lattice, places)
        self._fields[key] = field
        if len(self._fields) > MAX_FIELDS:
            self._fields.popitem(last=False)
        return field

    def distance_m(
        self, feet: tuple[float, float, float], goals: Sequence[tuple[float, float, float]]
    ) -> float:
        """Return how far it is on foot from a place, also one between those of the graph."""
        field = self.corner_distances_m(goals)
        over = distance_from_field(self.floor, field, *(float(value) for value in feet))
        if np.isfinite(over) or not np.isfinite(field).any():
            return float(over)
        nearest = self.corner_graph.nearest(feet)  # Off the floor: on furniture, or in the air.
        offset = np.linalg.norm(self.corner_graph.feet[nearest] - np.asarray(feet))
        return float(field[nearest] + offset * self.metres_per_block)

    def room_at(self, feet: tuple[float, float, float]) -> int:
        """Return the number of the room that a place is in, -1 for none."""
        return int(self.room_of_places[self.graph.nearest(feet)])

    def to_room_m(
        self, feet: np.ndarray | Sequence[float] | Sequence[tuple[float, float, float]]
    ) -> np.ndarray:
        """Return places in metres of the room, float64 [..., 3]."""
        return apply(self.volume.block_to_room, np.asarray(feet, np.float64))

    def camera_to_room(self, stance: Stance) -> np.ndarray:
        """Return the 4x4 pose of the eyes of one who stands so."""
        pose = GamePose(*stance.feet, stance.yaw_deg, stance.pitch_deg)
        return pose.camera_to_room(self.volume.block_to_room, self.eye_blocks)

    def picture(
        self,
        stance: Stance,
        camera: Camera,
        *,
        outputs: Collection[str] = DEFAULT_OUTPUTS,
        light: LightSettings = DAY,
        threads: int = 1,
    ) -> Picture:
        """Return what one who stands so sees."""
        pose = self.camera_to_room(stance)
        return render_volume(
            self.render_scene, camera, pose, outputs=outputs, light=light, threads=threads
        )

    def _walkable(self, body: float | None) -> tuple[float, WalkGraph, list[TourRoom]]:
        """Return the largest body that has floor to walk on, its graph and its rooms."""
        rule = TourRule(start=self.source.start(), layouts=self.layouts)
        for size in BODIES if body is None else (body,):
            scale = size * self.blocks_per_metre
            graph = walk_graph(self.volume, WalkRule(scale, opens_doors=self._opens_doors))
            rooms = find_rooms(self.volume, graph, self.solid, rule)
            floor_m2 = sum(room.floor_m2 for room in rooms)
            if floor_m2 >= MIN_FLOOR_M2 or (rooms and (body or size) == (body or BODIES[-1])):
                return size, graph, rooms
        size = min(BODIES) if body is None else body
        raise InputError(
            self.path,
            f"has no floor that a body of {size:g} times a person can stand on; a smaller one may, "
            "or a box around its rooms",
        )

    def _room_of_point(self, point_m: np.ndarray) -> int:
        """Return the room of a thing: that of the place nearest to it on the floor under it."""
        places = np.concatenate([room.places for room in self._found])
        at = apply(self.volume.block_to_room, self.graph.feet[places])
        under = (at[:, 2] > point_m[2] - STOREY_M) & (at[:, 2] < point_m[2] + 0.3)
        away = np.where(under, np.hypot(*(at[:, :2] - point_m[:2]).T), np.inf)
        nearest = int(away.argmin())
        return int(self.room_of_places[places[nearest]]) if away[nearest] <= STOREY_M else -1

    def _sees(self, feet_m: np.ndarray, landmark: Landmark) -> bool:
        """Whether no wall, floor or ceiling lies between the eyes at a place and a thing."""
        eye = feet_m + np.array([0, 0, EYE * self.body])
        target = np.clip(eye, landmark.low_m, landmark.high_m)
        target = target + 0.1 * (landmark.center_m - target)
        count = max(2, int(np.linalg.norm(target - eye) * self.blocks_per_metre * 4))
        points = eye + np.linspace(0, 1, count)[:, None] * (target - eye)
        cells = apply(invert(self.volume.block_to_room), points) - np.array(self.volume.corner)
        index = np.floor(cells).astype(np.int64)
        index = index[((index >= 0) & (index < self.volume.states.shape)).all(axis=1)].T
        classes = self.volume.semantic[tuple(index)]
        own = self.volume.instance[tuple(index)] == landmark.number
        hidden = (classes >= SemanticClass.CEILING) & (classes <= SemanticClass.WALL) & ~own
        return not hidden.any()


def open_scene(
    path: str | Path,
    *,
    box: Sequence[int] | None = None,
    blocks_per_metre: float | None = None,
    body: float | None = None,
) -> VlnScene:
    """Open a place that holds blocks as a scene to walk in.

    Args:
        path: a run's folder, a generated house, a world of anyone, or a file such as
            ``house.schem``; what ``minecraftocc.source.open_scene_source`` reads.
        box: x0 y0 z0 x1 y1 z1 in blocks of a world of others, the last ones not included.
        blocks_per_metre: the scale, where the place does not say it.
        body: the walker's size next to a person's. None takes 1, or the largest of 0.6 and 0.4
            that finds floor in a cluttered scan.

    Raises:
        InputError: it cannot be read, or nobody can stand in it. UsageError: an option cannot be.

    Example:
        >>> scene = open_scene("worlds/house_0001")                       # doctest: +SKIP
        >>> scene.goals_at(scene.landmark("piano"))[0]                    # doctest: +SKIP
        (41.5, 64.0, 12.5)
    """
    if body is not None and not 0.1 <= body <= 2:
        raise UsageError(f"a body is 0.1 to 2 times a person, not {body}")
    return VlnScene(open_scene_source(path, box=box, blocks_per_metre=blocks_per_metre), body)


def camera_of(width_px: int, height_px: int, hfov_deg: float) -> Camera:
    """Return a camera of a size in pixels and a horizontal field of view, as Habitat names it."""
    focal_px = float(focal_px_of_fov(width_px, hfov_deg))
    return Camera(width_px, height_px, focal_px, focal_px, width_px / 2, height_px / 2)


def _titles(names: Sequence[str]) -> dict[str, str]:
    known = set(TEMPLATES.names())
    return {name: TEMPLATES.load(name).title for name in names if name in known}


def layouts_beside(path: Path) -> tuple[Layout, ...]:
    """Return the floor plans beside a house, or of a run whose folder or build is named."""
    folder = path if path.is_dir() else path.parent
    blocks = find_blocks(path) if path.is_dir() else path
    for place in (folder, blocks.parent, blocks.parent.parent):
        if (place / "layout.json").is_file() and (place / "scene.json").is_file():
            return read_layouts(place / "layout.json")
        if (place / "layout.json").is_file() and (place / "build" / "scene.json").is_file():
            return read_layouts(place / "layout.json")
    return ()
