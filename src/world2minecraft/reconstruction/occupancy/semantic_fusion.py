"""Fuse semantics into depth evidence: networks vote for the class of each point of a view.

A segmenter votes by the pixel that shows the point, a monocular occupancy network by the cell of
its grid that holds it. A vote is shared among classes by their probabilities; classes that the
program does not know get no vote. Segmenters are found by name in ``SEGMENTERS``: ``hf:MODEL`` is
any of the transformers library (``hf_segmenter.py``), and packages add families under the entry
point group ``world2minecraft.segmenter``.

Predictions are cached in the user's folder by the content of the picture, the state of the network
and the meaning of its labels, so that whatever changes one of them is predicted again. The oldest
go when the cache is full.
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
from world2minecraft.reconstruction.occupancy.depth_evidence import Voter
from world2minecraft.reconstruction.occupancy.label_names import TABLE, label_classes, read_table
from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor
from world2minecraft.reconstruction.occupancy.parameters import OccupancyParameters

FOLDER = "semantics"
MAX_BYTES = 1 << 30  # Some 5,000 pictures.
VERSION = b"1"  # Of what is kept: another makes all that is there unknown.

SEGMENTERS = Registry(
    "segmenter",
    {"hf": "world2minecraft.reconstruction.occupancy.hf_segmenter:HuggingFaceSemantics"},
)

SHOWN_NAMES = 12  # Of those that no table holds.
FULL = 255  # A whole vote, as it is kept.


def key_of(colour: np.ndarray, *states: bytes) -> str:
    """Return the name of what is kept: a digest of a picture and of all that decides the answer."""
    digest = hashlib.sha256(VERSION)
    for part in (*states, str(colour.shape).encode(), np.ascontiguousarray(colour).tobytes()):
        digest.update(hashlib.sha256(part).digest())
    return digest.hexdigest()


def cached_prediction(
    key: str, ask: Callable[[], np.ndarray], folder: Path | None = None
) -> np.ndarray:
    """Return uint8 [h, w, 12] that was kept under a key, or ask for it and keep it.

    A cache that cannot be read or written is done without.
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
    """A network that is loaded when it is first asked.

    ``identity`` tells this state of it from any other, as ``labels`` does what its labels are.
    """

    name: str
    identity: str
    labels: tuple[str, ...]

    def predict(self, colour: np.ndarray, classes: np.ndarray) -> np.ndarray:
        """Return float32 [h, w, 12]: probabilities of classes, at a size of the network's own.

        Args:
            colour: uint8 [H, W, 3]; rows and columns of the answer spread over all of it.
            classes: float32 [C, 12], what each of its labels means.
        """
        ...


def segmenter(name: str) -> Segmenter:
    """Return the network that ``FAMILY:MODEL`` names, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.

    Raises:
        UnknownNameError: no registry holds the family. UsageError: no model is named.
        MissingExtraError: what the family needs is not installed.
        InputError: the model cannot be had or read.
    """
    family, _, model = name.partition(":")
    make: Callable[[str], Segmenter] = SEGMENTERS.load(family)
    if not model:
        raise UsageError(
            f"--semantics must be FAMILY:MODEL, such as {family}:ORG/NAME, got {name!r}"
        )
    return make(model)


def voters_of(chosen: OccupancyParameters) -> tuple[Voter, ...]:
    """Return the voters that were asked for.

    Raises what ``segmenter``, ``read_table`` and ``MonoPredictor`` raise.
    """
    voters: list[Voter] = []
    if chosen.semantics:
        voters.append(PixelVoter(segmenter(chosen.semantics), chosen.label_names))
    if chosen.mono_votes:
        voters.append(CellVoter(MonoPredictor(chosen.network)))
    return tuple(voters)


class PixelVoter:
    """Votes by what a segmenter says of the pixel that shows a point."""

    def __init__(self, network: Segmenter, label_names: str = ""):
        self.network = network
        self.classes = label_classes(network.labels, read_table(label_names))
        self.notes = _told_of(network, self.classes.unknown, label_names)

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> np.ndarray:
        """Return float32 [N, 12]; see ``Voter``."""
        if view.colour is None:
            return np.zeros((len(points_m), CLASS_COUNT), np.float32)
        shares = self.shares(view.colour).reshape(-1, CLASS_COUNT)[colour_px]
        return shares.astype(np.float32) / np.float32(FULL)

    def shares(self, colour: np.ndarray) -> np.ndarray:
        """Return uint8 [H, W, 12]: the share of each class, of 255, of a picture's pixels."""
        network, matrix = self.network, self.classes.matrix

        def ask() -> np.ndarray:
            found = np.clip(network.predict(colour, matrix), 0, 1)
            return np.floor(found * FULL + np.float32(0.5)).astype(np.uint8)

        states = (network.name.encode(), network.identity.encode(), matrix.tobytes())
        return spread(
            cached_prediction(key_of(colour, *states), ask), colour.shape[1], colour.shape[0]
        )


def spread(shares: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """Return shares uint8 [h, w, 12] at another size, read between pixels."""
    if shares.shape[:2] == (height_px, width_px):
        return shares
    planes = [
        Image.fromarray(plane).resize((width_px, height_px), Image.Resampling.BILINEAR)
        for plane in np.ascontiguousarray(np.moveaxis(shares, 2, 0))
    ]
    return np.stack([np.asarray(plane) for plane in planes], axis=2)


class CellVoter:
    """Votes by what a monocular occupancy network says of the cell that holds a point."""

    notes: tuple[str, ...] = ()

    def __init__(self, predictor: MonoPredictor):
        self.predictor = predictor

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> np.ndarray:
        """Return float32 [N, 12]; a point in a cell that was taken for empty votes weakly."""
        result = np.zeros((len(points_m), CLASS_COUNT), np.float32)
        if view.colour is None:
            return result
        predicted = self.predictor.look(view, scan_to_room)
        at_m = apply(invert_rigid(predicted.grid_to_scan), points_m.astype(np.float64))
        cells = np.floor(at_m / predicted.voxel_m).astype(np.int64)
        held = np.flatnonzero(((cells >= 0) & (cells < predicted.seen.shape)).all(axis=1))
        held = held[predicted.seen[tuple(cells[held].T)]]
        result[held] = predicted.probabilities[tuple(cells[held].T)]
        result[:, 0] = 0
        return result


def _told_of(network: Segmenter, unknown: tuple[str, ...], own: str) -> tuple[str, ...]:
    if not unknown:
        return ()
    shown = ", ".join(unknown[:SHOWN_NAMES]) + (" ..." if len(unknown) > SHOWN_NAMES else "")
    where = (
        f"edit {own}"
        if own
        else f"assign classes with --set occupy.label_names=FILE, see {TABLE.name}"
    )
    return (
        f"{len(unknown)} of {len(network.labels)} labels of {network.name} have no class and do "
        f"not vote: {shown}; {where}",
    )
