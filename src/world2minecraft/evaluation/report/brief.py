"""The report of a run without photos: a plan's, or several rooms joined.

There is no evidence to compare with, so it shows what was built, what is in it, and how it came
about. ``report.html``, ``report.json`` and ``preview.png`` are written, as of any run.
"""

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from world2minecraft import __version__
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.files import write_bytes, write_json, write_text
from world2minecraft.core.types import BlockVolume, Layout, Placement, Scan
from world2minecraft.evaluation.report.comparison_pictures import as_data_uri, as_png
from world2minecraft.evaluation.report.scene import read_built
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.objects import read_placements
from world2minecraft.rendering.preview import plan_view, preview

PLAN_PX = 720


def write_brief_report(
    folder: Path, scan: Scan, links: Sequence[tuple[str, str]] = ()
) -> dict[str, Any]:
    """Write ``report.html``, ``report.json`` and ``preview.png`` of a run without photos.

    Args:
        folder: the run's folder, built.
        scan: what is told of it: source, name, size and notes.
        links: names and addresses of further reports, such as each room's own.

    Returns:
        What ``report.json`` holds.
    """
    volume = read_built(folder / "build")
    rooms = read_layouts(folder / "layout.json")
    facts = _facts(scan, volume, rooms, read_placements(folder / "placements.json"))
    across = max(volume.states.shape[0], volume.states.shape[2])
    outside = preview(volume)
    plan = plan_view(volume, px_per_block=max(PLAN_PX // across, 2))
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    source = (
        files("world2minecraft.evaluation.report").joinpath("brief.html.jinja").read_text("utf-8")
    )
    page = environment.from_string(source).render(
        facts=facts,
        links=list(links),
        version=__version__,
        outside=as_data_uri(outside),
        plan=as_data_uri(plan, lossless=True),
    )
    write_bytes(folder / "preview.png", as_png(outside))
    write_json(folder / "report.json", facts)
    write_text(folder / "report.html", page)
    return facts


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
                "floor_m2": round(_area_m2(room.floor_polygon_m), 2),
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


def _area_m2(polygon: np.ndarray) -> float:
    x, y = polygon[:, 0], polygon[:, 1]
    return float(abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2)
