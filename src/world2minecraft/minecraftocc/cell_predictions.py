"""Predicted cell labels in the npz file format of ``w2m occupy``.

The cells of a frame follow the axes of its grid file; those of a capture follow the room axes. The
``axes`` entry of the file names the order of the array axes: ``xzy`` is x right, z up, y forward,
as in NYUv2 files, and ``xyz`` has z last.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.files import write_npz
from world2minecraft.core.types import Camera, OccupancyGrid, View
from world2minecraft.minecraftocc.scene_completion import FILE_AXES, SHAPE, VOXEL_M, GridPlace
from world2minecraft.reconstruction.occupancy.monocular_occupancy import fitted
from world2minecraft.reconstruction.occupancy.onnx_network import OccupancyNetwork

OBSERVED = 1  # Of ``OccupancyGrid.source``.


@dataclass(frozen=True, eq=False)
class PredictedCells:
    """Predicted labels for a grid of cells, with the axes x, y and z (up)."""

    labels: np.ndarray  # uint8 [X, Y, Z], 0 to 11, or 255 where nothing was observed
    confidence: np.ndarray  # float [X, Y, Z], 0 to 1
    observed: np.ndarray  # bool [X, Y, Z]; the rest is completed, or unknown
    voxel_m: float
    origin_m: np.ndarray  # float64 [3], minimum corner of cell (0, 0, 0)


def write_cells(out: Path, cells: PredictedCells, axes: str, **more: np.ndarray) -> None:
    """Write predicted cells to an npz file.

    The file contains labels, confidence, observed, voxel_m, origin_m, axes and the extra arrays.

    Args:
        out: Output file.
        cells: Predictions to write.
        axes: Axis order of the three cell arrays in the file, ``xyz`` or ``xzy``.
        more: Extra arrays to store, such as ``scan_to_room``.

    Raises:
        OutputError: If the file cannot be written.
    """
    order = FILE_AXES if axes == "xzy" else (0, 1, 2)
    write_npz(
        out,
        {
            "labels": cells.labels.transpose(order),
            "confidence": cells.confidence.astype(np.float16).transpose(order),
            "observed": cells.observed.transpose(order),
            "voxel_m": np.array(cells.voxel_m),
            "origin_m": np.asarray(cells.origin_m, np.float64),
            "axes": np.array(axes),
            **more,
        },
    )


def cells_of_room(grid: OccupancyGrid) -> PredictedCells:
    """Convert the occupancy grid of a room to predicted cells. Unseen cells have the label 255."""
    return PredictedCells(
        grid.labels, grid.confidence, grid.source == OBSERVED, grid.voxel_m, grid.origin_m
    )


def resample_to_grid(
    room: PredictedCells, scan_to_room: np.ndarray, place: GridPlace
) -> PredictedCells:
    """Resample the cells of a room to the grid of a grid file by nearest neighbour.

    Args:
        room: Predicted cells along the room axes.
        scan_to_room: Matrix from scan coordinates to room coordinates [4, 4]. The scan must have
            the same world coordinates as the grid file.
        place: Position of the grid in the scan.

    Raises:
        InputError: If the grid does not overlap the cells of the room.
    """
    centers_m = (np.moveaxis(np.indices(SHAPE), 0, -1) + 0.5) * VOXEL_M + place.origin_m
    at = (apply(scan_to_room, centers_m) - room.origin_m) / room.voxel_m
    cells = np.floor(at).astype(np.int64)
    within = (cells >= 0) & (cells < np.array(room.labels.shape))
    inside = np.asarray(within.all(axis=-1), bool)
    if not inside.any():
        raise InputError(
            "grid",
            "does not overlap the captured area; check that it has the same world coordinates",
        )
    index = tuple(np.moveaxis(np.where(inside[..., None], cells, 0), -1, 0))
    return PredictedCells(
        np.where(inside, room.labels[index], np.uint8(UNKNOWN)),
        np.where(inside, room.confidence[index], 0).astype(np.float32),
        inside & room.observed[index],
        VOXEL_M,
        place.origin_m,
    )


def predict_cells(
    photo: np.ndarray, camera: Camera, place: GridPlace, network: OccupancyNetwork
) -> PredictedCells:
    """Predict the grid of a frame from a single photo with a monocular network.

    If the network's cells are twice as large, each of them is split into eight cells with the same
    prediction. No cell is marked as observed, because all of them are estimates.

    Args:
        photo: Colour image, uint8 [H, W, 3].
        camera: Camera of the photo.
        place: Position of the grid and pose of the camera.
        network: Network without depth input, whose grid covers the same volume as the frame grid.

    Raises:
        UsageError: If the network requires depth, or if its grid covers a different volume.
    """
    facts = network.facts
    if facts.wants_depth:
        raise UsageError(
            f"{facts.name} requires depth; choose a network trained without --depth given"
        )
    times = round(facts.voxel_m / VOXEL_M)
    sides_of_ours = tuple(side * times for side in facts.grid_shape)
    if not np.isclose(times * VOXEL_M, facts.voxel_m) or sides_of_ours != SHAPE:
        sides = "x".join(map(str, facts.grid_shape))
        raise UsageError(
            f"{facts.name} has a grid of {sides} cells of {facts.voxel_m:g} m; choose a network "
            "with 60x60x36 cells of 0.08 m or 30x30x18 cells of 0.16 m"
        )
    view = View(
        name="frame", camera_to_scan=place.camera_to_world, colour=photo, colour_camera=camera
    )
    picture, fitting = fitted(view, facts.image_size_px)
    world_to_grid = np.eye(4)
    world_to_grid[:3, 3] = -place.origin_m
    chance = network.probabilities(
        np.moveaxis(picture, 2, 0).astype(np.float32) / np.float32(255),
        fitting.matrix,
        world_to_grid @ place.camera_to_world,
    )
    for axis in range(3):
        chance = np.repeat(chance, times, axis=axis)
    return PredictedCells(
        chance.argmax(axis=-1).astype(np.uint8),
        chance.max(axis=-1),
        np.zeros(SHAPE, bool),
        VOXEL_M,
        place.origin_m,
    )
