"""Calibration of the colour camera of captures that state one matrix for depth and colour.

Kinect-like sensors record depth and colour through two lenses, but many captures state only one
intrinsic matrix. Colour usually changes where depth jumps. The focal-length scale and the shift of
the principal point that align depth edges with colour edges therefore describe the colour camera.
They are estimated on half of the frames, and used only if they clearly improve the alignment on the
other half.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter1d

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera, View

WORK_WIDTH_PX = 320  # Shifts below are in pixels of a colour image of this width.
BLUR_PX = 1.5  # So wide that the coarse steps below do not miss a peak.
JUMP = 0.06  # Of the nearer depth: more than noise and slanted surfaces give between two pixels.
MAX_HOLE_PX = 8  # A Kinect's shadows next to near things are wider; the rest suffices.
POINTS_PER_MAP = 700
SCALES = np.arange(0.80, 1.2001, 0.02)
SHIFTS_PX = np.arange(-15.0, 15.1, 3.0)
REFINEMENTS = ((0.01, 1.5), (0.005, 0.75), (0.0025, 0.375))
MIN_GAIN = 1.25  # The kitchen: over 2.6; where depth and colour share a camera: at most 1.05.
MIN_SCORE = 0.04  # How much more the colour changes at depth edges than on average, from 0 to 1.
MIN_POINTS = 400
MIN_INSIDE_SHARE = 0.6


@dataclass(frozen=True)
class ColourCameraEstimate:
    """An estimate of the colour camera relative to the stated intrinsics.

    Attributes:
        scale: Ratio of the estimated to the stated focal length.
        shift_x_px: Shift of the principal point in pixels of the colour image, to the right.
        shift_y_px: Shift of the principal point in pixels of the colour image, downward.
        gain: Ratio by which the alignment of held-out frames improves.
        clear: Whether the improvement is large enough to use the estimate.
    """

    scale: float
    shift_x_px: float
    shift_y_px: float
    gain: float
    clear: bool

    @property
    def correction(self) -> tuple[float, float, float]:
        """The factor and the shifts as ``Scan.colour_correction``."""
        return float(self.scale), float(self.shift_x_px), float(self.shift_y_px)


def corrected_camera(camera: Camera, correction: tuple[float, float, float]) -> Camera:
    """Return a stated colour camera with a ``Scan.colour_correction`` applied."""
    scale, right_px, down_px = correction
    return replace(
        camera,
        fx_px=camera.fx_px * scale,
        fy_px=camera.fy_px * scale,
        cx_px=camera.cx_px + right_px,
        cy_px=camera.cy_px + down_px,
    )


@dataclass(frozen=True)
class _DepthEdges:
    """The depth edges of a frame as rays, float64 [N, 2], and colour gradients, float32 [h, w].

    Horizontal depth jumps come first, then vertical ones; each direction has its own gradient map.
    """

    rays: tuple[np.ndarray, np.ndarray]
    change: tuple[np.ndarray, np.ndarray]


def estimate_colour_camera(views: Iterable[View]) -> ColourCameraEstimate | None:
    """Estimate the colour camera from views, which are read once and one at a time.

    Returns:
        The estimate, which may be unclear, or None if there are too few edges.
    """
    edges: list[_DepthEdges] = []
    stated = None
    for view in views:
        if view.depth_m is not None and view.colour_camera is not None:
            stated = view.colour_camera
            edges.append(_extract_edges(view))
    fitted, held_out = edges[0::2], edges[1::2]
    if stated is None or min(_edge_count(fitted), _edge_count(held_out)) < MIN_POINTS:
        return None
    enlarged = stated.width_px / WORK_WIDTH_PX
    matrix = np.array([stated.fx_px, stated.fy_px, stated.cx_px, stated.cy_px]) / enlarged
    scale, shift_x, shift_y = _search_camera(fitted, matrix)
    cameras = np.array([(1.0, 0.0, 0.0), (scale, shift_x, shift_y)])
    before, after = _alignment_scores(_pack(held_out), matrix, cameras).tolist()
    gain = after / max(before, 1e-3)
    clear = gain > MIN_GAIN and after > MIN_SCORE
    return ColourCameraEstimate(scale, shift_x * enlarged, shift_y * enlarged, gain, clear)


def _edge_count(frames: Sequence[_DepthEdges]) -> int:
    return sum(len(rays) for frame in frames for rays in frame.rays)


def _extract_edges(view: View) -> _DepthEdges:
    depth, camera, colour = view.depth_m, view.depth_camera, view.colour
    if depth is None or camera is None or colour is None:
        raise ValueError(f"view {view.name} must have depth and colour")
    down, across = _depth_edges(depth.T), _depth_edges(depth)
    focal = np.array([camera.fx_px, camera.fy_px])
    center = np.array([camera.cx_px, camera.cy_px])
    rays = ((across - center) / focal, (down[:, ::-1] - center) / focal)
    small = Image.fromarray(colour).resize(
        (WORK_WIDTH_PX, round(colour.shape[0] * WORK_WIDTH_PX / colour.shape[1])),
        Image.Resampling.BOX,
    )
    pixels = np.asarray(small, np.float32)
    return _DepthEdges(rays, (_colour_gradient(pixels, 1), _colour_gradient(pixels, 0)))


def _depth_edges(depth_m: np.ndarray) -> np.ndarray:
    """Return the positions of depth jumps along rows in pixels, float64 [N, 2] (x, y).

    Sensors have holes at depth edges. The position is the border of the nearer surface.
    """
    columns = np.arange(depth_m.shape[1], dtype=np.int32)
    latest = np.maximum.accumulate(np.where(depth_m > 0, columns, -1), axis=1)[:, :-1]
    left = np.take_along_axis(depth_m, np.maximum(latest, 0), axis=1)
    right = depth_m[:, 1:]
    near_by = (latest >= 0) & (columns[1:] - latest <= MAX_HOLE_PX) & (right > 0)
    jumps = near_by & (np.abs(left - right) > JUMP * np.minimum(left, right))
    rows, found = np.nonzero(jumps)
    border = np.where(left[rows, found] < right[rows, found], latest[rows, found], found) + 1
    every = max(1, len(rows) // POINTS_PER_MAP)
    return np.column_stack([border[::every], rows[::every] + 0.5]).astype(np.float64)


def _colour_gradient(pixels: np.ndarray, axis: int) -> np.ndarray:
    """Return the colour change along an axis, from 0 to 1, with the mean subtracted."""
    gradient = np.zeros(pixels.shape[:2], np.float32)
    for channel in range(3):
        smoothed = gaussian_filter1d(pixels[..., channel], BLUR_PX, axis=1 - axis)
        slope = gaussian_filter1d(smoothed, BLUR_PX, axis=axis, order=1)
        np.maximum(gradient, np.abs(slope), out=gradient)
    # A strong border must not outweigh many plain ones: change saturates at what is steep here.
    change = gradient / (gradient + np.percentile(gradient, 85) + 1e-3)
    return np.ascontiguousarray(change - change.mean(), np.float32)


def _search_camera(frames: Sequence[_DepthEdges], matrix: np.ndarray) -> tuple[float, float, float]:
    """Return the best scale and shifts by a coarse search with local refinement."""
    maps = _pack(frames)
    coarse = list(product(SCALES.tolist(), SHIFTS_PX.tolist(), SHIFTS_PX.tolist()))
    scores = _alignment_scores(maps, matrix, np.array(coarse))
    first = int(np.argmax(scores))
    best, score = coarse[first], scores[first]
    for scale_step, shift_step in REFINEMENTS:
        moved = True
        while moved:
            moved = False
            for offsets in np.ndindex(3, 3, 3):
                a, b, c = (index - 1 for index in offsets)
                other = (
                    best[0] + a * scale_step,
                    best[1] + b * shift_step,
                    best[2] + c * shift_step,
                )
                found = _alignment_scores(maps, matrix, np.array([other]))[0]
                if found > score + 1e-9:
                    best, score, moved = other, found, True
    return best


class _EdgeMaps(NamedTuple):
    """The depth edges and gradient maps of frames, one after another.

    Attributes:
        rays: Edges of all maps, float64 [N, 2].
        ends: End of each map's edges in ``rays``, int64 [M].
        change: Pixels of all maps, float32 [P].
        starts: Start of each map in ``change``, int64 [M].
        sizes: Height and width of each map, int64 [M, 2].
    """

    rays: np.ndarray
    ends: np.ndarray
    change: np.ndarray
    starts: np.ndarray
    sizes: np.ndarray


def _pack(frames: Sequence[_DepthEdges]) -> _EdgeMaps:
    rays = [rays for frame in frames for rays in frame.rays]
    change = [change for frame in frames for change in frame.change]
    pixels = np.cumsum([0, *(one.size for one in change)])
    return _EdgeMaps(
        np.concatenate(rays),
        np.cumsum([len(one) for one in rays]),
        np.concatenate([one.reshape(-1) for one in change]),
        pixels[:-1],
        np.array([one.shape for one in change], np.int64),
    )


def _alignment_scores(maps: _EdgeMaps, matrix: np.ndarray, cameras: np.ndarray) -> np.ndarray:
    """Return the mean colour gradient at the depth edges that project into the image.

    Edges outside the image are ignored; a camera for which most edges are outside is rejected.

    Args:
        maps: Edges and gradients.
        matrix: Stated fx, fy, cx and cy at the size of the maps.
        cameras: Scale of the focal length and shifts of the centre, float64 [K, 3].

    Returns:
        The score of each camera, float64 [K].
    """
    totals, inside = _sums_at_pixels(maps, matrix, cameras)
    enough = inside > MIN_INSIDE_SHARE * len(maps.rays)
    return np.where(enough, totals / np.maximum(inside, 1), -1.0)


@njit
def _sums_at_pixels(maps, matrix, cameras):
    """Return the summed gradients at the edges of each camera, and how many are in the image."""
    totals, inside = np.zeros(len(cameras)), np.zeros(len(cameras), np.int64)
    for k in range(len(cameras)):
        scale, shift_x, shift_y = cameras[k]
        first = 0
        for m in range(len(maps.ends)):
            height, width = maps.sizes[m]
            total = 0.0
            for n in range(first, maps.ends[m]):
                u = int(np.floor(maps.rays[n, 0] * matrix[0] * scale + matrix[2] + shift_x))
                v = int(np.floor(maps.rays[n, 1] * matrix[1] * scale + matrix[3] + shift_y))
                if 0 <= u < width and 0 <= v < height:
                    total += maps.change[maps.starts[m] + v * width + u]
                    inside[k] += 1
            first = maps.ends[m]
            totals[k] += total
    return totals, inside
