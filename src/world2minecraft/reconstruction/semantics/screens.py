"""Screens at walls: dark or bluish plates a few centimetres in front of a wall.

Pictures are closer to the wall, and cupboards extend further into the room. Depth cameras often see
only the frame of a lit or glossy screen, so a part of its box is sufficient.
"""

from typing import cast

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.parameters import PieceParameters, within
from world2minecraft.reconstruction.layout.surface_cells import Surface, turn_surface
from world2minecraft.reconstruction.layout.walls import WallRun

PLATE_GATE_M = 0.05  # A screen's cells lie within this of its plane.
ALIKE = 0.12  # Oklab difference of one cloth in the light and in its own shadow.
MAX_DEPTHS = 6  # Maximum number of depths to examine before a wall.


def label_screens(
    surface: Surface,
    rest: np.ndarray,
    runs: list[WallRun],
    labels: np.ndarray,
    parameters: PieceParameters,
) -> np.ndarray:
    """Write the class tvs to the cells of screens in ``labels`` and return their mask [X, Y, Z].

    Args:
        surface: Surface of the room.
        rest: Mask of the cells that are not structure, bool [X, Y, Z].
        runs: Walls of the room.
        labels: Labels, uint8 [X, Y, Z], modified in place.
        parameters: Thresholds of the size, position and colour of screens.
    """
    found = np.zeros(rest.shape, bool)
    for run in runs:
        box = _box_before(surface, run, parameters)
        outward = run.sign * turn_surface(surface.points_m[..., run.axis], run.axis, run.sign)[box]
        before = run.outward_m - outward
        low, high = parameters.screen_before_m
        cells = turn_surface(rest, run.axis, run.sign)[box] & (before >= low) & (before <= high)
        target = turn_surface(found, run.axis, run.sign)[box]
        colour = turn_surface(surface.oklab, run.axis, run.sign)[box]
        below = _just_below(surface, rest, run, box)
        for _ in range(MAX_DEPTHS):
            if cells.sum() * surface.voxel_m**2 < 0.05:
                break
            depth, _ = highest_peak(before[cells], PLATE_GATE_M / 2)
            near = cells & (np.abs(before - depth) <= PLATE_GATE_M)
            cells = cells & ~near
            for plate in _plates(near):
                goes_on = below is not None and _goes_on(plate, colour, *below)
                if not goes_on and _is_screen(plate, colour, surface.voxel_m, parameters):
                    target |= plate
    labels[found] = SemanticClass.TVS
    return found


def _box_before(
    surface: Surface, run: WallRun, parameters: PieceParameters
) -> tuple[slice, slice, slice]:
    """Return the part of the rotated room in which screens in front of a wall may be."""
    size = surface.occupied.shape[run.axis]
    ends = surface.origin_m[run.axis] + np.array([0, size]) * surface.voxel_m
    face = (run.outward_m - min(run.sign * ends)) / surface.voxel_m
    reach = parameters.screen_before_m[1] / surface.voxel_m
    first, last = int(np.floor(face - reach)) - 1, int(np.ceil(face)) + 1
    bottom = surface.layers_below(parameters.screen_bottom_m)
    return (
        slice(max(first, 0), max(last, 0)),
        slice(run.span[0], run.span[1] + 1),
        slice(bottom, None),
    )


def _plates(near: np.ndarray) -> list[np.ndarray]:
    """Return the connected parts of cells at one depth."""
    parts, count = label_components(cast(np.ndarray, near.any(axis=0)))
    return [near & (parts == part)[None] for part in range(1, count + 1)]


def _just_below(
    surface: Surface, rest: np.ndarray, run: WallRun, box: tuple[slice, slice, slice]
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the layer below a box: its non-structure cells, bool [N, A], and Oklab colours."""
    under = box[2].start - 1
    if under < 0:
        return None
    layer = (box[0], box[1], under)
    oklab = turn_surface(surface.oklab, run.axis, run.sign)[layer]
    return turn_surface(rest, run.axis, run.sign)[layer], oklab


def _goes_on(plate: np.ndarray, oklab: np.ndarray, rest: np.ndarray, below: np.ndarray) -> bool:
    """Return whether a plate continues below the height of screens, as the back of a chair.

    The support of a screen has another colour.
    """
    foot = plate[:, :, 0]
    alike = np.linalg.norm(below - np.median(oklab[plate], axis=0), axis=-1) <= ALIKE
    under = (rest & alike).any(axis=0) & foot.any(axis=0)
    return bool(under.sum() > 0.5 * plate.any(axis=(0, 2)).sum())


def _is_screen(
    plate: np.ndarray, oklab: np.ndarray, voxel_m: float, parameters: PieceParameters
) -> bool:
    """Return whether a plate has the size, shape and colours of a screen."""
    face = plate.any(axis=0)
    along, up = np.nonzero(face)
    width, height = (np.ptp(along) + 1) * voxel_m, (np.ptp(up) + 1) * voxel_m
    sized = within(width, parameters.screen_width_m) and within(height, parameters.screen_height_m)
    if not sized or not within(width / height, parameters.screen_shape):
        return False
    filled = face.sum() * voxel_m**2 / (width * height)
    return filled >= parameters.screen_filled and screen_share(oklab[plate], parameters) >= 0.5


def screen_share(oklab: np.ndarray, parameters: PieceParameters) -> float:
    """Return the share of Oklab colours [N, 3] that are dark, blue or cyan."""
    dark = oklab[:, 0] <= parameters.screen_lightness
    blue = (oklab[:, 1] < 0.02) & (oklab[:, 2] < -0.01) & (np.hypot(*oklab[:, 1:].T) >= 0.04)
    return float((dark | blue).mean())
