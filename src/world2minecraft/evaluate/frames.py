"""The frames that a run used: their cameras, where they truly stood, and where it was said."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.coordinates import invert_rigid
from world2minecraft.errors import DamagedFileError
from world2minecraft.evaluate.truth import Truth
from world2minecraft.files import read_json
from world2minecraft.scan.sources import find_capture
from world2minecraft.types import Camera


@dataclass(frozen=True, eq=False)
class UsedFrame:
    """One frame; the camera is that of the depth, or of the colour where there is no depth."""

    name: str
    camera: Camera
    camera_to_truth: np.ndarray  # float64 [4, 4], the true pose
    colour_to_truth: np.ndarray  # float64 [4, 4], that of the colour camera
    camera_to_scan: np.ndarray  # float64 [4, 4], as the capture states it


def used_frames(out: Path, truth: Truth) -> tuple[UsedFrame, ...]:
    """Return the frames that the run in ``out`` used, in its order.

    Raises:
        InputError: ``out`` has no ``scan.json``. CaptureError: no capture lies beside the truth.
        DamagedFileError: the run used a frame that the capture does not have.
    """
    path = out / "scan.json"
    try:
        names = [str(name) for name in read_json(path)["frames_used"]]
    except (KeyError, TypeError) as error:
        raise DamagedFileError(path, f"has no list frames_used ({error})") from error
    frames = {frame.name: frame for frame in find_capture(truth.folder).frames}
    strange = [name for name in names if name not in frames]
    if strange:
        raise DamagedFileError(
            path, f"used frame {strange[0]!r}, which {truth.folder} does not have; another capture?"
        )
    return tuple(_used(frames[name], truth) for name in names)


def _used(frame, truth: Truth) -> UsedFrame:
    camera = frame.depth_camera or frame.colour_camera
    stated = np.asarray(frame.camera_to_world, np.float64)
    true = (truth.camera_to_truth or {}).get(frame.name)
    if true is None:
        true = invert_rigid(truth.truth_to_scan) @ stated
    to_colour = frame.depth_to_colour if frame.depth_camera else np.eye(4)
    return UsedFrame(frame.name, camera, true @ to_colour, true, stated @ to_colour)
