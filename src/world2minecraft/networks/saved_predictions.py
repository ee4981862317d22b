"""Read saved predictions, ours and those of others, as labels of our order and classes.

A folder of ``KEY.npz``, ``KEY.npy`` or ``KEY.pkl``, or one ``.npz`` with an array a key. A file
of a single array, or one named ``labels``, is a frame's: uint8 labels, or scores of 12 or 13
channels, first or last. 13 channels are EmbodiedOcc's and GPOcc's: 0 is ignored, 12 is empty.
Grids of whole scenes are read in the same forms, by the names of scenes.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.files import npz_array_names, read_npy, read_npz
from world2minecraft.minecraftocc.formats.safe_pickle import read_pickle
from world2minecraft.networks.config import GRIDS, Grid

# How an array's axes lie: which of them are our x, y, z.
ORDERS = {"xyz": (0, 1, 2), "xzy": (0, 2, 1), "yxz": (1, 0, 2)}
KINDS = ("ours", "embodied")
NAMES = ("labels", "pred", "prediction", "logits", "probabilities")  # Of a frame's array.
SUFFIXES = (".npz", ".npy", ".pkl")
EMBODIED_EMPTY, EMBODIED_CLASSES = 12, 13


class SavedPredictions:
    """Labels by key, read on access."""

    def __init__(self, path: Path, order: str = "", classes: str = ""):
        """Find out what is there.

        Args:
            path: a folder or a file.
            order: of ``ORDERS``; by the shape where empty: 60x36x60 is xzy, as NYUv2's files are,
                60x60x36 is xyz, as EmbodiedOcc and GPOcc compare.
            classes: ours or embodied; by the number of channels where empty, labels are ours.

        Raises:
            InputError: there are none. UnknownNameError: no such order or classes.
        """
        for kind, name, known in (("order", order, ORDERS), ("classes", classes, KINDS)):
            if name and name not in known:
                raise UnknownNameError(kind, name, known)
        self._order, self._classes, self.path = order, classes, path
        self._files: dict[str, Path] = {}
        self._members: tuple[str, ...] = ()
        if path.is_dir():
            found = [one for one in sorted(path.iterdir()) if one.suffix in SUFFIXES]
            self._files = {one.stem: one for one in found}
        elif path.suffix == ".npz" and path.is_file():
            names = npz_array_names(path)
            if not set(names) & set(NAMES):
                self._members = names
        elif not path.is_file():
            raise InputError(
                path, "is not there; give a run, weights, an .onnx or a folder of KEY.npz"
            )
        if path.is_dir() and not self._files:
            raise InputError(path, "holds no KEY.npz, KEY.npy or KEY.pkl")

    @property
    def is_single(self) -> bool:
        """Whether this is one file of one frame, which names no key."""
        return not self._files and not self._members

    def keys(self) -> list[str]:
        """Return the keys that there are predictions of; none where there is a single one."""
        return list(self._files or self._members)

    def labels(self, key: str) -> np.ndarray:
        """Return a frame's labels, uint8 [X, Y, Z], 0 to 11 or 255.

        Raises:
            InputError: there are none of this key. DamagedFileError: they cannot be understood.
        """
        return self._to_labels(*self._array(key), self._order)

    def scene_labels(self, key: str, shape: tuple[int, ...]) -> np.ndarray:
        """Return the labels of a whole scene, uint8 ``shape``, 0 to 11 or 255.

        Scenes are as long and as low as they are, so their axes are x, y, z unless ``order`` says
        otherwise. One value a cell in a row, as a network's list of cells has them, is put back.

        Raises:
            InputError: there are none of this key. DamagedFileError: they have other cells.
        """
        values, path = self._array(key)
        values = _reshape_scene(values, shape)
        labels = self._to_labels(values, path, self._order or "xyz")
        if labels.shape != shape:
            raise DamagedFileError(
                path, f"has {_sides(labels.shape)} cells of {key}, the truth {_sides(shape)}"
            )
        return labels

    def _array(self, key: str) -> tuple[np.ndarray, Path]:
        if self.is_single:
            return _read_frame_array(self.path), self.path
        if self._members:
            if key not in self._members:
                raise InputError(self.path, f"holds no array {key}")
            return read_npz(self.path, (key,))[key], self.path
        if key not in self._files:
            raise InputError(self.path, f"holds no {key}.npz, .npy or .pkl")
        return _read_frame_array(self._files[key]), self._files[key]

    def _to_labels(self, values: np.ndarray, path: Path, order: str = "") -> np.ndarray:
        classes = self._classes
        if values.ndim == 5 and values.shape[0] == 1:
            values = values[0]
        if values.ndim == 4:
            axis = _channels(values, path)
            classes = "embodied" if values.shape[axis] == EMBODIED_CLASSES else "ours"
            values = values.argmax(axis=axis)
        if values.ndim != 3:
            raise DamagedFileError(path, f"has an array of {values.shape}, and no grid")
        labels = values.astype(np.uint8)
        if not np.array_equal(labels, values):
            raise DamagedFileError(path, "has values that are no class ids")
        if classes == "embodied":
            labels = from_embodied_classes(labels, path)
        if np.any((labels >= CLASS_COUNT) & (labels != UNKNOWN)):
            raise DamagedFileError(
                path,
                f"has the class {int(labels[labels != UNKNOWN].max())}; of 13 classes with 12 "
                "for empty say --classes embodied",
            )
        return np.ascontiguousarray(labels.transpose(ORDERS[order or _order_of(labels)]))


def _reshape_scene(values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return labels [X, Y, Z] or scores [C, X, Y, Z], where values are some form of these."""
    if values.ndim in (2, 3, 5) and values.shape[0] == 1 != shape[0]:
        values = values[0]  # A batch of one.
    cells = math.prod(shape)
    if values.ndim == 2 and values.shape[1] == cells:
        values = values.T
    if values.ndim in (1, 2) and values.shape[0] == cells:
        values = values.reshape(*shape, *values.shape[1:])
    return np.moveaxis(values, -1, 0) if values.ndim == 4 and values.shape[:3] == shape else values


def from_embodied_classes(labels: np.ndarray, path: Path) -> np.ndarray:
    """Return ours of EmbodiedOcc's own classes: its 0 is unknown, its 12 empty."""
    if labels.max(initial=0) > EMBODIED_EMPTY:
        raise DamagedFileError(path, f"has the class {labels.max()}; EmbodiedOcc's end at 12")
    table = np.arange(EMBODIED_CLASSES, dtype=np.uint8)
    table[0], table[EMBODIED_EMPTY] = UNKNOWN, 0
    return table[labels]


def grid_of_labels(labels: np.ndarray, path: Path) -> Grid:
    """Return the grid that has as many cells. Raises DamagedFileError."""
    for grid in GRIDS.values():
        if grid.shape == labels.shape:
            return grid
    raise DamagedFileError(
        path,
        f"has {_sides(labels.shape)} cells; 60x60x36 or 30x30x18 as x, y, z are scored (see "
        "--order)",
    )


def _sides(shape: tuple[int, ...]) -> str:
    return "x".join(map(str, shape))


def _order_of(labels: np.ndarray) -> str:
    """Return the order in which the box is as low as it is: a side of 0.6 of the others is z."""
    low = labels.shape.index(min(labels.shape))
    return "xzy" if low == 1 else "xyz"


def _channels(values: np.ndarray, path: Path) -> int:
    for axis in (0, -1):
        if values.shape[axis] in (CLASS_COUNT, EMBODIED_CLASSES):
            return axis
    raise DamagedFileError(path, f"has scores of {values.shape}; 12 or 13 channels are known")


def _read_frame_array(path: Path) -> np.ndarray:
    if path.suffix == ".npy":
        return read_npy(path)
    if path.suffix == ".pkl":
        return _find_array(dict(read_pickle(path)), path)
    names = npz_array_names(path)
    wanted = next((name for name in NAMES if name in names), names[0] if len(names) == 1 else "")
    if not wanted:
        raise DamagedFileError(path, f"holds {', '.join(names)}; the grid is named labels")
    return read_npz(path, (wanted,))[wanted]


def _find_array(arrays: dict[str, Any], path: Path) -> np.ndarray:
    for name in (*NAMES, *arrays):
        value = arrays.get(name)
        if isinstance(value, np.ndarray) and math.prod(value.shape) > 1:
            return value
    raise DamagedFileError(path, "holds no array")
