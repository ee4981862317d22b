"""How a person films a room: the walk of a scan, looked along without jumps.

A depth sensor's pictures may look anywhere, each knows where it is. Photos are matched with each
other, so neighbours must share most of what they see: where to look is decided now and then, and
between two such moments the camera turns evenly.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.tour import eyes_m
from world2minecraft.procgen.sensors.view_planning import Gaze
from world2minecraft.procgen.sensors.walk import plan_walk
from world2minecraft.rendering.voxel_camera import VoxelScene

TURN = np.radians([14.0, 6.0])  # Of yaw and pitch at most, from one photo to the next.
LOOK_TURN = np.radians([56.0, 24.0])  # From one look to the next.
LOOK_PHOTOS = 4  # One decides where to look every fourth photo,
LOOK_PICTURES = 14  # and every fourteenth picture of a video: half a second.
SMOOTH_PICTURES = 3.0  # A hand that films sways, but does not jerk.


@dataclass(frozen=True, eq=False)
class Film:
    """Where the camera is and looks at each of F moments, and evenly in between."""

    eyes_m: np.ndarray  # float64 [F, 3]
    angles: np.ndarray  # float64 [F, 2], yaw (it may exceed a full turn) and pitch in radians

    def pose(self, moment: float) -> np.ndarray:
        """Return ``camera_to_room`` float64 [4, 4]; moments beyond the ends are those of the ends.

        Args:
            moment: 0 is the first, and it need not be a whole number.
        """
        low = int(np.clip(np.floor(moment), 0, max(len(self.eyes_m) - 2, 0)))
        high = min(low + 1, len(self.eyes_m) - 1)
        part = float(np.clip(moment - low, 0, 1))
        eye = (1 - part) * self.eyes_m[low] + part * self.eyes_m[high]
        yaw, pitch = (1 - part) * self.angles[low] + part * self.angles[high]
        ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
        return look_at(eye, eye + np.array(ahead))


def plan_film(
    room: Room,
    scene: VoxelScene,
    camera: Camera,
    pictures: int,
    rng: np.random.Generator,
    *,
    smooth: bool,
) -> Film:
    """Return how a room is filmed in so many pictures.

    Args:
        room: the room or the house.
        scene: ``prepare_voxels`` of its labels.
        camera: whose field of view counts.
        pictures: how many; they are spread evenly over the time of the walk.
        rng: draws the door where the walk begins, and the height of the eye.
        smooth: whether it is a video, without jerks; photos are taken one by one.
    """
    walk = plan_walk(room, pictures, rng)
    eyes = eyes_m(walk.feet_m, rng)
    every = LOOK_PICTURES if smooth else LOOK_PHOTOS
    looks = np.unique(np.append(np.arange(0, pictures, every), pictures - 1))
    gaze = Gaze(scene, camera, walk.pace_m * every, (LOOK_TURN[0], LOOK_TURN[1]))
    seen = np.array([gaze.turn(eyes[n]) for n in looks])
    seen[:, 0] = np.unwrap(seen[:, 0])
    angles = np.column_stack([np.interp(np.arange(pictures), looks, seen[:, n]) for n in (0, 1)])
    if smooth:
        eyes, angles = (
            ndimage.gaussian_filter1d(track, SMOOTH_PICTURES, axis=0, mode="nearest")
            for track in (eyes, angles)
        )
    return Film(eyes, angles)
