"""Augmentation of labelled frames: windows, lenses, light, sensor noise and missing channels.

All random numbers come from one generator, so a seed and a step determine the batch.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.jit import njit
from world2minecraft.geometry.rotations import rotation_from_vector
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.networks.segmentation.frames import FLOOR, IGNORED, LabelledFrame
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    COLOUR_MEAN,
    COLOUR_SPREAD,
    GEOMETRY_CHANNELS,
    NORMAL_RIGHT,
    channels_of_fine_depth,
    network_size,
    sample_nearest,
)

CROP = (256, 192)
SCALES = (0.72, 1.7)  # Of the image; below 0.8 the window is wider than the image.
ASPECT, TURN_DEG, TURNED = 0.1, 5.0, 0.5
NO_COLOUR, NO_DEPTH = 0.12, 0.15  # Colour and depth are never both missing.
GREY, NOISY = 0.04, 0.3
STORED, BENT, HOLES = 0.1, 0.5, 0.5  # How often depth keeps its steps, is bent, or has holes.
NOISE_PER_M = 0.0025  # Maximum depth noise in metres at one metre; it grows quadratically.
BEND, SCALE_OFF = 0.01, 0.02
UP_GIVEN, UP_SIGMA_DEG, UP_WRONG, UP_WRONG_DEG = 0.5, 1.5, 0.1, 12.0
FLOOR_GIVEN, FLOOR_SIGMA_M, FLOOR_UNSEEN = 0.4, 0.04, 0.3
MIN_FLOOR_PX = 80  # At the size of the geometry channels.


class Example(NamedTuple):
    """One example for training.

    Attributes:
        colour: Normalised colours, float32 [3, H, W].
        geometry: Geometry channels, float32 [7, H / 2, W / 2].
        labels: Classes, uint8 [H / 2, W / 2].
    """

    colour: np.ndarray
    geometry: np.ndarray
    labels: np.ndarray


def draw_example(
    frame: LabelledFrame, rng: np.random.Generator, crop: tuple[int, int] = CROP
) -> Example:
    """Draw a random window of a frame, with random light, sensor noise and missing channels.

    Args:
        frame: Labelled frame.
        rng: Random generator.
        crop: Width and height of the window in pixels of the network, which are even.
    """
    width, height = crop
    window, is_mirrored = _draw_window(frame, rng, crop)
    missing = rng.random()
    half = (height // 2, width // 2)
    colour = np.zeros((3, height, width), np.float32)
    if missing >= NO_COLOUR:
        colour = _lit(warp_colour(frame.colour, window, (height, width)), rng)
    geometry = np.zeros((GEOMETRY_CHANNELS, *half), np.float32)
    if missing < NO_COLOUR or missing >= NO_COLOUR + NO_DEPTH:
        given = _draw_geometry(frame, rng)
        geometry = warp_nearest(given, window, half, np.float32(0))
        if is_mirrored:
            geometry[NORMAL_RIGHT] *= -1
    labels = warp_nearest(frame.labels[None], window, half, np.uint8(IGNORED))[0]
    return Example(colour, geometry, labels)


def _draw_window(
    frame: LabelledFrame, rng: np.random.Generator, crop: tuple[int, int]
) -> tuple[np.ndarray, bool]:
    """Return the map from positions in the result to those in the image, both 0 to 1."""
    full = network_size(frame.camera.width_px, frame.camera.height_px)
    scale = np.exp(rng.uniform(*np.log(SCALES)))
    stretch = np.exp(rng.uniform(-ASPECT, ASPECT) / 2)
    sides = np.array([crop[0] / scale * stretch, crop[1] / scale / stretch])  # In its pixels.
    spare = np.array(full) - sides
    middle = np.array(full) / 2 + np.abs(spare) / 2 * rng.uniform(-1, 1, 2)
    angle = np.deg2rad(rng.uniform(-TURN_DEG, TURN_DEG)) * (rng.random() < TURNED)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    is_mirrored = bool(rng.random() < 0.5)
    linear = turn @ np.diag(sides * [-1 if is_mirrored else 1, 1])
    window = np.column_stack([linear, middle - linear @ [0.5, 0.5]]) / np.array(full)[:, None]
    return window, is_mirrored


def _lit(colour: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Change light, contrast, saturation and noise of colours [3, H, W], and normalise them."""
    share = colour * np.float32(1 / 255)
    share = share ** np.float32(np.exp(rng.uniform(-0.4, 0.4)))
    grey = share.mean(axis=0, keepdims=True)
    saturation = 0.0 if rng.random() < GREY else rng.uniform(0.6, 1.4)
    share = grey + (share - grey) * np.float32(saturation)
    gain = np.exp(rng.uniform(-0.25, 0.25)) * np.exp(rng.uniform(-0.1, 0.1, 3))
    share *= gain.astype(np.float32)[:, None, None]
    share = (share - np.float32(0.45)) * np.float32(rng.uniform(0.75, 1.25)) + np.float32(0.45)
    if rng.random() < NOISY:
        sigma = np.float32(rng.uniform(0, 0.05))
        share += rng.standard_normal(share.shape, np.float32) * sigma
    np.clip(share, 0, 1, out=share)
    return (share * 255 - _column(COLOUR_MEAN)) / _column(COLOUR_SPREAD)


def _column(values: tuple[float, float, float]) -> np.ndarray:
    return np.array(values, np.float32)[:, None, None]


def _draw_geometry(frame: LabelledFrame, rng: np.random.Generator) -> np.ndarray:
    """Return the geometry channels of a frame with noise, with up and floor known or unknown."""
    depth_m = frame.stored_m if rng.random() < STORED else frame.depth_m
    rays = pixel_rays(frame.depth_camera)
    depth_m = _noisy(depth_m, rays, rng)
    up = height_m = rows = None
    given = rng.random(3)
    if given[0] < UP_GIVEN or given[1] < FLOOR_GIVEN:
        up = frame.up
        if given[1] < FLOOR_GIVEN:
            height_m = floor_height(frame, up)
        if given[0] < UP_GIVEN:
            off = UP_WRONG_DEG if rng.random() < UP_WRONG else UP_SIGMA_DEG
            up = rotation_from_vector(np.deg2rad(off) * rng.standard_normal(3)) @ up
        else:
            up = None
    if height_m is not None:
        height_m += FLOOR_SIGMA_M * float(rng.standard_normal())
    elif given[2] < FLOOR_UNSEEN:
        rows = int(len(depth_m) * rng.uniform(0.4, 1))
    return channels_of_fine_depth(depth_m, rays, up, height_m, rows)


def floor_height(frame: LabelledFrame, up: np.ndarray) -> float | None:
    """Return the height of the camera above the labelled floor in metres, or None without one."""
    labels = sample_nearest(frame.labels, frame.depth_m.shape[1], frame.depth_m.shape[0])
    seen = (labels == FLOOR) & (frame.depth_m > 0)
    if seen.sum() < MIN_FLOOR_PX:
        return None
    rays = pixel_rays(frame.depth_camera)[seen]
    return -float(np.median(frame.depth_m[seen] * (rays @ up[:2] + up[2])))


def _noisy(depth_m: np.ndarray, rays: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return depth with noise, a wrong scale, a bend and holes."""
    known, shape = depth_m > 0, (depth_m.shape[0], depth_m.shape[1])
    result = depth_m * np.float32(1 + SCALE_OFF * rng.standard_normal())
    if rng.random() < BENT:
        bend = (BEND * rng.standard_normal(3)).astype(np.float32)
        x, y = rays[..., 0], rays[..., 1]
        result = result * (1 + bend[0] * x + bend[1] * y + bend[2] * 2 * (x * x + y * y))
    coarse = int(rng.integers(1, 4))
    grains = (-(-shape[0] // coarse), -(-shape[1] // coarse))
    noise = rng.standard_normal(grains, np.float32)
    noise = noise.repeat(coarse, axis=0).repeat(coarse, axis=1)[: shape[0], : shape[1]]
    sigma = np.float32(NOISE_PER_M * rng.random() ** 2)
    result = np.maximum(result + sigma * result * result * noise, 0)
    if rng.random() < HOLES:
        known &= ~_draw_holes(shape, rng)
    return np.where(known, result, 0).astype(np.float32)


def _draw_holes(shape: tuple[int, ...], rng: np.random.Generator) -> np.ndarray:
    """Return a mask of random patches with ragged edges."""
    spots = rng.standard_normal((8, 10)).astype(np.float32)
    coarse = np.asarray(ndimage.zoom(spots, (3, 3), order=1), np.float32)
    coarse += 0.3 * rng.standard_normal((24, 30), np.float32)
    limit = np.quantile(coarse, 1 - 0.35 * rng.random() ** 2)
    return sample_nearest(coarse > limit, shape[1], shape[0])


def warp_colour(colour: np.ndarray, window: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Resample colours uint8 [H, W, 3] to float32 [3, *shape], with 2 x 2 samples for each pixel.

    Args:
        colour: Image.
        window: Map from positions in the result to those in the image, both 0 to 1, [2, 3].
        shape: Height and width of the result. What lies outside the image has the mean colour.
    """
    return _warp_colour(colour, window, shape, np.array(COLOUR_MEAN, np.float32))


@njit
def _warp_colour(colour, window, shape, outside):
    height, width = shape
    high, wide = colour.shape[:2]
    result = np.empty((3, height, width), np.float32)
    for i in range(height):
        for j in range(width):
            red = green = blue = np.float32(0)
            for n in range(4):
                u = (j + 0.25 + 0.5 * (n % 2)) / width
                v = (i + 0.25 + 0.5 * (n // 2)) / height
                x = (window[0, 0] * u + window[0, 1] * v + window[0, 2]) * wide - 0.5
                y = (window[1, 0] * u + window[1, 1] * v + window[1, 2]) * high - 0.5
                if not (-0.5 <= x <= wide - 0.5 and -0.5 <= y <= high - 0.5):
                    red += outside[0]
                    green += outside[1]
                    blue += outside[2]
                    continue
                x, y = min(max(x, 0.0), wide - 1.0), min(max(y, 0.0), high - 1.0)
                a, b = int(y), int(x)
                c, d = min(a + 1, high - 1), min(b + 1, wide - 1)
                q, p = np.float32(y - a), np.float32(x - b)
                one = np.float32(1)
                w0, w1, w2, w3 = (one - q) * (one - p), (one - q) * p, q * (one - p), q * p
                red += w0 * colour[a, b, 0] + w1 * colour[a, d, 0]
                red += w2 * colour[c, b, 0] + w3 * colour[c, d, 0]
                green += w0 * colour[a, b, 1] + w1 * colour[a, d, 1]
                green += w2 * colour[c, b, 1] + w3 * colour[c, d, 1]
                blue += w0 * colour[a, b, 2] + w1 * colour[a, d, 2]
                blue += w2 * colour[c, b, 2] + w3 * colour[c, d, 2]
            result[0, i, j] = red / 4
            result[1, i, j] = green / 4
            result[2, i, j] = blue / 4
    return result


@njit
def warp_nearest(image, window, shape, outside):
    """Resample an image [C, H, W] to [C, *shape] without mixing values, as ``warp_colour``."""
    height, width = shape
    channels, high, wide = image.shape
    result = np.empty((channels, height, width), image.dtype)
    for i in range(height):
        for j in range(width):
            u, v = (j + 0.5) / width, (i + 0.5) / height
            x = int(np.floor((window[0, 0] * u + window[0, 1] * v + window[0, 2]) * wide))
            y = int(np.floor((window[1, 0] * u + window[1, 1] * v + window[1, 2]) * high))
            inside = 0 <= x < wide and 0 <= y < high
            for c in range(channels):
                result[c, i, j] = image[c, y, x] if inside else outside
    return result
