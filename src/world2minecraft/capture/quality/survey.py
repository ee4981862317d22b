"""``survey_capture``: the results of a quick survey of a capture."""

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
    """Results of a quick survey.

    ``shares`` float64 [len(pictures) - 1] is how much of each picture the next shows too, NaN
    where that is not known. ``plan`` and ``directions`` are None where there are no poses.
    """

    validated: ValidatedCapture
    pictures: tuple[Picture, ...]
    shares: np.ndarray
    plan: TopView | None
    directions: ViewDirections | None


def survey_capture(validated: ValidatedCapture) -> Survey:
    """Sample pictures of a validated capture and, where it has poses, lay out a plan."""
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
