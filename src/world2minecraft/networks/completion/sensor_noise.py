"""Noise of virtual scans, so strong that about a quarter of the observed surface is wrong.

In real single frames, 23 % of the fused surface cells are empty in the ground truth, because of
errors in depth, pose and scale, and because annotators fitted furniture models by hand. Virtual
scans reproduce this with wrong poses, a wrong depth scale in each frame, and a ground truth that is
shifted slightly. The noise is random and constant within a scan. ``python -m
benchmarks.check_completion`` prints the fraction.
"""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.procgen.sensors.depth_camera import SENSORS, Sensor

MISFIT_M = {"walk": 0.016, "few": 0.045, "single": 0.048}  # Of a quarter false, measured.
PATCH_SHARE = 1 / 80  # Of the width: 8 px at 640, the patches in which label images err.


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
        label_error: Fraction of wrong pixels in label images, or None if there are no label images.
    """

    sensor: Sensor
    frame_scale: float
    scan_scale: float
    misfit_m: np.ndarray  # float64 [3]
    yaw_error_deg: float
    glass: float
    blots: float
    label_error: float | None


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
        label_error=float(rng.uniform(0, 0.35)) if rng.random() < 0.45 else None,
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


def corrupt_labels(labels: np.ndarray, error: float, rng: np.random.Generator) -> np.ndarray:
    """Replace the class of random patches that cover a fraction ``error`` of a label image."""
    height, width = labels.shape
    side = max(round(width * PATCH_SHARE), 1)
    shape = (height // side + 1, width // side + 1)
    wrong, shift = rng.random(shape) < error, rng.integers(1, CLASS_COUNT - 1, shape)
    wrong, shift = (
        values.repeat(side, axis=0).repeat(side, axis=1)[:height, :width]
        for values in (wrong, shift)
    )
    other = (labels.astype(np.int64) - 1 + shift) % (CLASS_COUNT - 1) + 1
    labelled = (labels > 0) & (labels < CLASS_COUNT)
    return np.where(wrong & labelled, other, labels).astype(np.uint8)
