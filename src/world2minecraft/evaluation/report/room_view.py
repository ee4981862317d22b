"""The room of the report in 3D: the page of a shared room, in a frame of the report."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import BlockVolume
from world2minecraft.rendering.mesh import mesh_of
from world2minecraft.rendering.mesh.packets import COMPACT_UNIT, compact_mesh_arrays
from world2minecraft.rendering.mesh.viewer_page import assemble, packed_block

MAX_VIEW_BYTES = 2_500_000  # With its pictures, a report stays below 5 MB.
TITLE = "The built room"


def room_view(
    volume: BlockVolume,
    room_size_m: np.ndarray,
    things: Iterable[dict[str, Any]],
    camera_to_room: np.ndarray,
) -> str | None:
    """Return the page that shows a build, or None if it would be too large.

    Args:
        volume: The build.
        room_size_m: The size of its rooms together, float64 [3].
        things: What can be chosen, as ``named_box`` describes it.
        camera_to_room: The pose from which most is visible, 4x4; the view starts on its side.
    """
    mesh = mesh_of(volume)
    forward = camera_to_room[:3, 2]
    facts = {
        "title": TITLE,
        "size_m": np.round(room_size_m, 2).tolist(),
        "unit": COMPACT_UNIT,
        "clear_from": mesh.clear_from,
        "texture_px": mesh.atlas.side_px,
        "grid_to_room": volume.grid_to_room.ravel().tolist(),
        "azimuth": float(np.arctan2(-forward[1], -forward[0])),
        "can_walk": False,
        "things": sorted(things, key=lambda row: (row["name"], row["id"])),
        "phrases": {},
        "photos": [],
    }
    data = packed_block(facts, compact_mesh_arrays(mesh))
    page = assemble(TITLE, {"room-data": data})
    return page.decode() if len(page) <= MAX_VIEW_BYTES else None


def named_box(
    number: int, title: str, center_m: np.ndarray, size_m: np.ndarray, yaw_deg: float
) -> dict[str, Any]:
    """Return an object as the page lists it.

    Args:
        number: Its id.
        title: Its name without the id.
        center_m: The centre of its box in metres of the room, float64 [3].
        size_m: The sides of its box before the turn, float64 [3].
        yaw_deg: The turn of its box, counter-clockwise from above.
    """
    half = np.abs(rotation_about_z(yaw_deg)[:3, :3]) @ size_m / 2
    return {
        "id": number,
        "name": f"{title} {number}",
        "low_m": np.round(center_m - half, 3).tolist(),
        "high_m": np.round(center_m + half, 3).tolist(),
        "size_m": np.round(size_m, 2).tolist(),
        "way": -1,
    }
