"""Planned walks: simulated tours that visit one landmark after another.

The path between landmarks is the shortest one that keeps a distance from walls where possible. The
walker pauses at each landmark and faces it, so that the stream can be cut there like a recorded
one.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.minecraft.physics.shortest_paths import clearance_m, shortest_path
from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.language.landmark_grounding import unambiguous_landmarks
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Stance
from world2minecraft.navigation.walk_stream import StreamFrame, wrap_deg

EVERY_S = 0.2
SPEED_M_S, TURN_DEG_S = 1.0, 90.0
PAUSE_S = 2.4  # Longer than a pause at which a stream is cut.
ASIDE_DEG = (50.0, 125.0)  # Angle between the path and the view before a leg begins.
SPOKEN_DEG = 35.0  # Minimum angle of a turn that instructions mention.
AHEAD_M = 0.6  # Distance along the path to which a walker looks.
ELBOW_M, NARROW_COST = 0.5, 3.0  # Preferred distance from walls, and relative cost at a wall.
STOPS = 8  # Of a tour.
MIN_LEG_M = 1.6  # Minimum distance to the next stop.
MAX_HEIGHT_M = 1.2  # Maximum height of the underside of a landmark above the floor.
MIN_SIDE_M = 0.4  # Minimum size of a goal.
PULL_M = 0.2  # Free space that a straightened path must keep.


@dataclass(frozen=True)
class Tour:
    """The frames of a tour, and the name of each visited landmark by the time of the stop."""

    frames: tuple[StreamFrame, ...]
    targets: dict[float, str]

    def target_at(self, t_s: float) -> str:
        """Return the landmark that is being approached at a time, or "" after the last stop."""
        later = [stop_s for stop_s in self.targets if stop_s >= t_s - 1e-9]
        return self.targets[min(later)] if later else ""


class TourPlanner:
    """A planner of random tours through a scene."""

    def __init__(self, scene: VlnScene):
        self._scene, self._graph = scene, scene.graph
        self._elbow = clearance_m(scene.graph)
        self._weights = 1 + NARROW_COST * np.maximum(0.0, 1 - self._elbow / ELBOW_M)
        self._tree = KDTree(scene.graph.feet)
        self._goals = _goals(scene)

    @property
    def has_goals(self) -> bool:
        """Whether the scene has at least two reachable landmarks to walk between."""
        return len(self._goals) >= 2

    def tour(self, tour_id: str, rng: np.random.Generator) -> Tour:
        """Return a tour with up to ``STOPS`` stops, which depends only on the random generator."""
        here = int(rng.choice(self._scene.main_places))
        frames = [self._frame(0.0, self._graph.feet[here], float(rng.uniform(-180, 180)), tour_id)]
        targets: dict[float, str] = {}
        for number in rng.permutation(len(self._goals))[:STOPS]:
            landmark, places = self._goals[number]
            goal = int(rng.choice(places))
            path = shortest_path(self._graph, here, goal, self._weights)
            if path is None or path.length_m < MIN_LEG_M:
                continue
            way = self._straightened(path.feet)
            facing = self._facing(way[-1], landmark)
            self._look_aside(frames, way, facing, rng)
            self._walk(frames, way, facing)
            targets[frames[-1].t_s] = landmark.name
            self._pause(frames)
            here = goal
        return Tour(tuple(frames), targets)

    def _look_aside(
        self, frames: list[StreamFrame], way: np.ndarray, facing: float, rng: np.random.Generator
    ) -> None:
        """Turn away from the path and pause before a leg, so that each leg starts with a turn.

        The direction is chosen so that the first turn is opposite to the last turn of the leg.
        """
        ahead = _yaw_of(way[1] - way[0])
        last = float(wrap_deg(facing - _yaw_of(way[-1] - way[-2])))
        side = -np.sign(last) if abs(last) >= SPOKEN_DEG else float(rng.choice([-1, 1]))
        angle = float(rng.uniform(*ASIDE_DEG))
        self._turn(frames, float(wrap_deg(ahead - side * angle)))
        self._pause(frames)

    def _walk(self, frames: list[StreamFrame], corners: np.ndarray, facing: float) -> None:
        """Add the frames of a walk along corners, and of the final turn to the landmark."""
        way = _sampled(corners, SPEED_M_S * EVERY_S * self._graph.blocks_per_metre)
        ahead = max(1, round(AHEAD_M / (SPEED_M_S * EVERY_S)))
        for n in range(1, len(way)):
            yaw = _yaw_of(way[min(n + ahead, len(way) - 1)] - way[n - 1])
            if n == 1:
                self._turn(frames, yaw)
            self._add(frames, way[n], yaw)
        self._turn(frames, facing)

    def _facing(self, feet: np.ndarray, landmark: Landmark) -> float:
        """Return the yaw at which a person at a position faces a landmark."""
        near = np.clip(self._scene.to_room_m(feet), landmark.low_m, landmark.high_m)
        room_to_block = invert(self._scene.volume.block_to_room)
        point = apply(room_to_block, (near + landmark.center_m)[None] / 2)[0]
        return _yaw_of(point - feet)

    def _straightened(self, feet: np.ndarray) -> np.ndarray:
        """Return the corners of a path, straightened where there is enough free space."""
        retained, n = [0], 0
        while n < len(feet) - 1:
            n = next(m for m in range(len(feet) - 1, n, -1) if m == n + 1 or self._free(feet, n, m))
            retained.append(n)
        return feet[retained]

    def _free(self, feet: np.ndarray, first: int, last: int) -> bool:
        """Return whether a person can walk straight between two points of a path."""
        begin, end = feet[first], feet[last]
        count = int(np.linalg.norm(end - begin) / self._graph.spacing * 2) + 2
        line = begin + np.linspace(0, 1, count)[:, None] * (end - begin)
        away, near = self._tree.query(line)
        if away.max() > 0.75 * self._graph.spacing:
            return False
        _, own = self._tree.query(feet[first : last + 1])
        return bool(self._elbow[near].min() >= min(PULL_M, self._elbow[own].min()))

    def _turn(self, frames: list[StreamFrame], yaw_deg: float) -> None:
        """Add the frames of a turn on the spot."""
        last = frames[-1].stance
        off = float(wrap_deg(yaw_deg - last.yaw_deg))
        count = int(np.ceil(abs(off) / (TURN_DEG_S * EVERY_S)))
        for n in range(1, count + 1):
            self._add(frames, np.array(last.feet), last.yaw_deg + off * n / count)

    def _pause(self, frames: list[StreamFrame]) -> None:
        last = frames[-1].stance
        for _ in range(round(PAUSE_S / EVERY_S)):
            self._add(frames, np.array(last.feet), last.yaw_deg)

    def _add(self, frames: list[StreamFrame], feet: np.ndarray, yaw_deg: float) -> None:
        t_s = round(frames[-1].t_s + EVERY_S, 6)
        frames.append(self._frame(t_s, feet, yaw_deg, frames[-1].tour_id))

    def _frame(self, t_s: float, feet: np.ndarray, yaw_deg: float, tour_id: str) -> StreamFrame:
        x, y, z = (float(value) for value in feet)
        stance = Stance(x, y, z, float(wrap_deg(yaw_deg)))
        return StreamFrame(t_s, stance, self._scene.scene_id, tour_id)


def _yaw_of(direction: np.ndarray) -> float:
    return float(np.degrees(np.arctan2(-direction[0], direction[2])))


def _goals(scene: VlnScene) -> list[tuple[Landmark, list[int]]]:
    """Return the reachable landmarks, each with the reachable positions in front of it."""
    main = set(scene.main_places.tolist())
    found = []
    for landmark in floor_landmarks(scene):
        if landmark.size_m.max() < MIN_SIDE_M:
            continue
        places = sorted({scene.graph.nearest(goal) for goal in scene.goals_at(landmark)} & main)
        if places:
            found.append((landmark, places))
    return found


def floor_landmarks(scene: VlnScene) -> list[Landmark]:
    """Return landmarks suitable for directions: clearly named and not mounted high up."""
    floor = scene.to_room_m(scene.graph.feet[scene.main_places])
    found = []
    for one in unambiguous_landmarks(scene.landmarks):
        under = floor[(floor[:, 2] < one.high_m[2]) & (floor[:, 2] > one.low_m[2] - 2.5)]
        if not len(under):
            continue
        nearest = np.hypot(*(under[:, :2] - one.center_m[:2]).T).argmin()
        if one.low_m[2] - under[nearest, 2] <= MAX_HEIGHT_M:
            found.append(one)
    return found


def _sampled(feet: np.ndarray, step: float) -> np.ndarray:
    """Return points every ``step`` along a path, with its end, as float64 [N, 3]."""
    lengths = np.linalg.norm(np.diff(feet, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    at = np.append(np.arange(0.0, along[-1], step), along[-1])
    return np.stack([np.interp(at, along, feet[:, axis]) for axis in range(3)], axis=1)
