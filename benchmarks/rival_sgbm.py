"""Depth of photos by OpenCV's StereoSGBM: pairs are rectified, matched, and carried back.

It takes the place of ``capture.stereo.compute_depth_maps``, with the same neighbours and the same
filter behind it, so that the two differ only in how depth is estimated.
``python -m benchmarks.rival_sgbm ARGUMENTS`` runs ``w2m ARGUMENTS`` with it; ``check_photos``
compares the two.
"""

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from world2minecraft.capture.stereo.depth_maps import (
    DEPTH_PERCENTILES,
    filter_consistent,
    select_neighbours,
)
from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.capture.stereo.photo_preparation import StereoPhoto, prepare_stereo_photos
from world2minecraft.capture.stereo.plane_sweep import depth_range
from world2minecraft.cli import run
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera, DepthMap, SparseScene
from world2minecraft.core.types.photos import PhotoStream
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.reconstruction.opening import open_capture as preparing

ASKED, PAIRS = 12, 6  # So many neighbours are looked at for so many pairs that can be rectified.
MOST_ALONG = 0.6  # Share of a motion that may go along the view: rectified, more turns too far.
MOST_TURN = 0.8  # Cosine of the farthest that a rectified view may turn away from the photo.
BLOCK_PX = 5
FEW_POINTS = 20  # With fewer, the depths of all photos stand in.


@dataclass(frozen=True, eq=False)
class Pair:
    """Two photos, both turned so that a point lies in one row of both.

    ``turn`` carries the first camera's rays to the turned one, ``camera`` is the turned camera
    (3x4, of whole pixel centres), ``shift_px_m`` what disparity times depth is, of either sign.
    """

    first: np.ndarray
    second: np.ndarray
    turn: np.ndarray
    camera: np.ndarray
    shift_px_m: float
    upright: bool


def depth_maps(
    photos: PhotoStream,
    scene: SparseScene,
    parameters: StereoParameters | None = None,
    progress: Progress = no_progress,
    guide=None,
) -> Iterator[DepthMap]:
    """Yield the depth maps of a scene's photos at half their size; see ``capture.stereo``.

    ``parameters`` are those of ours: the angle wanted between photos, and the agreement asked for,
    hold here too. ``guide`` does not.
    """
    half_px = max(camera.width_px for camera in scene.cameras) // 2
    small = prepare_stereo_photos(photos, scene, half_px, no_progress)
    all_m = np.concatenate([photo.guide_m for photo in small])
    stand_in = [p.guide_m if len(p.guide_m) > FEW_POINTS else all_m for p in small]
    depths_m = np.array([np.percentile(known, DEPTH_PERCENTILES) for known in stand_in])
    values = parameters or StereoParameters()
    neighbours = select_neighbours(small, depths_m, ASKED, values.angle_deg)
    raw = []
    for frame, photo in enumerate(small):
        others = [small[other] for other in neighbours[frame]]
        raw.append(depth_of(photo, others, depth_range(photo, all_m)))
        progress("stereo", frame + 1, len(small), photo.name)
    for frame in range(len(small)):
        yield filter_consistent(frame, small, raw, neighbours, values)


def depth_of(photo: StereoPhoto, others: list[StereoPhoto], depths_m) -> np.ndarray:
    """Return float32 [h, w]: the median of what up to six pairs say, 0 where none does."""
    found = []
    for other in others:
        pair = rectified(photo, other) if len(found) < PAIRS else None
        if pair is not None:
            found.append(carried_back(pair, disparity(pair, depths_m), photo.camera))
    if not found:
        return np.zeros((photo.camera.height_px, photo.camera.width_px), np.float32)
    stack = np.sort(np.stack(found), axis=0)
    count = np.isfinite(stack).sum(axis=0)
    middle = np.maximum(count - 1, 0) // 2  # NaN is sorted behind all numbers.
    depth_m = np.take_along_axis(stack, middle[None], axis=0)[0]
    return np.nan_to_num(depth_m, nan=0.0).astype(np.float32)


def rectified(photo: StereoPhoto, other: StereoPhoto) -> Pair | None:
    """Turn two photos into one row order; None where their motion does not allow it."""
    here_to_there = invert_rigid(other.camera_to_scan) @ photo.camera_to_scan
    turn, shift = here_to_there[:3, :3], here_to_there[:3, 3]
    there = -turn.T @ shift  # The other's place, in this camera's frame.
    length = np.linalg.norm(there)
    if length < 1e-9 or max(abs(there[2]), abs(shift[2])) > MOST_ALONG * length:
        return None
    size = (photo.camera.width_px, photo.camera.height_px)
    first, second, no_lens = whole_centres(photo.camera), whole_centres(other.camera), np.zeros(5)
    turn_1, turn_2, camera_1, camera_2, *_ = cv2.stereoRectify(
        first, no_lens, second, no_lens, size, turn, shift[:, None],
        flags=cv2.CALIB_ZERO_DISPARITY, alpha=-1,
    )  # fmt: skip
    if min(turn_1[2, 2], turn_2[2, 2]) < MOST_TURN or camera_1[0, 0] <= 0:
        return None
    pictures = []
    for colour, matrix, by, camera in (
        (photo.colour, first, turn_1, camera_1),
        (other.colour, second, turn_2, camera_2),
    ):
        maps = cv2.initUndistortRectifyMap(matrix, None, by, camera, size, cv2.CV_32FC1)
        pictures.append(
            cv2.remap(cv2.cvtColor(colour, cv2.COLOR_RGB2GRAY), *maps, cv2.INTER_LINEAR)
        )
    upright = abs(camera_2[1, 3]) > abs(camera_2[0, 3])
    return Pair(*pictures, turn_1, camera_1, float(camera_2[1 if upright else 0, 3]), upright)


def whole_centres(camera: Camera) -> np.ndarray:
    """Return the camera's matrix in OpenCV's way, in which a pixel's centre has no half."""
    return camera.matrix - [[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]]


def disparity(pair: Pair, depths_m) -> np.ndarray:
    """Return float64 [h, w] disparity of the first picture in pixels, NaN where there is none."""
    first, second = pair.first, pair.second
    if pair.upright:
        first, second = np.ascontiguousarray(first.T), np.ascontiguousarray(second.T)
    ends = sorted(-pair.shift_px_m / np.array(depths_m))
    least = int(np.floor(ends[0]))
    count = max(16, int(np.ceil((ends[1] - least + 1) / 16)) * 16)
    if count >= first.shape[1]:
        return np.full(pair.first.shape, np.nan)
    matcher = cv2.StereoSGBM_create(
        minDisparity=least, numDisparities=count, blockSize=BLOCK_PX, P1=8 * BLOCK_PX**2,
        P2=32 * BLOCK_PX**2, disp12MaxDiff=1, uniquenessRatio=10, speckleWindowSize=100,
        speckleRange=2, mode=cv2.STEREO_SGBM_MODE_SGBM,
    )  # fmt: skip
    # What lies beyond the edge of either picture is repeated, so that no strip is lost.
    margin = max(0, least + count, -least)
    wide = [
        cv2.copyMakeBorder(p, 0, 0, margin, margin, cv2.BORDER_REPLICATE) for p in (first, second)
    ]
    steps = matcher.compute(*wide)[:, margin : margin + first.shape[1]]
    found = np.where(steps >= 16 * least, steps / 16, np.nan)
    return found.T if pair.upright else found


def carried_back(pair: Pair, found: np.ndarray, camera: Camera) -> np.ndarray:
    """Return float64 [h, w] z-depth in the photo itself, NaN where there is none."""
    rays = pixel_rays(camera).astype(np.float64)
    rays = np.concatenate([rays, np.ones((*rays.shape[:2], 1))], axis=2) @ pair.turn.T
    at = rays @ pair.camera[:, :3].T
    u, v = (np.rint(at[..., k] / at[..., 2]).astype(int) for k in (0, 1))
    high, wide = found.shape
    inside = (u >= 0) & (v >= 0) & (u < wide) & (v < high)
    values = found[np.clip(v, 0, high - 1), np.clip(u, 0, wide - 1)]
    with np.errstate(divide="ignore", invalid="ignore"):
        depth_m = -pair.shift_px_m / values / rays[..., 2]
    return np.where(inside & (depth_m > 0), depth_m, np.nan)


def main(words: list[str]) -> int:
    """Run ``w2m`` with this stereo and return its exit code."""
    preparing.compute_depth_maps = depth_maps
    return run(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
