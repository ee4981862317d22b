"""Calibration of the segmentation network: undone class weights and a temperature.

Training with class weights makes rare classes too likely; most of the weights is undone by a
constant for each class. A network is too sure of itself on frames that it never saw, so its logits
are divided by a temperature, which is fitted on frames that were kept from training. Each kind of
input has its own temperature.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from scipy.optimize import minimize_scalar
from torch.nn import functional

from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame
from world2minecraft.networks.segmentation.network import SegmentationNet
from world2minecraft.networks.segmentation.scores import frame_logits, sampled_labels

UNDONE_SHARE = 0.75  # Of the logarithm of the class weights; see docs/explanation/segmentation.md.
INPUTS = ({"colour": True, "depth": True}, {"depth": False}, {"colour": False})
EVERY_PX = 8  # Neighbouring pixels are alike.
TEMPERATURES = (0.3, 5.0)


@dataclass(frozen=True, eq=False)
class Calibration:
    """The calibration of a network.

    Attributes:
        offset: What is added to the logit of each class, float32 [40].
        temperatures: Divisors of the logits with colour and depth, colour alone and depth alone.
    """

    offset: np.ndarray
    temperatures: tuple[float, float, float] = (1.0, 1.0, 1.0)


def undo_class_weights(weights: np.ndarray, share: float = UNDONE_SHARE) -> np.ndarray:
    """Return what undoes a share of class weights when added to the logits, float32 [40]."""
    return (-share * np.log(weights)).astype(np.float32)


def fit_calibration(
    network: SegmentationNet,
    frames: Sequence[LabelledFrame],
    weights: np.ndarray,
) -> Calibration:
    """Fit the temperatures on frames that the network was not trained on.

    Args:
        network: Trained network.
        frames: Labelled frames.
        weights: Class weights of the training, [40].
    """
    offset = undo_class_weights(weights)
    fitted = []
    for inputs in INPUTS:
        rows, truth = [], []
        for frame in frames:
            logits = frame_logits(network, frame, mirrored=True, every_px=EVERY_PX, **inputs)
            labels = sampled_labels(frame, EVERY_PX).reshape(-1)
            seen = labels != IGNORED
            picked = logits.reshape(len(logits), -1).T[torch.from_numpy(seen)]
            rows.append(picked + torch.from_numpy(offset))
            truth.append(torch.from_numpy(labels[seen].astype(np.int64)))
        fitted.append(fit_temperature(torch.cat(rows), torch.cat(truth)))
    return Calibration(offset, (fitted[0], fitted[1], fitted[2]))


def fit_temperature(logits: torch.Tensor, truth: torch.Tensor) -> float:
    """Return the temperature with the least cross entropy.

    Args:
        logits: Logits [N, C].
        truth: Classes, int64 [N].
    """

    def entropy(log_temperature: float) -> float:
        scaled = logits / float(np.exp(log_temperature))
        return float(functional.cross_entropy(scaled, truth))

    found = minimize_scalar(entropy, bounds=tuple(np.log(TEMPERATURES)), method="bounded")
    return float(np.exp(found.x))
