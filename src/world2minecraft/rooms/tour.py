"""Where a person with a camera stands and looks: a walk around the free floor.

The walk goes once around the room, near the edge of the free floor, so that one looks across. At
each stop the camera turns to what was seen least so far; a turn costs a little, so that the
pictures follow each other like a film.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.coordinates import look_at
from world2minecraft.geometry.parts import connected_parts
from world2minecraft.render import cast_voxels
from world2minecraft.render.scene import RayScene
from world2minecraft.rooms.room import Room
from world2minecraft.types import Camera

EYE_M = (1.2, 1.7)
BODY_M = 0.28
FLOOR_STEP_M = 0.1
SCOUT_PX = (32, 24)
YAWS = 14
PITCHES_DEG = (16.0, -8.0, -28.0, -46.0)
TURN_COST = 0.35  # What a turn by 180 degrees takes from the worth of a look.
PATCH = 4  # Voxels a side of the patches that are counted as seen.
USEFUL_M = (0.5, 4.2)  # Where the rgbd sensor is good.
SEEN_AGAIN = np.array([1.0, 0.6, 0.35, 0.15, 0.05])  # What one more look at a patch is worth.


def free_floor(room: Room) -> np.ndarray:
    """Return bool [X, Y] in squares of 10 cm: where a person may stand, in one piece."""
    step = round(FLOOR_STEP_M / room.voxel_m)
    low = round((0.1 - room.origin_m[2]) / room.voxel_m)
    high = round((1.9 - room.origin_m[2]) / room.voxel_m)
    taken = (room.labels[:, :, low:high] != 0).any(axis=2)
    body = round(BODY_M / room.voxel_m)
    distance = np.zeros(taken.shape)
    ndimage.distance_transform_edt(~taken, distances=distance)
    nx, ny = (side // step * step for side in taken.shape)
    inner = distance[:nx, :ny]
    free = inner[step // 2 :: step, step // 2 :: step] > body
    parts, _ = connected_parts(free, corners=False)
    if not free.any():
        return free
    return parts == 1 + np.argmax(np.bincount(parts.reshape(-1))[1:])


def plan_tour(
    room: Room, scene: RayScene, camera: Camera, frames: int, rng: np.random.Generator
) -> np.ndarray:
    """Return the poses of a tour, float64 [frames, 4, 4], ``camera_to_room``.

    Args:
        room: the room.
        scene: ``prepare_voxels`` of its labels.
        camera: whose field of view counts.
        frames: how many.
        rng: draws where the walk begins and the heights of the eye.
    """
    stops = _walk(room, frames, rng)
    scout = _scout(camera)
    seen = np.zeros(int(np.prod([side // PATCH + 1 for side in room.labels.shape])), np.int64)
    poses, yaw = [], None
    for stop in stops:
        best, worth = None, -1.0
        for turn in range(YAWS):
            angle = 2 * np.pi * turn / YAWS
            off = 0.0 if yaw is None else abs((angle - yaw + np.pi) % (2 * np.pi) - np.pi) / np.pi
            for pitch in np.radians(PITCHES_DEG):
                pose = _pose(stop, angle, pitch)
                patches = _patches(room, scene, scout, pose)
                gain = SEEN_AGAIN[np.minimum(seen[patches], 4)].sum() * (1 - TURN_COST * off)
                if gain > worth:
                    best, worth = (angle, pitch, patches), gain
        if best is None:
            continue
        yaw = best[0] + rng.uniform(-0.06, 0.06)
        seen[best[2]] += 1
        poses.append(_pose(stop, yaw, best[1] + rng.uniform(-0.04, 0.04)))
    return np.array(poses)


def _walk(room: Room, frames: int, rng: np.random.Generator) -> np.ndarray:
    """Return the places of the eye, float64 [frames, 3], around the free floor."""
    free = np.argwhere(free_floor(room))
    if not len(free):
        free = np.array(room.labels.shape[:2])[None] // 2 // round(FLOOR_STEP_M / room.voxel_m)
    places = (free + 0.5) * FLOOR_STEP_M + room.origin_m[:2]
    middle = places.mean(axis=0)
    around = places - middle
    angle = np.arctan2(around[:, 1], around[:, 0])
    radius = np.hypot(around[:, 0], around[:, 1])
    start = rng.uniform(0, 2 * np.pi)
    stops = []
    for n in range(frames):
        aim = start + 2 * np.pi * n / frames
        off = np.abs((angle - aim + np.pi) % (2 * np.pi) - np.pi)
        # Every other stop is nearer to the middle: low furniture is seen from above there.
        reach = 1.0 if n % 3 else 0.45
        stops.append(places[np.argmax(reach * radius - 1.6 * off * np.maximum(radius, 0.3))])
    # Where the free floor is no ring, the walk begins behind its gap: nobody steps over a bed.
    ahead = np.linalg.norm(np.roll(stops, -1, axis=0) - np.array(stops), axis=1)
    stops = np.roll(stops, -1 - int(ahead.argmax()), axis=0)
    height = rng.uniform(*EYE_M) + 0.22 * np.sin(np.linspace(0, 4 * np.pi, frames))
    height = np.clip(height, *EYE_M)
    smooth = ndimage.uniform_filter1d(stops, 3, axis=0, mode="nearest")
    return np.column_stack([_nearest(smooth, places), height])


def _nearest(wanted: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Move each wanted spot that is not free to the nearest free place."""
    gap = np.linalg.norm(wanted[:, None] - places[None], axis=2)
    near = places[gap.argmin(axis=1)]
    return np.where((gap.min(axis=1) < FLOOR_STEP_M)[:, None], wanted, near)


def _scout(camera: Camera) -> Camera:
    across, down = SCOUT_PX[0] / camera.width_px, SCOUT_PX[1] / camera.height_px
    return Camera(
        *SCOUT_PX,
        camera.fx_px * across,
        camera.fy_px * down,
        camera.cx_px * across,
        camera.cy_px * down,
    )


def _pose(eye_m: np.ndarray, yaw: float, pitch: float) -> np.ndarray:
    ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
    return look_at(eye_m, eye_m + np.array(ahead))


def _patches(room: Room, scene: RayScene, scout: Camera, pose: np.ndarray) -> np.ndarray:
    """Return the patches of surface that a look shows at a useful distance, each once."""
    hits = cast_voxels(scene, scout, pose)
    near, far = USEFUL_M
    index = hits.voxel_index[(hits.depth_m > near) & (hits.depth_m < far)]
    cells = np.unravel_index(index, room.labels.shape)
    shape = [side // PATCH + 1 for side in room.labels.shape]
    return np.unique(np.ravel_multi_index([axis // PATCH for axis in cells], shape))
