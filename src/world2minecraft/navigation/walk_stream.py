"""Streams: sequences of poses of a walker, planned or imported from recordings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.types import Stance
from world2minecraft.rendering.views.pose_file import TourPose


@dataclass(frozen=True)
class StreamFrame:
    """A pose of a walk at a time, optionally with an image.

    Attributes:
        t_s: The time in seconds.
        stance: The position and viewing direction.
        scene_id: The ID of the scene, or "".
        tour_id: The ID of the tour, or "".
        image: The path of the image, or "".
    """

    t_s: float
    stance: Stance
    scene_id: str = ""
    tour_id: str = ""
    image: str = ""


def frame_of_pose(one: TourPose, eye: float) -> StreamFrame:
    """Convert a pose of a tour file to a frame, given the eye height in blocks."""
    pose = one.pose
    down = eye if pose.at == "eye" else 0.0
    stance = Stance(pose.x, pose.y - down, pose.z, pose.yaw_deg, pose.pitch_deg)
    return StreamFrame(one.t_s, stance, one.scene_id, one.tour_id, one.image)


def assign_even_times(frames: Sequence[StreamFrame], every_s: float) -> list[StreamFrame]:
    """Return the frames with times ``every_s`` seconds apart, for files without times."""
    return [replace(frame, t_s=number * every_s) for number, frame in enumerate(frames)]


def feet_m(frames: Sequence[StreamFrame], blocks_per_metre: float) -> np.ndarray:
    """Return the positions of the feet in metres along the block axes, as float64 [N, 3]."""
    return np.array([frame.stance.feet for frame in frames]).reshape(-1, 3) / blocks_per_metre


def wrap_deg(angle_deg: np.ndarray | float) -> np.ndarray:
    """Normalise angles to [-180, 180) degrees.

    Example:
        >>> wrap_deg(np.array([190.0, -180.0, 540.0])).tolist()
        [-170.0, -180.0, -180.0]
    """
    return (np.asarray(angle_deg, float) + 180.0) % 360.0 - 180.0
