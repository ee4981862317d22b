"""Voxelization of a block world into labelled cells.

A cell is occupied if a solid shape reaches more than ``TOLERANCE_M`` into it. The shapes are the
boxes that the renderer uses, including display entities, so every surface that a ray hits is in an
occupied cell. Transparent pixels of textures are ignored: glass panes, plants, leaves and bars
occupy the full boxes that carry their textures. Shapes thinner than ``MIN_THICKNESS_M`` are
thickened to this value. The class, object and fine class of a cell are those of the block that
fills most of it. Blocks that are not rendered, such as barriers, leave their cells empty.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraftocc.labels.box_kernels import (
    NO_OWNER,
    SEARCH_MARGIN,
    CellLattice,
    Slab,
    fill_slab,
)
from world2minecraft.minecraftocc.labels.fine_classes import Designs, FineClassMap, map_fine_classes
from world2minecraft.minecraftocc.types import DEFAULT_VOXEL_M, SceneVoxels
from world2minecraft.rendering import BlockScene, prepare_scene
from world2minecraft.rendering.scene_tables import ABSOLUTE, FLAGS, TURN, SceneTables

MIN_THICKNESS_M = 0.004
_ALIGNED = 1e-6  # Blocks: tolerance within which an edge is axis-aligned.
# Depth to which a shape may reach into a cell without being counted, for rounding of 1/16 blocks.
TOLERANCE_M = 0.001
MIN_VOXEL_M = 0.01
MAX_CELLS = 200_000_000  # A gigabyte of labels; a house of twelve rooms has three million.
SLAB_CELLS = 4_000_000  # Cells that are filled at a time.
_SAME_BORDER = 1e-6  # Cells: tolerance within which two borders are the same.


class SolidBoxes(NamedTuple):
    """The boxes of E scene elements, in blocks, in the coordinate system of each element.

    Attributes:
        low: Minimum corner of the axis-aligned bounding box, float64 [E, 3].
        high: Maximum corner of the axis-aligned bounding box, float64 [E, 3].
        centre: Centre of the box, float64 [E, 3].
        half: Half edges of the box, float64 [E, 3, 3]; row a is half the edge along the box's own
            axis a.
        straight: Whether the box is axis-aligned, bool [E].
        there: Whether the box has a visible face, bool [E].
    """

    low: np.ndarray
    high: np.ndarray
    centre: np.ndarray
    half: np.ndarray
    straight: np.ndarray
    there: np.ndarray


def solid_boxes(tables: SceneTables, metres_per_block: float) -> SolidBoxes:
    """Compute the boxes of all elements of a scene.

    Args:
        tables: Renderer tables of the scene.
        metres_per_block: Edge length of a block in metres.
    """
    low, high = tables.boxes[:, :3].astype(np.float64), tables.boxes[:, 3:].astype(np.float64)
    axes = np.tile(np.eye(3), (len(low), 1, 1))
    shift = np.zeros((len(low), 3))
    turned = np.flatnonzero(tables.traits[:, TURN] >= 0)
    if len(turned):
        to_frame = np.tile(np.eye(4), (len(turned), 1, 1))
        to_frame[:, :3] = tables.turns[tables.traits[turned, TURN]]
        back = np.linalg.inv(to_frame)
        axes[turned], shift[turned] = back[:, :3, :3].transpose(0, 2, 1), back[:, :3, 3]
    centre = np.einsum("ea,eab->eb", (low + high) / 2, axes) + shift
    lengths = np.linalg.norm(axes, axis=2)
    reach = np.maximum((high - low) / 2 * lengths, MIN_THICKNESS_M / 2 / metres_per_block)
    half = axes / np.maximum(lengths, 1e-12)[..., None] * reach[..., None]
    around = np.abs(half).sum(axis=1)
    leaning = np.sort(np.abs(half), axis=2)[..., :2].max(axis=(1, 2), initial=0.0)
    return SolidBoxes(
        low=centre - around,
        high=centre + around,
        centre=centre,
        half=np.ascontiguousarray(half),
        straight=leaning < _ALIGNED,
        there=np.any(tables.layers >= 0, axis=1).astype(bool),
    )


@dataclass(frozen=True)
class _Lattice:
    """A lattice of cells along the block axes, with its position in the room."""

    start: np.ndarray  # float64 [3], minimum corner in the scene's grid of blocks
    step: float  # blocks
    origin_m: np.ndarray  # float64 [3], minimum corner in the room
    shape: tuple[int, int, int]  # along the room's axes
    axes: tuple[int, int, int]  # the room's axis of each block axis
    flips: tuple[bool, bool, bool]  # whether a block axis runs against it

    def in_block_axes(self, values: np.ndarray) -> np.ndarray:
        """Return a view of an array in room axis order, reordered to block axes."""
        turned = np.transpose(values, self.axes)
        return turned[tuple(slice(None, None, -1 if flip else None) for flip in self.flips)]


def voxelize_scene(
    volume: BlockVolume,
    designs: Designs | None = None,
    *,
    voxel_m: float | None = DEFAULT_VOXEL_M,
    within_m: Sequence[Sequence[float]] | None = None,
    scene: BlockScene | None = None,
) -> SceneVoxels:
    """Voxelize a world into labelled cells.

    Args:
        volume: Blocks with their classes and object numbers.
        designs: Furniture design index of each block, and the names of the designs.
        voxel_m: Cell size in metres. None uses one cell per block.
        within_m: Minimum and maximum corner of the part of the room to voxelize, in metres. None
            voxelizes the whole volume.
        scene: Result of ``prepare_scene`` for the volume, if already available.

    Raises:
        UsageError: If the cells are too small or exceed ``MAX_CELLS``, or if the blocks are not
            aligned with the room axes.
    """
    if voxel_m is not None and not voxel_m >= MIN_VOXEL_M:
        raise UsageError(f"voxel_m must be at least {MIN_VOXEL_M} m, got {voxel_m}")
    scene = prepare_scene(volume) if scene is None else scene
    lattice, voxel_m = _lattice(volume, scene, voxel_m, within_m)
    names = map_fine_classes(volume, designs)
    return SceneVoxels(
        *_fill_lattice(volume, scene, lattice, names), names.classes, voxel_m, lattice.origin_m
    )


def _lattice(
    volume: BlockVolume,
    scene: BlockScene,
    voxel_m: float | None,
    within_m: Sequence[Sequence[float]] | None,
) -> tuple[_Lattice, float]:
    """Create the lattice of a scene, aligned to multiples of the cell size or to its blocks."""
    grid_to_room = np.linalg.inv(scene.room_to_grid)
    side = 1 / scene.cells_per_metre
    turn = grid_to_room[:3, :3] / side
    axes = np.abs(turn).argmax(axis=0)
    if np.abs(np.abs(turn) - np.eye(3)[axes].T).max() > 1e-6:
        raise UsageError("the blocks of the world must be aligned with the axes of its room")
    flips = turn[axes, range(3)] < 0
    ends = np.array([np.zeros(3), scene.tables.space.shape]) @ grid_to_room[:3, :3].T
    ends += grid_to_room[:3, 3]
    low, high = ends.min(axis=0), ends.max(axis=0)
    size = side if voxel_m is None else float(voxel_m)
    zero = low if voxel_m is None else np.zeros(3)
    if within_m is not None:
        low, high = np.maximum(low, within_m[0]), np.minimum(high, within_m[1])
    first = np.floor((low - zero) / size + _SAME_BORDER).astype(np.int64)
    last = np.maximum(np.ceil((high - zero) / size - _SAME_BORDER).astype(np.int64), first + 1)
    shape = _checked_shape(last - first, size)
    origin = zero + first * size
    corners = np.array([origin, origin + np.array(shape) * size])
    start = (corners @ scene.room_to_grid[:3, :3].T + scene.room_to_grid[:3, 3]).min(axis=0)
    lattice = _Lattice(
        start=np.where(np.abs(start - np.round(start)) < _SAME_BORDER, np.round(start), start),
        step=1.0 if voxel_m is None else size / side,
        origin_m=origin,
        shape=shape,
        axes=(int(axes[0]), int(axes[1]), int(axes[2])),
        flips=(bool(flips[0]), bool(flips[1]), bool(flips[2])),
    )
    return lattice, size


def _checked_shape(shape: np.ndarray, voxel_m: float) -> tuple[int, int, int]:
    count = float(np.prod(shape.astype(float)))
    if count > MAX_CELLS:
        raise UsageError(
            f"{'x'.join(map(str, shape))} cells of {voxel_m:g} m need {count * 5 / 1e9:.0f} GB and "
            f"exceed the limit of {MAX_CELLS:,} cells; use larger cells or a part of the world"
        )
    return int(shape[0]), int(shape[1]), int(shape[2])


def _fill_lattice(
    volume: BlockVolume, scene: BlockScene, lattice: _Lattice, names: FineClassMap
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the labels, fine classes and object numbers of all cells, in room axis order."""
    labels = np.zeros(lattice.shape, np.uint8)
    fine, instance = (np.zeros(lattice.shape, np.uint16) for _ in range(2))
    views = [lattice.in_block_axes(values) for values in (labels, fine, instance)]
    boxes = solid_boxes(scene.tables, 1 / scene.cells_per_metre)
    depth, wide, high = views[0].shape
    thick = max(SLAB_CELLS // (wide * high), 1)
    for first in range(0, depth, thick):
        owner = _slab_owners(scene, boxes, lattice, first, (min(thick, depth - first), wide, high))
        taken = np.nonzero(owner != NO_OWNER)
        what = _describe_owners(owner[taken], volume, scene, names)
        for view, values in zip(views, what, strict=True):
            view[first : first + thick][taken] = values
    return labels, fine, instance


def _slab_owners(
    scene: BlockScene,
    boxes: SolidBoxes,
    lattice: _Lattice,
    first: int,
    shape: tuple[int, int, int],
) -> np.ndarray:
    """Return the owner of each cell in a slab, int32, numbered as in ``Slab``."""
    tables = scene.tables
    standing = np.flatnonzero((tables.traits[:, FLAGS] & ABSOLUTE > 0) & boxes.there)
    side = int(np.ceil((1 + 2 * SEARCH_MARGIN) / lattice.step)) + 1
    owner = np.full(shape, NO_OWNER, np.int32)
    fill_slab(
        tables,
        boxes,
        standing,
        CellLattice(lattice.start, lattice.step, TOLERANCE_M * scene.cells_per_metre),
        Slab(first, np.zeros(shape, np.float32), owner),
        np.zeros((side, side, side)),
    )
    return owner


def _describe_owners(
    owner: np.ndarray, volume: BlockVolume, scene: BlockScene, names: FineClassMap
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the label (unknown if unclassified), fine class and object number of each owner."""
    is_cell = owner >= 0
    cells, things = owner[is_cell], -2 - owner[~is_cell]
    labels = np.empty(len(owner), np.uint8)
    fine, instance = np.empty(len(owner), np.uint16), np.empty(len(owner), np.uint16)
    labels[is_cell] = volume.semantic.reshape(-1)[cells]
    labels[~is_cell] = scene.things.semantic[things]
    instance[is_cell] = volume.instance.reshape(-1)[cells]
    instance[~is_cell] = scene.things.instance[things]
    fine[is_cell], fine[~is_cell] = names.of_cells(cells), names.of_thing[things]
    labels[labels == 0] = UNKNOWN
    return labels, fine, instance
