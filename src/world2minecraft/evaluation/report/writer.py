"""Writing of a run's report: ``report.html``, ``report.json`` and its images.

``write_report`` compares the world with the photos. Runs without photos, made from a floor plan or
from several rooms, have no evidence for a comparison. ``write_brief_report`` shows their build,
their contents and their sources.
"""

from collections.abc import Sequence
from dataclasses import asdict
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from world2minecraft import __version__
from world2minecraft.core.classes import CLASS_COLOURS, CLASS_DISPLAY_NAMES, CLASS_NAMES
from world2minecraft.core.files import write_bytes, write_json, write_text
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume, Layout, Placement, Scan
from world2minecraft.core.vocabulary import object_title, read_vocabulary
from world2minecraft.evaluation.report.comparison_pictures import (
    Pair,
    as_data_uri,
    as_png,
    make_pairs,
)
from world2minecraft.evaluation.report.finished_run import read_built, read_finished
from world2minecraft.evaluation.report.measures import built_categories, scene_facts
from world2minecraft.evaluation.report.photo_section import (
    Crop,
    agreement_facts,
    compare_with_photos,
    crop_objects,
    worst_first,
)
from world2minecraft.evaluation.report.room_view import named_box, room_view
from world2minecraft.evaluation.report.truth_picture import truth_picture
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.objects_and_placements import read_placements
from world2minecraft.formats.scan_record import read_registration
from world2minecraft.furniture.footprints import area_m2
from world2minecraft.furniture.layout_checks import category_integrity
from world2minecraft.reconstruction.repair_run import read_repairs
from world2minecraft.rendering.preview import plan_view, preview_view, render_preview
from world2minecraft.rendering.scene import prepare_scene

PLAN_PX = 720
NAMES = dict(zip(CLASS_NAMES, CLASS_DISPLAY_NAMES, strict=True)) | {"unknown": "unknown"}


def write_brief_report(
    folder: Path, scan: Scan, links: Sequence[tuple[str, str]] = ()
) -> dict[str, Any]:
    """Write ``report.html``, ``report.json`` and ``preview.png`` for a run without photos.

    Args:
        folder: The folder of the finished run.
        scan: The source, name, size and notes of the run.
        links: The names and addresses of further reports, such as those of single rooms.

    Returns:
        The content of ``report.json``.
    """
    volume = read_built(folder / "build")
    rooms = read_layouts(folder / "layout.json")
    placed = read_placements(folder / "placements.json")
    facts = _facts(scan, volume, rooms, placed)
    view = preview_view(volume)
    outside = render_preview(view)
    things = [
        named_box(
            one.object_id, _placed_title(one), one.center_m, one.size_m, 90 * one.quarter_turns
        )
        for one in placed
    ]
    page = _render(
        "brief.html.jinja",
        facts=facts,
        names=NAMES,
        links=list(links),
        version=__version__,
        outside=as_data_uri(outside),
        plan=as_data_uri(_plan(volume), lossless=True),
        room=room_view(volume, scan.room_size_m, things, view.camera_to_room),
    )
    write_bytes(folder / "preview.png", as_png(outside))
    write_json(folder / "report.json", facts)
    write_text(folder / "report.html", page)
    return facts


def _plan(volume: BlockVolume) -> np.ndarray:
    """Return the floor plan of a build, about ``PLAN_PX`` pixels wide, uint8 [H, W, 3]."""
    across = max(volume.states.shape[0], volume.states.shape[2])
    return plan_view(volume, px_per_block=max(PLAN_PX // across, 2))


def _render(template: str, **values: Any) -> str:
    """Return the page of a template of this package with the given values."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    source = files("world2minecraft.evaluation.report").joinpath(template).read_text("utf-8")
    return environment.from_string(source).render(**values)


def _placed_title(one: Placement) -> str:
    """Return what a piece of furniture shows, or its class."""
    entry = read_vocabulary().of_template(one.template)
    return entry.name if entry is not None else CLASS_DISPLAY_NAMES[one.class_id]


def _facts(
    scan: Scan, volume: BlockVolume, rooms: tuple[Layout, ...], placed: tuple[Placement, ...]
) -> dict[str, Any]:
    return {
        "name": scan.name,
        "source": scan.source,
        "room_size_m": [round(float(side), 3) for side in scan.room_size_m],
        "notes": list(scan.notes),
        "rooms": [
            {
                "name": room.name,
                "floor_m2": round(area_m2(room.floor_polygon_m), 2),
                "height_m": round(float(room.wall_height_m), 3),
                "openings": len(room.openings),
            }
            for room in rooms
        ],
        "objects": [
            {
                "id": one.object_id,
                "class": CLASS_NAMES[one.class_id],
                "template": one.template,
                "size_m": [round(float(side), 3) for side in one.size_m],
            }
            for one in placed
        ],
        "blocks": int((volume.semantic > 0).sum()),
        "blocks_per_metre": volume.blocks_per_metre,
    }


def write_report(
    folder: Path, scan: Scan, *, truth: Path | None = None, progress: Progress = no_progress
) -> dict[str, Any]:
    """Write ``report.html``, ``report.json`` and ``preview.png`` for a finished run.

    Args:
        folder: The folder of the run.
        scan: The scan of the run. Up to twelve views are compared with the world, and six shown.
        truth: The folder of a capture with ``truth.npz`` to score against. None skips the scores.
        progress: Called at each step.

    Returns:
        The content of ``report.json``.
    """
    scene = read_finished(folder)
    progress("report", 0, 3, "measurements")
    facts = scene_facts(scene) | {"scan": _scan_facts(scan, folder)}
    if truth is not None:
        facts["truth"] = evaluate_reconstruction(folder, truth)
        facts["layout"]["semantic_integrity"]["true_categories"] = round(
            category_integrity(
                built_categories(scene), {one.class_id for one in read_truth(truth).objects}
            ),
            4,
        )
    progress("report", 1, 3, "images")
    drawn = prepare_scene(scene.volume)
    pairs = make_pairs(scan, drawn)
    agreement, samples = compare_with_photos(scene, scan, drawn)
    facts = {"photo_agreement": agreement_facts(agreement, samples)} | facts
    facts["repairs"] = read_repairs(folder)
    crops = [] if agreement is None else crop_objects(agreement, samples, drawn)
    facts["views"] = [
        {"view": p.name, "depth_error_m": p.depth_error_m, "depth_agrees": p.depth_agrees}
        for p in pairs
    ]
    plan = _plan(scene.volume)
    view = preview_view(scene.volume)
    outside = render_preview(view)
    true = None if truth is None else truth_picture(folder, truth, view)
    progress("report", 2, 3, "page")
    write_bytes(folder / "preview.png", as_png(outside))
    write_json(folder / "report.json", facts)
    things = [
        named_box(
            one.id, object_title(one.name, one.class_id), one.center_m, one.size_m, one.yaw_deg
        )
        for one in scene.instances
    ]
    room = room_view(scene.volume, scene.room_size_m, things, view.camera_to_room)
    write_text(folder / "report.html", _page(facts, pairs, crops, outside, true, plan, room))
    progress("report", 3, 3)
    return facts


def _scan_facts(scan: Scan, folder: Path) -> dict[str, Any]:
    return {
        "source": scan.source,
        "frames_used": len(scan.frames_used),
        "frames_skipped": [{"frame": n, "reason": r} for n, r in scan.frames_skipped],
        "scale": scan.scale,
        "scale_sigma": scan.scale_sigma,
        "frame_sigmas": None if scan.frame_sigmas is None else asdict(scan.frame_sigmas),
        "notes": list(scan.notes),
        "registration": read_registration(folder / "scan.json"),
    }


def _page(
    facts: dict[str, Any],
    pairs: list[Pair],
    crops: list[Crop],
    outside: np.ndarray,
    true: np.ndarray | None,
    plan: np.ndarray,
    room: str | None,
) -> str:
    return _render(
        "page.html.jinja",
        facts=facts,
        names=NAMES,
        version=__version__,
        outside=as_data_uri(outside),
        true_room=None if true is None else as_data_uri(true),
        plan=as_data_uri(plan, lossless=True),
        room=room,
        agreeing=[pair.depth_agrees for pair in pairs if pair.depth_agrees is not None],
        pairs=[
            {
                "name": pair.name,
                "photo": as_data_uri(pair.photo),
                "built": as_data_uri(pair.built),
                "error_m": pair.depth_error_m,
                "agrees": pair.depth_agrees,
            }
            for pair in pairs
            if pair.photo is not None
        ],
        compared=worst_first(facts["photo_agreement"].get("objects", ())),
        crops={
            crop.object_id: (as_data_uri(crop.photo), as_data_uri(crop.built)) for crop in crops
        },
        called={row["id"]: row.get("name") or NAMES[row["class"]] for row in facts["objects"]},
        known={row["id"]: row for row in facts["objects"]},
        colours={
            name: "#{:02x}{:02x}{:02x}".format(*colour)
            for name, colour in zip(CLASS_NAMES, CLASS_COLOURS, strict=True)
        },
    )
