"""Find the rooms of a scan as layouts: floor outline, wall height and openings.

Seen from above, walls divide the free space of a storey into rooms. Walls are continued across
doorways, whose lintels were seen, and behind objects. Outlines have few corners, all on the planes
of the walls.
"""

from itertools import pairwise

import numpy as np
from scipy import ndimage

from world2minecraft.core.types import FusedEvidence, Layout, OccupancyGrid, Opening
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate
from world2minecraft.reconstruction.layout.openings import Gap
from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.layout.storeys import find_storeys
from world2minecraft.reconstruction.layout.structure import Structure, Wall, structure_of
from world2minecraft.reconstruction.layout.surface_cells import Surface, surface_of, turn_surface

MERGE_M = 0.09  # Lines nearer than a cell and a bit are one wall.
NEAR_WALL_M = 0.35  # A region ends at a wall this near; else it ends where it was seen to.
INSIDE_SHARE = 0.5

ROOM_M2 = 1.0  # A closet; less is the depth of a wall between the two faces of a doorway.
FLOOR_SHARE = 0.15  # Of a room's columns, its floor was seen in so many; out of a window, in none.
PASSED_CELLS = 3  # Free cells in a column that count as rays; fewer are noise.
ALONG_M = 0.3  # A wall belongs to a room over this length at least.


def outline_of(
    region: np.ndarray,
    corner_m: np.ndarray,
    voxel_m: float,
    lines_m: tuple[list[float], list[float]],
) -> np.ndarray | None:
    """Return the polygon of a region, float64 [N, 2], counter-clockwise, or None if it is empty.

    The lines of the walls divide the plan into rectangles; rectangles at least half filled by the
    region belong to the room.

    Args:
        region: Mask of the columns of the room, bool [X, Y]; must not be empty.
        corner_m: Minimum corner of the plan in metres, float [2].
        voxel_m: Column size in metres.
        lines_m: Positions of the walls perpendicular to x and to y, in metres.
    """
    edges = [
        _lines(np.flatnonzero(plan.any(axis=1)), corner_m[axis], voxel_m, lines_m[axis])
        for axis, plan in enumerate((region, region.T))
    ]
    share = _filled_shares(region, corner_m, voxel_m, edges)
    parts, count = label_components(share >= INSIDE_SHARE, corners=False)
    if not count:
        return None
    areas = np.outer(np.diff(edges[0]), np.diff(edges[1]))
    largest = 1 + int(np.argmax(ndimage.sum(areas, parts, range(1, count + 1))))
    mask = np.asarray(ndimage.binary_fill_holes(parts == largest))
    ring = _ring(mask)
    return np.array([[edges[0][i], edges[1][j]] for i, j in ring]).round(4)


def _lines(cells: np.ndarray, corner_m: float, voxel_m: float, walls_m: list[float]) -> list:
    """Return the sorted cuts along an axis: the walls, and ends that are not close to a wall."""
    ends = corner_m + np.array([cells[0], cells[-1] + 1]) * voxel_m
    cuts = [x for x in walls_m if ends[0] - NEAR_WALL_M <= x <= ends[1] + NEAR_WALL_M]
    cuts += [float(end) for end in ends if all(abs(end - x) > NEAR_WALL_M for x in cuts)]
    merged: list[list[float]] = []
    for cut in sorted(cuts):
        if merged and cut - merged[-1][-1] <= MERGE_M:
            merged[-1].append(cut)
        else:
            merged.append([cut])
    return [sum(group) / len(group) for group in merged]


def _filled_shares(region: np.ndarray, corner_m: np.ndarray, voxel_m: float, edges) -> np.ndarray:
    """Return the share of each rectangle inside the region, float [columns, rows]."""
    total = np.pad(region.astype(np.int64).cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    at = [
        np.clip(np.round((np.array(e) - corner_m[a]) / voxel_m).astype(int), 0, region.shape[a])
        for a, e in enumerate(edges)
    ]
    count = np.diff(np.diff(total[np.ix_(*at)], axis=0), axis=1)
    cells = np.outer(np.diff(at[0]), np.diff(at[1]))
    return count / np.maximum(cells, 1)


def _ring(mask: np.ndarray) -> list[tuple[int, int]]:
    """Return the corners around a mask without holes, counter-clockwise."""
    steps: dict[tuple[int, int], list[tuple[int, int]]] = {}
    padded = np.pad(mask, 1)
    for i, j in np.argwhere(mask):
        corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        beyond = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
        for (a, b), side in zip(pairwise([*corners, corners[0]]), beyond, strict=True):
            if not padded[side]:
                steps.setdefault((int(a[0]), int(a[1])), []).append((int(b[0]), int(b[1])))
    start = min(steps)
    ring, at, way = [start], start, (1, 0)
    while True:
        ahead = sorted(steps[at], key=lambda to: -_turn(way, at, to))
        following = ahead[0]
        steps[at].remove(following)
        way = (following[0] - at[0], following[1] - at[1])
        at = following
        if at == start:
            break
        ring.append(at)
    count = len(ring)
    return [ring[n] for n in range(count) if _bends(ring[n - 1], ring[n], ring[(n + 1) % count])]


def _turn(way: tuple[int, int], at: tuple[int, int], to: tuple[int, int]) -> int:
    """Return the direction of a turn: 1 is left, 0 straight, -1 right."""
    step = (to[0] - at[0], to[1] - at[1])
    return int(np.sign(way[0] * step[1] - way[1] * step[0]))


def _bends(a: tuple[int, int], b: tuple[int, int], c: tuple[int, int]) -> bool:
    return (b[0] - a[0]) * (c[1] - b[1]) != (b[1] - a[1]) * (c[0] - b[0])


def find_structure(
    grid: OccupancyGrid, evidence: FusedEvidence, parameters: GeometricParameters | None = None
) -> tuple[Layout, ...]:
    """Return the rooms of a scan, storey by storey, the largest of each storey first.

    Args:
        grid: Cleaned or labelled grid; only its occupied cells are used.
        evidence: Evidence from which the grid was extracted.
        parameters: Parameters of the geometric labeller.

    Returns:
        A layout for each room in the room frame, without objects; empty if no floor was seen.

    Raises:
        ValueError: If grid and evidence do not have the same cells.
    """
    chosen = (parameters or GeometricParameters()).structure
    surface = surface_of(grid, evidence)
    layouts: list[Layout] = []
    for storey in find_storeys(surface, chosen):
        structure = structure_of(storey.surface(surface), chosen)
        for region in _regions(structure):
            layout = _layout(structure, region, storey.floor_z_m, f"room {len(layouts) + 1}")
            if layout is not None:
                layouts.append(layout)
    return tuple(layouts)


def _regions(structure: Structure) -> list[np.ndarray]:
    """Return the columns of each room, bool [X, Y], by decreasing area."""
    surface = structure.surface
    band = slice(max(surface.floor_layer + 2, 0), None)
    inside = surface.free[:, :, band].sum(axis=2) >= 3
    inside |= structure.rest[:, :, band].any(axis=2)
    closed = structure.wall.any(axis=2)
    for wall in structure.walls:
        closed |= _line(wall, structure)
    seen = structure.floor.cells.any(axis=2)
    parts, count = label_components(inside & ~closed, corners=False)
    sizes = np.bincount(parts.reshape(-1), minlength=count + 1)
    floors = np.bincount(parts[seen], minlength=count + 1)
    large = sizes * surface.voxel_m**2 >= ROOM_M2
    rooms = np.flatnonzero(large & (floors >= FLOOR_SHARE * sizes))
    rooms = sorted((int(n) for n in rooms if n), key=lambda n: -sizes[n])
    return [parts == number for number in rooms]


def _line(wall: Wall, structure: Structure) -> np.ndarray:
    """Return the columns of a wall, bool [X, Y], including hidden parts.

    Across a passage the wall continues only if a part of it was seen, such as the lintel of a
    doorway; these cells count as wall.
    """
    surface, run = structure.surface, wall.run
    columns = np.zeros(surface.occupied.shape[:2], bool)
    layer = plane_layer(wall, surface)
    high = slice(max(surface.floor_layer + 2, 0), surface.layers_below(run.top_m))
    free = turn_surface(surface.free, run.axis, run.sign)[
        layer, run.span[0] : run.span[1] + 1, high
    ]
    view = turn_surface(columns, run.axis, run.sign)
    view[layer, run.span[0] : run.span[1] + 1] = free.sum(axis=1) < PASSED_CELLS
    return columns


def plane_layer(wall: Wall, surface: Surface) -> int:
    """Return the layer of the rotated grid directly behind a wall's face."""
    relief = wall.relief
    inside_m = float(np.median(relief.plane_m)) - relief.edge_m(surface)
    return int(np.floor(inside_m / surface.voxel_m + 0.1)) + relief.box[0].start


def _layout(structure: Structure, region: np.ndarray, floor_z_m: float, name: str) -> Layout | None:
    surface = structure.surface
    walls = [wall for wall in structure.walls if _bounds(wall, region, surface)]
    lines = tuple([_position_m(wall) for wall in walls if wall.run.axis == axis] for axis in (0, 1))
    polygon = outline_of(dilate(region), surface.origin_m[:2], surface.voxel_m, lines)  # type: ignore[arg-type]
    if polygon is None:
        return None
    height = structure.ceiling_m
    if height is None:
        tops = [wall.run.top_m for wall in walls]
        height = max(tops, default=float(surface.points_m[surface.occupied][:, 2].max()))
    openings = [_opening(wall, gap) for wall in walls for gap in wall.face.gaps]
    return Layout(
        floor_polygon_m=polygon,
        wall_height_m=round(max(height, 0.1), 4),
        openings=tuple(o for o in openings if _on_outline(o, polygon)),
        floor_z_m=round(floor_z_m, 4),
        name=name,
    )


def _position_m(wall: Wall) -> float:
    """Return the position of a wall along its perpendicular axis in metres."""
    return wall.run.sign * float(np.median(wall.relief.plane_m))


def _bounds(wall: Wall, region: np.ndarray, surface: Surface) -> bool:
    """Return whether a region is directly in front of a wall."""
    view = turn_surface(region, wall.run.axis, wall.run.sign)
    layer = plane_layer(wall, surface)
    before = view[max(layer - 4, 0) : max(layer, 0), wall.run.span[0] : wall.run.span[1] + 1]
    return before.any(axis=0).sum() * surface.voxel_m >= ALONG_M


def _opening(wall: Wall, gap: Gap) -> Opening:
    at = _position_m(wall)
    ends = [[along, at] if wall.run.axis else [at, along] for along in gap.along_m]
    start, end = (np.round(np.array(point), 4) for point in ends)
    return Opening(gap.kind, start, end, round(gap.height_m[0], 4), round(gap.height_m[1], 4))


def _on_outline(opening: Opening, polygon: np.ndarray) -> bool:
    """Return whether the centre of an opening is on an edge of a polygon."""
    middle = (opening.start_m + opening.end_m) / 2
    first, second = polygon, np.roll(polygon, -1, axis=0)
    low, high = np.minimum(first, second) - 0.15, np.maximum(first, second) + 0.15
    return bool(((low <= middle) & (middle <= high)).all(axis=1).any())
