"""The emitters of a scene: luminous boxes with their position, faces and radiance.

A box is a corner and three edges, which may be rotated. Its radiance depends on its light level and
its size: as in the game, a torch lights a room like a glowstone block, although it is a fiftieth of
the size. For bricks of 8 cells per side, lists of the relevant lamps are precomputed; other lamps
still contribute if a ray hits them by chance.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.rendering.atlas import to_linear
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.scene_tables import (
    ABSOLUTE,
    FACE_NORMALS,
    FLAGS,
    FULL,
    TURN,
    SceneTables,
)

BRICK = 8  # Cells.
MAX_NEARBY = 12  # Lamps in a brick's list.
MIN_LIGHT_SHARE = 0.004  # Of a brick's light; lamps that give less are left out of its list.
POWER = 8.0  # Light of a lamp of level 15: a quarter of full daylight at 3 cells.
WARM = np.array([1.0, 0.78, 0.52])  # What lamps of pale textures shine like.
OWN_COLOUR = 0.2  # How much the texture's colour counts at least.
_UNSEEN = np.array([0.25, 0.25, 0.25, 0.75, 0.75, 0.75])  # Where a block shines that has no box.
_MIN_AREA = 0.02  # Square cells.
_NEAREST = 3.0  # Cells: a brick's own lamps are taken to be so far.


class Emitters(NamedTuple):
    """L luminous boxes. ``b`` indexes the three pairs of faces: -x +x, -y +y, -z +z."""

    row_of_cell: np.ndarray  # int32 [X, Y, Z]: the first of a cell's rows, -1 for none
    row_of_element: np.ndarray  # int32 [E]: of display entities, -1 for none
    cell: np.ndarray  # int64 [L]: flat cell, -1 of display entities
    element: np.ndarray  # int32 [L], -1 for one that is not seen
    corner: np.ndarray  # float64 [L, 3]
    edges: np.ndarray  # float64 [L, b, 3]
    out: np.ndarray  # float64 [L, b, 3]: unit normal of the second face of each pair
    thick: np.ndarray  # float64 [L, b]: distance of the two faces
    area: np.ndarray  # float64 [L, b]
    shown: np.ndarray  # uint8 [L]: a bit for each face that is not covered
    centre: np.ndarray  # float64 [L, 3]
    radius: np.ndarray  # float64 [L]
    light: np.ndarray  # float64 [L, 3]: linear radiance
    power: np.ndarray  # float64 [L]
    near_start: np.ndarray  # int32 [bricks + 1]
    near: np.ndarray  # int32 [N]: rows
    bricks: np.ndarray  # int64 [3]


def emitters_of(scene: BlockScene) -> Emitters:
    """Return the lamps of a scene. Reuse the result for several images of the scene."""
    tables = scene.tables
    cells, elements, level = _find_emitters(scene, element_levels(tables, scene.material))
    corner, edges = _boxes(tables, cells, elements)
    area = np.linalg.norm(np.cross(edges[:, [1, 2, 0]], edges[:, [2, 0, 1]]), axis=2)
    out = _unit_normals(tables, elements)
    thick = np.abs((edges * out).sum(axis=2))
    light = _radiance(scene, level, cells, elements, area)
    shown = _visible_faces(tables, cells, elements)
    bits = (shown[:, None] >> np.arange(6)) & 1
    faces = (bits * np.repeat(area, 2, axis=1)).sum(axis=1)
    row_of_cell = np.full(tables.space.shape, -1, np.int32)
    inside = np.flatnonzero((cells >= 0) & (elements >= 0))[::-1]
    row_of_cell.reshape(-1)[cells[inside]] = inside  # The first of a cell's is written last.
    row_of_element = np.full(len(tables.boxes), -1, np.int32)
    free = np.flatnonzero(cells < 0)
    row_of_element[elements[free]] = free
    centre = corner + edges.sum(axis=1) / 2
    power = light.mean(axis=1) * faces
    bricks = -(-np.array(tables.space.shape, np.int64) // BRICK)
    start, near = _near_lists(bricks, centre, power)
    return Emitters(
        row_of_cell, row_of_element, cells, elements, corner, edges, out, thick, area, shown,
        centre, np.linalg.norm(edges, axis=2).sum(axis=1) / 2, light, power, start, near, bricks,
    )  # fmt: skip


def element_levels(tables: SceneTables, material: np.ndarray) -> np.ndarray:
    """Return the emission of each element, float64 [E], 0 to 1, from itself or its textures."""
    means = material[:, -1, 4].astype(np.float64) / 255
    faces = np.where(tables.layers >= 0, means[np.maximum(tables.layers, 0)], 0)
    return np.maximum(tables.emission, faces.max(axis=1, initial=0))


def _find_emitters(scene: BlockScene, own: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return flat cells (-1 for display entities), elements (-1 for unseen) and levels.

    A cell's level is what its block gives, in the game's count, else what its elements say. All
    elements of a block shine where it gives light and none says so; a block without any, as
    ``minecraft:light`` is, shines unseen.
    """
    tables = scene.tables
    gives = scene.light.gives[scene.light.kinds[1:-1, 1:-1, 1:-1]].reshape(-1) / 15
    standing = (tables.traits[:, FLAGS] & ABSOLUTE) > 0
    counts = np.diff(tables.look_start)
    rows = np.repeat(np.arange(len(counts)), counts)
    shines = (own[tables.refs] > 0) & ~standing[tables.refs]
    some = np.bincount(rows[shines], minlength=len(counts)) > 0
    looks = tables.looks.reshape(-1)
    cells = np.flatnonzero((some[looks] & (tables.space.reshape(-1) < 0)) | (gives > 0))
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for row in np.unique(looks[cells]):
        here = cells[looks[cells] == row]
        mine = (rows == row) & ~standing[tables.refs]
        elements = tables.refs[mine & shines] if some[row] else tables.refs[mine]
        elements = elements if len(elements) else np.array([-1])
        found.append((np.repeat(here, len(elements)), np.tile(elements, len(here))))
    free = np.flatnonzero((own > 0) & standing)
    found.append((np.full(len(free), -1), free))
    cell, element = (np.concatenate(values) for values in zip(*found, strict=True))
    order = np.argsort(cell, kind="stable")
    cell, element = cell[order], element[order]
    given = np.where(cell >= 0, gives[np.maximum(cell, 0)], 0)
    stated = np.where(element >= 0, own[np.maximum(element, 0)], 1) if len(own) else given
    return cell.astype(np.int64), element.astype(np.int32), np.where(given > 0, given, stated)


def _boxes(
    tables: SceneTables, cells: np.ndarray, elements: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a corner [L, 3] and the edges [L, 3, 3] of boxes, in the grid."""
    unseen = elements < 0
    boxes = np.where(unseen[:, None], _UNSEEN, _rows_of_elements(tables.boxes, elements)).astype(
        np.float64
    )
    low, high = np.split(boxes, 2, axis=1)
    edges = np.eye(3) * (high - low)[:, :, None]
    corner = low.copy()
    for n in np.flatnonzero(_turn_rows(tables, elements) >= 0):
        inverse = np.linalg.inv(
            np.vstack([tables.turns[tables.traits[elements[n], TURN]], [0, 0, 0, 1]])
        )
        corner[n] = inverse[:3, :3] @ low[n] + inverse[:3, 3]
        edges[n] = edges[n] @ inverse[:3, :3].T
    places = np.stack(np.unravel_index(np.maximum(cells, 0), tables.space.shape), axis=1)
    return corner + np.where(cells[:, None] >= 0, places, 0), edges


def _rows_of_elements(values: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """Return the rows of elements; any row for one that is -1."""
    return values[np.maximum(elements, 0)] if len(values) else np.zeros((len(elements), 6))


def _turn_rows(tables: SceneTables, elements: np.ndarray) -> np.ndarray:
    """Return the rows of ``turns`` of elements, -1 for none."""
    if not len(tables.traits):
        return np.full(len(elements), -1)
    return np.where(elements >= 0, _rows_of_elements(tables.traits, elements)[:, TURN], -1)


def _unit_normals(tables: SceneTables, elements: np.ndarray) -> np.ndarray:
    """Return the unit normals [L, 3, 3] of the second faces, for flat boxes too."""
    out = np.broadcast_to(np.eye(3), (len(elements), 3, 3)).copy()
    turns = _turn_rows(tables, elements)
    out[turns >= 0] = tables.normals[turns[turns >= 0]]
    return out


def _radiance(
    scene: BlockScene, level: np.ndarray, cells: np.ndarray, elements: np.ndarray, area: np.ndarray
) -> np.ndarray:
    """Return the radiance of lamps, float64 [L, 3]."""
    if not len(elements):
        return np.zeros((0, 3))
    colour = np.broadcast_to(WARM, (len(elements), 3)).copy()
    for element in np.unique(elements[elements >= 0]):
        colour[elements == element] = _colour(scene, element)
    # All lamps of one cell share its power by their areas.
    owner = np.where(cells >= 0, cells, -1 - elements.astype(np.int64))
    _, group = np.unique(owner, return_inverse=True)
    whole = np.bincount(group, weights=2 * area.sum(axis=1))[group]
    strength = 4 * POWER * level**1.5 / np.maximum(whole, _MIN_AREA)
    own = np.maximum(1 - colour.min(axis=1, keepdims=True), OWN_COLOUR)
    return (own * colour + (1 - own) * WARM) * strength[:, None]


def _colour(scene: BlockScene, element: int) -> np.ndarray:
    """Return the colour, its strongest channel 1, of what shines of an element: float64 [3]."""
    tables = scene.tables
    weights, colour = 1e-9, 1e-9 * WARM
    for side in np.flatnonzero(tables.layers[element] >= 0):
        layer = tables.layers[element, side]
        finest = slice(0, scene.side_px**2)
        weight = scene.material[layer, finest, 4] / 255 + (tables.emission[element] > 0) + 1e-6
        texels = to_linear(tables.texels[layer, finest, :3]) * tables.tints[element, side]
        weights = weights + weight.sum()
        colour = colour + (texels * weight[:, None]).sum(axis=0)
    colour = colour / weights
    return colour / max(float(colour.max()), 1e-6)


def _visible_faces(tables: SceneTables, cells: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """Return a bit for each face that is there and has no whole cube before it, uint8 [L]."""
    places = np.stack(np.unravel_index(np.maximum(cells, 0), tables.space.shape), axis=1)
    shape = np.array(tables.space.shape)
    boxes, layers = (
        _rows_of_elements(tables.boxes, elements),
        _rows_of_elements(tables.layers, elements),
    )
    shown = np.zeros(len(cells), np.uint8)
    plain = (cells >= 0) & (elements >= 0) & (_turn_rows(tables, elements) < 0)
    for side in range(6):
        axis = side // 2
        at_edge = boxes[:, axis + 3] >= 1 if side % 2 else boxes[:, axis] <= 0
        near = places + FACE_NORMALS[side]
        inside = ((near >= 0) & (near < shape)).all(axis=1)
        kinds = tables.space[tuple(np.clip(near, 0, shape - 1).T)]
        covered = plain & at_edge & inside & (kinds == FULL)
        there = (layers[:, side] >= 0) | (elements < 0)
        shown |= np.where(there & ~covered, 1 << side, 0).astype(np.uint8)
    return shown


@njit
def _near_lists(bricks, centre, power):
    """Return ``near_start`` and ``near``: for each brick the lamps that give most, best first."""
    total = bricks[0] * bricks[1] * bricks[2]
    start = np.zeros(total + 1, np.int32)
    near = np.empty(total * min(MAX_NEARBY, len(power)), np.int32)
    best, rows = np.empty(MAX_NEARBY), np.empty(MAX_NEARBY, np.int32)
    count = 0
    for brick in range(total):
        x = (brick // (bricks[1] * bricks[2]) + 0.5) * BRICK
        y = (brick // bricks[2] % bricks[1] + 0.5) * BRICK
        z = (brick % bricks[2] + 0.5) * BRICK
        found, whole = 0, 0.0
        for row in range(len(power)):
            dx, dy, dz = centre[row, 0] - x, centre[row, 1] - y, centre[row, 2] - z
            gives = power[row] / max(dx * dx + dy * dy + dz * dz, _NEAREST * _NEAREST)
            whole += gives
            place = found
            while place > 0 and best[place - 1] < gives:
                if place < MAX_NEARBY:
                    best[place], rows[place] = best[place - 1], rows[place - 1]
                place -= 1
            if place < MAX_NEARBY and gives > 0:
                best[place], rows[place] = gives, row
                found = min(found + 1, MAX_NEARBY)
        for place in range(found):
            if best[place] >= MIN_LIGHT_SHARE * whole:
                near[count] = rows[place]
                count += 1
        start[brick + 1] = count
    return start, near[:count].copy()
