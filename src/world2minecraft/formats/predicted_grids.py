"""Semantic occupancy grids as other programs save them, in the conventions of these programs.

A file contains class ids, or scores with a channel for each class on the first or last axis, as
``.npy``, ``.npz``, a pickled dictionary (read without running code) or SSCNet's ``.bin``. The names
of a convention state the order of the axes:

===============  ============================================  ==================================
convention       axes of a frame's array                       box of a frame
===============  ============================================  ==================================
``w2m``          x, y, z                                       any; 60x60x36 cells of 0.08 m
``monoscene``    x, z, y                                       60x36x60 cells of 0.08 m
``sscnet``       x, z, y                                       60x36x60, or 240x144x240 of 0.02 m
``iso``          x, z, y (NYUv2) or y, x, z (OccScanNet)       60x36x60 or 60x60x36
``embodiedocc``  x, y, z                                       60x60x36
===============  ============================================  ==================================

In all of them z points up, ``voxel_origin`` is the minimum corner of the first cell and
``cam_pose`` transforms an OpenCV camera to the world of that corner.
"""

import math
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.archives import UNREADABLE
from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    UnknownNameError,
)
from world2minecraft.core.files import npz_array_names, read_npy, read_npz
from world2minecraft.core.types import checks
from world2minecraft.formats.class_ids import EMBODIED_EMPTY, ClassSet, read_class_set
from world2minecraft.formats.safe_pickle import read_pickle
from world2minecraft.formats.sscnet import FINE_PER_CELL, FINE_SHAPE, downsample_labels, read_bin
from world2minecraft.geometry.rotations import nearest_rigid

# How an array's axes lie: which of them are our x, y, z. Each is its own inverse.
ORDERS = {"xyz": (0, 1, 2), "xzy": (0, 2, 1), "yxz": (1, 0, 2)}
CONVENTIONS = ("w2m", "monoscene", "iso", "embodiedocc", "sscnet")
SCORES = ("probabilities", "logits")
SUFFIXES = (".npy", ".npz", ".pkl", ".bin")
NAMES = (
    *("labels", "y_pred", "pred", "prediction", "probabilities", "logits"),
    *("target_1_4", "local_label", "global_labels"),
)
STORED_YXZ = ("target_1_4", "local_label")  # Files of OccScanNet; NYUv2's are told by their shape.
ORIGINS = ("voxel_origin", "vox_origin", "origin_m")
POSES = ("cam_pose", "camera_to_world")
BOX_SIDES = (5, 5, 3)  # Of a frame's box along x, y, z.
BOX_M = 4.8  # Its longest side.
MAX_CELLS = 16_000_000  # A scene of 20 x 20 x 3 m has 2.3 million; its evidence takes 400 MB here.
MAX_BYTES = 1 << 30  # Scores of float32 with 13 channels of 16 million cells take 830 MB.
MAX_SKEW = 1e-3  # A pose of float32, or of a few printed digits, is put right within this.
SUM_TOLERANCE = 0.02  # Probabilities of float16 are off by up to 0.006.


@dataclass(frozen=True, eq=False)
class StoredGrid:
    """The arrays of a file, before its axes and classes are interpreted.

    Attributes:
        path: File.
        name: Name of the array in the file; empty for a ``.npy`` file.
        values: Class ids [A, B, C], or scores with one more axis.
        origin_m: Minimum corner of the first cell in the world, float64 [3], or None.
        camera_to_world: Camera pose in the world of the corner, float64 [4, 4], or None.
        voxel_m: Edge length of a cell in metres, or None.
        scan_to_world: Transform from the scan to the world of the corner, or None.
        axes: Axis order that the file states; empty if it states none.
    """

    path: Path
    name: str
    values: np.ndarray
    origin_m: np.ndarray | None = None
    camera_to_world: np.ndarray | None = None
    voxel_m: float | None = None
    scan_to_world: np.ndarray | None = None
    axes: str = ""

    @property
    def channel_axis(self) -> int | None:
        """The axis of the score channels (0 or 3), or None for class ids."""
        if self.values.ndim != 4:
            return None
        return 0 if self.values.shape[0] <= self.values.shape[3] else 3

    @property
    def cells(self) -> tuple[int, int, int]:
        """The number of cells along each axis of the array."""
        axis, shape = self.channel_axis, self.values.shape
        sides = shape if axis is None else shape[1:] if axis == 0 else shape[:3]
        return sides[0], sides[1], sides[2]

    @property
    def channels(self) -> int:
        """The number of score channels, or 0 for class ids."""
        return 0 if self.channel_axis is None else self.values.shape[self.channel_axis]


@dataclass(frozen=True)
class GridRules:
    """How the arrays of a folder are interpreted.

    Attributes:
        convention: One of ``CONVENTIONS``; empty to detect it from each file.
        classes: Name or file of a class set; empty to detect it from each file.
        scores: ``probabilities`` or ``logits``.
    """

    convention: str = ""
    classes: str = ""
    scores: str = "probabilities"

    def __post_init__(self):
        if self.convention and self.convention not in CONVENTIONS:
            raise UnknownNameError("convention", self.convention, CONVENTIONS)
        if self.scores not in SCORES:
            raise UnknownNameError("kind of scores", self.scores, SCORES)


@dataclass(frozen=True, eq=False)
class PredictedGrid:
    """A predicted grid with the axes x, y and z (up) and the 12 classes.

    Attributes:
        path: File of the grid.
        labels: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z].
        shares: Probability of each class, float16 [X, Y, Z, 12], or None for a file of class ids.
        voxel_m: Edge length of a cell in metres.
        origin_m: Minimum corner of the first cell in the world, float64 [3], or None.
        camera_to_world: Camera pose in the world of the corner, float64 [4, 4], or None.
        scan_to_world: Transform from the scan to the world of the corner, or None.
        convention: Convention of the file.
        axes: Order of the axes in the file.
    """

    path: Path
    labels: np.ndarray
    shares: np.ndarray | None
    voxel_m: float
    origin_m: np.ndarray | None
    camera_to_world: np.ndarray | None
    scan_to_world: np.ndarray | None
    convention: str
    axes: str

    def probabilities(self) -> np.ndarray:
        """Return the probability of each class, float16 [X, Y, Z, 12]; 0 in unknown cells."""
        if self.shares is not None:
            return self.shares
        one_hot = np.zeros((UNKNOWN + 1, CLASS_COUNT), np.float16)
        one_hot[np.arange(CLASS_COUNT), np.arange(CLASS_COUNT)] = 1
        return one_hot[self.labels]


def read_stored_grid(path: Path) -> StoredGrid:
    """Read a file without interpreting its axes and classes.

    Raises:
        InputError: If the file cannot be read or has an unknown suffix.
        DamagedFileError: If the file is not valid in its format or contains no grid.
        LimitError: If the grid has too many cells.
    """
    if path.suffix == ".bin":
        return _read_sscnet(path)
    arrays, name = _arrays(path)
    values = np.asarray(arrays[name])
    if values.ndim == 5 and values.shape[0] == 1:
        values = values[0]
    if values.ndim not in (3, 4):
        raise DamagedFileError(
            path, f"must contain a grid with three axes, or four with scores, got {values.shape}"
        )
    if values.dtype.kind not in "iuf":
        raise DamagedFileError(
            path, f"must contain class ids or scores, got values of type {values.dtype}"
        )
    found = StoredGrid(path, name, values, **_place(arrays, path))
    if 0 in values.shape:
        raise DamagedFileError(path, f"contains an empty grid of shape {values.shape}")
    if math.prod(found.cells) > MAX_CELLS:
        raise LimitError(path, f"has {math.prod(found.cells):,} cells; the limit is {MAX_CELLS:,}")
    return found


def _read_sscnet(path: Path) -> StoredGrid:
    frame = read_bin(path)
    pose = _rigid(frame.camera_to_world, path)
    labels = downsample_labels(frame.labels, FINE_PER_CELL)
    origin_m = _numbers(frame.origin_m, (3,), "vox_origin", path)
    return StoredGrid(path, "", labels, origin_m, pose, BOX_M / FINE_SHAPE[0] * FINE_PER_CELL)


def _arrays(path: Path) -> tuple[dict[str, Any], str]:
    """Return the arrays of a file by name, and the name of the grid."""
    if path.suffix not in SUFFIXES:
        raise InputError(path, f"is not a grid; expected a file with {', '.join(SUFFIXES)}")
    if path.suffix == ".npy":
        _check_bytes(path, path.stat().st_size if path.is_file() else 0)
        return {"": read_npy(path)}, ""
    if path.suffix == ".pkl":
        arrays = dict(read_pickle(path))
        names = [name for name, value in arrays.items() if _is_grid(value)]
    else:
        _check_unpacked(path)
        arrays = read_npz(path, npz_array_names(path))
        names = [name for name, value in arrays.items() if _is_grid(value)]
    wanted = next((name for name in NAMES if name in names), names[0] if len(names) == 1 else None)
    if wanted is None:
        held = ", ".join(arrays) or "nothing"
        raise DamagedFileError(
            path, f"contains {held}; the array with the grid must be named labels or probabilities"
        )
    return arrays, wanted


def _check_unpacked(path: Path) -> None:
    """Check the size of a ``.npz`` file before it is unpacked."""
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(entry.file_size for entry in archive.infolist())
    except UNREADABLE as error:
        raise DamagedFileError(path, f"is not a readable .npz ({error})") from error
    _check_bytes(path, size)


def _check_bytes(path: Path, size: int) -> None:
    if size > MAX_BYTES:
        raise LimitError(path, f"has {size:,} bytes; the limit is {MAX_BYTES:,}")


def _is_grid(value: Any) -> bool:
    return isinstance(value, np.ndarray) and value.ndim in (3, 4, 5) and value.size > 0


def _place(arrays: dict[str, Any], path: Path) -> dict[str, Any]:
    """Return what a file states on the place of its grid."""
    found: dict[str, Any] = {}
    for name in ORIGINS:
        if name in arrays:
            found["origin_m"] = _numbers(arrays[name], (3,), name, path)
    for name in POSES:
        if name in arrays:
            found["camera_to_world"] = _rigid(arrays[name], path, name)
    if "voxel_m" in arrays:
        side = _numbers(arrays["voxel_m"], (), "voxel_m", path).item()
        if not 0.005 <= side <= 1:
            raise DamagedFileError(path, f"voxel_m must be 0.005 to 1 m, got {side:g}")
        found["voxel_m"] = side
    if "scan_to_room" in arrays:
        found["scan_to_world"] = _rigid(arrays["scan_to_room"], path, "scan_to_room")
    centres = arrays.get("global_pts")
    if isinstance(centres, np.ndarray) and centres.ndim == 4 and centres.shape[3] == 3:
        first = _numbers(centres[0, 0, 0], (3,), "global_pts", path)
        found["origin_m"] = first - 0.5 * found.get("voxel_m", BOX_M / 60)
    axes = arrays.get("axes")
    if axes is not None and str(np.asarray(axes)) in ORDERS:
        found["axes"] = str(np.asarray(axes))
    return found


def _numbers(values: Any, shape: tuple[int, ...], name: str, path: Path) -> np.ndarray:
    try:
        numbers = np.asarray(values, np.float64)
    except MALFORMED as error:
        raise DamagedFileError(path, f"{name} does not consist of numbers") from error
    if shape == () and numbers.size == 1:
        numbers = numbers.reshape(())
    try:
        return checks.coordinates(name, numbers, shape)
    except ValueError as error:
        raise DamagedFileError(path, str(error)) from error


def _rigid(values: Any, path: Path, name: str = "cam_pose") -> np.ndarray:
    """Return a rigid transform with an exact rotation."""
    stored = _numbers(values, (4, 4), name, path)
    if fault := checks.rigid_fault(stored, MAX_SKEW):
        raise DamagedFileError(path, f"{name} is not a rotation and a translation: it {fault}")
    return checks.transform(name, nearest_rigid(stored))


def interpret_grid(stored: StoredGrid, rules: GridRules, *, is_frame: bool) -> PredictedGrid:
    """Return a grid with our axes and classes.

    Args:
        stored: Arrays of the file.
        rules: Convention, classes and kind of scores.
        is_frame: Whether the grid belongs to a single view, whose box has a fixed size.

    Raises:
        DamagedFileError: If the values are not valid, or if the shape contradicts the convention.
        InputError: If the convention cannot be detected.
    """
    convention = rules.convention or _detect_convention(stored, is_frame)
    axes = stored.axes or axes_of(convention, stored.cells, stored.name)
    return read_as(stored, rules, convention, axes, is_frame=is_frame)


def read_as(
    stored: StoredGrid, rules: GridRules, convention: str, axes: str, *, is_frame: bool
) -> PredictedGrid:
    """Return a grid with our axes and classes, for a given order of its axes.

    Raises the exceptions of ``interpret_grid``.
    """
    order = ORDERS[axes]
    sides = tuple(stored.cells[axis] for axis in order)
    voxel_m = _voxel_m(stored, sides, convention) if is_frame else stored.voxel_m or BOX_M / 60
    is_sscnet = stored.path.suffix == ".bin"  # Its codes were converted when it was read.
    classes = read_class_set("nyu12" if is_sscnet else rules.classes or _detect_classes(stored))
    shares = None
    if stored.channel_axis is None:
        labels = classes.convert(stored.values, stored.path).transpose(order)
    else:
        shares = _shares(stored, classes, rules).transpose(*order, 3)
        labels = shares.argmax(axis=3).astype(np.uint8)
        labels[~shares.any(axis=3)] = UNKNOWN
        shares = np.ascontiguousarray(shares, np.float16)
    return PredictedGrid(
        stored.path,
        np.ascontiguousarray(labels),
        shares,
        voxel_m,
        stored.origin_m,
        stored.camera_to_world,
        stored.scan_to_world,
        convention,
        axes,
    )


def axes_of(convention: str, cells: tuple[int, ...], name: str = "") -> str:
    """Return the order of a grid's axes in a convention.

    Example:
        >>> axes_of("iso", (60, 36, 60)), axes_of("iso", (60, 60, 36)), axes_of("w2m", (9, 8, 7))
        ('xzy', 'yxz', 'xyz')
    """
    if convention in ("monoscene", "sscnet") or (convention == "iso" and _is_box(cells, "xzy")):
        return "xzy"
    if convention == "iso" or (convention == "embodiedocc" and name in STORED_YXZ):
        return "yxz"
    return "xyz"


def _is_box(cells: tuple[int, ...], axes: str) -> bool:
    """Return whether a shape is that of a frame's box with this order of axes."""
    sides = [cells[axis] for axis in ORDERS[axes]]
    times = sides[0] // BOX_SIDES[0]
    return times > 0 and sides == [times * side for side in BOX_SIDES]


def _detect_convention(stored: StoredGrid, is_frame: bool) -> str:
    """Return the only convention that a file can have.

    Raises:
        InputError: If there are several.
    """
    if stored.path.suffix == ".bin":
        return "sscnet"
    if stored.axes or stored.scan_to_world is not None:
        return "w2m"
    if _is_box(stored.cells, "xzy"):
        return "monoscene"
    if stored.name in STORED_YXZ:
        return "iso"
    if stored.name == "global_labels" or _is_embodied(stored):
        return "embodiedocc"
    if not is_frame or not _is_box(stored.cells, "xyz"):
        return "w2m"
    raise InputError(
        stored.path,
        f"has {_sides(stored.cells)} cells, which may lie as x, y, z (EmbodiedOcc) or as y, x, z "
        "(ISO); set the convention to embodiedocc or iso (--convention)",
    )


def _detect_classes(stored: StoredGrid) -> str:
    return "embodied" if _is_embodied(stored) else "nyu12"


def _is_embodied(stored: StoredGrid) -> bool:
    """Return whether a grid has 13 channels, or ids up to 12 and 12 among them."""
    if stored.channels:
        return stored.channels == EMBODIED_EMPTY + 1
    values = stored.values
    below = values[values != UNKNOWN]
    return bool(below.size) and bool(below.max() == EMBODIED_EMPTY)


def _voxel_m(stored: StoredGrid, sides: tuple[int, ...], convention: str) -> float:
    """Return the edge length of the cells of a frame, whose box is 4.8 x 4.8 x 2.88 m.

    Raises:
        DamagedFileError: If the shape contradicts the convention.
    """
    if convention == "w2m" and stored.voxel_m is not None:
        return stored.voxel_m
    if _is_box(sides, "xyz"):
        return BOX_M / sides[0]
    implied = {"xzy": "60x36x60", "yxz": "60x60x36", "xyz": "60x60x36"}
    axes = axes_of(convention, stored.cells, stored.name)
    fits = [name for name in CONVENTIONS[1:] if _fits_box(name, stored)]
    help_ = f"--convention {' or '.join(fits)} fits" if fits else "no convention has this shape"
    raise DamagedFileError(
        stored.path,
        f"has {_sides(stored.cells)} cells, but {convention} implies {implied[axes]} as "
        f"{', '.join(axes)}; {help_}",
    )


def _fits_box(convention: str, stored: StoredGrid) -> bool:
    return _is_box(stored.cells, axes_of(convention, stored.cells, stored.name))


def _shares(stored: StoredGrid, classes: ClassSet, rules: GridRules) -> np.ndarray:
    """Return the probabilities of the classes, float32 [A, B, C, 12]."""
    if stored.values.dtype.kind != "f":
        raise DamagedFileError(
            stored.path, f"must contain scores as floats, got {stored.values.dtype}"
        )
    if stored.channels != classes.count:
        raise DamagedFileError(
            stored.path,
            f"has {stored.channels} score channels, but {classes.name} has {classes.count} classes",
        )
    scores = np.moveaxis(stored.values, stored.channel_axis or 0, -1).astype(np.float32)
    if not np.isfinite(scores).all():
        raise DamagedFileError(stored.path, "contains NaN or infinity, expected scores")
    if rules.scores == "logits" or stored.name == "logits":
        scores = np.exp(scores - scores.max(axis=-1, keepdims=True))
        scores /= scores.sum(axis=-1, keepdims=True)
    elif scores.min() < -SUM_TOLERANCE or np.abs(scores.sum(axis=-1) - 1).max() > SUM_TOLERANCE:
        raise DamagedFileError(
            stored.path,
            "contains scores that do not add up to 1 in each cell; if they are logits, add "
            "--set predictions.scores=logits",
        )
    shares = classes.convert_scores(scores)
    table = classes.table[: classes.count]
    return np.where((table[scores.argmax(axis=-1)] < CLASS_COUNT)[..., None], shares, 0)


def _sides(shape: tuple[int, ...]) -> str:
    return "x".join(map(str, shape))


def grid_to_world(grid: PredictedGrid) -> np.ndarray:
    """Return the transform from a grid's minimum corner to its world, float64 [4, 4]."""
    transform = np.eye(4)
    if grid.origin_m is not None:
        transform[:3, 3] = grid.origin_m
    return transform


def grid_to_camera(grid: PredictedGrid) -> np.ndarray | None:
    """Return the transform from a grid's minimum corner to its camera, or None if unknown."""
    if grid.camera_to_world is None or grid.origin_m is None:
        return None
    return invert_rigid(grid.camera_to_world) @ grid_to_world(grid)
