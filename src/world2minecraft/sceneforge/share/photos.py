"""The photos that go with a shared page: few, spread over the room, small."""

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import image_bytes
from world2minecraft.evaluation.scoring.used_frames import computed
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.sceneforge.run_photos import (
    PlacedPhoto,
    RunPhotos,
    read_photos,
)

# Longest side in pixels and JPEG quality, from the best to the smallest.
SIZES = ((960, 78), (720, 74), (560, 70), (420, 66))
TURN_M = 2.0  # A turn by a right angle counts as much as a move by so many metres.


@dataclass(frozen=True, eq=False)
class PagePhoto:
    """A photo of a page: its description for ``web/src/photos/place.ts``, and its JPEG."""

    facts: dict[str, Any]
    jpeg: bytes


def choose_photos(
    run: Path, capture: Path | None, most: int, budget_bytes: int
) -> tuple[PagePhoto, ...]:
    """Return up to ``most`` photos of a run that fit into a budget, in the order of the capture.

    They are made smaller until they fit, and fewer where that does not suffice.

    Args:
        run: Run folder.
        capture: Path of its capture, if the run does not contain it.
        most: Maximum number of photos.
        budget_bytes: Size of all JPEG files together.

    Raises:
        UsageError: If the run does not record its photos, or has none.
        CaptureError: If the capture cannot be read.
    """
    if most <= 0:
        return ()
    _, scan_to_room = read_room(run / "room.npz")
    place = computed(run) or capture
    if place is None:
        raise UsageError(
            f"{run.name} does not record where its photos are; add --capture DIR, the capture "
            "that it was made of"
        )
    taken = read_photos(run, place, scan_to_room)
    chosen = spread_out([one.camera_to_room for one in taken.photos], most)
    while chosen:
        for longest_px, quality in SIZES:
            files = [_small(taken, number, longest_px, quality) for number in sorted(chosen)]
            if sum(map(len, files)) <= budget_bytes:
                return tuple(
                    PagePhoto(_facts(taken.photos[number], place), jpeg)
                    for place, (number, jpeg) in enumerate(zip(sorted(chosen), files, strict=True))
                )
        chosen = chosen[: len(chosen) // 2]
    return ()


def spread_out(poses: list[np.ndarray], most: int) -> list[int]:
    """Return the indices of poses that are far from each other, the most different first.

    Args:
        poses: Camera-to-room transforms, float64 [4, 4].
        most: Maximum number of indices.
    """
    if not poses:
        return []
    places = np.array([[*pose[:3, 3], *(pose[:3, 2] * TURN_M / np.sqrt(2))] for pose in poses])
    chosen = [0]
    away = np.full(len(poses), np.inf)
    while len(chosen) < min(most, len(poses)):
        away = np.minimum(away, np.linalg.norm(places - places[chosen[-1]], axis=1))
        away[chosen[-1]] = -1.0  # Not twice, even where all are at one place.
        chosen.append(int(away.argmax()))
    return chosen


def _facts(photo: PlacedPhoto, number: int) -> dict[str, Any]:
    """Return what the page knows of a photo, without the name of the user's file."""
    facts = photo.as_json(number)
    return facts | {
        "name": f"Photo {number + 1}",
        "camera_to_room": np.round(photo.camera_to_room, 5).tolist(),
    }


def _small(taken: RunPhotos, number: int, longest_px: int, quality: int) -> bytes:
    """Return a photo as a small JPEG without metadata."""
    with Image.open(io.BytesIO(taken.jpeg(number, small=False))) as image:
        pixels = image.convert("RGB")
    pixels.thumbnail((longest_px, longest_px))
    return image_bytes(pixels, "JPEG", quality=quality, optimize=True, progressive=True)
