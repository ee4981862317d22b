"""Camera trajectories of scans: a person walks through all rooms and looks around while scanning.

The tour enters a room through the door and visits a few stops that are far apart, in the order of a
short path over free floor. It pauses at each stop and then continues in the nearest unvisited room.
``view_planning`` chooses the viewing directions.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera, Layout, Opening
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.navmesh import STEP_M, NavMesh, build_navmesh
from world2minecraft.procgen.sensors.view_planning import ViewPlanner
from world2minecraft.rendering.voxel_camera import VoxelScene

STOPS_PER_M2 = 1.2  # Of free floor; four at least, so that a place is seen from several sides.
STOPS = (4, 9)
STAY_M = 0.6  # A stop takes as long as a walk of this length: one sweeps there.
JUMP_M = 0.6  # Twice the longest step.
SMOOTH_M = 0.5  # Nobody walks in steps of a grid.
EYE_M = (1.2, 1.7)  # Range of camera heights over the floor, in metres.
SWAY_M = 0.22  # Vertical motion of the camera along the walk, in metres.
ASIDE_M = 0.03  # A hand is never still, least of all where one stays.
YAW_SPREAD, PITCH_SPREAD = np.radians(3.5), np.radians(2.3)


@dataclass(frozen=True, eq=False)
class WalkPath:
    """The position of the feet at F moments, spread evenly over the duration of the tour."""

    feet_m: np.ndarray  # float64 [F, 3]
    pace_m: float  # Distance between two moments; pauses count as distance.


def plan_walk(room: Room, moments: int, rng: np.random.Generator) -> WalkPath:
    """Plan a tour of ``moments`` positions through all rooms, starting at a random door."""
    places_m, stays = _way(room, build_navmesh(room), rng)
    steps = np.linalg.norm(np.diff(places_m, axis=0), axis=1)
    steps[steps > JUMP_M] = 0.0  # No pictures are taken where no path leads on.
    leave = np.cumsum(stays + np.concatenate([[0.0], steps]))
    # A pause is time at one place, so each place is listed at arrival and at departure.
    times = np.column_stack([leave - stays, leave]).reshape(-1)
    wanted = (np.arange(moments) + 0.5) / moments * times[-1]
    twice = places_m.repeat(2, axis=0)
    feet_m = np.column_stack([np.interp(wanted, times, twice[:, n]) for n in range(3)])
    return WalkPath(feet_m, float(times[-1]) / moments)


def _way(room: Room, stands: NavMesh, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Return the places of the tour, float64 [N, 3], and the pause at each, in metres."""
    stops = _all_stops(room, stands, rng)
    if not stops:
        return _middles(room), np.full(len(room.layouts), STAY_M)
    way, stays = [stops[0]], [STAY_M]
    for stop in stops[1:]:
        between = _path(stands, way[-1], stop)
        way += between
        stays += [0.0] * (len(between) - 1) + [STAY_M]
    return _smooth_path(stands, stands.places_m[way]), np.array(stays)


def _middles(room: Room) -> np.ndarray:
    """Return the middle of each room's floor, for rooms without standing places."""
    return np.array(
        [
            [*(layout.floor_polygon_m.min(axis=0) + layout.floor_polygon_m.max(axis=0)) / 2,
             layout.floor_z_m]
            for layout in room.layouts
        ]
    )  # fmt: skip


def _all_stops(room: Room, stands: NavMesh, rng: np.random.Generator) -> list[int]:
    """Return the stops of all rooms in tour order, as place indices."""
    free = {n: _free_of(stands, n) for n in range(len(room.layouts))}
    left = {n: places for n, places in free.items() if len(places)}
    if not left:
        return []
    here, stops = _entrance(room, stands, left, rng), []
    while left:
        away = dijkstra(stands.links, directed=False, indices=here)
        # Rooms that no path leads to come last.
        away = np.where(np.isfinite(away), away, 1e6)
        n = min(left, key=lambda n: (float(away[left[n]].min()), n))
        places = left.pop(n)
        first = int(places[away[places].argmin()])
        stops += _stops(stands, places, first)
        here = stops[-1]
    return stops


def _free_of(stands: NavMesh, number: int) -> np.ndarray:
    """Return the largest connected part of the easy places of a room."""
    places = np.flatnonzero(stands.easy & (stands.storey_room == number))
    if not len(places):
        return np.flatnonzero(stands.storey_room == number)
    parts = stands.part[places]
    return places[parts == np.bincount(parts).argmax()]


def _entrance(
    room: Room, stands: NavMesh, free: dict[int, np.ndarray], rng: np.random.Generator
) -> int:
    """Return the place nearest to a door of the first room with a door on the lowest floor."""
    layouts = room.layouts
    first = min(free, key=lambda n: (layouts[n].floor_z_m, not _doors(layouts[n]), n))
    doors = _doors(layouts[first])
    places = free[first]
    if not doors:
        return int(places[int(rng.integers(len(places)))])
    door = doors[int(rng.integers(len(doors)))]
    middle = (door.start_m + door.end_m) / 2
    return int(places[np.linalg.norm(stands.places_m[places, :2] - middle, axis=1).argmin()])


def _doors(layout: Layout) -> list[Opening]:
    return [opening for opening in layout.openings if opening.kind != "window"]


def _stops(stands: NavMesh, places: np.ndarray, first: int) -> list[int]:
    """Return stops in a room that are far from each other, in the order of a short path."""
    points = stands.places_m[places, :2]
    wanted = round(STOPS_PER_M2 * len(places) * STEP_M**2)
    count = min(max(wanted, STOPS[0]), STOPS[1], len(places))
    chosen = [int(np.flatnonzero(places == first)[0])]
    gap = np.linalg.norm(points - points[chosen[0]], axis=1)
    while len(chosen) < count:
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return [int(places[n]) for n in _short_order(points, chosen)]


def _short_order(points: np.ndarray, chosen: list[int]) -> list[int]:
    """Return an order that 2-opt exchanges do not shorten, with the first stop fixed."""
    order, better = list(chosen), True

    def length(route: list[int]) -> float:
        return float(np.linalg.norm(np.diff(points[route], axis=0), axis=1).sum())

    while better:
        better = False
        for a in range(1, len(order) - 1):
            for b in range(a + 1, len(order)):
                turned = order[:a] + order[a : b + 1][::-1] + order[b + 1 :]
                if length(turned) < length(order) - 1e-9:
                    order, better = turned, True
    return order


def _path(stands: NavMesh, start: int, end: int) -> list[int]:
    """Return the places after ``start`` up to ``end`` on the shortest path."""
    _, before = dijkstra(stands.links, directed=False, indices=start, return_predecessors=True)
    way, at = [end], int(before[end])
    while at >= 0 and at != start:
        way.append(at)
        at = int(before[at])
    return way[::-1]


def _smooth_path(stands: NavMesh, way_m: np.ndarray) -> np.ndarray:
    """Round the corners of a path where the result stays on the free floor."""
    smooth = ndimage.uniform_filter1d(way_m, round(SMOOTH_M / STEP_M), axis=0, mode="nearest")
    gap, _ = KDTree(stands.places_m).query(smooth)
    return np.where((gap < STEP_M)[:, None], smooth, way_m)


def plan_trajectory(
    room: Room, scene: VoxelScene, camera: Camera, frames: int, rng: np.random.Generator
) -> np.ndarray:
    """Plan the camera poses of a tour as ``camera_to_room``, float64 [frames, 4, 4].

    Args:
        room: The room or house.
        scene: The result of ``prepare_voxels`` for the labels of the room.
        camera: The camera, whose field of view is used.
        frames: Number of frames, spread evenly over the duration of the tour.
        rng: Random generator for the entrance door, the eye height and the camera shake.
    """
    walk = plan_walk(room, frames, rng)
    planner = ViewPlanner(scene, camera, walk.pace_m)
    poses = np.empty((frames, 4, 4))
    for n, eye_m in enumerate(camera_positions_m(walk.feet_m, rng)):
        yaw, pitch = planner.next_direction(eye_m)
        yaw += rng.uniform(-YAW_SPREAD, YAW_SPREAD)
        pitch += rng.uniform(-PITCH_SPREAD, PITCH_SPREAD)
        ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
        poses[n] = look_at(eye_m, eye_m + np.array(ahead))
    return poses


def camera_positions_m(feet_m: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the camera positions above the feet in metres, float64 [F, 3]."""
    waves = rng.uniform(0, 2 * np.pi) + np.linspace(0, 4 * np.pi, len(feet_m))
    height = np.clip(rng.uniform(*EYE_M) + SWAY_M * np.sin(waves), *EYE_M)
    aside = rng.uniform(-ASIDE_M, ASIDE_M, (len(feet_m), 2))
    return feet_m + np.column_stack([aside, height])
