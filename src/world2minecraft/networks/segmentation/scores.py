"""Scores of predicted classes: pixel accuracy and IoU of 40 and of the paper's eleven classes."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import torch
from torch.nn import functional

from world2minecraft.core.vocabulary import nyu40_classes
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.networks.segmentation.frames import IGNORED, LabelledFrame
from world2minecraft.networks.segmentation.network import CLASSES, SegmentationNet
from world2minecraft.reconstruction.recognition.segmentation import colour_channels
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    GEOMETRY_CHANNELS,
    NORMAL_RIGHT,
    channels_of_fine_depth,
    network_size,
)

CALIBRATION_BINS = 15


@dataclass(frozen=True, eq=False)
class SegmentationScores:
    """Scores over the labelled pixels of all frames together.

    Attributes:
        confusion: Number of pixels by true and predicted class, int64 [40, 40].
    """

    confusion: np.ndarray

    @property
    def pixel_accuracy(self) -> float:
        """Share of the labelled pixels with the right one of the 40 classes."""
        return float(np.trace(self.confusion) / max(self.confusion.sum(), 1))

    @property
    def iou(self) -> np.ndarray:
        """IoU of each of the 40 classes, NaN where a class does not occur."""
        return _iou(self.confusion)

    @property
    def mean_iou(self) -> float:
        """Mean IoU of the classes that occur, without otherprop."""
        return float(np.nanmean(self.iou[:IGNORED]))

    @property
    def eleven(self) -> "SegmentationScores":
        """The same after both are mapped to the paper's eleven classes."""
        classes = nyu40_classes()[1 : CLASSES + 1].astype(np.int64)
        confusion = np.zeros((12, 12), np.int64)
        np.add.at(confusion, (classes[:, None], classes[None, :]), self.confusion)
        return SegmentationScores(confusion[1:, 1:])

    def __str__(self) -> str:
        eleven = self.eleven
        return (
            f"acc40 {self.pixel_accuracy:.3f} mIoU40 {self.mean_iou:.3f} "
            f"acc11 {eleven.pixel_accuracy:.3f} mIoU11 {float(np.nanmean(eleven.iou)):.3f}"
        )


def _iou(confusion: np.ndarray) -> np.ndarray:
    either = confusion.sum(axis=0) + confusion.sum(axis=1) - np.diag(confusion)
    there = confusion.sum(axis=1) > 0
    return np.where(there, np.diag(confusion) / np.maximum(either, 1), np.nan)


def confusion_matrix(truth: np.ndarray, predicted: np.ndarray) -> np.ndarray:
    """Count pixels by true and predicted class, int64 [40, 40], leaving out ignored ones."""
    seen = truth != IGNORED
    codes = truth[seen].astype(np.int64) * CLASSES + predicted[seen]
    return np.bincount(codes, minlength=CLASSES * CLASSES).reshape(CLASSES, CLASSES)


def calibration_error(confidence: np.ndarray, is_right: np.ndarray) -> float:
    """Return the expected calibration error over 15 bins of equal width.

    Args:
        confidence: Probability of the predicted class of each pixel, [N].
        is_right: Whether the predicted class is the true one, bool [N].
    """
    bins = np.minimum((confidence * CALIBRATION_BINS).astype(int), CALIBRATION_BINS - 1)
    counts = np.bincount(bins, minlength=CALIBRATION_BINS)
    sure = np.bincount(bins, confidence, CALIBRATION_BINS)
    right = np.bincount(bins, is_right.astype(float), CALIBRATION_BINS)
    return float(np.abs(sure - right).sum() / max(counts.sum(), 1))


@torch.no_grad()
def frame_logits(
    network: SegmentationNet,
    frame: LabelledFrame,
    *,
    colour: bool = True,
    depth: bool = True,
    mirrored: bool = False,
    every_px: int = 1,
) -> torch.Tensor:
    """Return the logits of a frame at the size of ``sampled_labels``, float32 [40, H, W].

    Args:
        network: Network, which is put into evaluation mode.
        frame: Labelled frame.
        colour: Whether the network sees the colours.
        depth: Whether the network sees the depth.
        mirrored: Whether the mean with the mirrored frame is taken.
        every_px: Distance of the pixels, to save time.
    """
    network.eval()
    width, height = network_size(frame.camera.width_px, frame.camera.height_px)
    colours = colour_channels(frame.colour if colour else None, width, height)
    shape = (GEOMETRY_CHANNELS, *frame.depth_m.shape)
    geometry = np.zeros(shape, np.float32)
    if depth:
        geometry = channels_of_fine_depth(frame.depth_m, pixel_rays(frame.depth_camera))
    device = next(network.parameters()).device
    given = tuple(torch.from_numpy(one)[None].to(device) for one in (colours, geometry))
    logits = network(*given)
    if mirrored:
        turned = network(given[0].flip(3), mirror_geometry(given[1]))
        logits = (logits + turned.flip(3)) / 2
    size = sampled_labels(frame, every_px).shape
    return functional.interpolate(logits, size=size, mode="bilinear", align_corners=False)[0].cpu()


def sampled_labels(frame: LabelledFrame, every_px: int) -> np.ndarray:
    """Return the labels of every n-th pixel of a frame, uint8 [H, W]."""
    return frame.labels[every_px // 2 :: every_px, every_px // 2 :: every_px]


def mirror_geometry(geometry: torch.Tensor) -> torch.Tensor:
    """Return geometry channels [B, 7, H, W] of the mirrored image."""
    result = geometry.flip(3).clone()
    result[:, NORMAL_RIGHT] *= -1
    return result


def score_network(
    network: SegmentationNet,
    frames: Iterable[LabelledFrame],
    offset: np.ndarray | None = None,
    every_px: int = 1,
    **inputs: bool,
) -> SegmentationScores:
    """Score a network on frames.

    Args:
        network: Network.
        frames: Labelled frames.
        offset: What is added to the logits of each class, float32 [40]; defaults to nothing.
        every_px: Distance of the pixels that are scored, to save time.
        inputs: Further options of ``frame_logits``.
    """
    confusion = np.zeros((CLASSES, CLASSES), np.int64)
    added = torch.zeros(CLASSES) if offset is None else torch.from_numpy(offset)
    for frame in frames:
        logits = frame_logits(network, frame, every_px=every_px, **inputs) + added[:, None, None]
        labels = sampled_labels(frame, every_px)
        confusion += confusion_matrix(labels, logits.argmax(dim=0).numpy())
    return SegmentationScores(confusion)
