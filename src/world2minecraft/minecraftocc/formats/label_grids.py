"""The labelled box of an image, in region or room axes, and the grid of a complete scene."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, cell_centers_m, invert_rigid, turn_grid
from world2minecraft.core.errors import InputError, LimitError
from world2minecraft.core.types import Camera
from world2minecraft.formats.safe_pickle import read_pickle
from world2minecraft.geometry.unprojection import unproject_depth
from world2minecraft.minecraftocc.formats.image_conventions import HALF_PX, HEIGHT_PX, WIDTH_PX
from world2minecraft.minecraftocc.types import (
    DEFAULT_SHAPE,
    DEFAULT_VOXEL_M,
    LabelRegion,
    OccSample,
)

TURN_TOLERANCE_DEG = 0.01
MAX_CELLS = 100_000_000  # A hall of 64 x 64 x 12 m; its package would take 1.4 GB.
INTO_CELL = 0.25  # Of a cell: how far behind its depth a surface point is moved into its cell.


@dataclass(frozen=True, eq=False)
class LabelledBox:
    """A box of labelled cells along the axes of a world, with the camera pose in that world.

    Attributes:
        labels: Class of each cell, uint8 [60, 60, 36], with axes x, y and z (up).
        origin_m: Minimum corner of cell (0, 0, 0) in metres, float64 [3].
        camera_to_world: Camera pose in the world, float64 [4, 4].
    """

    labels: np.ndarray
    origin_m: np.ndarray
    camera_to_world: np.ndarray


def check_standard_region(sample: OccSample) -> None:
    """Check that the region of a sample has the size that the published loaders require.

    Raises:
        InputError: If its shape or voxel size differs.
    """
    region = sample.occ.region
    if region.shape != DEFAULT_SHAPE or abs(region.voxel_m - DEFAULT_VOXEL_M) > 1e-9:
        sides = "x".join(str(side) for side in region.shape)
        raise InputError(
            sample.key,
            f"the region has {sides} cells of {region.voxel_m:g} m, but this format needs 60x60x36 "
            "cells of 0.08 m; export to npz, or build the data set with this region",
        )


def region_box(sample: OccSample) -> LabelledBox:
    """Return the box of a sample in region coordinates (x right, y forward, z up, corner at 0)."""
    camera_to_region = invert_rigid(sample.occ.region.region_to_room) @ sample.camera_to_room
    return LabelledBox(sample.occ.labels, np.zeros(3), camera_to_region)


def room_box(sample: OccSample) -> LabelledBox | None:
    """Return the box of a sample along the room axes, or None if it is not aligned with them."""
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
    """Project the centres of a box's cells into an image, in the same way as the published loaders.

    Returns:
        Three arrays. The first states whether each cell is in front of the camera and inside the
        image, bool [X, Y, Z]. The others are the pixel positions (column, row), int64 [X, Y, Z, 2],
        and the depths in metres, float64 [X, Y, Z]; they are valid only for cells inside the image.
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


def cells_behind_depth(
    depth_m: np.ndarray, camera: Camera, region: LabelRegion, camera_to_region: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the cell just behind the surface that each pixel sees.

    Args:
        depth_m: Depth along the camera's z axis in metres, float32 [H, W]; 0 for none.
        camera: Camera of the depth.
        region: Region of the cells.
        camera_to_region: Matrix from camera coordinates to region coordinates, float64 [4, 4].

    Returns:
        The flat indices of the pixels in ascending order, int32 [N], and their cells in the region,
        int64 [N, 3]. Pixels that see surfaces outside the region are omitted.
    """
    finite = np.isfinite(depth_m) & (depth_m > 0)
    behind = np.where(finite, depth_m + np.float32(INTO_CELL * region.voxel_m), 0)
    points, pixels = unproject_depth(behind.astype(np.float32), camera, camera_to_region)
    cells = np.floor(points / np.float32(region.voxel_m)).astype(np.int64)
    within = np.all((cells >= 0) & (cells < region.shape), axis=1)
    return pixels[within], cells[within]


def box_cells_in_image(box: LabelledBox, camera: Camera) -> np.ndarray:
    """Return whether the centre of each cell of a box is inside an image, bool [60, 60, 36]."""
    box_to_world = np.eye(4)
    box_to_world[:3, 3] = box.origin_m
    box_to_camera = invert_rigid(box.camera_to_world) @ box_to_world
    return cells_in_image(box.labels.shape, DEFAULT_VOXEL_M, box_to_camera, camera)[0]


def export_labels(labels: np.ndarray, in_image: np.ndarray | None, unknown: str) -> np.ndarray:
    """Prepare labels for export.

    Args:
        labels: Class of each cell, 255 for unknown.
        in_image: Whether each cell is inside the image; other cells become unknown. None changes no
            cells.
        unknown: ``keep`` (255) or ``empty`` (0): the value to write for unknown cells.
    """
    result = labels if in_image is None else np.where(in_image, labels, UNKNOWN)
    if unknown == "empty":
        result = np.where(result == UNKNOWN, 0, result)
    return np.ascontiguousarray(result.astype(np.uint8))


@dataclass(frozen=True, eq=False)
class SceneGrid:
    """The grid of a complete scene along the room axes.

    The grid is aligned with the first box; other boxes are rounded to the nearest cell.
    """

    shape: tuple[int, int, int]
    origin_m: np.ndarray  # float64 [3]
    voxel_m: float

    @classmethod
    def around(cls, origins_m: Sequence[np.ndarray], voxel_m: float) -> "SceneGrid":
        """Return the smallest grid that contains the standard boxes with the given minimum corners.

        Raises:
            LimitError: If the grid has more than ``MAX_CELLS`` cells.
        """
        steps = np.array([np.round((at - origins_m[0]) / voxel_m) for at in origins_m])
        low, high = steps.min(axis=0), steps.max(axis=0) + DEFAULT_SHAPE
        sides = (high - low).astype(np.int64)
        if np.prod(sides.astype(np.float64)) > MAX_CELLS:
            raise LimitError(
                "scene", f"the frames are too far apart: they span {sides.tolist()} cells"
            )
        shape = (int(sides[0]), int(sides[1]), int(sides[2]))
        return cls(shape, origins_m[0] + low * voxel_m, voxel_m)

    def slices(self, origin_m: np.ndarray) -> tuple[slice, ...]:
        """Return the slices of the grid that the box with this minimum corner covers."""
        first = np.round((origin_m - self.origin_m) / self.voxel_m).astype(int)
        return tuple(slice(at, at + side) for at, side in zip(first, DEFAULT_SHAPE, strict=True))

    def centers_m(self) -> np.ndarray:
        """Return the centres of all cells in room coordinates in metres, float64 [X, Y, Z, 3]."""
        return cell_centers_m(
            np.moveaxis(np.indices(self.shape), 0, -1), self.origin_m, self.voxel_m
        )


@dataclass(frozen=True, eq=False)
class StoredFrame:
    """An OccScanNet frame, as needed to assemble a scene.

    Attributes:
        labels: Class of each cell, uint8 [60, 60, 36], with axes x, y and z.
        origin_m: Minimum corner of the box in metres, float64 [3].
        in_image: Whether each cell is inside the image, bool [60, 60, 36].
    """

    labels: np.ndarray
    origin_m: np.ndarray
    in_image: np.ndarray


def read_stored_frame(path: Path) -> StoredFrame:
    """Read the box of a frame that was exported at 640x480 pixels.

    Raises the same exceptions as ``read_pickle``.
    """
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
