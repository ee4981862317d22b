"""Convert a floor plan to a finished run, with the files of a reconstruction, and its world."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft import __version__
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.files import write_json
from world2minecraft.core.output_folders import check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Layout, Scan
from world2minecraft.formats.roomplan import CapturedPlan, read_roomplan
from world2minecraft.reconstruction.file_stages import run_stage
from world2minecraft.reconstruction.floorplans.plan_grid import rasterize_plan
from world2minecraft.reconstruction.floorplans.room_outlines import (
    layouts_of,
    place_plan_rooms,
    straighten_plan,
)
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.retrieval.placement_settling import settle_placements
from world2minecraft.reconstruction.room_files import write_room_files


@dataclass(frozen=True, eq=False)
class PlanWorld:
    """The result of building a plan: its scan without views, its rooms and its object count."""

    scan: Scan
    layouts: tuple[Layout, ...]
    objects: int


def build_plan(
    place: AnyPath,
    out: Path,
    parameters: Parameters | None = None,
    progress: Progress = no_progress,
    name: str = "",
) -> PlanWorld:
    """Build a RoomPlan capture into the folder of a run with its world; no photo is required.

    Args:
        place: The JSON file, as returned by ``find_roomplan``.
        out: Output folder.
        parameters: Parameters; the cell size, scale, style and palette are used.
        progress: Callback for progress.
        name: Name of the scene.

    Raises:
        InputError: If the plan cannot be read.
        OutputError: If ``out`` cannot be written.
    """
    chosen = parameters or Parameters()
    progress("plan", 0, 1)
    plan = straighten_plan(read_roomplan(place))
    source = {"plan": hashlib.sha256(place.read_bytes()).hexdigest()}
    return build_captured(plan, out, chosen, source, progress=progress, name=name)


def build_captured(
    plan: CapturedPlan,
    out: Path,
    parameters: Parameters,
    source: Mapping[str, Any],
    *,
    progress: Progress = no_progress,
    name: str = "",
    as_told: bool = False,
) -> PlanWorld:
    """Build a straightened plan of any source into the folder of a run with its world.

    Args:
        plan: Plan with walls along x and y.
        out: Output folder.
        parameters: Parameters; the cell size, scale, style and palette are used.
        source: Information on the origin of the plan for the manifest.
        progress: Callback for progress.
        name: Name of the scene.
        as_told: Whether overlapping furniture keeps its position and is cut by larger furniture,
            instead of being moved apart.

    Raises:
        UsageError: If the plan is too large for the cell size.
        OutputError: If ``out`` cannot be written.
    """
    progress("plan", 0, 1)
    held = rasterize_plan(plan, parameters.voxel_m)
    layouts = layouts_of(plan)
    if not as_told:
        held = replace(held, placements=settle_placements(held.placements, held.grid, layouts))
    check_writable(out)
    scan = scan_of_plan(plan, name)
    write_room_files(out, scan, held.grid, layouts, held.instances, held.placements)
    manifest = {"program": __version__, "parameters": parameters.as_json(), **source}
    write_json(out / "manifest.json", manifest)
    progress("plan", 1, 1)
    run_stage("build", out, parameters, progress)
    return PlanWorld(scan, layouts, len(held.instances))


def scan_of_plan(plan: CapturedPlan, name: str = "") -> Scan:
    """Return a scan of a plan with its frame and size but without views."""
    rooms = place_plan_rooms(plan)
    high = np.max([room.outline_m.max(axis=0) for room in rooms], axis=0)
    top = max(room.floor_z_m + room.height_m for room in rooms)
    notes = list(plan.notes)
    notes += [
        f"the walls of {room.room.name} do not close; their bounding box is used instead"
        for room in rooms
        if not room.closed
    ]
    return Scan(
        views=(),  # type: ignore[arg-type]
        scan_to_room=np.linalg.inv(plan.plan_to_session),
        room_size_m=np.round(np.array([*high, top]), 6),
        frames_used=(),
        source="roomplan",
        notes=tuple(notes),
        name=name,
    )
