"""Floor plans measured by an app (Apple's RoomPlan), used alone or together with a scan.

``build_plan`` builds a world from a plan alone. ``align_plan`` finds the position of a plan in a
scan; ``plan_votes`` then adds its labels as votes for the scan's cells, and
``merge_plan_openings`` adds doors and windows that were not seen. ``find_roomplan`` finds the plan
file of a path.
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
