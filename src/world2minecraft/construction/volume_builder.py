"""Stage 7: build a volume of blocks from the labelled grid and its placements."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.construction.block_lattice import is_exact, lattice_over, snap_corner_m
from world2minecraft.construction.block_updates import apply_block_updates
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.cell_colours import cell_colours, coloured_cells, unify_paints
from world2minecraft.construction.colour_sets import darken_screens, unify_sets
from world2minecraft.construction.colour_sources import BuildSource
from world2minecraft.construction.display.builder import DisplayBuilder
from world2minecraft.construction.door_leaves import find_leaves, without_leaves
from world2minecraft.construction.doors import put_doors
from world2minecraft.construction.floating_blocks import close_gaps, support_floaters
from world2minecraft.construction.islands import remove_islands
from world2minecraft.construction.lighting import hang_lamps, put_lights
from world2minecraft.construction.mod_furniture import place_mod_furniture
from world2minecraft.construction.object_builder import ObjectBuilder
from world2minecraft.construction.palette_restriction import restrict_to_palette
from world2minecraft.construction.palettes import load_palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.plaque import SIGN, WALL_SIGN, add_plaque
from world2minecraft.construction.shell import put_edge, put_shell
from world2minecraft.construction.shell_geometry import build_shell
from world2minecraft.construction.storeys import add_storeys
from world2minecraft.construction.voxel_blocks import place_voxels
from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import (
    BlockVolume,
    Layout,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)


def build_volume(
    grid: OccupancyGrid,
    placements: Sequence[Placement],
    instances: Sequence[ObjectInstance],
    *,
    corner_m: np.ndarray | None = None,
    blocks_per_metre: float = 4.0,
    parameters: BuildParameters | None = None,
    name: str = "",
    rooms: Sequence[Layout] = (),
) -> BlockVolume:
    """Build a room of blocks.

    Small parts far from everything else are left out, unless a block equals a voxel.

    Args:
        grid: Labelled grid with colours.
        placements: Placements of furniture; object cells without a placement are built as they are.
        instances: Objects, whose cells are given by ``grid.instance``.
        corner_m: Corner (x_min, y_max) of the room's inner box in metres, which is placed at block
            (0, 64, 0); rounded to whole voxels. The default is the corner of the grid.
        blocks_per_metre: Scale. If a block equals a voxel, every occupied cell becomes one block.
        parameters: Build parameters.
        name: Name of the scene for the plaque. Without a name, a plaque is placed only if the
            parameters contain its text.
        rooms: Rooms, of whose openings the door leaves become doors, except if a block equals a
            voxel.

    Raises:
        UsageError: If the scale is not positive or gives too many blocks.
        UnknownNameError: If the palette is unknown.
    """
    chosen = parameters or BuildParameters()
    if not 0 < blocks_per_metre < 1e4:
        raise UsageError(f"blocks_per_metre must be above 0, got {blocks_per_metre}; try 4")
    corner = grid_corner_m(grid) if corner_m is None else snap_corner_m(grid, corner_m)
    canvas = Canvas(add_storeys(lattice_over(grid, corner, blocks_per_metre), grid))
    palette = load_palette(chosen.palette)
    if not is_exact(grid, blocks_per_metre):
        grid, placements = remove_islands(grid, placements)
    colours = cell_colours(grid, chosen.expose, chosen.saturation)
    source = BuildSource(grid, colours, coloured_cells(grid), palette, chosen)
    if is_exact(grid, blocks_per_metre):
        footprints = place_voxels(canvas, source)
    else:
        footprints = _put_room(canvas, placements, instances, source, rooms)
    restrict_to_palette(canvas, palette)
    apply_block_updates(canvas)
    if chosen.edge == "barrier":
        put_edge(canvas, footprints)
    if chosen.lights == "lamps" and not is_exact(grid, blocks_per_metre):
        hang_lamps(canvas, footprints, palette)
    if chosen.lights != "off":
        put_lights(canvas, footprints)
    restrict_to_palette(canvas, palette)
    volume = canvas.volume()
    text = {"auto": name, "off": ""}.get(chosen.plaque, chosen.plaque)
    allowed = palette.allows(SIGN) and palette.allows(WALL_SIGN)
    return add_plaque(volume, text) if text and allowed else volume


def _put_room(
    canvas: Canvas,
    placements: Sequence[Placement],
    instances: Sequence[ObjectInstance],
    source: BuildSource,
    rooms: Sequence[Layout],
) -> tuple[np.ndarray, ...]:
    """Place the shell, the objects and doors, and return each storey's footprint, bool [X, Y]."""
    grid, colours, coloured, palette, parameters = source
    shell = build_shell(grid, canvas.lattice, parameters)
    put_shell(canvas, shell, source)
    found = find_leaves(grid, rooms)
    placements = [one for one in placements if one.object_id not in found.objects]
    grid = without_leaves(grid, found)
    things = coloured & np.isin(grid.labels, OBJECT_CLASSES)
    painted = colours.copy()
    painted[things] = unify_paints(colours[things])
    painted = unify_sets(instances, painted, things)
    painted = darken_screens(grid, instances, painted, things)
    object_source = source._replace(grid=grid, colours=painted)
    if parameters.style == "display":
        DisplayBuilder(canvas, object_source, instances).put_all(placements)
        put_doors(canvas, shell.footprints, found, source)
        return shell.footprints
    builder = ObjectBuilder(canvas, object_source, shell.footprints, instances)
    remaining = place_mod_furniture(
        canvas, palette.furniture, placements, painted, grid, builder.within
    )
    builder.put_all(remaining)
    support_floaters(canvas)
    close_gaps(canvas)
    put_doors(canvas, shell.footprints, found, source)
    return shell.footprints


def grid_corner_m(grid: OccupancyGrid) -> np.ndarray:
    """Return the corner (x_min, y_max) of a room without a known box, from its occupied cells.

    The outer layer of wall cells counts as shell and is outside the corner, float64 [2] in metres.
    """
    occupied = np.asarray(grid.occupied.any(2))
    if not occupied.any():
        return np.array([grid.origin_m[0], grid.origin_m[1] + grid.shape[1] * grid.voxel_m])
    cells = np.argwhere(occupied)
    first, last = int(cells[:, 0].min()), int(cells[:, 1].max())
    walls = np.asarray(np.isin(grid.labels, (SemanticClass.WALL, SemanticClass.WINDOW)).any(2))
    first += bool(walls[first].any())
    last -= bool(walls[:, last].any())
    return grid.origin_m[:2] + np.array([first, last + 1]) * grid.voxel_m
