"""A stream: where a walker was, frame after frame; planned by us or imported from the game."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.types import Stance
from world2minecraft.rendering.views.pose_file import TourPose


@dataclass(frozen=True)
class StreamFrame:
    """One look of a walk: when, where the feet were, and the picture where there is one."""

    t_s: float
    stance: Stance
    scene_id: str = ""
    tour_id: str = ""
    image: str = ""


def frame_of_pose(one: TourPose, eye: float) -> StreamFrame:
    """Return a line of a tour file as a frame; ``eye`` is its height over the feet, blocks."""
    pose = one.pose
    down = eye if pose.at == "eye" else 0.0
    stance = Stance(pose.x, pose.y - down, pose.z, pose.yaw_deg, pose.pitch_deg)
    return StreamFrame(one.t_s, stance, one.scene_id, one.tour_id, one.image)


def assign_even_times(frames: Sequence[StreamFrame], every_s: float) -> list[StreamFrame]:
    """Return the frames with times ``every_s`` apart: of files that say the order alone."""
    return [replace(frame, t_s=number * every_s) for number, frame in enumerate(frames)]


def feet_m(frames: Sequence[StreamFrame], blocks_per_metre: float) -> np.ndarray:
    """Return where the feet were in metres along the block axes, float64 [N, 3]."""
    return np.array([frame.stance.feet for frame in frames]).reshape(-1, 3) / blocks_per_metre


def wrap_deg(angle_deg: np.ndarray | float) -> np.ndarray:
    """Return angles from -180 up to 180.

    Example:
        >>> wrap_deg(np.array([190.0, -180.0, 540.0])).tolist()
        [-170.0, -180.0, -180.0]
    """
    return (np.asarray(angle_deg, float) + 180.0) % 360.0 - 180.0
