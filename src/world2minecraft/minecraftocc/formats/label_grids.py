"""The labelled box of an image, in its own axes or the room's, and the grid of a whole scene."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, cell_centers_m, invert_rigid, turn_grid
from world2minecraft.core.errors import InputError, LimitError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.formats.image_conventions import HALF_PX, HEIGHT_PX, WIDTH_PX
from world2minecraft.minecraftocc.formats.safe_pickle import read_pickle
from world2minecraft.minecraftocc.types import DEFAULT_SHAPE, DEFAULT_VOXEL_M, OccSample

TURN_TOLERANCE_DEG = 0.01
MAX_CELLS = 100_000_000  # A hall of 64 x 64 x 12 m; its package would take 1.4 GB.


@dataclass(frozen=True, eq=False)
class LabelledBox:
    """A box of cells along the axes of a world, and the camera in that world."""

    labels: np.ndarray  # uint8 [60, 60, 36] as x, y, z up
    origin_m: np.ndarray  # float64 [3], minimum corner of cell (0, 0, 0)
    camera_to_world: np.ndarray  # float64 [4, 4]


def check_standard_region(sample: OccSample) -> None:
    """Refuse a region that the papers' loaders cannot hold.

    Raises:
        InputError: its shape or its voxel size is another.
    """
    region = sample.occ.region
    if region.shape != DEFAULT_SHAPE or abs(region.voxel_m - DEFAULT_VOXEL_M) > 1e-9:
        sides = "x".join(str(side) for side in region.shape)
        raise InputError(
            sample.key,
            f"its region is {sides} cells of {region.voxel_m:g} m; this format holds 60x60x36 of "
            "0.08 m alone: build the data set so, or export to npz",
        )


def region_box(sample: OccSample) -> LabelledBox:
    """Return the box in the region's own world: x right, y forward, z up, its corner at 0."""
    camera_to_region = invert_rigid(sample.occ.region.region_to_room) @ sample.camera_to_room
    return LabelledBox(sample.occ.labels, np.zeros(3), camera_to_region)


def room_box(sample: OccSample) -> LabelledBox | None:
    """Return the box along the room's axes, or None where it is turned by no quarter."""
    region = sample.occ.region
    turn_deg = np.degrees(np.arctan2(region.region_to_room[1, 0], region.region_to_room[0, 0]))
    quarters = round(turn_deg / 90)
    if abs(turn_deg - 90 * quarters) > TURN_TOLERANCE_DEG:
        return None
    ends = np.array([[0.0, 0, 0], region.shape]) * region.voxel_m
    origin_m = apply(region.region_to_room, ends).min(axis=0)
    labels = np.ascontiguousarray(turn_grid(sample.occ.labels, quarters))
    return LabelledBox(labels, origin_m, sample.camera_to_room)


def cells_in_image(
    shape: tuple[int, ...],
    voxel_m: float,
    box_to_camera: np.ndarray,
    camera: Camera,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Project the centres of a box's cells, as the loaders do.

    Returns:
        Which fall into the image in front of the camera, bool [X, Y, Z]; their pixels int64
        [X, Y, Z, 2] (column, row) and their depths float64 [X, Y, Z], sound only where they do.
    """
    centres = (np.moveaxis(np.indices(shape), 0, -1) + 0.5) * voxel_m
    points = apply(box_to_camera, centres)
    depth_m = points[..., 2]
    in_front = depth_m > 1e-6
    safe = np.where(in_front, depth_m, 1.0)
    across = points[..., 0] / safe * camera.fx_px + camera.cx_px
    down = points[..., 1] / safe * camera.fy_px + camera.cy_px
    inside = in_front & (across >= 0) & (across < camera.width_px)
    inside &= (down >= 0) & (down < camera.height_px)
    pixels = np.stack([np.where(inside, across, 0), np.where(inside, down, 0)], axis=-1)
    return inside, np.floor(pixels).astype(np.int64), depth_m


def box_cells_in_image(box: LabelledBox, camera: Camera) -> np.ndarray:
    """Return which cells of a box fall into an image, bool [60, 60, 36]."""
    box_to_world = np.eye(4)
    box_to_world[:3, 3] = box.origin_m
    box_to_camera = invert_rigid(box.camera_to_world) @ box_to_world
    return cells_in_image(box.labels.shape, DEFAULT_VOXEL_M, box_to_camera, camera)[0]


def export_labels(labels: np.ndarray, in_image: np.ndarray | None, unknown: str) -> np.ndarray:
    """Return labels with cells outside the image unknown, and unknown kept or made empty."""
    result = labels if in_image is None else np.where(in_image, labels, UNKNOWN)
    if unknown == "empty":
        result = np.where(result == UNKNOWN, 0, result)
    return np.ascontiguousarray(result.astype(np.uint8))


@dataclass(frozen=True, eq=False)
class SceneGrid:
    """Cells along the room's axes, in step with the first box; others lie to the nearest cell."""

    shape: tuple[int, int, int]
    origin_m: np.ndarray  # float64 [3]
    voxel_m: float

    @classmethod
    def around(cls, origins_m: Sequence[np.ndarray], voxel_m: float) -> "SceneGrid":
        """Return the smallest grid that holds usual boxes with these minimum corners.

        Raises:
            LimitError: it would be larger than any home.
        """
        steps = np.array([np.round((at - origins_m[0]) / voxel_m) for at in origins_m])
        low, high = steps.min(axis=0), steps.max(axis=0) + DEFAULT_SHAPE
        sides = (high - low).astype(np.int64)
        if np.prod(sides.astype(np.float64)) > MAX_CELLS:
            raise LimitError("scene", f"its frames span {sides.tolist()} cells; too far apart")
        shape = (int(sides[0]), int(sides[1]), int(sides[2]))
        return cls(shape, origins_m[0] + low * voxel_m, voxel_m)

    def slices(self, origin_m: np.ndarray) -> tuple[slice, ...]:
        """Return where the box with this minimum corner lies."""
        first = np.round((origin_m - self.origin_m) / self.voxel_m).astype(int)
        return tuple(slice(at, at + side) for at, side in zip(first, DEFAULT_SHAPE, strict=True))

    def centers_m(self) -> np.ndarray:
        """Return the centres of all cells in the room, float64 [X, Y, Z, 3]."""
        return cell_centers_m(
            np.moveaxis(np.indices(self.shape), 0, -1), self.origin_m, self.voxel_m
        )


@dataclass(frozen=True, eq=False)
class StoredFrame:
    """A frame of OccScanNet as scenes are made of it."""

    labels: np.ndarray  # uint8 [60, 60, 36] as x, y, z
    origin_m: np.ndarray
    in_image: np.ndarray  # bool [60, 60, 36]


def read_stored_frame(path: Path) -> StoredFrame:
    """Read the box of a frame that was written as 640x480. Raises what ``read_pickle`` raises."""
    found: dict[str, Any] = read_pickle(path)
    matrix = np.asarray(found["intrinsic"], np.float64)
    camera = Camera(
        WIDTH_PX,
        HEIGHT_PX,
        matrix[0, 0],
        matrix[1, 1],
        matrix[0, 2] + HALF_PX,
        matrix[1, 2] + HALF_PX,
    )
    labels = np.ascontiguousarray(found["target_1_4"].transpose(1, 0, 2))
    box = LabelledBox(labels, np.asarray(found["voxel_origin"]), np.asarray(found["cam_pose"]))
    return StoredFrame(labels, box.origin_m, box_cells_in_image(box, camera))
