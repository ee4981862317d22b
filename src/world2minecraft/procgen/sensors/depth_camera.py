"""Simulation of consumer depth cameras from exact depth.

``rgbd`` simulates a structured-light sensor: axial noise that grows with the square of the
distance, depth quantized in disparity steps, missing pixels at edges and on dark or grazing
surfaces, and holes. ``clean`` gives exact depth and exact poses. ``photo``, ``photos`` and
``video`` are phones without depth (see ``phone``).
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.geometry.rotations import rotation_from_vector

BASELINE_M = 0.075  # Between projector and camera, of the sensors that the model follows.
NATIVE_WIDTH_PX = 640  # Disparity is counted in pixels of the sensor, whatever size is handed out.
BEND_AT_M = 2.5  # Depth at which the smooth error of a depth camera is stated.
EDGE_SHARE = 0.03  # A step between neighbours of over 3 % of the depth, and 3 cm, is an edge.


@dataclass(frozen=True)
class Sensor:
    """The noise parameters of a sensor. Zero disables an effect.

    The defaults are those of ``rgbd``: axial sigma 1.2 mm + 1.9 mm x (z - 0.4 m)^2, disparity steps
    of 1/8 px, 2 % holes, pose jitter of 5 mm and 0.2 degrees, range 0.4 to 5 m.
    """

    sigma_m: float = 0.0012
    sigma_growth: float = 0.0019
    disparity_step_px: float = 0.125
    edge_px: int = 1
    hole_share: float = 0.02
    dark_below: float = 36.0  # Luminance, 0 to 255; half of that is lost for certain.
    grazing_cosine: float = 0.20  # 78 degrees from square; half of it is lost for certain.
    range_m: tuple[float, float] = (0.4, 5.0)
    jitter_m: float = 0.005
    jitter_deg: float = 0.2
    colour_sigma: float = 1.5


CLEAN = Sensor(0.0, 0.0, 0.0, 0, 0.0, 0.0, 0.0, (0.0, np.inf), 0.0, 0.0, 0.0)
PHONES = ("photo", "photos", "video")  # Without depth; ``photo`` alone states its poses.
SENSORS = {"rgbd": Sensor(), "clean": CLEAN} | dict.fromkeys(PHONES, CLEAN)


def find_sensor(name: str) -> Sensor:
    """Return a sensor by name.

    Raises:
        UnknownNameError: If the sensor is unknown.
    """
    if name not in SENSORS:
        raise UnknownNameError("sensor", name, SENSORS)
    return SENSORS[name]


def sense_depth(
    model: Sensor,
    depth_m: np.ndarray,
    cosine: np.ndarray,
    luminance: np.ndarray,
    fx_px: float,
    rng: np.random.Generator,
) -> np.ndarray:
    """Simulate the measured depth of a frame as float32 [H, W], with 0 for missing pixels.

    Args:
        model: The sensor.
        depth_m: Exact z-depth as float32 [H, W], 0 if there is no surface.
        cosine: Cosine between ray and surface normal, float32 [H, W].
        luminance: Luminance of the image, 0 to 255, float32 [H, W].
        fx_px: The focal length of this image in pixels.
        rng: Random generator for the noise of this frame.
    """
    focal_px = fx_px * NATIVE_WIDTH_PX / depth_m.shape[1]
    noise = rng.standard_normal(depth_m.shape, np.float32)
    sensed = depth_m + noise * axial_sigma_m(model, depth_m)
    sensed = quantize_disparity(model, sensed, focal_px)
    lost = (depth_m <= 0) | (sensed < model.range_m[0]) | (sensed > model.range_m[1])
    if model.edge_px:
        lost |= depth_edges(depth_m)
    lost |= _holes(model, depth_m.shape, rng)
    chance = np.maximum(_below(luminance, model.dark_below), _below(cosine, model.grazing_cosine))
    lost |= rng.random(depth_m.shape, np.float32) < chance
    return np.where(lost, np.float32(0), sensed).astype(np.float32)


def axial_sigma_m(model: Sensor, depth_m: np.ndarray) -> np.ndarray:
    """Return the standard deviation of the measured depth at given depths, in metres."""
    return np.float32(model.sigma_m) + np.float32(model.sigma_growth) * (depth_m - 0.4) ** 2


def quantize_disparity(model: Sensor, depth_m: np.ndarray, focal_px: float) -> np.ndarray:
    """Round depths so that the disparity is a multiple of the sensor's disparity step."""
    if not model.disparity_step_px:
        return depth_m
    reach = np.float32(focal_px * BASELINE_M / model.disparity_step_px)
    steps = np.round(reach / np.maximum(depth_m, 1e-3))
    return reach / np.maximum(steps, 1)


def bend_depth(depth_m: np.ndarray, bend_m: float, rng: np.random.Generator) -> np.ndarray:
    """Return depth with the smooth error of an uncalibrated depth camera, float32 [H, W].

    Args:
        depth_m: Depth in metres, float32 [H, W]; 0 stays 0.
        bend_m: Largest error at a depth of ``BEND_AT_M``. It grows with the square of the depth.
        rng: Random generator for the shape of the error.
    """
    v, u = (np.linspace(-1, 1, side) for side in depth_m.shape)
    v, u = v[:, None], u[None]
    a, b, c, d, e = rng.normal(size=5)
    bend = a * u**2 + b * v**2 + c * u * v + d * np.sin(2.5 * u) + e * np.sin(2.5 * v)
    bend -= bend.mean()
    bend *= bend_m / np.abs(bend).max()
    return np.where(depth_m > 0, depth_m + bend * (depth_m / BEND_AT_M) ** 2, 0).astype(np.float32)


def depth_edges(depth_m: np.ndarray) -> np.ndarray:
    """Return which pixels differ strongly in depth from one of their four neighbours."""
    found = np.zeros(depth_m.shape, bool)
    for axis in (0, 1):
        a, b = np.moveaxis(depth_m, axis, 0)[:-1], np.moveaxis(depth_m, axis, 0)[1:]
        step = np.abs(a - b) > np.maximum(EDGE_SHARE * np.minimum(a, b), 0.03)
        rows = np.moveaxis(found, axis, 0)
        rows[:-1] |= step
        rows[1:] |= step
    return found


def _holes(model: Sensor, shape: tuple[int, ...], rng: np.random.Generator) -> np.ndarray:
    """Return random holes of 2 x 2 pixels that cover the sensor's share of the image."""
    half = rng.random(((shape[0] + 1) // 2, (shape[1] + 1) // 2), np.float32) < model.hole_share
    return half.repeat(2, axis=0).repeat(2, axis=1)[: shape[0], : shape[1]]


def _below(values: np.ndarray, limit: float) -> np.ndarray:
    """Return a probability that rises from 0 at ``limit`` to 1 at half of it."""
    if not limit:
        return np.zeros(values.shape, np.float32)
    return np.clip((limit - values) / np.float32(limit / 2), 0, 1)


def jitter_pose(model: Sensor, camera_to_room: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return a camera pose with the random error of the sensor's tracking."""
    shift = rng.standard_normal(3) * model.jitter_m
    angles = np.radians(rng.standard_normal(3) * model.jitter_deg)
    stated = camera_to_room.copy()
    stated[:3, :3] = camera_to_room[:3, :3] @ rotation_from_vector(angles)
    stated[:3, 3] += shift
    return stated


def scale_factor(sigma: float, rng: np.random.Generator) -> float:
    """Return a random depth scale of a frame, normal around 1 and clipped to 3 ``sigma``."""
    return 1.0 + sigma * float(np.clip(rng.standard_normal(), -3, 3))
