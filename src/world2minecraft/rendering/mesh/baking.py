"""Baking of a block volume to quads: the visible faces with texture, tint and light.

Faces against full cubes are removed, and equal faces of full cubes are merged; every other face is
one quad. Faces behind blocks that a viewer can hide as a group (a class, or the blocks that a
cutaway removes) are kept. Light is sampled from the light lattice at the corners.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.minecraft.rules.light import MAX_REACH
from world2minecraft.rendering.atlas import Atlas, to_srgb
from world2minecraft.rendering.block_elements import BlockModel, ModelSource
from world2minecraft.rendering.block_models import BuiltinModels
from world2minecraft.rendering.cutaway import (
    without_ceiling,
    without_near_walls,
    without_partitions,
)
from world2minecraft.rendering.light.light_field import BLOCK_SHIFT, COUNT_SHIFT, light_field
from world2minecraft.rendering.mesh.quads import (
    INSIDE,
    Quads,
    concatenate_quads,
    hidden_sides,
    quads_of,
)
from world2minecraft.rendering.off_grid_elements import display_entity_elements
from world2minecraft.rendering.scene import bake_model
from world2minecraft.rendering.scene_baking import Baker, joins_neighbours, kind_of, models_of
from world2minecraft.rendering.scene_tables import ABSOLUTE, FULL

# For each side, the two axes along it.
ALONG = np.array([[1, 2], [1, 2], [0, 2], [0, 2], [0, 1], [0, 1]])
# Bits 0 to 3: the walls near an eye that stands towards (block x, block z) of these signs.
CORNERS = ((-1, -1), (-1, 1), (1, -1), (1, 1))
_NEAR_EDGE = 1e-3  # Blocks: a face so near its cell's boundary is lit from beyond it.
OPEN = np.array([60, 0, 0], np.uint8)  # Daylight and free corners: faces that a cut lays bare.
NO_STATE = NO_COVER = 65_535


class Rectangles(NamedTuple):
    """R rectangles of unit faces, each given by its lowest cell and its extent."""

    first: np.ndarray  # int64 [R], the row of the face in its lowest cell
    length: np.ndarray  # int64 [R, 3], cells along x, y and z


def merge_faces(cells: np.ndarray, side: np.ndarray, look: np.ndarray) -> Rectangles:
    """Merge unit faces of equal appearance into rectangles.

    Args:
        cells: Cells of the faces, int [N, 3].
        side: Side of the cell, int [N], 0 to 5.
        look: Appearance id, int [N]. Faces are merged only if their ids are equal and not negative.
    """
    one, two = (
        cells[np.arange(len(side)), ALONG[side, 0]],
        cells[np.arange(len(side)), ALONG[side, 1]],
    )
    plane = cells[np.arange(len(side)), side // 2]
    first, run = _join_runs([side, plane, look, one, two], look >= 0)
    keys = [side[first], plane[first], look[first], two[first], run, one[first]]
    again, lines = _join_runs(keys, look[first] >= 0)
    rows = first[again]
    length = np.ones((len(rows), 3), np.int64)
    at = np.arange(len(rows))
    length[at, ALONG[side[rows], 0]] = lines
    length[at, ALONG[side[rows], 1]] = run[again]
    return Rectangles(rows, length)


def _join_runs(keys: list[np.ndarray], may: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Join rows equal in all keys but the last, which counts up by one; return first and number."""
    if not len(keys[0]):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    order = np.lexsort(keys[::-1])
    ordered = [key[order] for key in keys]
    goes_on = may[order][1:].copy()
    for key in ordered[:-1]:
        goes_on &= key[1:] == key[:-1]
    goes_on &= ordered[-1][1:] == ordered[-1][:-1] + 1
    starts = np.flatnonzero(np.concatenate([[True], ~goes_on]))
    return order[starts], np.diff(starts, append=len(order))


def cut_bits(volume: BlockVolume) -> tuple[np.ndarray, np.ndarray]:
    """Return bit masks of the cutaways that remove each block and each display entity.

    Bits 0 to 3 are the near walls of ``CORNERS``, bit 4 is the ceiling with everything above it,
    and bit 5 is the upper parts of walls between rooms.

    Returns:
        Masks of the blocks, uint8 [X, Y, Z], and of the volume's ``display_cubes``, uint8.
    """
    has_floor = bool((volume.semantic == SemanticClass.FLOOR).any())  # Else all would be outside.
    ways = [without_near_walls(volume, *corner) if has_floor else volume for corner in CORNERS]
    ways += [without_ceiling(volume), without_partitions(volume)]
    blocks = np.zeros(volume.states.shape, np.uint8)
    entities = np.zeros(len(display_cubes(volume.entities)), np.uint8)
    for bit, cut in enumerate(ways):
        blocks |= ((cut.states != volume.states).astype(np.uint8)) << bit
        kept = {id(entity) for entity in cut.entities}
        gone = [id(one) not in kept for one in volume.entities if display_cubes((one,))]
        entities |= np.array(gone, np.uint8) << bit
    return blocks, entities


def sample_lattice(
    lattice: np.ndarray, cells: np.ndarray, facing: np.ndarray, points: np.ndarray
) -> np.ndarray:
    """Return sky light, block light and occlusion at points on block faces, as uint8 [N, 3].

    Light is in quarters of a level, 0 to 60. Occlusion is 0 to 240, for 0 to 3 occluders.

    Args:
        lattice: Light lattice, uint16 [3, X + 2, Y + 2, Z + 2]; see
            ``rendering.light.light_field``.
        cells: Cell of each point, int [N, 3].
        facing: Side that the face is on, int [N].
        points: Coordinates within the cell, 0 to 1, float64 [N, 3].
    """
    axis, sign = facing // 2, np.where(facing % 2, 1, -1)
    rows = np.arange(len(points))
    along = points[rows, axis]
    on_rim = np.where(sign > 0, along > 1 - _NEAR_EDGE, along < _NEAR_EDGE)
    first, second = np.array([1, 0, 0])[axis], np.array([2, 2, 1])[axis]
    p = np.clip(points[rows, first], 0, 1)[:, None]
    q = np.clip(points[rows, second], 0, 1)[:, None]
    base = cells.copy()
    base[rows, axis] += 1 + on_rim * sign
    corners = []
    for a, b in ((0, 0), (0, 1), (1, 0), (1, 1)):
        at = base.copy()
        at[rows, first] += a
        at[rows, second] += b
        at = np.clip(at, 0, np.array(lattice.shape[1:]) - 1)  # What stands free may be outside.
        corners.append(_parts(lattice[axis, at[:, 0], at[:, 1], at[:, 2]]))
    one, two, three, four = corners
    mixed = (1 - p) * ((1 - q) * one + q * two) + p * ((1 - q) * three + q * four)
    return (mixed * [1, 1, 80] + 0.5).astype(np.uint8)


def _parts(words: np.ndarray) -> np.ndarray:
    """Return float64 [N, 3] of the lattice's words."""
    return np.stack([words & 63, (words >> BLOCK_SHIFT) & 63, words >> COUNT_SHIFT], axis=1).astype(
        np.float64
    )


@dataclass(frozen=True, eq=False)
class BlockMesh:
    """Q quads in cell coordinates of the volume, with overlays last.

    ``light`` contains sky light and block light, 0 to 60, and corner occlusion, 0 to 240. ``state``
    indexes the palette and is 65535 for display entities. ``cuts`` are bits of ``cut_bits``. A quad
    with a ``cover`` is visible only if its cover is hidden.
    """

    position: np.ndarray  # float32 [Q, 4, 3]
    uv: np.ndarray  # float32 [Q, 4, 2], one texture is [0, 1] wide and repeats
    light: np.ndarray  # uint8 [Q, 4, 3]
    emission: np.ndarray  # uint8 [Q], 0 to 255
    tint: np.ndarray  # uint8 [Q, 3], sRGB
    shade: np.ndarray  # uint8 [Q], 255 for 1, a screen value
    layer: np.ndarray  # uint16 [Q], of the atlas
    state: np.ndarray  # uint16 [Q]
    instance: np.ndarray  # uint16 [Q]
    semantic: np.ndarray  # uint8 [Q]
    cuts: np.ndarray  # uint8 [Q]
    cover: np.ndarray  # uint16 [Q], class + 256 * cuts of what lies on it; 65535 for nothing
    clear_from: int  # the first quad that is drawn over what is behind it
    atlas: Atlas

    def __len__(self) -> int:
        return len(self.layer)


@dataclass(frozen=True, eq=False)
class _Placed:
    """Quads in cells of the volume, and whose they are."""

    quads: Quads
    cells: np.ndarray  # int64 [Q, 3]
    state: np.ndarray
    semantic: np.ndarray
    instance: np.ndarray
    cuts: np.ndarray
    cover: np.ndarray


def mesh_of(volume: BlockVolume, looks: ModelSource | None = None) -> BlockMesh:
    """Return the mesh of a volume, including display entities.

    Args:
        volume: The blocks.
        looks: Source of models and textures. None uses the built-in set.
    """
    baker = Baker(looks or BuiltinModels())
    models = models_of(volume.palette, baker.looks)
    numbers = [bake_model(s, m, baker) for s, m in zip(volume.palette, models, strict=True)]
    guests = display_entity_elements(volume, baker.looks)[1]
    free = [(guest, baker.add(guest.element, ABSOLUTE | guest.flags)) for guest in guests]
    table = baker.table()
    cuts, thing_cuts = cut_bits(volume)
    reach = min(max(1.0, volume.blocks_per_metre / 2), MAX_REACH)
    lattice = light_field(volume.states, volume.palette, reach).lattice
    templates = [
        concatenate_quads([quads_of(n, baker.elements[n][0], table) for n in rows])
        for rows in numbers
    ]
    parts = _of_blocks(volume, models, baker.looks, templates, cuts, lattice)
    cubes = display_cubes(volume.entities)
    for guest, number in free:
        cube = cubes[guest.owner]
        facts = (NO_STATE, cube.class_id, cube.instance, thing_cuts[guest.owner])
        parts.append(
            _with_light(_place_freestanding(quads_of(number, guest.element, table), facts), lattice)
        )
    return _mesh(parts, table.atlas)


def _of_blocks(
    volume: BlockVolume,
    models: list[BlockModel],
    looks: ModelSource,
    templates: list[Quads],
    cuts: np.ndarray,
    lattice: np.ndarray,
) -> list[tuple[_Placed, np.ndarray]]:
    """Return the visible quads of all blocks with their light, uint8 [Q, 4, 3]."""
    states = volume.states
    kinds = np.array([kind_of(model, looks) for model in models], np.int8)
    joining = np.array(
        [joins_neighbours(*pair) for pair in zip(volume.palette, models, strict=True)], bool
    )
    groups = cuts.astype(np.int32) * 256 + volume.semantic
    hidden = hidden_sides(states, kinds, joining, groups)
    full = (kinds == FULL)[states]
    owners = volume.semantic + cuts * np.uint16(256)
    covers = np.pad(np.where(full, owners, NO_COVER), 1, constant_values=NO_COVER)
    order = np.argsort(states.ravel(), kind="stable")
    ends = np.searchsorted(states.ravel()[order], np.arange(len(templates) + 1))
    parts = []
    for row, template in enumerate(templates):
        flat = order[ends[row] : ends[row + 1]]
        if not len(flat) or not len(template.layer):
            continue
        cells = np.stack(np.unravel_index(flat, states.shape), axis=1)
        at = tuple(cells.T)
        gone = [
            hidden[(side, *at)] if side != INSIDE else np.zeros(len(cells), bool)
            for side in template.side
        ]
        which, quad = np.nonzero(~np.stack(gone, axis=1))
        quads, cells = template.select(quad), cells[which]
        at = tuple(cells.T)
        facts = (volume.semantic[at], volume.instance[at], cuts[at])
        state = np.full(len(cells), row, np.uint16)
        placed = _Placed(quads, cells, state, *facts, _cover(quads, cells, covers))
        lit = _with_light(placed, lattice)
        parts.append(_merge_cube_faces(*lit) if kinds[row] == FULL else lit)
    return parts


def _cover(quads: Quads, cells: np.ndarray, covers: np.ndarray) -> np.ndarray:
    """Return what lies on each quad; ``covers`` has a margin of one cell."""
    ahead = cells + 1
    ahead[np.arange(len(cells)), quads.facing // 2] += np.where(quads.facing % 2, 1, -1)
    return np.where(quads.side == INSIDE, NO_COVER, covers[tuple(ahead.T)])


def _with_light(placed: _Placed, lattice: np.ndarray) -> tuple[_Placed, np.ndarray]:
    """Return quads with the light at their corners; what a cut lays bare is in the open."""
    count = len(placed.cells)
    cells = np.repeat(placed.cells, 4, axis=0)
    points = placed.quads.corners.reshape(-1, 3)
    facing = np.repeat(placed.quads.facing.astype(np.int64), 4)
    light = sample_lattice(lattice, cells, facing, points).reshape(count, 4, 3)
    light[placed.cover != NO_COVER] = OPEN
    return placed, light


def _place_freestanding(quads: Quads, facts: tuple[int, int, int, int]) -> _Placed:
    """Place quads in grid coordinates in the cell of their middle."""
    middle = quads.corners.mean(axis=1)
    cells = np.floor(middle).astype(np.int64)
    count = len(cells)
    moved = quads._replace(corners=quads.corners - cells[:, None])
    held = (np.full(count, fact) for fact in (*facts, NO_COVER))
    return _Placed(moved, cells, *held)


def _merge_cube_faces(placed: _Placed, light: np.ndarray) -> tuple[_Placed, np.ndarray]:
    """Join the faces of cubes of one state; only such that are lit evenly."""
    facts = (placed.semantic, placed.instance, placed.cuts, placed.cover)
    facts = np.stack(facts, axis=1).astype(np.int64)
    keys = np.concatenate([facts, light[:, 0].astype(np.int64)], axis=1)
    look = np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1)
    even = (light == light[:, :1]).all(axis=(1, 2))
    found = merge_faces(placed.cells, placed.quads.side, np.where(even, look, -1))
    rows, length = found
    grown = placed.quads.corners[rows] * length[:, None]
    quads = placed.quads.select(rows)
    slope = quads.uv[:, 1:2] - quads.uv[:, 0:1], quads.uv[:, 3:4] - quads.uv[:, 0:1]
    one = np.abs(quads.corners[:, 1] - quads.corners[:, 0])
    two = np.abs(quads.corners[:, 3] - quads.corners[:, 0])
    along_one = (one * (length - 1)).sum(axis=1)[:, None, None]
    along_two = (two * (length - 1)).sum(axis=1)[:, None, None]
    ends = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    uv = quads.uv + slope[0] * along_one * ends[:, :1] + slope[1] * along_two * ends[:, 1:]
    names = ("cells", "state", "semantic", "instance", "cuts", "cover")
    held = {name: getattr(placed, name)[rows] for name in names}
    quads = quads._replace(corners=grown, uv=uv.astype(np.float32))
    return _Placed(quads=quads, **held), light[rows]


def _mesh(parts: list[tuple[_Placed, np.ndarray]], atlas: Atlas) -> BlockMesh:
    """Put all quads into one mesh, the clear ones last."""
    quads = concatenate_quads([placed.quads for placed, _ in parts])
    order = np.argsort(quads.clear, kind="stable")

    def all_of(name: str, dtype: type) -> np.ndarray:
        found = [np.asarray(getattr(placed, name)) for placed, _ in parts]
        return np.concatenate(found or [np.zeros(0)]).astype(dtype)[order]

    cells = np.concatenate([placed.cells for placed, _ in parts] or [np.zeros((0, 3))])
    light = np.concatenate([lit for _, lit in parts] or [np.zeros((0, 4, 3), np.uint8)])
    return BlockMesh(
        position=(quads.corners + cells[:, None])[order].astype(np.float32),
        uv=quads.uv[order],
        light=light[order],
        emission=np.round(quads.emission[order] * 255).astype(np.uint8),
        tint=to_srgb(quads.tint[order].astype(np.float64)),
        shade=np.round(quads.shade[order] * 255).astype(np.uint8),
        layer=quads.layer[order].astype(np.uint16),
        state=all_of("state", np.uint16),
        instance=all_of("instance", np.uint16),
        semantic=all_of("semantic", np.uint8),
        cuts=all_of("cuts", np.uint8),
        cover=all_of("cover", np.uint16),
        clear_from=int(np.count_nonzero(~quads.clear)),
        atlas=atlas,
    )
