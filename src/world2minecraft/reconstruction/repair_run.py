"""Repair by rendering on the files of a run: ``placements.json`` -> ``placements.json``.

What was exchanged is listed in ``repairs.json``. Worlds are built with the default settings and at
the default scale, so that furniture does not depend on settings of the later build stage.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from world2minecraft.construction import build_volume
from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume, ObjectInstance, Placement, Scan
from world2minecraft.core.vocabulary import object_title
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import (
    read_objects,
    read_placements,
    write_placements,
)
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.reconstruction.file_stages import corner_m
from world2minecraft.reconstruction.naming.name_votes import NAME_VOTES, read_name_votes
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.repair.exchange import Change, Repaired, repair_placements
from world2minecraft.reconstruction.retrieval.other_furniture import OtherFurniture
from world2minecraft.reconstruction.verification.photo_samples import (
    MAX_SAMPLES,
    PhotoSample,
    evenly_spread,
    sample_photos,
)

REPAIRS = "repairs.json"
MIN_OTHERS = 4  # Frames beside those of the report from which repair does without the latter.


def repair_run(
    folder: Path, scan: Scan, chosen: Parameters, progress: Progress = no_progress
) -> None:
    """Exchange furniture of a run that compares badly with its photos.

    Nothing happens without photos that have depth, and without objects.

    Args:
        folder: Folder of the run, after the furnish stage.
        scan: Registered scan of the run.
        chosen: Parameters of the run.
        progress: Callback for progress.
    """
    (folder / REPAIRS).unlink(missing_ok=True)
    grid, _ = read_room(folder / "room.npz")
    instances = read_objects(folder / "objects.json", grid)
    if not chosen.repair.enabled or not instances:
        return
    progress("repair", 0, 1)
    samples = photos_for_repair(folder, scan, chosen.repair.max_views)
    if not any((sample.depth_m > 0).any() for sample in samples):
        progress("repair", 1, 1, "no photo with depth")
        return
    rooms, corner = read_rooms(folder, grid), corner_m(folder, grid)

    def build(placements: Sequence[Placement]) -> BlockVolume:
        return build_volume(grid, placements, instances, corner_m=corner, rooms=rooms)

    repaired = repair_placements(
        samples,
        grid,
        instances,
        read_placements(folder / "placements.json"),
        build,
        OtherFurniture(grid, rooms, chosen.furnish),
        chosen.repair,
    )
    write_placements(folder / "placements.json", repaired.placements)
    write_json(folder / REPAIRS, repair_facts(repaired, instances, len(samples)))
    progress("repair", 1, 1, _note(repaired))


def photos_for_repair(folder: Path, scan: Scan, count: int) -> tuple[PhotoSample, ...]:
    """Return samples of frames that the report does not use, or of all if there are few others."""
    reported = set(evenly_spread(scan.frames_used, MAX_SAMPLES))
    others = set(scan.frames_used) - reported
    path = folder / NAME_VOTES
    votes = read_name_votes(path) if path.is_file() else None
    without = reported if len(others) >= MIN_OTHERS else ()
    return sample_photos(scan, votes, count=count, without=without)


def repair_facts(
    repaired: Repaired, instances: Sequence[ObjectInstance], views: int
) -> dict[str, Any]:
    """Return the content of ``repairs.json``."""
    titles = {one.id: object_title(one.name, one.class_id) for one in instances}
    return {
        "views": views,
        "tried": repaired.tried,
        "headline_before": round(repaired.headline[0], 4),
        "headline_after": round(repaired.headline[1], 4),
        "changes": [_row(change, titles[change.object_id]) for change in repaired.changes],
    }


def read_repairs(folder: Path) -> dict[str, Any] | None:
    """Return the content of ``repairs.json``, or None if no furniture was compared.

    Raises:
        DamagedFileError: If the file is not such a list.
    """
    path = folder / REPAIRS
    if not path.is_file():
        return None
    stated = read_json(path)
    try:
        shares = {name: float(stated[f"headline_{name}"]) for name in ("before", "after")}
        return {
            "views": int(stated["views"]),
            "tried": int(stated["tried"]),
            **{f"headline_{name}": share for name, share in shares.items()},
            "changes": [_checked_row(row) for row in stated["changes"]],
        }
    except MALFORMED as error:
        raise DamagedFileError(path, f"not a list of repairs ({error!r})") from error


def _checked_row(row: Any) -> dict[str, Any]:
    figures = [f"{what}_{when}" for what in ("agreement", "iou") for when in ("before", "after")]
    furniture = {
        when: [
            {"template": str(one["template"]), "quarter_turns": int(one["quarter_turns"])}
            for one in row[when]
        ]
        for when in ("before", "after")
    }
    return {
        "id": int(row["id"]),
        "name": str(row["name"]),
        **furniture,
        **{name: float(row[name]) for name in figures},
    }


def _row(change: Change, title: str) -> dict[str, Any]:
    return {
        "id": change.object_id,
        "name": title,
        "before": _furniture(change.before),
        "after": _furniture(change.after),
        "agreement_before": round(change.agreement[0], 4),
        "agreement_after": round(change.agreement[1], 4),
        "iou_before": round(change.iou[0], 4),
        "iou_after": round(change.iou[1], 4),
    }


def _furniture(placed: Sequence[Placement]) -> list[dict[str, Any]]:
    return [{"template": one.template, "quarter_turns": one.quarter_turns} for one in placed]


def _note(repaired: Repaired) -> str:
    before, after = repaired.headline
    return (
        f"{len(repaired.changes)} of {repaired.tried} objects exchanged, headline {before:.0%} to "
        f"{after:.0%}"
    )
