"""What a shared page contains of a room, as two packets.

The packets are those of ``rendering.mesh``, with the magic ``W2MS``. That of the room has the
arrays of ``compact_mesh_arrays``. That of the floor has those of ``collision_arrays``, and the
ways of the planner: ``feet_of_ways`` float32 [N, 3] (positions in cells) and ``turns`` uint16
[T, N]. Row t contains where the shortest path from each position to thing t turns first, or 65535
without a path.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import InputError, World2MinecraftError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.objects_and_placements import read_objects
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.scan_record import read_room_size
from world2minecraft.minecraft.physics import BlockWorld, find_standing_place
from world2minecraft.minecraftocc.scene_sources import SceneSource, open_scene_source
from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.running.sentence_goals import phrases_of
from world2minecraft.navigation.scene import VlnScene, source_landmarks
from world2minecraft.rendering.mesh import mesh_of
from world2minecraft.rendering.mesh.packets import COMPACT_UNIT, compact_mesh_arrays
from world2minecraft.rendering.mesh.viewer_page import packed_block
from world2minecraft.rendering.presentation.opened_room import OpenedBuild
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.rendering.views.orbit import orbit_shots
from world2minecraft.sceneforge.block_arrays import collision_arrays
from world2minecraft.sceneforge.walk_guide import goals_of

NO_WAY = 65_535
MAX_TURNS = 8_000_000  # Of all goals together; beyond, things far from the start have no way.
GENERIC_NAMES = ("out", "build", "world", "output", "run", "room")
ELEVATION_DEG = 42.0  # Of the page's first view.
DEFAULT_TITLE = "My room"


@dataclass(frozen=True, eq=False)
class SharedRoom:
    """A room to be shared.

    Attributes:
        source: The source of the blocks.
        title: The heading of the page.
        volume: The blocks, with doors open where somebody can walk.
        landmarks: The things of the room.
        scene: The walkable floor. None if there is no place to stand.
    """

    source: SceneSource
    title: str
    volume: BlockVolume
    landmarks: tuple[Landmark, ...]
    scene: VlnScene | None

    @classmethod
    def read(cls, path: Path, title: str = "") -> "SharedRoom":
        """Read a run folder, world or block file.

        Args:
            path: Path of the room.
            title: The heading of the page. Derived from the path if empty.

        Raises:
            InputError: If the blocks cannot be read.
        """
        source = open_scene_source(path)
        volume = source.volume()
        heading = title or title_of(source.scene_id)
        try:
            scene = VlnScene(source)
        except InputError:  # Nowhere to stand: the room can still be looked at.
            return cls(source, heading, volume, source_landmarks(source, volume, _no_room), None)
        return cls(source, heading, scene.volume, scene.landmarks, scene)

    @cached_property
    def start(self) -> tuple[tuple[float, float, float], float]:
        """The start of a walk: the feet in cells of the volume, and Minecraft's yaw in degrees."""
        if self.scene is None:
            middle = tuple(float(side) / 2 for side in self.volume.states.shape)
            return middle, 0.0  # type: ignore[return-value]
        stance, floor = self.scene.start, self.scene.graph.feet[self.scene.main_places]
        world = BlockWorld.of_volume(self.volume)
        place = find_standing_place(world, stance.feet, self.scene.scale)
        x, _, z = floor.mean(axis=0) - np.array(stance.feet)
        yaw_deg = float(np.degrees(np.arctan2(-x, z))) if np.hypot(x, z) > 1e-6 else 0.0
        feet = np.array(place) - self.volume.corner
        return (float(feet[0]), float(feet[1]), float(feet[2])), yaw_deg

    def room_packet(self) -> "SharedPacket":
        """Return the mesh with the things and their words: all that the first picture needs."""
        mesh = mesh_of(self.volume)
        phrases = phrases_of(self.landmarks)
        header = {
            "title": self.title,
            "size_m": self._room_size(),
            "unit": COMPACT_UNIT,
            "clear_from": mesh.clear_from,
            "texture_px": mesh.atlas.side_px,
            "grid_to_room": self.volume.grid_to_room.ravel().tolist(),
            "azimuth": _best_azimuth(self.volume),
            "can_walk": self.scene is not None,
            "things": self._things(),
            "phrases": {words: [one.number for one in found] for words, found in phrases.items()},
            "photos": [],
        }
        return SharedPacket(header, compact_mesh_arrays(mesh))

    def floor_packet(self, progress: Progress = no_progress) -> "SharedPacket":
        """Return what stops a walker, and the ways of the planner.

        Args:
            progress: Callback that reports the ways, by thing.
        """
        place, yaw_deg = self.start
        body = 1.0 if self.scene is None else self.scene.body
        header = {
            "rev": 0,
            "blocks_per_metre": self.volume.blocks_per_metre * body,  # Of the walker's size.
            "grid_to_room": self.volume.grid_to_room.ravel().tolist(),
            "feet": list(place),
            "yaw_deg": yaw_deg,
        }
        boxes = collision_arrays(BlockWorld.of_volume(self.volume))
        return SharedPacket(header, boxes | self._ways(progress))

    def _things(self) -> list[dict[str, Any]]:
        """Return the things for the list of the page, sorted by name.

        ``way`` is the row of a thing in the ways, or -1.
        """
        sizes = self._own_sizes()
        rows = [
            {
                "id": one.number,
                "name": one.name,
                "low_m": np.round(one.low_m, 3).tolist(),
                "high_m": np.round(one.high_m, 3).tolist(),
                "size_m": np.round(sizes.get(one.number, one.size_m), 2).tolist(),
                "way": place if place < self._ways_count else -1,
            }
            for place, one in enumerate(self.landmarks)
        ]
        return sorted(rows, key=lambda row: (row["name"].casefold(), row["id"]))

    def _room_size(self) -> list[float] | None:
        """Return the size of the room in metres, if the run states it."""
        try:
            return np.round(read_room_size(Path(self.source.path) / "scan.json"), 2).tolist()
        except World2MinecraftError:
            return None

    def _own_sizes(self) -> dict[int, np.ndarray]:
        """Return the size of each object along its own axes in metres, if the run states it."""
        folder = Path(self.source.path)
        try:
            grid, _ = read_room(folder / "room.npz")
            return {one.id: one.size_m for one in read_objects(folder / "objects.json", grid)}
        except World2MinecraftError:
            return {}

    @property
    def _ways_count(self) -> int:
        """The number of things that have ways: the first ones of ``landmarks``."""
        if self.scene is None or len(self.scene.corner_graph) >= NO_WAY:
            return 0
        return min(MAX_TURNS // max(len(self.scene.corner_graph), 1), len(self.landmarks))

    def _ways(self, progress: Progress) -> dict[str, np.ndarray]:
        """Return the places of the floor, and where the path to each thing turns."""
        rows: list[np.ndarray] = []
        scene, count = self.scene, self._ways_count
        if scene is None:
            return {
                "feet_of_ways": np.zeros((0, 3), np.float32),
                "turns": np.zeros((0, 0), np.uint16),
            }
        for number, one in enumerate(self.landmarks[:count]):
            progress("ways", number, count)
            turns = scene.turning_places(goals_of(scene, one))
            rows.append(np.where(turns < 0, NO_WAY, turns).astype(np.uint16))
        progress("ways", count, count)
        feet = scene.corner_graph.feet - np.array(self.volume.corner)
        empty = np.zeros((0, len(feet)), np.uint16)
        return {
            "feet_of_ways": feet.astype(np.float32),
            "turns": np.stack(rows) if rows else empty,
        }


@dataclass(frozen=True, eq=False)
class SharedPacket:
    """A packet before it is compressed."""

    header: dict[str, Any]
    arrays: dict[str, np.ndarray]

    def compressed(self, **more: Any) -> bytes:
        """Return the packet as bytes, with further facts in its header."""
        return packed_block(self.header | more, self.arrays)


def _best_azimuth(volume: BlockVolume) -> float:
    """Return the direction from which most things are visible, in radians from +x towards +y."""
    build = OpenedBuild(volume)
    camera = camera_of(64, 48, vertical_fov_deg=40.0)
    start_deg = build.best_start_deg(ELEVATION_DEG)
    shot = orbit_shots(build.whole, camera, 1, elevation_deg=ELEVATION_DEG, start_deg=start_deg)[0]
    forward = shot.camera_to_room[:3, 2]
    return float(np.arctan2(-forward[1], -forward[0]))


def title_of(scene_id: str) -> str:
    """Return a heading for a scene.

    Example:
        >>> title_of("aunt_marys-kitchen"), title_of("OUT")
        ('Aunt marys kitchen', 'My room')
    """
    words = " ".join(scene_id.replace("_", " ").replace("-", " ").split())
    if not words or words.casefold() in GENERIC_NAMES:
        return DEFAULT_TITLE
    return words[0].upper() + words[1:]


def _no_room(_: np.ndarray) -> int:
    return -1
