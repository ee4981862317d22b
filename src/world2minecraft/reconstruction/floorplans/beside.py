"""A plan beside a scan, from file to file: its votes after fusion, its openings after labelling."""

from pathlib import Path

from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import FusedEvidence
from world2minecraft.formats.evidence import read_evidence
from world2minecraft.formats.layout import read_layouts, write_layouts
from world2minecraft.formats.roomplan import read_roomplan
from world2minecraft.reconstruction.floorplans.plan_to_scan import (
    LaidPlan,
    PlanMismatchError,
    laid_plan,
)
from world2minecraft.reconstruction.floorplans.room_outlines import layouts_of
from world2minecraft.reconstruction.floorplans.votes import plan_votes, with_plan_openings


def voted_by_plan(evidence: FusedEvidence, plan: Path) -> tuple[FusedEvidence, tuple[str, ...]]:
    """Return evidence with a plan's votes, and sentences on where the plan was laid.

    Raises:
        InputError: the file is no plan. CaptureError: the plan is of another room.
    """
    laid = _laid(plan, evidence)
    return plan_votes(evidence, laid.plan), (laid.told,)


def add_plan_openings(folder: Path, plan: Path) -> None:
    """Add doors and windows that only the plan knows to ``layout.json`` of a run."""
    laid = _laid(plan, read_evidence(folder / "evidence.npz"))
    layouts = with_plan_openings(read_layouts(folder / "layout.json"), layouts_of(laid.plan))
    write_layouts(folder / "layout.json", layouts)


def _laid(plan: Path, evidence: FusedEvidence) -> LaidPlan:
    try:
        return laid_plan(read_roomplan(plan), evidence)
    except PlanMismatchError as error:
        raise CaptureError(plan, str(error)) from error
