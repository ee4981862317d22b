"""Viewpoints for rendering: cameras, poses in the game's convention, orbits and walks."""

from world2minecraft.rendering.views.cameras import (
    GamePose,
    Shot,
    camera_of,
    game_pose_of,
    vertical_fov_deg_of,
)
from world2minecraft.rendering.views.orbit import orbit_shots
from world2minecraft.rendering.views.pose_file import TourPose, read_tour, tour_line, write_lines
from world2minecraft.rendering.views.walk_through import Tour, plan_tour, with_open_doors

__all__ = [
    "GamePose",
    "Shot",
    "Tour",
    "TourPose",
    "camera_of",
    "game_pose_of",
    "orbit_shots",
    "plan_tour",
    "read_tour",
    "tour_line",
    "vertical_fov_deg_of",
    "with_open_doors",
    "write_lines",
]
