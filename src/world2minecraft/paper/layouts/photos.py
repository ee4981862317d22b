"""A few photos of a capture, spread evenly over it, as a model is shown them."""

from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.capture.images import read_colour
from world2minecraft.capture.sources import find_capture
from world2minecraft.core.errors import CaptureError
from world2minecraft.external_models.chat_messages import Picture
from world2minecraft.paper.layouts.judge import QUALITY
from world2minecraft.rendering.output.images import colour_bytes

LONGEST_PX = 1024


def capture_photos(place: Path, count: int) -> list[Picture]:
    """Return at most ``count`` photos of a capture, JPEG, 1,024 pixels long at most.

    Raises:
        CaptureError: it is no capture, or has no pictures in colour.
    """
    paths = [frame.colour_path for frame in find_capture(place).frames if frame.colour_path]
    chosen = min(count, len(paths))
    wanted = [paths[int((n + 0.5) * len(paths) / chosen)] for n in range(chosen)]
    photos = [Picture(colour_bytes(_small(read_colour(path)), ".jpg", QUALITY)) for path in wanted]
    if not photos:
        raise CaptureError(place, "has no pictures in colour; leave out --agent")
    return photos


def _small(colour: np.ndarray) -> np.ndarray:
    picture = Image.fromarray(colour)
    picture.thumbnail((LONGEST_PX, LONGEST_PX), Image.Resampling.LANCZOS)
    return np.asarray(picture)
