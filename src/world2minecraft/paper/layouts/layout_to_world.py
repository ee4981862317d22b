"""Building of a Minecraft world from a layout, without correcting its errors.

Each object is built with the design for its name, within its box, rotated to the nearest quarter
turn. Parts inside or beyond a wall are cut off, except that a box that extends less than 16 cm into
a wall is moved out of it. If two objects overlap, the larger one wins. Errors of the layout thus
remain visible as far as blocks permit. Scores are computed from the boxes, never from the blocks.
"""

import hashlib
import json
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import read_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Layout, LayoutObject, Opening
from world2minecraft.evaluation.report import write_brief_report
from world2minecraft.formats.roomplan import CapturedPlan, PlanObject, PlanRoom, PlanSurface
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.paper.layouts.compared_scene import SCENE_FILE, ComparedScene, write_scene
from world2minecraft.paper.layouts.furniture_lookup import design_of
from world2minecraft.reconstruction.floorplans import PlanWorld, build_captured
from world2minecraft.reconstruction.parameters import Parameters

PLACE = "layout of"


def build_scene(
    scene: ComparedScene,
    out: Path,
    parameters: Parameters | None = None,
    progress: Progress = no_progress,
) -> PlanWorld:
    """Build the world of a layout into a run folder, with a brief report and the boxes.

    Args:
        scene: The layout. Its boxes are written to ``compared.json`` beside the world.
        out: The output folder.
        parameters: The parameters, of which cell size, scale, style and palette are used.
        progress: Called at each step.

    Raises:
        UsageError: If the scene is a run, which already has a world, or is too large.
        OutputError: If the folder cannot be written.
    """
    plan = plan_of(scene)
    write_scene(out / SCENE_FILE, scene)
    text = json.dumps(read_json(out / SCENE_FILE), sort_keys=True)
    source = {"layout": hashlib.sha256(text.encode()).hexdigest(), "method": scene.method}
    built = build_captured(
        plan, out, parameters or Parameters(), source, progress=progress,
        name=f"{PLACE} {scene.method}", as_told=True,
    )  # fmt: skip
    progress("report", 0, 1)
    write_brief_report(out, built.scan)
    progress("report", 1, 1)
    return built


def plan_of(scene: ComparedScene) -> CapturedPlan:
    """Convert a layout to a floor plan whose objects have furniture designs.

    Raises:
        UsageError: If the scene is a finished run.
    """
    boxes = [item for item in scene.objects if isinstance(item, LayoutObject)]
    if len(boxes) < len(scene.objects):
        raise UsageError(
            f"{scene.name} is a finished run that already has a world; render it with w2m render"
        )
    owners = [_room_of(item, scene.rooms) for item in boxes]
    rooms = []
    for number, room in enumerate(scene.rooms):
        own = [item for item, owner in zip(boxes, owners, strict=True) if owner == number]
        rooms.append(_plan_room(room, own, number))
    return CapturedPlan(tuple(rooms), tuple(f"skipped: {line}" for line in scene.skipped))


def _room_of(item: LayoutObject, rooms: tuple[Layout, ...]) -> int:
    """Return the index of the room that contains an object, or 0 if there is none."""
    for number, room in enumerate(rooms):
        in_height = -0.1 <= item.center_m[2] - room.floor_z_m <= room.wall_height_m + 0.1
        if in_height and inside_polygon(item.center_m[None, :2], room.floor_polygon_m, 0.1)[0]:
            return number
    return 0


def _plan_room(room: Layout, objects: list[LayoutObject], number: int) -> PlanRoom:
    corners, low = room.floor_polygon_m, room.floor_z_m
    walls = tuple(
        PlanSurface("wall", start, end, low, low + room.wall_height_m)
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    )
    floor = np.column_stack([corners, np.full(len(corners), low)])
    return PlanRoom(
        room.name or f"room {number + 1}",
        walls,
        tuple(_plan_opening(one, low) for one in room.openings),
        tuple(_plan_object(item, low) for item in objects),
        (floor,),
    )


def _plan_opening(opening: Opening, floor_z_m: float) -> PlanSurface:
    bottom, top = floor_z_m + opening.sill_m, floor_z_m + opening.head_m
    return PlanSurface(opening.kind, opening.start_m, opening.end_m, bottom, top)


def _plan_object(item: LayoutObject, floor_z_m: float) -> PlanObject:
    found = design_of(item, floor_z_m)
    return PlanObject(
        found.category, item.center_m, item.size_m, item.yaw_deg, design=found.template
    )
