"""An object without a template: its own cells as few coloured boxes."""

import numpy as np

from world2minecraft.construction.display.frame import Frame, Piece
from world2minecraft.construction.display.pieces import heap_pieces
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.surfaces import painted
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.connected_components import label_components

MOST_COLOURS = 3  # Each further one costs boxes; an object of four paints is rare.


def frame_of_cells(cells: np.ndarray, grid: OccupancyGrid) -> Frame:
    """Return the frame of cells, int [N, 3], at least one: upright, along the room's axes."""
    low = grid.origin_m + cells.min(axis=0) * grid.voxel_m
    size = (np.ptp(cells, axis=0) + 1) * grid.voxel_m
    return Frame(low + size * [0.5, 0.5, 0.0], size, 0.0)


def pieces_of_cells(
    cells: np.ndarray,
    colours: np.ndarray,
    known: np.ndarray,
    grid: OccupancyGrid,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
) -> list[Piece]:
    """Return the pieces of an object's own cells in the frame of ``frame_of_cells``.

    Args:
        cells: int [N, 3], indices into the grid, at least one.
        colours: float32 [N, 3], their Oklab colours.
        known: bool [N], which of them have one.
        grid: where they lie; its unseen cells inside the object may be filled.
        class_id: whose blocks of the palette may be used.
        palette: what may be used.
        parameters: how colours are weighed.
    """
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    at = tuple((cells - low).T)
    mask = np.zeros(high - low, bool)
    mask[at] = True
    tinted = np.zeros((*mask.shape, 3), np.float32)
    tinted[at] = colours
    has_colour = np.zeros(mask.shape, bool)
    has_colour[at] = known
    most = min(MOST_COLOURS, parameters.object_colours)
    states = painted(mask, tinted, has_colour, class_id, palette, parameters, most).astype(str)
    names, index = np.unique(states, return_inverse=True)
    labels = np.zeros(mask.shape, np.int32)
    labels[mask] = index + 1
    box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    unseen = np.asarray(grid.source[box] == UNSEEN) & ~mask
    size = (high - low) * grid.voxel_m
    low_m = np.array([-size[0] / 2, -size[1] / 2, 0.0])
    return heap_pieces(labels, unseen & _between(mask), names.tolist(), low_m, grid.voxel_m)


def _between(mask: np.ndarray) -> np.ndarray:
    """Return the cells, bool, with cells of a mask on both sides along two axes and more."""
    count = np.zeros(mask.shape, np.int8)
    for axis in range(3):
        before = np.logical_or.accumulate(mask, axis=axis)
        after = np.flip(np.logical_or.accumulate(np.flip(mask, axis), axis=axis), axis)
        count += before & after
    return np.asarray(count >= 2)


def without_specks(cells: np.ndarray, least: int) -> np.ndarray:
    """Return cells, int [N, 3], without those whose connected part has fewer than ``least``."""
    if not len(cells):
        return cells
    low = cells.min(axis=0)
    mask = np.zeros(cells.max(axis=0) - low + 1, bool)
    mask[tuple((cells - low).T)] = True
    parts, _ = label_components(mask)
    sizes = np.bincount(parts.ravel())
    numbers = parts[tuple((cells - low).T)]
    kept: np.ndarray = cells[sizes[numbers] >= least]
    return kept if len(kept) else cells
