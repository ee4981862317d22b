"""Reading of the ground truth files ``truth.npz`` and ``truth.json``.

The files are in the folder of a virtual scan, or in another folder if ``truth.json`` contains the
path of the scan (``capture``, relative to that folder).
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass, class_id
from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.files import npz_array_names, read_json, read_npz
from world2minecraft.core.types import Layout, LayoutObject, checks
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.formats.layout import layout_from_json

ARRAYS = ("labels", "voxel_m", "origin_m", "truth_room_to_scan")
POSE_TOLERANCE = 1e-2  # Poses of other data sets are rounded.


@dataclass(frozen=True, eq=False)
class Truth:
    """The ground truth of a scanned room in its own frame.

    With ``surface``, the ground truth is a scanned surface, such as the mesh of a data set, instead
    of a generated room. Such a ground truth is partial: cells with 255 are unknown and not scored,
    and orientations, openings and rooms are unknown.

    Attributes:
        folder: The folder of the files.
        labels: The labels as uint8 [A, B, C].
        voxel_m: The cell size in metres.
        origin_m: The minimum corner of the grid as float64 [3].
        truth_to_scan: The transform to the frame of the capture as float64 [4, 4].
        objects: The true objects.
        layouts: The true rooms.
        camera_to_truth: The true pose of each frame by name. None in old files, for which the
            recorded poses are used.
        depth_scale: The depth scale error of each frame by name, or None.
        surface: The surface cells as bool [A, B, C], or None for a generated room.
        capture: The folder of the capture.
    """

    folder: Path
    labels: np.ndarray
    voxel_m: float
    origin_m: np.ndarray
    truth_to_scan: np.ndarray
    objects: tuple[LayoutObject, ...]
    layouts: tuple[Layout, ...] = ()
    camera_to_truth: dict[str, np.ndarray] | None = None
    depth_scale: dict[str, float] | None = None
    surface: np.ndarray | None = None
    capture: Path = Path()

    def __post_init__(self):
        put = object.__setattr__
        put(self, "labels", checks.labels("labels", self.labels, (None, None, None)))
        put(self, "voxel_m", checks.voxel_size(self.voxel_m))
        checks.extent(self.labels.shape, self.voxel_m)
        put(self, "origin_m", checks.coordinates("origin_m", self.origin_m, (3,)))
        put(self, "truth_to_scan", checks.transform("truth_room_to_scan", self.truth_to_scan))
        for frame, pose in (self.camera_to_truth or {}).items():
            checks.transform(f"camera_to_truth of {frame}", pose, POSE_TOLERANCE)
        for frame, scale in (self.depth_scale or {}).items():
            checks.positive(f"depth_scale of {frame}", scale)
        if self.surface is not None:
            shape = self.labels.shape
            put(self, "surface", checks.array("surface", self.surface, np.bool_, shape))
            if ((self.labels > 0) & (self.labels != UNKNOWN) & ~self.surface).any():
                raise ValueError("surface must include every cell that has a class")

    @property
    def is_partial(self) -> bool:
        """Whether only a scanned surface is known."""
        return self.surface is not None

    @property
    def solid(self) -> np.ndarray:
        """The cells that stop rays, as uint8 [A, B, C] with 0 for free cells.

        Surface cells without a class have the class objs.
        """
        if self.surface is None:
            return self.labels
        solid = np.where(self.surface, self.labels, np.uint8(0))
        solid[solid == UNKNOWN] = SemanticClass.OBJS
        return solid


def read_truth(folder: Path) -> Truth:
    """Read ``truth.npz`` and ``truth.json`` from a folder.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a file is not a valid ground truth.
        ConflictError: If another process is changing the folder.
    """
    return read_whole(folder, lambda: _read(folder))


def _read(folder: Path) -> Truth:
    path = folder / "truth.npz"
    if not path.is_file():
        raise InputError(
            path,
            "ground truth not found; w2m rooms scan writes it, and w2m evaluate scannet "
            "creates it for a ScanNet scene",
        )
    stated = read_json(folder / "truth.json")
    try:
        objects = tuple(_object(row) for row in stated["objects"])
        layouts = _layouts(stated)
        capture = folder / str(stated.get("capture", ""))
    except KeyError as error:
        raise DamagedFileError(
            folder / "truth.json",
            f"not a valid ground truth: {error} is missing; see docs/reference/metrics.md",
        ) from error
    except (*MALFORMED, UnknownNameError) as error:
        raise DamagedFileError(
            folder / "truth.json", f"not a valid ground truth ({error})"
        ) from error
    arrays = read_npz(path, ARRAYS)
    try:
        return Truth(
            folder=folder,
            labels=arrays["labels"],
            voxel_m=float(arrays["voxel_m"]),
            origin_m=arrays["origin_m"],
            truth_to_scan=arrays["truth_room_to_scan"],
            objects=objects,
            layouts=layouts,
            camera_to_truth=_by_frame(path, "camera_to_truth", (4, 4)),
            depth_scale=_by_frame(path, "depth_scale", ()),
            surface=_surface(path),
            capture=capture,
        )
    except MALFORMED as error:
        raise DamagedFileError(path, f"not a valid ground truth ({error})") from error


def read_instances(truth: Truth) -> np.ndarray:
    """Read the true instances as uint16 [A, B, C]: n for the n-th of ``truth.objects``, or 0.

    Raises:
        DamagedFileError: If the array is missing, or is not uint16 of the shape of the labels.
    """
    path = truth.folder / "truth.npz"
    instance = read_npz(path, ("instance",))["instance"]
    if instance.shape != truth.labels.shape or instance.dtype != np.uint16:
        raise DamagedFileError(
            path,
            f"instance must be uint16 of the shape of the labels, {truth.labels.shape}, got "
            f"{instance.dtype} {instance.shape}",
        )
    return instance


def read_colour(truth: Truth) -> np.ndarray | None:
    """Read the true colours as uint8 [A, B, C, 3], or return None for a truth without colours.

    Raises:
        DamagedFileError: If the array cannot be read.
    """
    path = truth.folder / "truth.npz"
    if "colour" not in npz_array_names(path):
        return None
    colour = read_npz(path, ("colour",))["colour"]
    is_valid = colour.shape == (*truth.labels.shape, 3) and colour.dtype == np.uint8
    return colour if is_valid else None


def _object(row: dict[str, Any]) -> LayoutObject:
    return LayoutObject(
        class_id(row["class"]), row["center_m"], row["size_m"], row["yaw_deg"], row["name"]
    )


def _layouts(stated: dict[str, Any]) -> tuple[Layout, ...]:
    """Return the rooms. Old files only contain the size of a single room."""
    if "layouts" in stated:
        return tuple(layout_from_json(row) for row in stated["layouts"])
    if "size_m" not in stated:
        return ()
    width, depth, height = stated["size_m"]
    outline = np.array([[0, 0], [width, 0], [width, depth], [0, depth]], np.float64)
    return (Layout(outline, height),)


def _surface(path: Path) -> np.ndarray | None:
    return read_npz(path, ("surface",))["surface"] if "surface" in npz_array_names(path) else None


def _by_frame(path: Path, key: str, shape: tuple[int, ...]) -> Any:
    """Return an array [F, ...] as a mapping by frame, or None if it is missing."""
    names = npz_array_names(path)
    if key not in names or "frame_names" not in names:
        return None
    arrays = read_npz(path, ("frame_names", key))
    frames, values = [str(name) for name in arrays["frame_names"]], arrays[key]
    if values.shape != (len(frames), *shape) or not np.isfinite(values).all():
        raise ValueError(f"{key} must have shape {shape} for each of the {len(frames)} frames")
    return dict(zip(frames, values.astype(np.float64), strict=True))
