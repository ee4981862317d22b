"""Scenes for navigation, with walkable floor, walking distances, landmarks, rooms and views.

``VlnScene`` represents any world with blocks and computes its parts on first use. Doors that
players can open are treated as open for movement and rendering. ``FloorTable`` stores the walk
graph by columns, for fast lookups of positions between its nodes.
"""

from collections import OrderedDict
from collections.abc import Callable, Collection, Sequence
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
from world2minecraft.navigation.landmarks import Landmark, landmarks_of, nouns_of_names
from world2minecraft.navigation.rooms_and_doors import SceneRoom, rooms_of_places, scene_rooms
from world2minecraft.navigation.types import Stance
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS, Picture, render_volume
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.shading_parameters import DAY
from world2minecraft.rendering.views.cameras import GamePose

REACH_SPACINGS = 1.5  # Spacings within which nodes are on the same side of any wall.
LEVEL_SIZES = 0.6  # Height difference on the same floor, relative to the size of the body.
BODIES = (1.0, 0.6, 0.4)  # Body sizes that are tried; cluttered scans need small ones.
MIN_FLOOR_M2 = 1.0  # Of all rooms; with less, a smaller body is tried.
STOREY_M = 2.8  # Maximum distance of an object from the floor of its room, above or beside it.
REACH_M = 1.0  # Maximum distance of a goal position from its landmark.
RING_M = 0.25  # Maximum difference of this distance from that of the nearest position.
MAX_GOALS = 32
MAX_FIELDS = 64  # Most recently used distance fields that are cached.


class FloorTable(NamedTuple):
    """The nodes of a walk graph, sorted into the columns of a regular grid.

    Attributes:
        origin: The x and z of the first column in world blocks, as float64 [2].
        shape: The number of columns along x and z, as int64 [2].
        start: The offset of each column in ``place``, as int64 [C + 1].
        place: The node indices by column, as int32 [N].
        feet: The position of each node, as float64 [N, 3].
        spacing: The distance between columns in blocks.
        level: The maximum height difference to a node on the same floor, in blocks.
        metres_per_block: The scale.
    """

    origin: np.ndarray
    shape: np.ndarray
    start: np.ndarray
    place: np.ndarray
    feet: np.ndarray
    spacing: float
    level: float
    metres_per_block: float


def build_floor_table(graph: WalkGraph) -> FloorTable:
    """Build the table of a non-empty walk graph."""
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
    """Look up the walking distance of a position in a distance field over walk graph nodes.

    Args:
        floor: The ``FloorTable`` of the walk graph.
        field: The distance of each node in metres as float64 [N].
        x: The x coordinate of the feet in world blocks.
        y: The y coordinate of the feet.
        z: The z coordinate of the feet.

    Returns:
        The distance in metres, or inf if the position is not on the floor.
    """
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
    """A world in which an agent can walk.

    Positions are those of the feet in world blocks, and walking distances are in metres of the
    room.

    Args:
        source: The source of the blocks.
        body: The body size relative to a person. None chooses the largest that has floor to walk
            on.
        opens_doors: Whether doors are treated as open.

    Attributes:
        volume: The blocks, with open doors.
        graph: The walk graph of the body.
        body: The body size relative to a person.

    Raises:
        InputError: If no floor is large enough for the body.
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
        """The number of blocks per metre of the room."""
        return self.volume.blocks_per_metre

    @property
    def metres_per_block(self) -> float:
        """The length of a block in metres of the room."""
        return 1 / self.volume.blocks_per_metre

    @property
    def scale(self) -> float:
        """The size of the body relative to the game's player, in blocks."""
        return self.body * self.blocks_per_metre

    @property
    def eye_blocks(self) -> float:
        """The height of the eyes above the feet in blocks."""
        return EYE * self.scale

    @cached_property
    def corner(self) -> np.ndarray:
        """The world position of the volume's first cell as int64 [3]."""
        return np.array(self.volume.corner, np.int64)

    @cached_property
    def corner_graph(self) -> WalkGraph:
        """The walk graph with additional nodes at corners, where shortest paths bend."""
        return walk_graph(self.volume, WalkRule(scale=self.scale, at_corners=True))

    @cached_property
    def floor(self) -> FloorTable:
        """The lookup table of ``corner_graph`` for positions between its nodes."""
        return build_floor_table(self.corner_graph)

    @cached_property
    def _lattice(self) -> Lattice:
        return build_lattice(self.corner_graph)

    @cached_property
    def _own_places(self) -> np.ndarray:
        """The index in ``corner_graph`` of each node of ``graph``, as int64 [N]."""
        return np.asarray(KDTree(self.corner_graph.feet).query(self.graph.feet)[1])

    @cached_property
    def render_scene(self) -> BlockScene:
        """The scene prepared for rendering."""
        return prepare_scene(self.volume)

    @cached_property
    def layouts(self) -> tuple[Layout, ...]:
        """The floor plans stored beside the blocks. Worlds from other programs have none."""
        return layouts_beside(Path(self.path))

    @cached_property
    def room_of_places(self) -> np.ndarray:
        """The room of each node of the graph as int64 [N], or -1."""
        return rooms_of_places(self.graph, self._found)

    @cached_property
    def rooms(self) -> tuple[SceneRoom, ...]:
        """The rooms with walkable floor, and their doors."""
        return scene_rooms(self.volume, self.graph, self._found, self.room_of_places, self.layouts)

    @cached_property
    def landmarks(self) -> tuple[Landmark, ...]:
        """The landmarks of the scene, with unique names."""
        return source_landmarks(self.source, self.volume, self._room_of_point)

    @cached_property
    def main_places(self) -> np.ndarray:
        """The nodes of the largest connected group of rooms, int64 [N], for starts and goals."""
        places = np.concatenate([room.places for room in self._found])
        number = connected_parts(self.graph)[places]
        return np.sort(places[number == np.bincount(number).argmax()])

    @property
    def start(self) -> Stance:
        """The room position nearest to the world's spawn point."""
        spawn = self.source.start()
        rooms = self.graph.feet[self.main_places]
        target = rooms.mean(axis=0) if spawn is None else np.array(spawn)
        x, y, z = rooms[((rooms - target) ** 2).sum(axis=1).argmin()]
        return Stance(float(x), float(y), float(z))

    def landmark(self, name: str) -> Landmark:
        """Return the landmark with a name, noun or part of a noun that identifies it.

        Raises:
            UnknownNameError: If no landmark matches.
            UsageError: If several landmarks match.
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
        raise UsageError(f"{len(found)} landmarks are named {wanted!r}; use one of {names}")

    def goals_at(self, landmark: Landmark) -> tuple[tuple[float, float, float], ...]:
        """Return the nearest positions in front of a landmark, as feet in world blocks.

        Only room positions from which no wall hides the landmark are returned. There may be none.
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
        """Return the walking distance from each node to the nearest goal in metres, as float64 [N].

        Paths are straight wherever the body can walk straight. Unreachable nodes have the distance
        inf.
        """
        return self.corner_distances_m(goals)[self._own_places]

    def corner_distances_m(self, goals: Sequence[tuple[float, float, float]]) -> np.ndarray:
        """Return the walking distance from each node of ``corner_graph`` in metres.

        The most recently used distance fields are cached, because an episode needs one of them
        repeatedly.
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

    def turning_places(self, goals: Sequence[tuple[float, float, float]]) -> np.ndarray:
        """Return where the shortest path from each node of ``corner_graph`` to a goal turns first.

        The path leads straight to that node, and from there on to its own, up to a node that leads
        to itself, which is a goal. -1 stands for nodes without a path. The result is int32 [N].
        """
        places = np.array(sorted({self.corner_graph.nearest(goal) for goal in goals}))
        return straight_distances_m(self.corner_graph, self._lattice, places)[1]

    def distance_m(
        self, feet: tuple[float, float, float], goals: Sequence[tuple[float, float, float]]
    ) -> float:
        """Return the walking distance in metres from any position to the nearest goal."""
        field = self.corner_distances_m(goals)
        over = distance_from_field(self.floor, field, *(float(value) for value in feet))
        if np.isfinite(over) or not np.isfinite(field).any():
            return float(over)
        nearest = self.corner_graph.nearest(feet)  # The position is on furniture or in the air.
        offset = np.linalg.norm(self.corner_graph.feet[nearest] - np.asarray(feet))
        return float(field[nearest] + offset * self.metres_per_block)

    def room_at(self, feet: tuple[float, float, float]) -> int:
        """Return the index of the room at a position, or -1."""
        return int(self.room_of_places[self.graph.nearest(feet)])

    def to_room_m(
        self, feet: np.ndarray | Sequence[float] | Sequence[tuple[float, float, float]]
    ) -> np.ndarray:
        """Convert block positions to metres of the room, as float64 [..., 3]."""
        return apply(self.volume.block_to_room, np.asarray(feet, np.float64))

    def camera_to_room(self, stance: Stance) -> np.ndarray:
        """Return the 4x4 camera-to-room pose of the eyes at a stance."""
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
        """Render the view at a stance.

        Args:
            stance: The position and viewing direction.
            camera: The camera.
            outputs: The images to render, such as "colour", "depth", "semantic" or "instance".
            light: The lighting.
            threads: The number of rendering threads.
        """
        pose = self.camera_to_room(stance)
        return render_volume(
            self.render_scene, camera, pose, outputs=outputs, light=light, threads=threads
        )

    def _walkable(self, body: float | None) -> tuple[float, WalkGraph, list[TourRoom]]:
        """Return the largest body that has enough floor, with its walk graph and rooms."""
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
            f"no floor on which a body of {size:g} times human size can stand; use a "
            "smaller body, or a box around the rooms",
        )

    def _room_of_point(self, point_m: np.ndarray) -> int:
        """Return the room of an object, which is that of the nearest node on the floor below it."""
        places = np.concatenate([room.places for room in self._found])
        at = apply(self.volume.block_to_room, self.graph.feet[places])
        under = (at[:, 2] > point_m[2] - STOREY_M) & (at[:, 2] < point_m[2] + 0.3)
        away = np.where(under, np.hypot(*(at[:, :2] - point_m[:2]).T), np.inf)
        nearest = int(away.argmin())
        return int(self.room_of_places[places[nearest]]) if away[nearest] <= STOREY_M else -1

    def _sees(self, feet_m: np.ndarray, landmark: Landmark) -> bool:
        """Return whether no wall, floor or ceiling hides a landmark from a position."""
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
    """Open a world as a scene for navigation.

    Args:
        path: The folder of a run, a generated house, a Minecraft world, or a file such as
            ``house.schem``, as accepted by ``minecraftocc.scene_sources.open_scene_source``.
        box: The block range x0 y0 z0 x1 y1 z1 to load from a Minecraft world, with exclusive ends.
        blocks_per_metre: The scale, if the path does not define one.
        body: The body size relative to a person. None uses 1, or 0.6 or 0.4 in a cluttered scan
            without floor for larger bodies.

    Raises:
        InputError: If the world cannot be read, or has no floor to stand on.
        UsageError: If an option is invalid.

    Example:
        >>> scene = open_scene("worlds/house_0001")                       # doctest: +SKIP
        >>> scene.goals_at(scene.landmark("piano"))[0]                    # doctest: +SKIP
        (41.5, 64.0, 12.5)
    """
    if body is not None and not 0.1 <= body <= 2:
        raise UsageError(f"body must be 0.1 to 2 times human size, got {body}")
    return VlnScene(open_scene_source(path, box=box, blocks_per_metre=blocks_per_metre), body)


def source_landmarks(
    source: SceneSource, volume: BlockVolume, room_of: Callable[[np.ndarray], int]
) -> tuple[Landmark, ...]:
    """Return the landmarks of a source with unique names.

    Args:
        source: The source, which states the names and designs of objects.
        volume: Its blocks, with doors open or as they are.
        room_of: A function from a position in metres, float64 [3], to the index of its room.
    """
    designs = source.designs()
    names = nouns_of_names(source.names())
    return landmarks_of(volume, designs, _titles(designs[1]), room_of, names=names)


def camera_of(width_px: int, height_px: int, hfov_deg: float) -> Camera:
    """Return a camera with a size in pixels and a horizontal field of view in degrees."""
    focal_px = float(focal_px_of_fov(width_px, hfov_deg))
    return Camera(width_px, height_px, focal_px, focal_px, width_px / 2, height_px / 2)


def _titles(names: Sequence[str]) -> dict[str, str]:
    known = set(TEMPLATES.names())
    return {name: TEMPLATES.load(name).title for name in names if name in known}


def layouts_beside(path: Path) -> tuple[Layout, ...]:
    """Return the floor plans stored beside a house or a run.

    Args:
        path: The folder or the blocks of the house or run.
    """
    folder = path if path.is_dir() else path.parent
    blocks = find_blocks(path) if path.is_dir() else path
    for place in (folder, blocks.parent, blocks.parent.parent):
        if (place / "layout.json").is_file() and (place / "scene.json").is_file():
            return read_layouts(place / "layout.json")
        if (place / "layout.json").is_file() and (place / "build" / "scene.json").is_file():
            return read_layouts(place / "layout.json")
    return ()
