"""Depth as evidence: each pixel with depth is a point of the surface, with colour and label.

Where colour and depth are two cameras, a depth point takes the colour and the label of the pixel
that it projects to; a point that the colour camera does not see has the nearest edge pixel's.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Protocol

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.types import Camera, PointEvidence, Scan, View
from world2minecraft.geometry.unprojection import lift_depth, pixel_rays, project
from world2minecraft.reconstruction.occupancy.facing import facing_of_depth

MAX_DEPTH_M = 6.0  # Consumer depth cameras err by over 6 cm beyond; a room rarely needs more.


class Voter(Protocol):
    """Something that votes for the classes of what a view's depth sees, such as a network."""

    notes: tuple[str, ...]

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> np.ndarray:
        """Return float32 [N, 12], at most one vote in sum for each point.

        Args:
            view: with colour.
            scan_to_room: 4x4.
            points_m: [N, 3], in the scan's frame.
            colour_px: int [N], the flat pixel of the colour picture that shows each point.
        """
        ...


class DepthPredictor:
    """Gives one PointEvidence for each view that has depth; ``voters`` vote on its points."""

    def __init__(self, max_depth_m: float = MAX_DEPTH_M, *, voters: Sequence[Voter] = ()):
        self.max_depth_m = max_depth_m
        self.voters = tuple(voters)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the voters have to tell."""
        return tuple(note for voter in self.voters for note in voter.notes)

    def predict(self, scan: Scan) -> Iterator[PointEvidence]:
        """Yield the surface points of each view, in the scan's frame and order."""
        for view in scan.views:
            if view.depth_m is not None:
                yield self.lift(view, scan.scan_to_room)

    def lift(self, view: View, scan_to_room: np.ndarray | None = None) -> PointEvidence:
        """Return the points of one view, those beyond ``max_depth_m`` left out."""
        camera, depth_m = view.depth_camera, view.depth_m
        if camera is None or depth_m is None:
            raise ValueError(f"view {view.name} has no depth")
        near_m = np.where(depth_m <= self.max_depth_m, depth_m, np.float32(0))
        camera_to_scan = view.depth_camera_to_scan
        points_m, pixels = lift_depth(near_m, camera, camera_to_scan)
        depths = near_m.reshape(-1)[pixels]
        colour_px = _colour_pixels(view, points_m, pixels)
        colour, labels = _look_up(view, colour_px)
        return PointEvidence(
            view=view.name,
            camera_m=camera_to_scan[:3, 3],
            points_m=points_m,
            weight=depths * depths / np.float32(camera.fx_px * camera.fy_px),
            colour=colour,
            normals=facing_of_depth(near_m, camera, camera_to_scan, pixels),
            labels=labels,
            trust=_trust(view, pixels),
            votes=self._votes(view, scan_to_room, points_m, colour_px),
        )

    def _votes(self, view: View, scan_to_room, points_m, colour_px) -> np.ndarray | None:
        if not self.voters or colour_px is None:
            return None
        to_room = np.eye(4) if scan_to_room is None else scan_to_room
        total = np.zeros((len(points_m), CLASS_COUNT), np.float32)
        for voter in self.voters:
            total += voter.votes(view, to_room, points_m, colour_px)
        return total.astype(np.float16)


def _trust(view: View, pixels: np.ndarray) -> np.ndarray | None:
    """Return how far each point is to be trusted, 0 to 1; None where all are wholly."""
    if view.trust is None:
        return None
    return view.trust.reshape(-1)[pixels].astype(np.float32) / np.float32(255)


def _colour_pixels(view: View, points_m: np.ndarray, pixels: np.ndarray) -> np.ndarray | None:
    """Return the flat colour pixel of each of a view's points; None where it has no colour."""
    if view.colour is None or view.colour_camera is None or view.depth_camera is None:
        return None
    if np.array_equal(view.depth_to_colour, np.eye(4)):
        return _shared_place_map(view.depth_camera, view.colour_camera)[pixels]
    in_camera_m = apply(invert_rigid(view.camera_to_scan), points_m.astype(np.float64))
    return _nearest_pixels(project(in_camera_m, view.colour_camera), view.colour_camera)


def _look_up(view: View, colour_px: np.ndarray | None):
    """Return the colours and the labels of a view's points, or None for what it lacks."""
    if colour_px is None or view.colour is None:
        return None, None
    colour = view.colour.reshape(-1, 3)[colour_px]
    return colour, None if view.labels is None else view.labels.reshape(-1)[colour_px]


@lru_cache(maxsize=8)
def _shared_place_map(depth_camera: Camera, colour_camera: Camera) -> np.ndarray:
    """Return int32 [H*W]: the colour pixel of each depth pixel, for cameras in one place.

    Then a pixel's ray meets the other image at one place whatever its depth.
    """
    rays = pixel_rays(depth_camera).reshape(-1, 2)
    ahead = np.concatenate([rays, np.ones((len(rays), 1), np.float32)], axis=1)
    return _nearest_pixels(project(ahead, colour_camera), colour_camera)


def _nearest_pixels(at_px: np.ndarray, camera: Camera) -> np.ndarray:
    """Return the flat indices of the pixels that hold [N, 2] image points, clipped to the edge."""
    u = np.clip(np.floor(at_px[:, 0]), 0, camera.width_px - 1)
    v = np.clip(np.floor(at_px[:, 1]), 0, camera.height_px - 1)
    return (v * camera.width_px + u).astype(np.int32)
