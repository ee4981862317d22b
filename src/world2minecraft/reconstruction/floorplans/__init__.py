"""Plans of rooms that an app has measured: Apple's RoomPlan, as a world or beside a scan.

``build_plan`` makes a world of a plan alone. ``align_plan`` finds where a plan lies in a scan;
``plan_votes`` then lets it say what the scan's cells are, and ``merge_plan_openings`` adds doors
and windows that were not seen. ``find_roomplan`` tells whether a path holds a plan.
"""

from world2minecraft.formats.roomplan import find_roomplan, read_roomplan
from world2minecraft.reconstruction.floorplans.plan_alignment import (
    AlignedPlan,
    PlanMismatchError,
    align_plan,
)
from world2minecraft.reconstruction.floorplans.plan_run import PlanWorld, build_captured, build_plan
from world2minecraft.reconstruction.floorplans.plan_votes import (
    add_plan_openings,
    add_plan_votes,
    merge_plan_openings,
    plan_votes,
)
from world2minecraft.reconstruction.floorplans.room_outlines import layouts_of, straighten_plan

__all__ = [
    "AlignedPlan",
    "PlanMismatchError",
    "PlanWorld",
    "add_plan_openings",
    "add_plan_votes",
    "align_plan",
    "build_captured",
    "build_plan",
    "find_roomplan",
    "layouts_of",
    "merge_plan_openings",
    "plan_votes",
    "read_roomplan",
    "straighten_plan",
]
