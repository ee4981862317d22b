"""View directions: the number of images that cover each heading and pitch."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.types import Camera

STEP_DEG = 10
HEADINGS, PITCHES = 360 // STEP_DEG, 180 // STEP_DEG
SECTORS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
LEVEL_DEG = 30.0  # Within it a look meets walls and furniture, not the floor at one's feet.
STEEP_DEG = 40.0  # Beyond it, from the middle of a usual room, one sees floor or ceiling.


@dataclass(frozen=True, eq=False)
class ViewDirections:
    """The number of images that show each direction, ``seen`` int64 [18, 36].

    Rows are pitches from -85 to +85 degrees. Columns are headings from 5 to 355 degrees, clockwise
    from north, which is +y of the top view.
    """

    seen: np.ndarray

    @property
    def pitches_deg(self) -> np.ndarray:
        """The pitch of each row in degrees."""
        return np.arange(PITCHES) * STEP_DEG - 90 + STEP_DEG / 2

    def sectors(self) -> np.ndarray:
        """Return the share of each sector that is covered at level pitch, float64 [8]."""
        level = self.seen[np.abs(self.pitches_deg) < LEVEL_DEG] > 0
        heading = np.arange(HEADINGS) * STEP_DEG + STEP_DEG / 2
        sector = np.round(heading / 45).astype(int) % 8
        return np.array([level[:, sector == index].mean() for index in range(8)])

    def gaps(self) -> tuple[str, ...]:
        """Return the names of the sectors of which less than a tenth is covered."""
        shares = self.sectors()
        return tuple(name for name, share in zip(SECTORS, shares, strict=True) if share < 0.1)

    def share_below(self) -> float:
        """Return the share of steep downward directions that some image covers."""
        return float((self.seen[self.pitches_deg < -STEEP_DEG] > 0).mean())


def count_view_directions(
    cameras: Sequence[Camera | None], camera_to_level: np.ndarray
) -> ViewDirections:
    """Count the images that show each direction.

    Args:
        cameras: One camera per frame; None is treated as a field of view of 60 by 45 degrees.
        camera_to_level: Camera poses in a frame with z up, float64 [F, 4, 4].
    """
    pitch = np.radians(np.arange(PITCHES) * STEP_DEG - 90 + STEP_DEG / 2)
    heading = np.radians(np.arange(HEADINGS) * STEP_DEG + STEP_DEG / 2)
    up, turn = np.meshgrid(pitch, heading, indexing="ij")
    rays = np.stack([np.cos(up) * np.sin(turn), np.cos(up) * np.cos(turn), np.sin(up)], axis=-1)
    seen = np.zeros(up.shape, np.int64)
    for camera, pose in zip(cameras, camera_to_level, strict=True):
        across, down = _tangents(camera)
        x, y, z = np.moveaxis(rays @ pose[:3, :3], -1, 0)
        ahead = z > 1e-6
        depth = np.where(ahead, z, 1.0)
        seen += ahead & (np.abs(x / depth) <= across) & (np.abs(y / depth) <= down)
    return ViewDirections(seen)


def _tangents(camera: Camera | None) -> tuple[float, float]:
    """Return the tangents of half the horizontal and vertical fields of view."""
    if camera is None:
        return float(np.tan(np.radians(30))), float(np.tan(np.radians(22.5)))
    return camera.width_px / 2 / camera.fx_px, camera.height_px / 2 / camera.fy_px


def estimate_up(camera_to_world: np.ndarray) -> np.ndarray:
    """Estimate the up direction, which is orthogonal to the image rows.

    Args:
        camera_to_world: Poses of OpenCV cameras that are mostly upright, float64 [F, 4, 4].
    """
    right, down = camera_to_world[:, :3, 0], camera_to_world[:, :3, 1]
    mean = -down.mean(axis=0)
    spread, axes = np.linalg.eigh(right.T @ right / len(right))
    up = axes[:, 0]
    if spread[1] < 0.02:  # All look one way: rows do not tell, columns do.
        up = mean / max(float(np.linalg.norm(mean)), 1e-9)
    return up if up @ mean >= 0 else -up
