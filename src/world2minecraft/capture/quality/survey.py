"""The results of a quick survey of a capture."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.quality.picture_quality import (
    Picture,
    neighbour_overlaps,
    sample_pictures,
)
from world2minecraft.capture.quality.top_view import TopView, make_top_view
from world2minecraft.capture.quality.view_directions import ViewDirections, count_view_directions
from world2minecraft.capture.validation import ValidatedCapture

PICTURES_POSED = 40  # Where poses tell what was seen, a sample of pictures is enough.


@dataclass(frozen=True, eq=False)
class Survey:
    """The results of a quick survey of a capture.

    Attributes:
        validated: The validated capture.
        pictures: Sampled images with their quality.
        shares: Share of each image that the next image shows too, float64 [len(pictures) - 1]; NaN
            if unknown.
        plan: Top view, or None without poses.
        directions: Covered view directions, or None without poses.
    """

    validated: ValidatedCapture
    pictures: tuple[Picture, ...]
    shares: np.ndarray
    plan: TopView | None
    directions: ViewDirections | None


def survey_capture(validated: ValidatedCapture) -> Survey:
    """Sample images of a validated capture and, if it has poses, render a top view."""
    if validated.posed:
        pictures = sample_pictures(validated.frames, PICTURES_POSED)
        plan = make_top_view(validated)
        lenses = [frame.colour_camera or frame.depth_camera for frame in validated.frames]
        # With depth, how much neighbours share matters little; stereo lives of it.
        unknown = np.full(max(0, len(pictures) - 1), np.nan)
        shares = unknown if validated.has_depth else neighbour_overlaps(pictures)
        seen = count_view_directions(lenses, plan.cameras)
        return Survey(validated, tuple(pictures), shares, plan, seen)
    pictures = sample_pictures(validated.frames)
    return Survey(validated, tuple(pictures), neighbour_overlaps(pictures), None, None)
