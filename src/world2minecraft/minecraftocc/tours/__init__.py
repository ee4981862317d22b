"""Tours: smooth walks through the rooms of a world, and the selection of useful views on them."""

from world2minecraft.minecraftocc.tours.planning import plan_views
from world2minecraft.minecraftocc.tours.pose_files import read_views, view_line, write_views
from world2minecraft.minecraftocc.tours.rooms import find_layouts
from world2minecraft.minecraftocc.tours.types import (
    PlannedView,
    TourRule,
    kind_of_yaw,
    nyu_camera,
    paper_camera,
)

__all__ = [
    "PlannedView",
    "TourRule",
    "find_layouts",
    "kind_of_yaw",
    "nyu_camera",
    "paper_camera",
    "plan_views",
    "read_views",
    "view_line",
    "write_views",
]
