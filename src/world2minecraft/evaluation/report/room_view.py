"""The room of the report in 3D: the page of a shared room, in a frame of the report."""

from typing import Any

import numpy as np

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import ObjectInstance
from world2minecraft.core.vocabulary import object_title
from world2minecraft.evaluation.report.finished_run import FinishedScene
from world2minecraft.rendering.mesh import mesh_of
from world2minecraft.rendering.mesh.packets import COMPACT_UNIT, compact_mesh_arrays
from world2minecraft.rendering.mesh.viewer_page import assemble, packed_block

MAX_VIEW_BYTES = 2_500_000  # With its pictures, a report stays below 5 MB.
TITLE = "The built room"


def room_view(scene: FinishedScene, camera_to_room: np.ndarray) -> str | None:
    """Return the page that shows the room of a run, or None if it would be too large.

    Args:
        scene: The finished run.
        camera_to_room: The pose from which most is visible, 4x4; the view starts on its side.
    """
    volume = scene.volume
    mesh = mesh_of(volume)
    moved = np.eye(4)
    moved[:3, 3] = volume.corner
    forward = camera_to_room[:3, 2]
    facts = {
        "title": TITLE,
        "size_m": np.round(scene.room_size_m, 2).tolist(),
        "unit": COMPACT_UNIT,
        "clear_from": mesh.clear_from,
        "texture_px": mesh.atlas.side_px,
        "grid_to_room": (volume.block_to_room @ moved).ravel().tolist(),
        "azimuth": float(np.arctan2(-forward[1], -forward[0])),
        "can_walk": False,
        "things": sorted(map(_thing, scene.instances), key=lambda row: (row["name"], row["id"])),
        "phrases": {},
        "photos": [],
    }
    data = packed_block(facts, compact_mesh_arrays(mesh))
    page = assemble(TITLE, {"room-data": data})
    return page.decode() if len(page) <= MAX_VIEW_BYTES else None


def _thing(one: ObjectInstance) -> dict[str, Any]:
    half = np.abs(rotation_about_z(one.yaw_deg)[:3, :3]) @ one.size_m / 2
    return {
        "id": one.id,
        "name": f"{object_title(one.name, one.class_id)} {one.id}",
        "low_m": np.round(one.center_m - half, 3).tolist(),
        "high_m": np.round(one.center_m + half, 3).tolist(),
        "size_m": np.round(one.size_m, 2).tolist(),
        "way": -1,
    }
