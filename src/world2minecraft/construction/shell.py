"""Setting the shell on the canvas: painted floor, walls, ceiling, glass and the unseen edge."""

import numpy as np

from world2minecraft.construction.canvas import BARRIER, Canvas
from world2minecraft.construction.cell_colours import spread
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.standout import PICTURE, RUG, standing_out
from world2minecraft.construction.structure import CEILING, FLOOR, WALL, WINDOW, Shell
from world2minecraft.construction.surfaces import block_colours, painted, put_painted
from world2minecraft.geometry.morphology import dilate

STAND_OUT = {WALL: PICTURE, FLOOR: RUG}
LEAST_PATCH = 12  # Blocks; smaller patches take their colours from the walls as a whole.


def put_shell(
    canvas: Canvas,
    shell: Shell,
    colours: np.ndarray,
    coloured: np.ndarray,
    palette: Palette,
    parameters: BuildParameters,
) -> None:
    """Paint the surfaces of a shell and set them.

    Args:
        canvas: an empty canvas.
        shell: which blocks are what.
        colours: float32 [X, Y, Z, 3], the Oklab colours of the grid's cells.
        coloured: bool [X, Y, Z], which cells have one.
        palette: what may be used.
        parameters: how many colours, how calm.
    """
    at = tuple(shell.cells.T)
    tinted, known = block_colours(canvas.states.shape, shell.blocks, colours[at], coloured[at])
    surfaces = [(shell.ceiling, CEILING), (shell.walls, WALL), (shell.floor, FLOOR)]
    if parameters.ceiling == "glass":
        canvas.put(shell.ceiling, canvas.id_of(palette.glass), CEILING)
        surfaces = surfaces[1:]
    for mask, class_id in surfaces:
        source = (tinted, known & mask, class_id, palette, parameters)
        used: frozenset[str] = frozenset()
        for patch in sorted(_patches(mask, shell.patches), key=lambda patch: -int(patch.sum())):
            used |= _put_surface(canvas, patch, used, *source)
    _put_windows(canvas, shell.windows, palette)
    _name_foundations(canvas)


def _put_surface(
    canvas: Canvas,
    patch: np.ndarray,
    used: frozenset[str],
    tinted: np.ndarray,
    known: np.ndarray,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
) -> frozenset[str]:
    """Set a surface, and on it, in blocks of their own, what stands out from it.

    Returns:
        The blocks of the surface itself.
    """
    parts = np.zeros(patch.shape, np.int32)
    if class_id in STAND_OUT and (known & patch).any():
        step_m = 1 / canvas.lattice.blocks_per_metre
        colours = spread(tinted, known & patch, patch, np.zeros(3, np.float32))
        parts[patch] = standing_out(patch, colours, step_m, STAND_OUT[class_id])
    around: frozenset[str] = frozenset()
    for part in np.unique(parts[patch]).tolist():
        mask = patch & (parts == part)
        states = painted(
            mask,
            tinted,
            known & (mask if (known & mask).any() else patch),
            class_id,
            palette,
            parameters,
            parameters.structure_colours,
            beside=around,
            used=used,
        )
        put_painted(canvas, mask, states, class_id)
        around = around or frozenset(states.tolist())
    return around


def _patches(mask: np.ndarray, numbers: np.ndarray):
    """Yield the surfaces of a mask; the small ones come together as one."""
    held = numbers[mask]
    counts = np.bincount(held, minlength=int(numbers.max()) + 1)
    small = counts < LEAST_PATCH
    if (small[held]).any():
        yield mask & small[numbers]
    for number in np.flatnonzero(~small):
        yield mask & (numbers == number)


def _name_foundations(canvas: Canvas) -> None:
    """Count the floor's blocks under walls as wall: so the floor's class is what one sees.

    A doorway has a wall over it and floor in it.
    """
    for ground in canvas.lattice.grounds:
        above = np.isin(canvas.semantic[:, :, ground], (WALL, WINDOW))
        below = canvas.semantic[:, :, ground - 1]
        below[above & (below == FLOOR)] = WALL


def _put_windows(canvas: Canvas, windows: np.ndarray, palette: Palette) -> None:
    """Set panes where they join something on both sides, else glass blocks."""
    if not windows.any():
        return
    held = np.pad((canvas.states > 0) | windows, ((1, 1), (1, 1), (0, 0)))
    along_x = held[2:, 1:-1] & held[:-2, 1:-1]
    along_y = held[1:-1, 2:] & held[1:-1, :-2]
    panes = windows & (along_x ^ along_y)
    canvas.put(panes, canvas.id_of(palette.pane), WINDOW)
    canvas.put(windows & ~panes, canvas.id_of(palette.glass), WINDOW)


def put_edge(canvas: Canvas, footprints: tuple[np.ndarray, ...]) -> None:
    """Stand invisible barriers where the floor ends and no wall was seen.

    Args:
        canvas: the finished shell and objects.
        footprints: bool [X, Y] for each storey, the columns within its rooms. What lies within
            the storey below is a stairwell, and stays open.
    """
    layers = np.flatnonzero((canvas.semantic > 0).any((0, 1)))
    highest = int(layers.max()) if len(layers) else 0
    below = np.zeros_like(footprints[0])
    for (ground, end), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        ring = dilate(footprint, (1, 1)) & ~footprint & ~below
        below = footprint
        top = min(max(highest, ground + 1), end - 1)
        open_cells = canvas.states[:, :, ground : top + 1] == 0
        open_cells &= ring[:, :, None]
        canvas.states[:, :, ground : top + 1][open_cells] = canvas.id_of(BARRIER)
