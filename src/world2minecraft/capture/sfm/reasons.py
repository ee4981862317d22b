"""Why photos could not be placed, in words that tell what to do."""

from collections.abc import Iterable

import numpy as np

from world2minecraft.capture.sfm.colmap import PLACE
from world2minecraft.capture.sfm.features import Features
from world2minecraft.capture.sfm.links import Links
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera

FEW_FEATURES = 60  # A photo with fewer shows a bare wall, or is out of focus.
CHANCE = 6  # So many features match by chance.
BLURRED = 0.5  # Times the usual sharpness.
HABIT = "walk sideways around the room, with most of each picture in the next"


def left_out(photos: list[Features], placed: Iterable[int], links: Links) -> list[tuple[str, str]]:
    """Return name and reason of each photo that is not among those placed."""
    inside = set(placed)
    usual = float(np.median([photo.sharpness for photo in photos]))
    return [
        (photo.name, _reason(i, photos, inside, links, usual))
        for i, photo in enumerate(photos)
        if i not in inside
    ]


def _reason(i: int, photos: list[Features], inside: set[int], links: Links, usual: float) -> str:
    photo = photos[i]
    blurred = photo.sharpness < BLURRED * usual
    if len(photo.pixels) < FEW_FEATURES:
        return f"shows only {len(photo.pixels)} details ({'blurred' if blurred else 'bare'})"
    if blurred:
        return "is blurred: hold the camera still for each picture, with more light"
    partners = links.of(i)
    near = _nearest(i, inside, links)
    advice = f"take more pictures between {photo.name} and {photos[near].name}" if inside else HABIT
    if not partners:
        return f"shares nothing with the other photos; {advice}"
    if not inside & set(partners):
        return f"shares nothing with the photos that were placed; {advice}"
    return f"shares too little with the photos that were placed; {advice}"


def _nearest(i: int, inside: set[int], links: Links) -> int:
    """Return the placed photo that is most like one, by what both show, then by order."""
    if not inside:
        return i
    shared = np.maximum(links.alike[i] - CHANCE, 0)
    return min(inside, key=lambda j: (-shared[j], abs(i - j), j))


def check_enough(photos: list[Features], least: int) -> None:
    """Raise CaptureError where there are too few photos, or too few that show anything."""
    if len(photos) < least:
        count = "there is no photo" if not photos else f"only {len(photos)} were given"
        raise CaptureError(PLACE, f"{count}; take 20 to 60 of the room: {HABIT}")
    bare = sum(len(photo.pixels) < FEW_FEATURES for photo in photos)
    if len(photos) - bare < least:
        raise CaptureError(
            PLACE,
            f"{bare} of {len(photos)} show too few details to be placed (blank, blurred or dark); "
            "turn on the lights, step back so that furniture and corners are seen",
        )


def too_few(placed: int, given: int) -> CaptureError:
    """Return the error for photos of which only a few could be placed."""
    return CaptureError(
        PLACE,
        f"only {placed} of {given} could be placed, too few to trust; {HABIT}, and stand back so "
        "that furniture and corners are seen",
    )


def refuse(photos: list[Features], links: Links, cameras: dict[int, Camera]) -> CaptureError:
    """Return the error for photos that make no model at all."""
    linked = {i for pair in links.matches for i in pair}
    if len(linked) < 3:
        reason = f"no three of the {len(photos)} show the same things; {HABIT}"
    elif links.turned(cameras) > 0.5:
        reason = (
            "the camera turned on one spot, which shows no depth; "
            "take steps of 20 to 40 cm sideways between pictures"
        )
    elif links.flat() > 0.5:
        reason = (
            "they show little but one flat surface (floor, wall or poster), which tells neither "
            "lens nor places; hold the camera level, so that furniture and corners are seen"
        )
    else:
        reason = (
            f"{len(linked)} of the {len(photos)} share details, but too few to tell where they "
            f"were taken; {HABIT}"
        )
    return CaptureError(PLACE, reason)
