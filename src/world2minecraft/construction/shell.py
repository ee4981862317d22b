"""The shell of a room: painted floor, walls and ceiling, windows, rugs, pictures and the edge.

Rugs and pictures are parts of a flat surface with a different paint, which must be distinguished
from shadow and noise. Shadow multiplies light, and thus all three Oklab coordinates, so hue and
chroma are compared at equal lightness. Lightness is compared with a smooth surface fitted to the
patch, so that a gradual change towards a corner does not count. A smaller difference of hue is
sufficient for what is lighter than its surroundings, since shadow is not.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.construction.canvas import BARRIER, Canvas
from world2minecraft.construction.cell_colours import fill_colours
from world2minecraft.construction.colour_sources import BuildSource
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.shell_geometry import CEILING, FLOOR, WALL, WINDOW, Shell
from world2minecraft.construction.surface_painting import (
    BlockChoice,
    block_colours,
    paint_surface,
    place_painted,
)
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate, nearest_set_cells

ROUNDS = 4
SCALE = 0.05  # Oklab distance at which a block counts half in the fit.
MIN_BLOCKS = 12  # A fit of six numbers to fewer blocks says nothing.
MAX_SHARE = 0.6  # Maximum share of a surface; larger parts are the surface itself.
SURE_SHARE = 0.3  # Of a part that stands out. A guess: a picture's rim is half wall.
MIN_PATCH = 12  # Blocks; smaller patches take their colours from the walls as a whole.
MIN_SEEN = 0.1  # Share of a patch with a colour; what furniture hides continues the wall above.


class PaintThresholds(NamedTuple):
    """The differences at which a block surely, or possibly, has a different paint."""

    hue: float  # Oklab distance of hue and chroma at one lightness
    lightness: float  # infinite: never by lightness alone
    weak_hue: float  # Blocks beside sure ones belong to them from here on.
    weak_lightness: float
    least_m2: float
    # Oklab distance of hue and chroma, and excess of lightness, that are sufficient together.
    light_hue: float = np.inf
    excess: float = np.inf


# All 20 rugs of the generated rooms differ by 0.05 and more, planks of one floor by up to 0.03.
# Pale and yellow rugs on wood, lighter by 0.1, differ by 0.02 or more; sunlight on a floor by less,
# as does everything on the floors of the real kitchen and lounge but one existing patch.
RUG = PaintThresholds(0.04, np.inf, 0.03, np.inf, 0.5, 0.02, 0.1)
WEAK_SHARE = 0.7  # Of both differences, for blocks beside sure ones.
# A picture is a mix of colours at 4 blocks a metre, darker than its wall by 0.25 to 0.3; a curtain
# darkens the wall beside it by up to 0.19.
PICTURE = PaintThresholds(0.04, 0.22, 0.015, 0.045, 0.3)


def find_contrasting_parts(
    mask: np.ndarray, colours: np.ndarray, step_m: float, steps: PaintThresholds
) -> np.ndarray:
    """Label the parts of a flat surface that stand out, int32 [N] from 1; 0 is the background.

    Args:
        mask: Bool [X, Y, Z] mask of N blocks in one layer.
        colours: Oklab colours of the blocks in mask order, float32 [N, 3].
        step_m: Block size in metres.
        steps: Thresholds of the differences.
    """
    places = np.argwhere(mask)
    flat = np.flatnonzero(np.ptp(places, axis=0) > 0) if len(places) else np.zeros(0, int)
    if len(places) < MIN_BLOCKS or len(flat) != 2:
        return np.zeros(len(places), np.int32)
    at = places[:, flat] - places[:, flat].min(0)
    sure, maybe = _differ(at.astype(float), colours, steps)
    sheet = np.zeros((2, *(at.max(0) + 1)), bool)
    sheet[:, at[:, 0], at[:, 1]] = sure, maybe
    wide = np.asarray(ndimage.binary_opening(sheet[1], np.ones((2, 2), bool)), bool)
    parts, _ = label_components(wide, corners=False)
    sizes = np.bincount(parts.ravel())
    held = np.bincount(parts[sheet[0]], minlength=len(sizes))
    good = (sizes * step_m**2 >= steps.least_m2) & (sizes <= MAX_SHARE * len(places))
    good &= held >= SURE_SHARE * sizes
    good[0] = False
    return np.where(good, np.arange(len(sizes)), 0).astype(np.int32)[parts[tuple(at.T)]]


def _differ(
    at: np.ndarray, colours: np.ndarray, steps: PaintThresholds
) -> tuple[np.ndarray, np.ndarray]:
    """Return which blocks surely, and which possibly, differ from the main paint, bool [N] each."""
    lightness = np.maximum(colours[:, 0], 0.05)
    middle = np.median(lightness)
    hues = colours[:, 1:] / lightness[:, None] * middle
    # What dark cells have of hue is noise: it counts as much less as they are darker.
    trust = np.minimum(1.0, lightness / middle)
    hue = np.linalg.norm(hues - np.median(hues, axis=0), axis=1) * trust
    excess = lightness - _smooth(at, lightness)
    light = np.abs(excess)
    sure = (hue >= steps.hue) | (light >= steps.lightness)
    sure |= (hue >= steps.light_hue) & (excess >= steps.excess)
    maybe = (hue >= steps.weak_hue) | (light >= steps.weak_lightness)
    weak_hue, weak_excess = WEAK_SHARE * steps.light_hue, WEAK_SHARE * steps.excess
    return sure, maybe | ((hue >= weak_hue) & (excess >= weak_excess))


def _smooth(at: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return a robust quadratic surface fitted to values at positions [N, 2], float64 [N]."""
    u, v = (at / np.maximum(at.max(0), 1)).T
    terms = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=1)
    fitted = np.full(len(values), np.median(values))
    for _ in range(ROUNDS):
        weights = 1 / (1 + ((values - fitted) / SCALE) ** 2)
        factor = np.sqrt(weights)[:, None]
        solution = np.linalg.lstsq(terms * factor, values * factor[:, 0], rcond=None)[0]
        fitted = terms @ solution
    return fitted


STAND_OUT = {WALL: PICTURE, FLOOR: RUG}


def put_shell(
    canvas: Canvas,
    shell: Shell,
    source: BuildSource,
) -> None:
    """Paint the surfaces of a shell and set their blocks.

    Args:
        canvas: Empty canvas.
        shell: Masks of the parts of the shell.
        source: Colours of the grid's cells and allowed blocks.
    """
    at, palette = tuple(shell.cells.T), source.palette
    tinted, known = block_colours(
        canvas.states.shape, shell.blocks, source.colours[at], source.coloured[at]
    )
    surfaces = [(shell.ceiling, CEILING), (shell.walls, WALL), (shell.floor, FLOOR)]
    if source.parameters.ceiling == "glass":
        canvas.put(shell.ceiling, canvas.id_of(palette.glass), CEILING)
        surfaces = surfaces[1:]
    for mask, class_id in surfaces:
        limit = source.parameters.structure_colours
        choice = BlockChoice(class_id, palette, source.parameters, limit)
        used: frozenset[str] = frozenset()
        patches = _patches(mask, shell.patches, known)
        for patch in sorted(patches, key=lambda patch: -int(patch.sum())):
            used |= _put_surface(canvas, patch, tinted, known & mask, choice, used)
        _continue_surfaces(canvas, mask, choice)
    _put_windows(canvas, shell.windows, palette)
    _name_foundations(canvas)


def _put_surface(
    canvas: Canvas,
    patch: np.ndarray,
    colours: np.ndarray,
    known: np.ndarray,
    choice: BlockChoice,
    used: frozenset[str],
) -> frozenset[str]:
    """Paint a surface, and the parts that stand out from it in other blocks.

    Returns:
        The blocks of the surface itself.
    """
    parts, class_id = np.zeros(patch.shape, np.int32), choice.class_id
    if class_id in STAND_OUT and (known & patch).any():
        step_m = 1 / canvas.lattice.blocks_per_metre
        filled = fill_colours(colours, known & patch, patch, np.zeros(3, np.float32))
        steps = STAND_OUT[class_id]
        if choice.parameters.paper_compat:
            steps = steps._replace(light_hue=np.inf, excess=np.inf)
        parts[patch] = find_contrasting_parts(patch, filled, step_m, steps)
    around: frozenset[str] = frozenset()
    for part in np.unique(parts[patch]).tolist():
        mask = patch & (parts == part)
        states = paint_surface(
            mask,
            colours,
            known & (mask if (known & mask).any() else patch),
            choice,
            beside=around,
            used=used,
        )
        place_painted(canvas, mask, states, class_id)
        around = around or frozenset(states.tolist())
    return around


def _patches(mask: np.ndarray, numbers: np.ndarray, known: np.ndarray):
    """Yield the surfaces of a mask that have a colour; small ones are combined into one."""
    most = int(numbers.max()) + 1
    counts, seen = (np.bincount(numbers[part], minlength=most) for part in (mask, mask & known))
    whole = (counts >= MIN_PATCH) & (seen >= MIN_SEEN * counts)
    rest = mask & known & ~whole[numbers]
    if rest.any():
        yield rest
    for number in np.flatnonzero(whole):
        yield mask & (numbers == number)


def _continue_surfaces(canvas: Canvas, mask: np.ndarray, choice: BlockChoice) -> None:
    """Set the blocks of surfaces without a colour like the nearest block of another."""
    rest = mask & (canvas.states == 0)
    if not rest.any():
        return
    done = mask & ~rest
    if not done.any():
        default = choice.palette.defaults[choice.class_id]
        canvas.put(rest, canvas.id_of(default), choice.class_id)
        return
    nearest, _ = nearest_set_cells(done)
    canvas.put(rest, canvas.states[tuple(axis[rest] for axis in nearest)], choice.class_id)


def _name_foundations(canvas: Canvas) -> None:
    """Assign the class wall to floor blocks under walls, since they are not visible as floor.

    A doorway has wall above and floor inside.
    """
    for ground in canvas.lattice.grounds:
        above = np.isin(canvas.semantic[:, :, ground], (WALL, WINDOW))
        below = canvas.semantic[:, :, ground - 1]
        below[above & (below == FLOOR)] = WALL


def _put_windows(canvas: Canvas, windows: np.ndarray, palette: Palette) -> None:
    """Set panes that connect on both sides, otherwise glass blocks."""
    if not windows.any():
        return
    held = np.pad((canvas.states > 0) | windows, ((1, 1), (1, 1), (0, 0)))
    along_x = held[2:, 1:-1] & held[:-2, 1:-1]
    along_y = held[1:-1, 2:] & held[1:-1, :-2]
    panes = windows & (along_x ^ along_y)
    canvas.put(panes, canvas.id_of(palette.pane), WINDOW)
    canvas.put(windows & ~panes, canvas.id_of(palette.glass), WINDOW)


def put_edge(canvas: Canvas, footprints: tuple[np.ndarray, ...]) -> None:
    """Place invisible barriers at the edge of the floor where no wall was seen.

    Args:
        canvas: Canvas with the finished shell and objects.
        footprints: Bool [X, Y] mask of the columns within the rooms, for each storey. An edge above
            the storey below is a stairwell and stays open.
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
