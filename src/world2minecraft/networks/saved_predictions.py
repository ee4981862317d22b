"""Reader for saved predictions from our own and other programs, with conversion to our labels.

Predictions are a folder with ``KEY.npz``, ``KEY.npy`` or ``KEY.pkl`` files, or a single ``.npz``
file with one array per key. A file with a single array, or with an array named ``labels``, belongs
to a single frame. An array contains uint8 labels, or scores with 12 or 13 channels in the first or
last axis. 13 channels are those of EmbodiedOcc and GPOcc: 0 is ignored and 12 is empty. Grids of
complete scenes are read in the same formats, with scene names as keys.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.errors import DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.files import npz_array_names, read_npy, read_npz
from world2minecraft.formats.safe_pickle import read_pickle
from world2minecraft.networks.config import GRIDS, Grid

# The axes of an array that correspond to x, y and z.
ORDERS = {"xyz": (0, 1, 2), "xzy": (0, 2, 1), "yxz": (1, 0, 2)}
KINDS = ("ours", "embodied")
NAMES = ("labels", "pred", "prediction", "logits", "probabilities")  # Of a frame's array.
SUFFIXES = (".npz", ".npy", ".pkl")
EMBODIED_EMPTY, EMBODIED_CLASSES = 12, 13


class SavedPredictions:
    """Saved predictions, read on access and converted to our labels."""

    def __init__(self, path: Path, order: str = "", classes: str = ""):
        """Find the predictions in a folder or file.

        Args:
            path: Folder or file.
            order: Axis order in ``ORDERS``. By default, it is derived from the shape: 60x36x60 is
                ``xzy`` (as in NYUv2 files) and 60x60x36 is ``xyz`` (as in EmbodiedOcc and GPOcc).
            classes: ``ours`` or ``embodied``. By default, it is derived from the number of
                channels, and labels are ``ours``.

        Raises:
            InputError: If there are no predictions.
            UnknownNameError: If the order or the classes are unknown.
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
                path,
                "not found; expected a run, weights, an .onnx file or a folder of KEY.npz files",
            )
        if path.is_dir() and not self._files:
            raise InputError(path, "contains no KEY.npz, KEY.npy or KEY.pkl files")

    @property
    def is_single(self) -> bool:
        """Whether this is a single file for one frame, without a key."""
        return not self._files and not self._members

    def keys(self) -> list[str]:
        """Return the keys of all predictions, or an empty list for a single file without a key."""
        return list(self._files or self._members)

    def labels(self, key: str) -> np.ndarray:
        """Return the predicted labels of a frame (0 to 11 or 255), uint8 [X, Y, Z].

        Raises:
            InputError: If there is no prediction for this key.
            DamagedFileError: If the prediction is not valid.
        """
        return self._to_labels(*self._array(key), self._order)

    def scene_labels(self, key: str, shape: tuple[int, ...]) -> np.ndarray:
        """Return the predicted labels of a complete scene, uint8 in the given shape.

        The axis order of scenes cannot be derived from their shape, so it is ``xyz`` unless
        ``order`` is given. A flat list with one value per cell is reshaped.

        Raises:
            InputError: If there is no prediction for this key.
            DamagedFileError: If the prediction has another shape.
        """
        values, path = self._array(key)
        values = _reshape_scene(values, shape)
        labels = self._to_labels(values, path, self._order or "xyz")
        if labels.shape != shape:
            raise DamagedFileError(
                path,
                f"prediction of {key} has {_sides(labels.shape)} cells, expected {_sides(shape)}",
            )
        return labels

    def _array(self, key: str) -> tuple[np.ndarray, Path]:
        if self.is_single:
            return _read_frame_array(self.path), self.path
        if self._members:
            if key not in self._members:
                raise InputError(self.path, f"contains no array named {key}")
            return read_npz(self.path, (key,))[key], self.path
        if key not in self._files:
            raise InputError(self.path, f"contains no {key}.npz, {key}.npy or {key}.pkl")
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
            raise DamagedFileError(
                path, f"expected a grid with three axes, got an array of shape {values.shape}"
            )
        labels = values.astype(np.uint8)
        if not np.array_equal(labels, values):
            raise DamagedFileError(path, "contains values that are not class ids")
        if classes == "embodied":
            labels = from_embodied_classes(labels, path)
        if np.any((labels >= CLASS_COUNT) & (labels != UNKNOWN)):
            raise DamagedFileError(
                path,
                f"contains the unknown class {int(labels[labels != UNKNOWN].max())}; for 13 "
                "classes in which 12 is empty, set classes to embodied (--classes embodied)",
            )
        return np.ascontiguousarray(labels.transpose(ORDERS[order or _order_of(labels)]))


def _reshape_scene(values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Reshape values to labels [X, Y, Z] or scores [C, X, Y, Z] if their shape allows it."""
    if values.ndim in (2, 3, 5) and values.shape[0] == 1 != shape[0]:
        values = values[0]  # A batch of one.
    cells = math.prod(shape)
    if values.ndim == 2 and values.shape[1] == cells:
        values = values.T
    if values.ndim in (1, 2) and values.shape[0] == cells:
        values = values.reshape(*shape, *values.shape[1:])
    return np.moveaxis(values, -1, 0) if values.ndim == 4 and values.shape[:3] == shape else values


def from_embodied_classes(labels: np.ndarray, path: Path) -> np.ndarray:
    """Convert the classes of EmbodiedOcc to ours: 0 becomes unknown (255) and 12 becomes empty (0).

    Raises:
        DamagedFileError: If there is a class above 12.
    """
    if labels.max(initial=0) > EMBODIED_EMPTY:
        raise DamagedFileError(
            path, f"contains the class {labels.max()}, but the classes of EmbodiedOcc end at 12"
        )
    table = np.arange(EMBODIED_CLASSES, dtype=np.uint8)
    table[0], table[EMBODIED_EMPTY] = UNKNOWN, 0
    return table[labels]


def grid_of_labels(labels: np.ndarray, path: Path) -> Grid:
    """Return the supported grid with the shape of these labels.

    Raises:
        DamagedFileError: If there is no such grid.
    """
    for grid in GRIDS.values():
        if grid.shape == labels.shape:
            return grid
    raise DamagedFileError(
        path,
        f"expected 60x60x36 or 30x30x18 cells as x, y, z, got {_sides(labels.shape)}; check the "
        "axis order (--order)",
    )


def _sides(shape: tuple[int, ...]) -> str:
    return "x".join(map(str, shape))


def _order_of(labels: np.ndarray) -> str:
    """Return the axis order in which the shortest side is z."""
    low = labels.shape.index(min(labels.shape))
    return "xzy" if low == 1 else "xyz"


def _channels(values: np.ndarray, path: Path) -> int:
    for axis in (0, -1):
        if values.shape[axis] in (CLASS_COUNT, EMBODIED_CLASSES):
            return axis
    raise DamagedFileError(
        path, f"expected scores with 12 or 13 channels, got shape {values.shape}"
    )


def _read_frame_array(path: Path) -> np.ndarray:
    if path.suffix == ".npy":
        return read_npy(path)
    if path.suffix == ".pkl":
        return _find_array(dict(read_pickle(path)), path)
    names = npz_array_names(path)
    wanted = next((name for name in NAMES if name in names), names[0] if len(names) == 1 else "")
    if not wanted:
        raise DamagedFileError(
            path, f"contains {', '.join(names)}; the array with the grid must be named labels"
        )
    return read_npz(path, (wanted,))[wanted]


def _find_array(arrays: dict[str, Any], path: Path) -> np.ndarray:
    for name in (*NAMES, *arrays):
        value = arrays.get(name)
        if isinstance(value, np.ndarray) and math.prod(value.shape) > 1:
            return value
    raise DamagedFileError(path, "contains no array")
