"""Depth of every photo: swept alone, confirmed by others, filled where planes say how."""

from collections.abc import Iterator

import numpy as np

from world2minecraft.capture.stereo.agree import confirm
from world2minecraft.capture.stereo.downscaled_photos import SmallPhoto, small_photos
from world2minecraft.capture.stereo.guide import DepthModel, filled
from world2minecraft.capture.stereo.islands import without_islands
from world2minecraft.capture.stereo.neighbours import DEPTH_PERCENTILES, chosen_neighbours
from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.capture.stereo.planar_regions import flattened
from world2minecraft.capture.stereo.sweep import depth_range, sweep
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.progress import Progress, silent
from world2minecraft.core.types import DepthMap, PhotoStream, SparseScene
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.rendering.thread_pool import side_by_side

AT_ONCE = 2  # Photos swept side by side; each needs about 60 MB.
TRUST = np.array([30, 60, 130, 180, 255], np.uint8)  # By how many confirm it, 4 or more wholly.
DECIDING = 160  # Trust of depth that may decide where a flat patch lies.
GUESSED = np.uint8(96)
GUESSES_AGREEING = 2  # Two photos may guess alike by chance; three hardly.
LEAST_GUIDES = 20
STAGE = "stereo"


def depth_maps(
    photos: PhotoStream,
    scene: SparseScene,
    parameters: StereoParameters | None = None,
    progress: Progress = silent,
    guide: DepthModel | None = None,
) -> Iterator[DepthMap]:
    """Yield the depth of each photo of a scene, in its order.

    Args:
        photos: read once; those that the scene does not name are left out.
        scene: where they were taken, in any unit; the depths are in the same.
        parameters: how.
        progress: told of the stage ``stereo``.
        guide: a network that fills what stays open, with low trust; see guide.py.

    Raises:
        CaptureError: no photo has another that sees the same, or one is missing.
    """
    values = parameters or StereoParameters()
    small = small_photos(photos, scene, values.width_px, silent)
    swept, neighbours = swept_depths(small, values, progress)
    found = [confirmed(n, small, swept, neighbours, values) for n in range(len(small))]
    every_m = np.concatenate([photo.guide_m for photo in small])
    guesses = [_flattened(one, p, every_m) for one, p in zip(found, small, strict=True)]
    guesses_m = [guess_m for guess_m, _ in guesses]
    for number, photo in enumerate(small):
        votes, _ = votes_of(number, small, guesses_m, neighbours[number], values.agreement)
        agreed = votes >= max(values.agreeing, GUESSES_AGREEING)
        result = _with_guess(found[number], *guesses[number], agreed)
        yield result if guide is None else _guided(result, photo, guide)
        progress(STAGE, len(small) + number + 1, 2 * len(small), photo.name)


def _flattened(
    found: DepthMap, photo: SmallPhoto, every_m: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a guess at flat patches; see flats.py."""
    sure = found.trust >= DECIDING
    return flattened(photo.colour, found.depth_m, sure, depth_range(photo, every_m))


def _with_guess(
    found: DepthMap, guess_m: np.ndarray, guessed: np.ndarray, agreed: np.ndarray
) -> DepthMap:
    """Take the guess where others agree; where they do not, what it contradicts goes too."""
    depth_m = np.where(guessed, np.where(agreed, guess_m, np.float32(0)), found.depth_m)
    trust = np.where(guessed, np.where(agreed, GUESSED, np.uint8(0)), found.trust)
    return DepthMap(found.name, found.camera, depth_m, trust)


def _guided(found: DepthMap, photo: SmallPhoto, guide: DepthModel) -> DepthMap:
    """Fill what is open by a network's guess."""
    guess = guide.predict(photo.colour, photo.camera)
    depth_m, trust = filled(
        found.depth_m, found.trust, guess, guide.kind, photo.guide_px, photo.guide_m
    )
    return DepthMap(found.name, found.camera, depth_m, trust)


def swept_depths(
    small: list[SmallPhoto], values: StereoParameters, progress: Progress = silent
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return each photo's depth float32 [h, w] by itself, and the numbers of its neighbours."""
    every_m = np.concatenate([photo.guide_m for photo in small])
    if not len(every_m):
        raise CaptureError("photos", "share no points; depth cannot be found: take more, nearer")
    known = [p.guide_m if len(p.guide_m) > LEAST_GUIDES else every_m for p in small]
    usual = np.array([np.percentile(found, DEPTH_PERCENTILES) for found in known])
    neighbours = chosen_neighbours(small, usual, values.neighbours, values.angle_deg)
    if not any(len(found) for found in neighbours):
        raise CaptureError(
            "photos", "no two see the same from places far enough apart: take steps aside"
        )
    swept: list[np.ndarray] = [np.zeros(0, np.float32)] * len(small)

    def one(number: int) -> None:
        others = [small[other] for other in neighbours[number]]
        swept[number] = _swept(small[number], others, every_m, values)

    for first in range(0, len(small), AT_ONCE):
        side_by_side(one, range(first, min(first + AT_ONCE, len(small))))
        done = min(first + AT_ONCE, len(small))
        progress(STAGE, done, 2 * len(small), small[done - 1].name)
    return swept, neighbours


def _swept(
    photo: SmallPhoto, others: list[SmallPhoto], every_m: np.ndarray, values: StereoParameters
) -> np.ndarray:
    if not others:
        return np.zeros((photo.camera.height_px, photo.camera.width_px), np.float32)
    return sweep(photo, others, depth_range(photo, every_m), values)


def confirmed(
    number: int,
    small: list[SmallPhoto],
    swept: list[np.ndarray],
    neighbours: list[np.ndarray],
    values: StereoParameters,
) -> DepthMap:
    """Return the depth of a photo that its neighbours' depths confirm."""
    photo = small[number]
    votes, mean = votes_of(number, small, swept, neighbours[number], values.agreement)
    asked = max(1, len(neighbours[number]))
    depth_m = np.where(votes >= min(values.agreeing, asked), mean, np.float32(0))
    least_px = round(values.island_share * depth_m.size)
    depth_m = without_islands(depth_m, least_px, values.island_step)
    trust = TRUST[np.clip(4 - min(asked, 4) + votes, 0, 4)]
    return DepthMap(photo.name, photo.camera, depth_m, np.where(depth_m > 0, trust, np.uint8(0)))


def votes_of(
    number: int,
    small: list[SmallPhoto],
    swept: list[np.ndarray],
    others: np.ndarray,
    agreement: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return how many others confirm each pixel's depth, uint8 [h, w], and the mean depth."""
    photo = small[number]
    votes = np.zeros(swept[number].shape, np.uint8)
    mean = swept[number].copy()
    if not len(others):
        return votes, mean
    # Photos upright and lying have other shapes; each shape is asked at once.
    total = np.zeros(votes.shape, np.float64)
    for shape in sorted({swept[other].shape for other in others}):
        same = [other for other in others if swept[other].shape == shape]
        found, middle = confirm(
            swept[number], pixel_rays(photo.camera),
            np.stack([swept[other] for other in same]),
            np.array([invert_rigid(small[o].camera_to_scan) @ photo.camera_to_scan for o in same]),
            np.array([_lens(small[other]) for other in same]), agreement,
        )  # fmt: skip
        total += middle.astype(np.float64) * (found + 1.0) - swept[number]
        votes += found
    return votes, ((total + swept[number]) / (votes + 1.0)).astype(np.float32)


def _lens(photo: SmallPhoto) -> list[float]:
    camera = photo.camera
    return [camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px]
