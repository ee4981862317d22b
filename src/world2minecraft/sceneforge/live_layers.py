"""What a reconstruction has found so far, for the live view of the start page.

Each layer is available once its stage is finished, and is a packet of ``rendering.mesh``:

===========  ===========  =====================================================================
layer        after        contents
===========  ===========  =====================================================================
cameras      ``scan``     ``rays`` f4 [N, 6]: positions and viewing directions
points       ``fuse``     ``position`` f4 [N, 3] and ``colour`` u1 [N, 3] of the surface
cells        ``label``    ``position`` f4 [N, 3], ``colour`` u1 [N, 3] and ``label`` u1 [N, 1]
things       ``find``     ``things`` in the header: ``{name, center_m, size_m, yaw_deg}``
blocks       ``build``    the mesh of ``BlockBuild.mesh_bytes``
===========  ===========  =====================================================================

Positions are in metres in the room frame. The walls of cells end at ``WALL_HEIGHT_M``, and
ceilings are omitted, so that a view from above shows the inside.
"""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    UnknownNameError,
)
from world2minecraft.core.files import read_json
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.formats.run_arrays import read_evidence, read_room
from world2minecraft.geometry.morphology import erode_faces
from world2minecraft.rendering.mesh.packets import pack_arrays
from world2minecraft.sceneforge.build_preview import BlockBuild, BuildOptions

MAGIC = b"W2ML"
STAGES = {
    "cameras": "scan",
    "points": "fuse",
    "cells": "label",
    "things": "find",
    "blocks": "build",
}
MAX_POINTS = 60_000
WALL_HEIGHT_M = 1.2


def finished_layers(run: Path, since_s: float) -> list[str]:
    """Return the layers that a run folder holds, in the order of their stages.

    Args:
        run: Run folder, which may not exist yet.
        since_s: Time in seconds since 1970 at which the run began. What an earlier run left in
            the folder does not count.
    """
    place = run / "manifest.json"
    try:
        if place.stat().st_mtime < since_s:
            return []
        finished = read_json(place)["finished"]
        return [layer for layer, stage in STAGES.items() if stage in finished]
    except (OSError, InputError, KeyError, TypeError):
        return []


def layer_bytes(run: Path, layer: str) -> bytes:
    """Return a layer of a run folder as a packet.

    Raises:
        UnknownNameError: If there is no layer of this name.
        InputError: If its stage is not finished, or its file is damaged.
    """
    if layer not in STAGES:
        raise UnknownNameError("layer", layer, STAGES)
    if layer == "cameras":
        return pack_arrays(MAGIC, {}, {"rays": _camera_rays(run / "scan.json")})
    if layer == "points":
        return pack_arrays(MAGIC, {}, _surface_points(run))
    if layer == "cells":
        return pack_arrays(MAGIC, *_open_cells(read_room(run / "room.npz")[0]))
    if layer == "things":
        return pack_arrays(MAGIC, {"things": _things(read_json(run / "objects.json"))}, {})
    volume = read_built(run / "build")
    scale = 1 / float(np.linalg.norm(volume.block_to_room[:3, 0]))
    return BlockBuild(0, BuildOptions(scale), volume).mesh_bytes()


def _camera_rays(path: Path) -> np.ndarray:
    """Return the camera positions and viewing directions of a ``scan.json``, float32 [N, 6]."""
    try:
        return np.array(read_json(path).get("cameras", []), np.float32).reshape(-1, 6)
    except MALFORMED as error:
        raise DamagedFileError(path, f"contains invalid cameras ({error})") from error


def _surface_points(run: Path) -> dict[str, np.ndarray]:
    """Return the mean point and colour of each cell that was hit, thinned evenly."""
    evidence = read_evidence(run / "evidence.npz")
    cells = np.argwhere((evidence.hits > 0) & (evidence.log_odds > 0))
    cells = cells[:: max(1, -(-len(cells) // MAX_POINTS))]
    at = tuple(cells.T)
    hits = evidence.hits[at].astype(np.float32)[:, None]
    centre = evidence.origin_m + (cells + 0.5) * evidence.voxel_m
    colour = np.clip(evidence.colour_sum[at] / hits, 0, 255).astype(np.uint8)
    return {
        "position": (centre + evidence.offset_sum[at] / hits).astype(np.float32),
        "colour": colour,
    }


def _open_cells(grid: OccupancyGrid) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Return the cells that a view from above shows, without ceilings and the upper walls."""
    height = grid.origin_m[2] + (np.arange(grid.shape[2]) + 0.5) * grid.voxel_m
    walls = np.isin(grid.labels, (SemanticClass.WALL, SemanticClass.WINDOW))
    shown = grid.occupied & (grid.labels != SemanticClass.CEILING)
    shown &= ~(walls & (height > WALL_HEIGHT_M))
    cells = np.argwhere(shown & ~erode_faces(shown))
    at = tuple(cells.T)
    arrays = {
        "position": (grid.origin_m + (cells + 0.5) * grid.voxel_m).astype(np.float32),
        "colour": grid.colour[at],
        "label": grid.labels[at][:, None].astype(np.uint8),
    }
    return {"voxel_m": grid.voxel_m}, arrays


def _things(objects: Any) -> list[dict[str, Any]]:
    """Return names and boxes of the objects of an ``objects.json``."""
    rows = [one for one in objects if isinstance(one, dict)] if isinstance(objects, list) else []
    keys = ("name", "center_m", "size_m", "yaw_deg")
    return [{key: row[key] for key in keys} for row in rows if all(key in row for key in keys)]
