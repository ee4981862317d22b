"""The processing steps of ``w2m reconstruct`` for a capture, with their duration."""

from dataclasses import dataclass
from typing import Literal

from world2minecraft.capture.validation import ValidatedCapture

Kind = Literal["rgbd", "posed photos", "photos", "video", "unposed rgbd", "solid"]
# Seconds on two cores: rgbd from the kitchen's 40 frames (10 s in all), pictures from 100 of a
# generated room.
BUILD_S, FRAME_S, POSE_S, STEREO_S = 6.0, 0.1, 0.7, 0.7


@dataclass(frozen=True)
class Route:
    """The processing steps for one kind of input.

    Attributes:
        kind: Kind of input.
        called: Name of the input for users.
        words: Description of the processing steps.
        about_s: Expected duration in seconds.
    """

    kind: Kind
    called: str
    words: str
    about_s: float

    @property
    def about(self) -> str:
        """The expected duration, rounded, as text."""
        if self.about_s < 60:
            return f"about {max(10, round(self.about_s / 10) * 10)} s"
        return f"about {round(self.about_s / 60)} min"

    @property
    def from_pictures(self) -> bool:
        """Whether depth is computed from the images."""
        return self.kind in ("posed photos", "photos", "video")


_INPUT_NAMES = {
    "rgbd": "posed RGB-D frames",
    "posed photos": "images with poses, without depth",
    "photos": "photos without poses",
    "video": "a video without poses",
    "unposed rgbd": "RGB-D frames without poses",
    "solid": "a mesh or point cloud, rendered from inside",
}
_DESCRIPTIONS = {
    "rgbd": "depth and poses are used as stated",
    "posed photos": "poses are checked and depth is computed from the images",
    "photos": "poses and depth are computed from the images",
    "video": "poses and depth are computed from the sharpest frames",
    "unposed rgbd": "poses are computed from the images, and their scale from the depth",
    "solid": "depth images are rendered with virtual cameras",
}


def choose_route(validated: ValidatedCapture) -> Route:
    """Return the processing route of a validated capture."""
    kind = _kind(validated)
    each = FRAME_S
    if kind in ("photos", "video", "unposed rgbd"):
        each += POSE_S
    if kind in ("photos", "video", "posed photos"):
        each += STEREO_S
    return Route(
        kind, _INPUT_NAMES[kind], _DESCRIPTIONS[kind], BUILD_S + each * len(validated.frames)
    )


def _kind(validated: ValidatedCapture) -> Kind:
    source = validated.capture.source
    if source.startswith("solid"):  # Rendered sequences have exact depth too, and are frames.
        return "solid"
    if validated.has_depth:
        return "rgbd" if validated.posed else "unposed rgbd"
    if validated.posed:
        return "posed photos"
    return "video" if source == "video" else "photos"
