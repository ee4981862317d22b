"""The poses of a scan: a person walks through all rooms and looks around as one does who scans.

``walk`` says where the feet are, ``gaze`` where the camera looks; here the two are put together.
"""

import numpy as np

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.view_planning import Gaze
from world2minecraft.procgen.sensors.walk import plan_walk
from world2minecraft.rendering.voxel_camera import VoxelScene

EYE_M = (1.2, 1.7)  # Of the camera over the floor.
SWAY_M = 0.22  # How much the camera rises and sinks along the walk.
ASIDE_M = 0.03  # A hand is never still, least of all where one stays.
YAW_SPREAD, PITCH_SPREAD = np.radians(3.5), np.radians(2.3)


def plan_tour(
    room: Room, scene: VoxelScene, camera: Camera, frames: int, rng: np.random.Generator
) -> np.ndarray:
    """Return the poses of a tour, float64 [frames, 4, 4], ``camera_to_room``.

    Args:
        room: the room or the house.
        scene: ``prepare_voxels`` of its labels.
        camera: whose field of view counts.
        frames: how many; they are spread evenly over the time of the walk.
        rng: draws the door where the walk begins, the height of the eye and the hand's unrest.
    """
    walk = plan_walk(room, frames, rng)
    gaze = Gaze(scene, camera, walk.pace_m)
    poses = np.empty((frames, 4, 4))
    for n, eye_m in enumerate(eyes_m(walk.feet_m, rng)):
        yaw, pitch = gaze.turn(eye_m)
        yaw += rng.uniform(-YAW_SPREAD, YAW_SPREAD)
        pitch += rng.uniform(-PITCH_SPREAD, PITCH_SPREAD)
        ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
        poses[n] = look_at(eye_m, eye_m + np.array(ahead))
    return poses


def eyes_m(feet_m: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return the places of the camera over the feet, float64 [F, 3]."""
    waves = rng.uniform(0, 2 * np.pi) + np.linspace(0, 4 * np.pi, len(feet_m))
    height = np.clip(rng.uniform(*EYE_M) + SWAY_M * np.sin(waves), *EYE_M)
    aside = rng.uniform(-ASIDE_M, ASIDE_M, (len(feet_m), 2))
    return feet_m + np.column_stack([aside, height])
