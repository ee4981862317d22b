"""Protocols of published occupancy scores: which cells they count, and how they treat unknown ones.

The scores of one network can differ by ten points between protocols, so each score states its
protocol. ``PROTOCOLS`` contains them, and ``cells`` and ``unknown`` describe what they count. The
``ProtocolCounts`` of frames can be summed, and ``evaluation.metrics.score_aggregation`` creates
tables from many frames.

Only ``ssc`` counts different cells for its two kinds of scores. As in SSCNet's paper, completion
(IoU, precision, recall) is scored on cells hidden behind the visible surface, and classes are
scored on these cells and on the surface.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts, count_occupancy


@dataclass(frozen=True, eq=False)
class KnownCells:
    """The ground truth of a frame's cells, each array [X, Y, Z]. Unknown masks are None.

    Attributes:
        labels: The labels as uint8, 0 to 11 or 255.
        in_frustum: Whether the centre of the cell is within the image, as bool.
        seen: Whether the cell is the first one that some pixel sees, as bool.
        free: Whether the cell is empty and crossed by some pixel's ray, as bool.
    """

    labels: np.ndarray
    in_frustum: np.ndarray | None = None
    seen: np.ndarray | None = None
    free: np.ndarray | None = None

    def __post_init__(self):
        for name in ("in_frustum", "seen", "free"):
            mask = getattr(self, name)
            if mask is not None and (mask.shape != self.labels.shape or mask.dtype != np.bool_):
                raise ValueError(
                    f"{name} must be bool with shape {self.labels.shape}, got {mask.dtype} "
                    f"{mask.shape}"
                )


class CellMasks(NamedTuple):
    """The cells on which a frame is scored. None stands for all cells.

    Attributes:
        geometry: The cells for IoU, precision and recall.
        classes: The cells for class IoU and mIoU.
    """

    geometry: np.ndarray | None
    classes: np.ndarray | None


@dataclass(frozen=True)
class Protocol:
    """A protocol for counting cells.

    Attributes:
        name: The name.
        cells: A description of the counted cells.
        unknown: A description of the treatment of label 255.
        masks: A function from the known cells of a frame to the scored cells.
        needs: The masks of ``KnownCells`` that the protocol requires.
        true_unknown: How a true 255 counts.
        said_unknown: How a predicted 255 counts.
    """

    name: str
    cells: str
    unknown: str
    masks: Callable[[KnownCells], CellMasks]
    needs: tuple[str, ...] = ()
    true_unknown: Literal["left out", "empty"] = "left out"
    said_unknown: Literal["empty", "occupied"] = "empty"


@dataclass(frozen=True, eq=False)
class ProtocolCounts:
    """The counts of one or several frames.

    Attributes:
        geometry: The counts for IoU, precision, recall and the IoU of the class empty.
        classes: The counts for all other scores. They differ from ``geometry`` only for ``ssc``.
    """

    geometry: OccupancyCounts = field(default_factory=OccupancyCounts)
    classes: OccupancyCounts = field(default_factory=OccupancyCounts)

    def __add__(self, other: "ProtocolCounts") -> "ProtocolCounts":
        return ProtocolCounts(self.geometry + other.geometry, self.classes + other.classes)

    @property
    def class_iou(self) -> np.ndarray:
        """The IoU of each class as float64 [12], with empty first and 0 for absent classes."""
        values = self.classes.class_iou
        values[0] = self.geometry.class_iou[0]
        return values


def protocol_named(name: str) -> Protocol:
    """Return a protocol by its name.

    Raises:
        UnknownNameError: If the protocol is unknown.
    """
    if name not in PROTOCOLS:
        raise UnknownNameError("protocol", name, PROTOCOLS)
    return PROTOCOLS[name]


def count_frame(
    protocol: Protocol, predicted: np.ndarray, known: KnownCells, within: np.ndarray | None = None
) -> ProtocolCounts:
    """Count the cells of one frame by a protocol.

    Args:
        protocol: One of ``PROTOCOLS``.
        predicted: The predicted labels as uint8 [X, Y, Z], 0 to 11 or 255.
        known: The ground truth of the same cells.
        within: The cells to which counting is limited, as bool [X, Y, Z]. None counts all.

    Raises:
        UsageError: If the protocol requires a mask that is unknown.

    Example:
        >>> known = KnownCells(np.array([[[0, 2, 255]]], np.uint8))
        >>> said = np.array([[[0, 2, 2]]], np.uint8)
        >>> counts = [count_frame(PROTOCOLS[name], said, known) for name in ("monoscene", "iso")]
        >>> [one.geometry.iou for one in counts]
        [1.0, 0.5]
    """
    missing = [name for name in protocol.needs if getattr(known, name) is None]
    if missing:
        raise UsageError(
            f"protocol {protocol.name} requires {', '.join(missing)} for each frame, which "
            "are computed from depth; score a set with depth, or choose the protocol "
            "monoscene or iso"
        )
    truth = known.labels
    if protocol.true_unknown == "empty":
        truth = np.where(truth == UNKNOWN, np.uint8(0), truth)
    masks = protocol.masks(known)
    geometry = count_occupancy(
        predicted, truth, _both(masks.geometry, within), unknown_as=protocol.said_unknown
    )
    # A predicted 255 is of no class: as a miss it costs its true class, and no other gains by it.
    classes = count_occupancy(predicted, truth, _both(masks.classes, within), unknown_as="empty")
    return ProtocolCounts(geometry, classes)


def count_scene(
    predicted: np.ndarray, truth: np.ndarray, seen_by_frames: Sequence[np.ndarray]
) -> ProtocolCounts:
    """Count the cells of a scene as EmbodiedOcc does, limited to those that any frame observed.

    Args:
        predicted: The predicted labels of the scene as uint8 [X, Y, Z], 0 to 11 or 255.
        truth: The true labels as uint8 [X, Y, Z]. Cells with 255 are excluded.
        seen_by_frames: The cells within each frame's box and image, each as bool [X, Y, Z].
    """
    union = np.zeros(truth.shape, bool)
    for mask in seen_by_frames:
        union |= mask
    return count_frame(PROTOCOLS["embodied"], predicted, KnownCells(truth), union)


def _both(mask: np.ndarray | None, within: np.ndarray | None) -> np.ndarray | None:
    if mask is None or within is None:
        return within if mask is None else mask
    return mask & within


def _all_cells(known: KnownCells) -> CellMasks:
    return CellMasks(None, None)


def _hidden_and_surface(known: KnownCells) -> CellMasks:
    """Return the occluded cells for geometry, and these with the surface for classes."""
    inside, seen, free = (_of(known, name) for name in ("in_frustum", "seen", "free"))
    hidden = inside & ~seen & ~free
    return CellMasks(hidden, hidden | (inside & seen))


def _looked_at(known: KnownCells) -> CellMasks:
    met = _of(known, "seen") | _of(known, "free")
    return CellMasks(met, met)


def _of(known: KnownCells, name: str) -> np.ndarray:
    mask = getattr(known, name)
    return np.zeros(known.labels.shape, bool) if mask is None else mask


_OF_DEPTH = ("in_frustum", "seen", "free")
PROTOCOLS: dict[str, Protocol] = {
    one.name: one
    for one in (
        Protocol(
            "monoscene",
            "all cells of the box, whether in the image or not",
            "a true 255 is excluded; a predicted 255 counts as empty",
            _all_cells,
        ),
        Protocol(
            "iso",
            "all cells of the box, whether in the image or not",
            "a true 255 counts as empty; a predicted 255 counts as empty",
            _all_cells,
            true_unknown="empty",
        ),
        Protocol(
            "embodied",
            "all cells of the box for a frame; for a scene those that any frame has in view",
            "a true 255 is excluded; a predicted 255 counts as occupied without a class",
            _all_cells,
            said_unknown="occupied",
        ),
        Protocol(
            "ssc",
            "cells in the image; IoU on cells hidden by the surface, classes on these and "
            "the surface",
            "a true 255, which is outside the room, is excluded; a predicted 255 counts as empty",
            _hidden_and_surface,
            _OF_DEPTH,
        ),
        Protocol(
            "visible",
            "cells that some pixel sees first, or that its ray crosses",
            "a true 255 is excluded; a predicted 255 counts as empty",
            _looked_at,
            ("seen", "free"),
        ),
    )
}
