"""Which pictures of a world are taken: smooth walks through its rooms, and views worth having."""

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
    "kind_of_yaw",
    "find_layouts",
    "nyu_camera",
    "paper_camera",
    "plan_views",
    "read_views",
    "view_line",
    "write_views",
]
