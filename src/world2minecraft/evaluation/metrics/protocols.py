"""Which cells a published occupancy score counts, and what it makes of unknown ones.

In: the prediction of a frame and what is known of its cells. Out: ``ProtocolCounts``, which add up
over frames. Two scores of one network may differ by ten points through the protocol alone, so a
score is named by it. ``PROTOCOLS`` holds them; what each counts is said in its ``cells`` and
``unknown``. ``evaluation.metrics.score_aggregation`` makes tables of many frames.

``ssc`` is the one whose two figures count different cells. SSCNet's paper scores completion (IoU,
precision, recall) where the camera's surface hides the cell, and classes there and on the surface.
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
    """What is true of a frame's cells, all [X, Y, Z]; masks that nobody knows are None."""

    labels: np.ndarray  # uint8, 0 to 11 or 255
    in_frustum: np.ndarray | None = None  # bool, the centre falls into the picture
    seen: np.ndarray | None = None  # bool, some pixel sees the cell first
    free: np.ndarray | None = None  # bool, empty, and some pixel's ray went through it

    def __post_init__(self):
        for name in ("in_frustum", "seen", "free"):
            mask = getattr(self, name)
            if mask is not None and (mask.shape != self.labels.shape or mask.dtype != np.bool_):
                raise ValueError(
                    f"{name} must be bool of shape {self.labels.shape}, "
                    f"not {mask.dtype} {mask.shape}"
                )


class CellMasks(NamedTuple):
    """The cells over which a frame is scored; None stands for all of them."""

    geometry: np.ndarray | None  # for IoU, precision and recall
    classes: np.ndarray | None  # for the IoU of each class and its mean


@dataclass(frozen=True)
class Protocol:
    """One way to count."""

    name: str
    cells: str  # Which cells are counted, in words.
    unknown: str  # What a true and a predicted 255 are, in words.
    masks: Callable[[KnownCells], CellMasks]
    needs: tuple[str, ...] = ()  # Which of the masks of ``KnownCells``.
    true_unknown: Literal["left out", "empty"] = "left out"
    said_unknown: Literal["empty", "occupied"] = "empty"


@dataclass(frozen=True, eq=False)
class ProtocolCounts:
    """The counts of some frames. ``geometry`` gives IoU, precision, recall; ``classes`` the rest.

    They are of the same cells but for ``ssc``. The IoU of class empty is that of ``geometry``.
    """

    geometry: OccupancyCounts = field(default_factory=OccupancyCounts)
    classes: OccupancyCounts = field(default_factory=OccupancyCounts)

    def __add__(self, other: "ProtocolCounts") -> "ProtocolCounts":
        return ProtocolCounts(self.geometry + other.geometry, self.classes + other.classes)

    @property
    def class_iou(self) -> np.ndarray:
        """IoU of each class, float64 [12], empty first; a class that is nowhere counts 0."""
        values = self.classes.class_iou
        values[0] = self.geometry.class_iou[0]
        return values


def protocol_named(name: str) -> Protocol:
    """Return a protocol. Raises UnknownNameError where there is none of the name."""
    if name not in PROTOCOLS:
        raise UnknownNameError("protocol", name, PROTOCOLS)
    return PROTOCOLS[name]


def count_frame(
    protocol: Protocol, predicted: np.ndarray, known: KnownCells, within: np.ndarray | None = None
) -> ProtocolCounts:
    """Count one frame.

    Args:
        protocol: see ``PROTOCOLS``.
        predicted: uint8 [X, Y, Z], 0 to 11 or 255.
        known: the truth of the same cells.
        within: bool [X, Y, Z], cells outside of which nothing is counted.

    Raises:
        UsageError: the protocol needs a mask that is not known.

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
            f"protocol {protocol.name} needs {', '.join(missing)} of each frame, which follow "
            f"from depth; score a set with depth, or choose monoscene or iso"
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
    """Count a whole scene as EmbodiedOcc does: where any of its frames looked.

    Args:
        predicted: uint8 [X, Y, Z] of the scene, 0 to 11 or 255.
        truth: uint8 of the same cells; 255 is left out.
        seen_by_frames: bool [X, Y, Z] each, the cells that a frame's box and picture hold.
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
    """Occluded cells; these and the surface. Both are in the picture, as rays see no others."""
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
            "all cells of the box, in the picture or not",
            "a true 255 is left out; a predicted 255 is empty",
            _all_cells,
        ),
        Protocol(
            "iso",
            "all cells of the box, in the picture or not",
            "a true 255 is empty; a predicted 255 is empty",
            _all_cells,
            true_unknown="empty",
        ),
        Protocol(
            "embodied",
            "of a frame all cells of the box; of a scene those that any frame has in view",
            "a true 255 is left out; a predicted 255 is occupied, and of no class",
            _all_cells,
            said_unknown="occupied",
        ),
        Protocol(
            "ssc",
            "in the picture; IoU where the surface hides the cell, classes there and on it",
            "a true 255, which is what lies outside the room, is left out; a predicted 255 is "
            "empty",
            _hidden_and_surface,
            _OF_DEPTH,
        ),
        Protocol(
            "visible",
            "that some pixel sees first, or whose ray went through them",
            "a true 255 is left out; a predicted 255 is empty",
            _looked_at,
            ("seen", "free"),
        ),
    )
}
