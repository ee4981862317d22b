"""Selection of the views of a long recording: those that show what others show are left out.

A camera at 30 frames a second sees almost the same in neighbouring frames. Decoding, registering
and fusing all of them takes time and memory and adds little: after a few views from one place in
one direction, the noise of the sensor has averaged out.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.capture.source_types import FrameFiles

LONG = 100  # Frames; shorter captures are used whole.
NEAR_M = 0.10  # Cameras so near to each other ...
NEAR_DEG = 6.0  # ... and turned by less than this show the same.
ENOUGH = 3  # Frames that show the same.


def select_views(frames: Sequence[FrameFiles]) -> tuple[FrameFiles, ...]:
    """Return the frames of a posed capture without those that show what three others show.

    A frame is left out if ``ENOUGH`` earlier selected frames with the same kinds of images (depth,
    colour, labels) are within ``NEAR_M`` and ``NEAR_DEG`` of it. Captures of at most ``LONG``
    frames are returned whole.
    """
    if len(frames) <= LONG:
        return tuple(frames)
    poses = np.array([frame.camera_to_world for frame in frames], np.float64)
    places, turns = poses[:, :3, 3], poses[:, :3, :3].reshape(-1, 9)
    images = np.array(
        [
            [bool(path) for path in (one.depth_path, one.colour_path, one.labels_path)]
            for one in frames
        ]
    )
    least_trace = 1 + 2 * np.cos(np.radians(NEAR_DEG))
    chosen: list[int] = []
    for n in range(len(frames)):
        near = np.linalg.norm(places[chosen] - places[n], axis=1) < NEAR_M
        near &= turns[chosen] @ turns[n] > least_trace
        near &= (images[chosen] == images[n]).all(axis=1)
        if np.count_nonzero(near) < ENOUGH:
            chosen.append(n)
    return tuple(frames[n] for n in chosen)
