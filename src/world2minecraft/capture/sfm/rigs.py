"""Rigs of photos that share a place, as pycolmap's rigs and frames.

The views of a panorama have one place and known directions to each other, so that only the pose of
the panorama is unknown. Photos without a rig have a rig and a frame of their own.
"""

from typing import Any

import numpy as np

from world2minecraft.capture.sfm.camera_groups import CameraGroup
from world2minecraft.capture.sfm.features import Features
from world2minecraft.core.coordinates import invert_rigid


def places_of(photos: list[Features]) -> list[int]:
    """Return the place number of each photo; each photo without a rig has its own place."""
    numbers: dict[str | int, int] = {}
    keys = (i if photo.rig is None else photo.rig.place for i, photo in enumerate(photos))
    return [numbers.setdefault(key, len(numbers)) for key in keys]


def count_places(photos: list[Features]) -> int:
    """Return the number of rigs of several photos, such as panoramas."""
    return len({photo.rig.place for photo in photos if photo.rig is not None})


def to_rigid(pycolmap: Any, pose: np.ndarray) -> Any:
    """Return the transform to the camera or rig with the given pose, as a pycolmap type."""
    inverse = np.linalg.inv(pose)
    return pycolmap.Rigid3d(pycolmap.Rotation3d(inverse[:3, :3]), inverse[:3, 3])


def rig_pose(photo: Features, camera_to_world: np.ndarray) -> np.ndarray:
    """Return the pose of the rig of a photo, float64 [4, 4]."""
    if photo.rig is None:
        return camera_to_world
    return camera_to_world @ invert_rigid(photo.rig.camera_to_rig)


def make_rigs(
    pycolmap: Any, photos: list[Features], groups: list[CameraGroup], cameras: list[Any]
) -> tuple[list[Any], list[int]]:
    """Return the rigs of the camera groups, and the number of the rig of each photo.

    Args:
        pycolmap: The module.
        photos: Features of all photos.
        groups: Camera groups; each sensor of a rig is a group of its own.
        cameras: The cameras of the groups, as pycolmap types.
    """
    rigs: list[Any] = []
    rig_of_photo = [0] * len(photos)
    shared = None
    order = sorted(range(len(groups)), key=lambda number: _sensor(photos, groups[number]))
    for number in order:
        member = photos[groups[number].photos[0]].rig
        sensor = cameras[number].sensor_id
        if member is not None and shared is not None:
            shared.add_sensor(sensor, to_rigid(pycolmap, member.camera_to_rig))
            rig = shared
        else:
            rig = pycolmap.Rig(rig_id=len(rigs) + 1)
            rig.add_ref_sensor(sensor)
            rigs.append(rig)
            shared = rig if member is not None else shared
        for i in groups[number].photos:
            rig_of_photo[i] = rig.rig_id
    return rigs, rig_of_photo


def _sensor(photos: list[Features], group: CameraGroup) -> int:
    member = photos[group.photos[0]].rig
    return -1 if member is None else member.sensor
