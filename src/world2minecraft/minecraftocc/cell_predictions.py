"""Predicted labels of cells as the npz file that ``w2m occupy`` writes and others read.

A frame's cells lie in the axes of its grid file, those of a capture in the room's. ``axes`` says
which: ``xzy`` is x right, z up, y forward, as NYUv2's files are; ``xyz`` has z last.
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
    """Labels of a grid along its world's axes x, y, z up."""

    labels: np.ndarray  # uint8 [X, Y, Z], 0 to 11, or 255 where nothing was observed
    confidence: np.ndarray  # float [X, Y, Z], 0 to 1
    observed: np.ndarray  # bool [X, Y, Z]; the rest is completed, or unknown
    voxel_m: float
    origin_m: np.ndarray  # float64 [3], minimum corner of cell (0, 0, 0)


def write_cells(out: Path, cells: PredictedCells, axes: str, **more: np.ndarray) -> None:
    """Write an npz: labels, confidence, observed, voxel_m, origin_m, axes and what is given.

    Args:
        out: the file.
        cells: the predictions.
        axes: xyz or xzy, the order in which the three arrays are written.
        more: further arrays, such as ``scan_to_room``.

    Raises:
        OutputError: it cannot be written.
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
    """Return the predictions of a room's grid; unseen cells are 255."""
    return PredictedCells(
        grid.labels, grid.confidence, grid.source == OBSERVED, grid.voxel_m, grid.origin_m
    )


def resample_to_grid(
    room: PredictedCells, scan_to_room: np.ndarray, place: GridPlace
) -> PredictedCells:
    """Resample a room's cells to a grid file's: each takes the cell that its centre lies in.

    Args:
        room: cells in the room's axes.
        scan_to_room: [4, 4]; the scan's world is that of the grid file.
        place: where the grid lies.

    Raises:
        InputError: no centre of the grid lies in the room's cells.
    """
    centers_m = (np.moveaxis(np.indices(SHAPE), 0, -1) + 0.5) * VOXEL_M + place.origin_m
    at = (apply(scan_to_room, centers_m) - room.origin_m) / room.voxel_m
    cells = np.floor(at).astype(np.int64)
    within = (cells >= 0) & (cells < np.array(room.labels.shape))
    inside = np.asarray(within.all(axis=-1), bool)
    if not inside.any():
        raise InputError("grid", "lies beside all that the capture shows; is it of another world?")
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
    """Predict a frame's grid by a monocular network, from one photo.

    A network of cells twice as large predicts the same for the eight cells in each. Nothing of it
    counts as observed: a network guesses all of it.

    Args:
        photo: uint8 [H, W, 3].
        camera: of it.
        place: the grid and the camera's place.
        network: of as large a box of cells, without depth.

    Raises:
        UsageError: the network wants depth, or has another box.
    """
    facts = network.facts
    if facts.wants_depth:
        raise UsageError(f"{facts.name} wants depth; give a network trained without --depth given")
    times = round(facts.voxel_m / VOXEL_M)
    sides_of_ours = tuple(side * times for side in facts.grid_shape)
    if not np.isclose(times * VOXEL_M, facts.voxel_m) or sides_of_ours != SHAPE:
        sides = "x".join(map(str, facts.grid_shape))
        raise UsageError(
            f"{facts.name} says {sides} cells of {facts.voxel_m:g} m; a frame's grid has "
            "60x60x36 of 0.08 m, and a network 30x30x18 of 0.16 m or as many"
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
