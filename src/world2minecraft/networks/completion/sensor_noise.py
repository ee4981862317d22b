"""Noise of virtual scans, so strong that about a quarter of the observed surface is wrong.

In real single frames, 23 % of the fused surface cells are empty in the ground truth, because of
errors in depth, pose and scale, and because annotators fitted furniture models by hand. Virtual
scans reproduce this with wrong poses, a wrong depth scale in each frame, and a ground truth that is
shifted slightly. The depth of a scan is bent smoothly, its frame leans by up to 2 degrees, and some
scans store depth in 256 steps, like NYUv2's 8-bit images. The noise is random and constant within
a scan. ``python -m benchmarks.check_completion`` prints the fraction.
"""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.sensors.depth_camera import SENSORS, Sensor

MISFIT_M = {"walk": 0.012, "few": 0.02, "single": 0.03}
MAX_LEAN_DEG, LEAN_SIGMA_DEG = 2.0, 0.7  # Of the frame against gravity.
MAX_BEND_M = 0.02  # At 2.5 m.
DEPTH8_STEP_M, DEPTH8_SHARE = 10 / 255, 0.15  # Steps of 8-bit depth, and how often it is simulated.


@dataclass(frozen=True)
class ScanNoise:
    """The noise of a scan.

    Attributes:
        sensor: Noise of the depth sensor.
        frame_scale: Standard deviation of the depth scale between frames.
        scan_scale: Factor by which all depths are scaled.
        misfit_m: Shift between the ground truth and the scan in metres, float64 [3].
        yaw_error_deg: Rotation between the ground truth and the scan in degrees.
        glass: Fraction of window pixels without depth.
        blots: Mean number of blots without depth in a frame.
        lean_deg: Error of the frame's direction of gravity about x and y in degrees, float64 [2].
        bend_m: Largest smooth error of the depth at 2.5 m, in metres.
        depth_step_m: Steps in which depth is stored in metres; 0 for exact values.
    """

    sensor: Sensor
    frame_scale: float
    scan_scale: float
    misfit_m: np.ndarray
    yaw_error_deg: float
    glass: float
    blots: float
    lean_deg: np.ndarray
    bend_m: float
    depth_step_m: float


def draw_noise(rng: np.random.Generator, kind: str) -> ScanNoise:
    """Choose random noise for a kind of scan. Single images have the largest shift."""
    level = float(rng.uniform(0.05, 1.85))
    sensor = replace(
        SENSORS["rgbd"],
        sigma_m=0.0012 * float(rng.uniform(0.5, 3)),
        sigma_growth=0.0019 * float(rng.uniform(0.5, 2)),
        hole_share=float(rng.uniform(0, 0.08)),
        edge_px=int(rng.integers(0, 2)),
        jitter_m=0.023 * level,
        jitter_deg=0.58 * level,
    )
    return ScanNoise(
        sensor=sensor,
        frame_scale=0.008 * level * float(rng.uniform(0, 2)),
        scan_scale=1 + 0.008 * float(rng.standard_normal()),
        misfit_m=rng.standard_normal(3) * MISFIT_M[kind] * level,
        yaw_error_deg=float(rng.standard_normal()) * 0.4,
        glass=float(rng.choice([0.0, 0.6, 1.0], p=[0.45, 0.2, 0.35])),
        blots=float(rng.choice([0.0, 3.0], p=[0.6, 0.4])),
        lean_deg=_draw_lean(rng),
        bend_m=float(rng.uniform(0, MAX_BEND_M)),
        depth_step_m=DEPTH8_STEP_M if rng.random() < DEPTH8_SHARE else 0.0,
    )


def draw_lost_pixels(
    noise: ScanNoise, labels: np.ndarray, depth_m: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    """Choose the pixels that lose their depth because of glass and blots, bool [H, W]."""
    lost = (labels == SemanticClass.WINDOW) & (rng.random(labels.shape) < noise.glass)
    height, width = labels.shape
    rows, columns = np.mgrid[:height, :width]
    for _ in range(rng.poisson(noise.blots)):
        middle = rng.uniform(0, 1, 2) * labels.shape
        radii = rng.uniform(0.02, 0.12, 2) * width
        lost |= ((rows - middle[0]) / radii[0]) ** 2 + ((columns - middle[1]) / radii[1]) ** 2 < 1
    return lost


def _draw_lean(rng: np.random.Generator) -> np.ndarray:
    """Choose the rotation of the frame about x and y in degrees, at most ``MAX_LEAN_DEG``."""
    lean = rng.standard_normal(2) * LEAN_SIGMA_DEG
    return lean * min(1.0, MAX_LEAN_DEG / max(float(np.linalg.norm(lean)), 1e-9))


def store_depth(noise: ScanNoise, depth_m: np.ndarray) -> np.ndarray:
    """Return depth as it is stored, rounded to whole steps, float32 [H, W]."""
    if not noise.depth_step_m:
        return depth_m
    return (np.round(depth_m / noise.depth_step_m) * noise.depth_step_m).astype(np.float32)
