"""Which fine voxels a scene's cameras saw through: what is free, and not merely not surface.

A ray counts where the mesh and the depth image agree on where it ends. Where the sensor saw nothing
(a screen, a window), or the mesh has a hole, nobody knows what the ray passed.
"""

from collections.abc import Mapping

import numpy as np

from world2minecraft.capture.depth_images import DepthEncoding, read_depth
from world2minecraft.capture.frames import FrameFiles
from world2minecraft.capture.judged import judge_capture, spread_over
from world2minecraft.capture.options import ScanOptions
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import CaptureError, DamagedFileError
from world2minecraft.core.progress import Progress, silent
from world2minecraft.evaluation.scoring.truth import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame
from world2minecraft.evaluation.scoring.visibility import CROSSED, Believed, reached_cells

MOST_FRAMES = 200  # Evenly spread over the recording: seven a second of a walk of half a minute.
APART_M, APART_SHARE = 0.08, 0.05  # A cell, or what such sensors err by at 2 m and beyond.


def seen_free(truth: Truth, progress: Progress = silent) -> np.ndarray:
    """Return bool [A, B, C]: the voxels of a truth that rays of its own capture passed.

    Args:
        truth: a scanned surface, whose ``capture`` has depth images and poses.
        progress: told of the stage ``seen``.

    Raises:
        CaptureError: the capture has no frame with a pose and depth.
    """
    judged = judge_capture(truth.capture, ScanOptions())
    usable = [f for f in judged.frames if f.depth_path and f.camera_to_world is not None]
    if not usable:
        raise CaptureError(truth.capture, "has no depth images with poses: give the scene's .sens")
    frames = {frame.name: frame for frame in spread_over(usable, MOST_FRAMES)}
    scan_to_truth = invert_rigid(truth.truth_to_scan)
    used = [_used(frame, scan_to_truth) for frame in frames.values()]
    agreed = _agreed(frames, judged.encoding, progress)
    reached = reached_cells(truth, used, np.eye(4), truth.voxel_m, believed=agreed)
    start = np.round(truth.origin_m / truth.voxel_m).astype(np.int64) - reached.low
    inside = tuple(slice(a, a + n) for a, n in zip(start, truth.labels.shape, strict=True))
    return (reached.flags[inside] & CROSSED) > 0


def _used(frame: FrameFiles, scan_to_truth: np.ndarray) -> UsedFrame:
    colour_to_scan = np.asarray(frame.camera_to_world, np.float64)
    depth_to_scan = colour_to_scan @ frame.depth_to_colour
    camera = frame.depth_camera
    if camera is None:
        raise CaptureError(frame.name, "has a depth image without a camera")
    truly = scan_to_truth @ depth_to_scan
    return UsedFrame(frame.name, camera, truly, scan_to_truth @ colour_to_scan, depth_to_scan)


def _agreed(
    frames: Mapping[str, FrameFiles], encoding: DepthEncoding, progress: Progress
) -> Believed:
    """Return the question whether rays end where the depth image of their frame says."""
    done = {"frames": 0}

    def agreed(used: UsedFrame, depth_m: np.ndarray) -> np.ndarray:
        done["frames"] += 1
        progress("seen", done["frames"], len(frames), used.name)
        path = frames[used.name].depth_path
        try:
            measured = read_depth(path, encoding) if path else np.zeros((1, 1), np.float32)
        except DamagedFileError:
            return np.zeros(depth_m.shape, bool)
        rows, columns = (
            ((np.arange(side) + 0.5) * (full / side)).astype(np.int64)
            for side, full in zip(depth_m.shape, measured.shape, strict=True)
        )
        there = measured[np.ix_(rows, columns)]
        allowed = np.maximum(APART_M, APART_SHARE * depth_m)
        return (there > 0) & (np.abs(there - depth_m) <= allowed)

    return agreed
