"""Upright rotation of captures whose images are rotated by quarter turns.

A phone held upright stores its images in the orientation of the sensor, that is, sideways. If the
capture states the up direction of its world, the poses show the number of quarter turns by which
most images are rotated. All images, cameras and poses are then rotated together, which does not
change the ray of any pixel.
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
    """An image rotated counter-clockwise by quarter turns. It implements ``ImageSource``."""

    image: ImagePlace
    quarter_turns: int

    def __str__(self) -> str:
        """Return the name of the original image, for messages."""
        return str(self.image)

    @property
    def stem(self) -> str:
        """The name of the original image without suffix."""
        return self.image.stem

    @property
    def name(self) -> str:
        """The name of the original image."""
        return self.image.name

    @property
    def holds_label_ids(self) -> bool:
        """Whether the values are label ids."""
        return getattr(self.image, "holds_label_ids", False)

    def header(self) -> ImageHeader:
        """Return the size of the rotated image and its mode."""
        header = read_header(self.image)
        if self.quarter_turns % 2 == 0:
            return header
        return ImageHeader(header.height_px, header.width_px, header.mode)

    def check_whole(self) -> None:
        """Check that the original image is complete."""
        check_whole(self.image)

    def colour(self) -> np.ndarray:
        """Return the rotated image as sRGB, uint8 [H, W, 3]."""
        return np.ascontiguousarray(np.rot90(read_colour(self.image), self.quarter_turns))

    def raw(self) -> np.ndarray:
        """Return the rotated stored values as an array [H, W]."""
        return np.ascontiguousarray(np.rot90(read_raw(self.image), self.quarter_turns))


def find_quarter_turns(frames: Sequence[FrameFiles], world_up: np.ndarray) -> int:
    """Return the number of counter-clockwise quarter turns that make most images upright.

    Args:
        frames: Frames with rigid poses.
        world_up: Up direction in the world of the poses, unit vector float64 [3].

    Returns:
        A number from 0 to 3. The result is 0 if no rotation suits more than half of the images.
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
    """Return a frame with rotated images, intrinsics and pose, and unchanged geometry."""
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
    """Return the camera of an image that is rotated counter-clockwise by quarter turns."""
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
