"""Rotation of captures whose images lie on their side.

A phone held upright stores its pictures as its sensor lies: sideways. Where the capture states
which way is up in its world, the poses tell by how many quarter turns most of its images are off.
All images, cameras and poses are then rotated together: each pixel's ray in the world stays the
same.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.images import (
    ImageHeader,
    ImagePlace,
    check_whole,
    read_colour,
    read_header,
    read_raw,
)
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.types import Camera

MIN_UP_IN_IMAGE = 0.3  # A camera within 17 degrees of straight up or down does not tell its roll.
TURN_DESCRIPTIONS = {
    1: "a quarter turn to the left",
    2: "half a turn",
    3: "a quarter turn to the right",
}
# The camera after one turn of the image, counter-clockwise: its right was down, its down was left.
_TURNED_TO_CAMERA = np.array(
    [[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)


@dataclass(frozen=True)
class RotatedImage:
    """An ``ImageSource``: another image, turned counter-clockwise by quarter turns."""

    image: ImagePlace
    quarter_turns: int

    def __str__(self) -> str:
        """The name of the image that is turned."""
        return str(self.image)

    @property
    def stem(self) -> str:
        """The name without suffix of the image that is turned."""
        return self.image.stem

    @property
    def name(self) -> str:
        """The name of the image that is turned."""
        return self.image.name

    def header(self) -> ImageHeader:
        """Return the size after the turn."""
        header = read_header(self.image)
        if self.quarter_turns % 2 == 0:
            return header
        return ImageHeader(header.height_px, header.width_px, header.mode)

    def check_whole(self) -> None:
        """Check the image that is turned."""
        check_whole(self.image)

    def colour(self) -> np.ndarray:
        """Return uint8 [H, W, 3] sRGB."""
        return np.ascontiguousarray(np.rot90(read_colour(self.image), self.quarter_turns))

    def raw(self) -> np.ndarray:
        """Return [H, W] values as stored."""
        return np.ascontiguousarray(np.rot90(read_raw(self.image), self.quarter_turns))


def find_quarter_turns(frames: Sequence[FrameFiles], world_up: np.ndarray) -> int:
    """Return by how many quarter turns, counter-clockwise, most images must be turned.

    Args:
        frames: with rigid poses.
        world_up: float64 [3], a unit vector of the poses' world.

    Returns:
        0 to 3; 0 where no more than half of the images that tell it agree: turning all of them
        would harm as many as it helps.
    """
    poses = [frame.camera_to_world for frame in frames if frame.camera_to_world is not None]
    if not poses:
        return 0
    up = np.stack([np.asarray(pose)[:3, :3].T @ world_up for pose in poses])[:, :2]
    informative = up[np.linalg.norm(up, axis=1) > MIN_UP_IN_IMAGE]
    if not len(informative):
        return 0
    # Of up in the image: above, right of it, below, left of it.
    sides = informative @ np.array([[0.0, 1.0, 0.0, -1.0], [-1.0, 0.0, 1.0, 0.0]])
    votes = np.bincount(sides.argmax(axis=1), minlength=4)
    return int(votes.argmax()) if votes.max() > 0.5 * len(informative) else 0


def rotate_frame(frame: FrameFiles, quarter_turns: int) -> FrameFiles:
    """Return a frame whose images, lenses and pose are turned; its geometry stays the same."""
    if quarter_turns % 4 == 0:
        return frame
    turned_to_camera = np.linalg.matrix_power(_TURNED_TO_CAMERA, quarter_turns % 4)
    pose = frame.camera_to_world
    return replace(
        frame,
        camera_to_world=None if pose is None else pose @ turned_to_camera,
        depth_to_colour=turned_to_camera.T @ frame.depth_to_colour @ turned_to_camera,
        colour_path=_rotate_image(frame.colour_path, quarter_turns),
        colour_camera=_rotate_optional_camera(frame.colour_camera, quarter_turns),
        depth_path=_rotate_image(frame.depth_path, quarter_turns),
        depth_camera=_rotate_optional_camera(frame.depth_camera, quarter_turns),
        labels_path=_rotate_image(frame.labels_path, quarter_turns),
        trust_path=_rotate_image(frame.trust_path, quarter_turns),
    )


def rotate_camera(camera: Camera, quarter_turns: int) -> Camera:
    """Return the camera of an image that is turned counter-clockwise by quarter turns."""
    for _ in range(quarter_turns % 4):
        k1, k2, p1, p2, k3 = camera.distortion
        camera = Camera(
            camera.height_px,
            camera.width_px,
            camera.fy_px,
            camera.fx_px,
            camera.cy_px,
            camera.width_px - camera.cx_px,
            (k1, k2, -p2, p1, k3),
        )
    return camera


def _rotate_image(image: ImagePlace | None, quarter_turns: int) -> ImagePlace | None:
    return None if image is None else RotatedImage(image, quarter_turns % 4)


def _rotate_optional_camera(camera: Camera | None, quarter_turns: int) -> Camera | None:
    return None if camera is None else rotate_camera(camera, quarter_turns)
