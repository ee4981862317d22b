"""Prediction of labels for frames, and the validation that selects the best weights."""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
import torch
from torch import nn

from world2minecraft.core.errors import MissingExtraError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts, count_occupancy
from world2minecraft.networks.config import RunConfig
from world2minecraft.networks.data.batches import ordered_loader
from world2minecraft.networks.data.cache import Frames


def resolve_precision(precision: str, device: torch.device) -> str:
    """Return the precision to use on a device, ``bf16`` or ``32``.

    ``auto`` selects bfloat16 if the device supports it in hardware: recent GPUs, and CPUs with AMX,
    which reduces the time of a step to a quarter. On CPUs without AMX, bfloat16 gradients of 3D
    convolutions in torch 2.13 differ between runs and are sometimes NaN.
    """
    if precision != "auto":
        return precision
    if device.type == "cuda":
        return "bf16" if torch.cuda.is_bf16_supported() else "32"
    has_amx = getattr(torch.cpu, "_is_amx_tile_supported", lambda: False)
    return "bf16" if device.type == "cpu" and has_amx() else "32"


def autocast(precision: str, device: torch.device) -> AbstractContextManager[Any]:
    """Return the autocast context in which a network is run."""
    wanted = resolve_precision(precision, device) == "bf16"
    return torch.autocast(device.type, torch.bfloat16, enabled=wanted)


def resolve_device(name: str) -> torch.device:
    """Return the device for ``auto``, ``cpu`` or ``cuda``.

    Raises:
        MissingExtraError: If ``cuda`` is requested but not available.
    """
    if name == "cuda" and not torch.cuda.is_available():
        raise MissingExtraError(
            "training on a GPU, which this installation of torch does not detect,", "train"
        )
    if name == "auto":
        name = "cuda" if torch.cuda.is_available() else "cpu"
    return torch.device(name)


def predict_labels(
    network: nn.Module,
    frames: Frames,
    rows: Sequence[int],
    config: RunConfig,
    *,
    progress: Progress = no_progress,
) -> Iterator[np.ndarray]:
    """Predict the most likely class of each cell for frames, yielding uint8 [X, Y, Z] in order.

    The mode of the network is restored afterwards.
    """
    device = next(network.parameters()).device
    was_training = network.training
    network.eval()
    done = 0
    try:
        for batch in ordered_loader(frames, rows, config):
            with torch.inference_mode(), autocast(config.precision, device):
                logits = network(batch.inputs.to(device)).logits
            for labels in logits.argmax(dim=1).to(torch.uint8).cpu().numpy():
                yield labels
                done += 1
            progress("score", done, len(rows))
    finally:
        network.train(was_training)


def validate(
    network: nn.Module, frames: Frames, rows: Sequence[int], config: RunConfig
) -> OccupancyCounts:
    """Predict the given frames and return the counts for the protocol ``monoscene``."""
    total = OccupancyCounts()
    predicted = predict_labels(network, frames, rows, config)
    for row, labels in zip(rows, predicted, strict=True):
        total = total + count_occupancy(labels, frames[row].labels)
    return total
