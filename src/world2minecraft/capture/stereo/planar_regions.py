"""Plane fitting for surfaces without texture or with gloss, from the depth at their borders.

A region of uniform colour contains nothing to match, or only reflections, whose depth is too large.
Its border, however, has edges, and a region of uniform colour is usually a single plane. The
estimates are used only where the estimates of other photos agree.
"""

import numpy as np
from scipy import ndimage

# Levels between the brightest and darkest of 3x3 pixels that are of one colour.
MAX_LEVEL_RANGE = 20
MIN_PATCH_SHARE = 0.002  # Minimum share of the image.
RIM_PX = 3  # To either side of a patch's outline; windows reach no farther.
MIN_RIM_PX = 40
MIN_INLIER_SHARE = 0.5  # Minimum share of the rim's depths on the plane.
TOLERANCE = 0.02  # Share of the depth; less than the difference at which photos agree.
# Of the depth: what is found so far behind the rim's plane is a reflection.
REFLECTION_SHARE = 0.04
RANSAC_TRIALS = 80  # A plane that holds half of the rim is missed once in 40,000.


def fill_planar_regions(
    colour: np.ndarray, depth_m: np.ndarray, sure: np.ndarray, range_m: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Estimate the depth of uniformly coloured regions from planes fitted to their borders.

    Args:
        colour: Image, uint8 [h, w, 3].
        depth_m: z-depth, float32 [h, w]; 0 if missing.
        sure: Pixels whose depth may be used to fit planes, bool [h, w].
        range_m: Smallest and largest plausible depth.

    Returns:
        The depth as float32 [h, w] with regions filled and reflections replaced, and the changed
        pixels as bool [h, w].
    """
    guess_m, guessed = depth_m.copy(), np.zeros(depth_m.shape, bool)
    patches, boxes = _uniform_patches(colour)
    for number, box in boxes:
        mask = patches[box] == number
        rim = _rim(mask) & sure[box] & (depth_m[box] > 0)
        if rim.sum() < MIN_RIM_PX:
            continue
        v, u = np.nonzero(rim)
        plane = _fit_plane(u, v, 1 / depth_m[box][rim].astype(np.float64))
        if plane is None:
            continue
        y, x = np.indices(mask.shape)
        inverse = plane[0] * x + plane[1] * y + plane[2]
        inside = mask & (inverse > 1 / range_m[1]) & (inverse < 1 / range_m[0])
        plane_m = (1 / np.where(inside, inverse, 1)).astype(np.float32)
        here = depth_m[box]
        change = inside & ((here == 0) | (here > plane_m * (1 + REFLECTION_SHARE)))
        guess_m[box][change] = plane_m[change]
        guessed[box] |= change
    return guess_m, guessed


def _uniform_patches(colour: np.ndarray):
    """Return numbered regions of uniform colour, and the boxes of the larger ones."""
    highest = np.asarray(ndimage.maximum_filter(colour, (3, 3, 1)), np.int16)
    lowest = np.asarray(ndimage.minimum_filter(colour, (3, 3, 1)), np.int16)
    even = (highest - lowest).max(axis=2) < MAX_LEVEL_RANGE
    patches = np.zeros(even.shape, np.int32)
    ndimage.label(even, output=patches)
    sizes = np.bincount(patches.reshape(-1))
    boxes = []
    for number, box in enumerate(ndimage.find_objects(patches), 1):
        if sizes[number] >= MIN_PATCH_SHARE * patches.size:
            wider = [slice(max(0, s.start - RIM_PX - 1), s.stop + RIM_PX + 1) for s in box]
            boxes.append((number, tuple(wider)))
    return patches, boxes


def _rim(mask: np.ndarray) -> np.ndarray:
    """Return the pixels near the border of a region, inside and outside."""
    outer = np.asarray(ndimage.binary_dilation(mask, iterations=RIM_PX), bool)
    inner = np.asarray(ndimage.binary_erosion(mask, iterations=RIM_PX), bool)
    return outer & ~inner


def _fit_plane(u: np.ndarray, v: np.ndarray, inverse: np.ndarray) -> np.ndarray | None:
    """Return (a, b, c) of the plane ``1/z = a u + b v + c`` with the most inliers, or None.

    In inverse depth, a plane is linear in the pixel coordinates.
    """
    points = np.stack([u, v, np.ones(len(u))], axis=1)
    chosen = np.random.default_rng(0).integers(0, len(u), (RANSAC_TRIALS, 3))
    corners = points[chosen]
    proper = np.abs(np.linalg.det(corners)) > 1
    if not proper.any():
        return None
    planes = np.linalg.solve(corners[proper], inverse[chosen[proper]][..., None])[..., 0]
    held = np.abs(planes @ points.T - inverse) < TOLERANCE * inverse
    plane = planes[held.sum(axis=1).argmax()]
    for _ in range(2):
        held = np.abs(points @ plane - inverse) < TOLERANCE * inverse
        if held.sum() < 3:
            return None
        plane = np.linalg.lstsq(points[held], inverse[held], rcond=None)[0]
    held = np.abs(points @ plane - inverse) < TOLERANCE * inverse
    return plane if held.mean() >= MIN_INLIER_SHARE else None
