"""A block volume made ready for rays: one byte a cell, tables of boxes, colours by state.

Making it costs one sweep over the volume; whoever takes many pictures of one volume makes the
scene once and passes it in the volume's place.
"""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.render.appearance import palette_colours, visible_boxes
from world2minecraft.render.cubes import CubeTable, cube_table
from world2minecraft.render.trace import BOXES, FULL, NEAR_AIR, fill_distances
from world2minecraft.types import BlockVolume

_UNIT_BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)


@dataclass(frozen=True, eq=False)
class RayScene:
    """What the kernels read. ``cells`` is explained in ``render.trace``."""

    cells: np.ndarray  # uint8 [X, Y, Z]
    states: np.ndarray  # uint16 [X, Y, Z]
    box_start: np.ndarray  # int32 [P + 1]
    boxes: np.ndarray  # float32 [N, 6]
    colours: np.ndarray  # float32 [P, 4]: sRGB 0 to 255, glow
    semantic: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    room_to_grid: np.ndarray  # float64 [4, 4]: room metres to cells of this grid
    cells_per_metre: float
    cubes: CubeTable = field(default_factory=lambda: cube_table((), (0, 0, 0)))


def prepare_scene(volume: BlockVolume) -> RayScene:
    """Return the scene of a volume."""
    shapes = [visible_boxes(state) for state in volume.palette]
    kinds = np.array([_kind(boxes) for boxes in shapes], np.uint8)
    cells = kinds[volume.states]
    fill_distances(cells)
    counts = [len(boxes) for boxes in shapes]
    grid_to_world = np.eye(4)
    grid_to_world[:3, 3] = volume.corner
    return RayScene(
        cells=cells,
        states=volume.states,
        box_start=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        boxes=np.concatenate([np.empty((0, 6), np.float32), *shapes]),
        colours=palette_colours(volume.palette),
        semantic=volume.semantic,
        instance=volume.instance,
        room_to_grid=np.linalg.inv(volume.block_to_room @ grid_to_world),
        cells_per_metre=volume.blocks_per_metre,
        cubes=cube_table(volume.entities, volume.corner),
    )


def _kind(boxes: np.ndarray) -> int:
    if not len(boxes):
        return NEAR_AIR
    return FULL if np.array_equal(boxes, _UNIT_BOX) else BOXES
