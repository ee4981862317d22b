"""Fuse semantics into depth evidence: networks vote for the class of each surface point.

A segmentation network votes by the pixel that shows the point, a monocular occupancy network by the
grid cell that contains it. A vote is divided among classes by their probabilities; labels unknown
to the program do not vote. Segmentation networks are registered in ``SEGMENTERS``: ``hf:MODEL`` is
any supported model of the transformers library (``hf_segmenter.py``), and packages add families
under the entry point group ``world2minecraft.segmenter``.

Predictions are cached in the user's cache folder by the image content, the network and the classes
of its labels, so a change of any of them causes a new prediction. The oldest entries are deleted
when the cache is full.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import numpy as np
from PIL import Image

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import InputError, OutputError, UsageError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.jit import user_cache_dir
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import View
from world2minecraft.core.vocabulary import VOCABULARY_FILE, label_id_of, read_vocabulary
from world2minecraft.reconstruction.naming.name_votes import NameVoteMap
from world2minecraft.reconstruction.occupancy.depth_evidence import PointVotes, Voter
from world2minecraft.reconstruction.occupancy.label_names import label_classes
from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor
from world2minecraft.reconstruction.occupancy.parameters import (
    AUTO,
    BUILT_IN,
    GENERATED,
    WITHOUT_VOTES,
    OccupancyParameters,
)
from world2minecraft.reconstruction.occupancy.rgbd_votes import RgbdVoter
from world2minecraft.reconstruction.recognition.segmentation import GENERATED_WEIGHTS

FOLDER = "semantics"
MAX_BYTES = 1 << 30  # Some 5,000 pictures.
VERSION = b"2"  # Of what is kept: another makes all that is there unknown.

SEGMENTERS = Registry(
    "segmenter",
    {"hf": "world2minecraft.reconstruction.occupancy.hf_segmenter:HuggingFaceSemantics"},
)

SHOWN_NAMES = 12  # Of those that no table holds.
FULL = 255  # A whole vote, as it is kept.
HALF = 0.5


def key_of(colour: np.ndarray, *states: bytes) -> str:
    """Return the cache key of an image and all other inputs of a prediction."""
    digest = hashlib.sha256(VERSION)
    for part in (*states, str(colour.shape).encode(), np.ascontiguousarray(colour).tobytes()):
        digest.update(hashlib.sha256(part).digest())
    return digest.hexdigest()


def cached_prediction(
    key: str, ask: Callable[[], np.ndarray], folder: Path | None = None
) -> np.ndarray:
    """Return the prediction uint8 [h, w, K] cached under a key, or compute and cache it.

    An unreadable or unwritable cache is ignored.
    """
    place = user_cache_dir() / FOLDER if folder is None else folder
    path = place / key[:2] / f"{key}.npz"
    try:
        return read_npz(path, ("shares",))["shares"]
    except InputError:
        found = ask()
    try:
        write_npz(path, {"shares": found})
        _forget_oldest(place)
    except (OutputError, OSError):
        pass
    return found


def _forget_oldest(place: Path) -> None:
    files = [(path.stat().st_mtime, str(path), path) for path in place.glob("*/*.npz")]
    total = sum(path.stat().st_size for _, _, path in files)
    for _, _, path in sorted(files):
        if total <= MAX_BYTES:
            return
        total -= path.stat().st_size
        path.unlink(missing_ok=True)


class Segmenter(Protocol):
    """A segmentation network that is loaded on first use.

    Attributes:
        name: Name of the network.
        identity: Identifier of this version of the network.
        labels: Names of its labels.
    """

    name: str
    identity: str
    labels: tuple[str, ...]

    def predict(self, colour: np.ndarray, classes: np.ndarray) -> np.ndarray:
        """Predict probabilities of classes, float32 [h, w, K], at the output size of the network.

        Args:
            colour: Image, uint8 [H, W, 3]; the rows and columns of the result cover the whole
                image.
            classes: Matrix that converts its C labels to K classes, float32 [C, K].
        """
        ...


def segmenter(name: str) -> Segmenter:
    """Return the segmentation network ``FAMILY:MODEL``, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.

    Raises:
        UnknownNameError: If the family is not registered.
        UsageError: If the model is missing in the name.
        MissingExtraError: If a dependency of the family is not installed.
        InputError: If the model cannot be downloaded or read.
    """
    family, _, model = name.partition(":")
    make: Callable[[str], Segmenter] = SEGMENTERS.load(family)
    if not model:
        raise UsageError(
            f"semantics must be {', '.join(BUILT_IN)}, none or FAMILY:MODEL, such as "
            f"{family}:ORG/NAME, "
            f"got {name!r}"
        )
    return make(model)


def voters_of(chosen: OccupancyParameters) -> tuple[Voter, ...]:
    """Create the requested voters.

    Raises the exceptions of ``segmenter``, ``read_vocabulary`` and ``MonoPredictor``.
    """
    voters: list[Voter] = []
    if chosen.semantics == AUTO and chosen.mono_votes:
        pass
    elif chosen.semantics in BUILT_IN:
        weights = GENERATED_WEIGHTS if chosen.semantics == GENERATED else None
        voters.append(RgbdVoter(weights, photos_only=chosen.semantics == AUTO))
    elif chosen.semantics not in WITHOUT_VOTES:
        voters.append(PixelVoter(segmenter(chosen.semantics), chosen.label_names))
    if chosen.mono_votes:
        voters.append(CellVoter(MonoPredictor(chosen.network)))
    return tuple(voters)


class PixelVoter:
    """Votes by the prediction of a segmentation network at the pixel that shows a point.

    Attributes:
        names: Votes of the labels for fine names so far.
    """

    photos_only = False

    def __init__(self, network: Segmenter, label_names: str = ""):
        vocabulary = read_vocabulary(label_names)
        self.network = network
        self.classes = label_classes(network.labels, vocabulary.label_table())
        self.notes = _told_of(network, self.classes.unknown, label_names)
        self.names = NameVoteMap()
        ids = np.array([label_id_of(label, vocabulary) or 0 for label in network.labels], np.uint8)
        self.label_ids = np.unique(ids)
        self.matrix = np.hstack(
            [self.classes.matrix, (ids[:, None] == self.label_ids).astype(np.float32)]
        )

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> PointVotes | None:
        """Return the votes of N points, or None; see ``Voter``."""
        if view.colour is None:
            return None
        shares, label_ids = self.prediction(view.colour)
        in_room_m = apply(scan_to_room, points_m.astype(np.float64))
        self.names.add_labels(in_room_m, colour_px, label_ids.reshape(-1))
        shares = shares.reshape(-1, CLASS_COUNT).astype(np.float32) / np.float32(FULL)
        return PointVotes(shares, colour_px.astype(np.int32))

    def prediction(self, colour: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the prediction for an image.

        Returns:
            The share of each class at the pixels, uint8 [H, W, 12] of 255, and the label id that
            has more than half, uint8 [H, W], or 0.
        """
        network = self.network

        def ask() -> np.ndarray:
            found = np.clip(network.predict(colour, self.matrix), 0, 1)
            shares = np.floor(found[..., :CLASS_COUNT] * FULL + np.float32(0.5)).astype(np.uint8)
            fine = found[..., CLASS_COUNT:]
            best = np.where(fine.max(axis=2) > HALF, self.label_ids[fine.argmax(axis=2)], 0)
            return np.dstack([shares, best.astype(np.uint8)])

        states = (network.name.encode(), network.identity.encode(), self.matrix.tobytes())
        kept = cached_prediction(key_of(colour, *states, self.label_ids.tobytes()), ask)
        height, width = colour.shape[:2]
        label_ids = Image.fromarray(np.ascontiguousarray(kept[..., CLASS_COUNT]))
        return (
            spread(kept[..., :CLASS_COUNT], width, height),
            np.asarray(label_ids.resize((width, height), Image.Resampling.NEAREST)),
        )


def spread(shares: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """Resize class shares uint8 [h, w, 12] by interpolation."""
    if shares.shape[:2] == (height_px, width_px):
        return shares
    planes = [
        Image.fromarray(plane).resize((width_px, height_px), Image.Resampling.BILINEAR)
        for plane in np.ascontiguousarray(np.moveaxis(shares, 2, 0))
    ]
    return np.stack([np.asarray(plane) for plane in planes], axis=2)


class CellVoter:
    """Votes by a monocular occupancy network's prediction for the cell of each point."""

    notes: tuple[str, ...] = ()
    photos_only = False

    def __init__(self, predictor: MonoPredictor):
        self.predictor = predictor

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> PointVotes | None:
        """Return the votes of N points, or None; see ``Voter``.

        Points in cells that are predicted to be empty vote with a low weight.
        """
        if view.colour is None:
            return None
        result = np.zeros((len(points_m), CLASS_COUNT), np.float32)
        predicted = self.predictor.look(view, scan_to_room)
        at_m = apply(invert_rigid(predicted.grid_to_scan), points_m.astype(np.float64))
        cells = np.floor(at_m / predicted.voxel_m).astype(np.int64)
        held = np.flatnonzero(((cells >= 0) & (cells < predicted.seen.shape)).all(axis=1))
        held = held[predicted.seen[tuple(cells[held].T)]]
        result[held] = predicted.probabilities[tuple(cells[held].T)]
        result[:, 0] = 0
        return PointVotes(result)


def _told_of(network: Segmenter, unknown: tuple[str, ...], own: str) -> tuple[str, ...]:
    if not unknown:
        return ()
    shown = ", ".join(unknown[:SHOWN_NAMES]) + (" ..." if len(unknown) > SHOWN_NAMES else "")
    where = (
        f"edit {own}"
        if own
        else f"assign classes with --set occupy.label_names=FILE, see {VOCABULARY_FILE.name}"
    )
    return (
        f"{len(unknown)} of {len(network.labels)} labels of {network.name} have no class and do "
        f"not vote: {shown}; {where}",
    )
