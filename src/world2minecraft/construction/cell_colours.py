"""The colours of cells and of the blocks that cover them, in Oklab."""

import numpy as np

from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import linear_to_oklab, srgb_to_linear, srgb_to_oklab
from world2minecraft.geometry.morphology import nearest_set_cells
from world2minecraft.minecraft.block_colours import colour_of

# Exposure: the brightest twentieth of a room's surfaces comes to this linear light, about that of
# white concrete. Photos of dim rooms come out darker than any wall paint is.
BRIGHT_LIGHT, BRIGHT_QUANTILE = 0.6, 0.95
GAIN_LIMIT = 1.8
# White balance: bright cells that are nearly grey are taken for grey.
GREY_CHROMA, CAST_LIMIT = 0.05, 1.1
MIN_CELLS = 50
# Chroma under which a colour is a grey with a cast, and from which it is meant.
FAINT_CHROMA, CLEAR_CHROMA = 0.02, 0.06
# Wood lies within these degrees of hue; red begins where they fade out.
WOOD_HUE, WOOD_REACH, WOOD_FADE = 65.0, 20.0, 10.0
# A paint: so many cells (1 m2 at 8 cm) of a strong chroma within a few degrees of one hue. The
# reach is that of the kitchen's reds in haze; lightness tells a pink thing from a red one.
STRONG_CHROMA, PAINT_CELLS, MAX_PAINTS = 0.09, 150, 3
HUE_BIN, PAINT_REACH, PAINT_LIGHT = 15.0, 25.0, 0.2
NEAR_BLOCKS = 2.0  # So far a block that nobody saw takes the colour of the nearest that was seen.


def coloured_cells(grid: OccupancyGrid) -> np.ndarray:
    """Return bool [X, Y, Z]: which cells carry a colour. Black, exactly 0, stands for none."""
    return grid.occupied & grid.colour.any(-1)


def cell_colours(grid: OccupancyGrid, expose: bool, saturation: float) -> np.ndarray:
    """Return the Oklab colours of all cells, float32 [X, Y, Z, 3]; zero where there is none.

    Args:
        grid: the room.
        expose: whether to light a dim room and take away its colour cast.
        saturation: the factor on the chroma of clear colours; greys stay as they are.
    """
    seen = coloured_cells(grid)
    result = np.zeros((*grid.shape, 3), np.float32)
    colours = grid.colour[seen]
    if not len(colours):
        return result
    if expose:
        linear = srgb_to_linear(colours)
        result[seen] = linear_to_oklab(np.clip(linear * exposure_gains(linear), 0, 1))
    else:
        result[seen] = srgb_to_oklab(colours)
    result[seen] = boost_saturation(result[seen], saturation)
    return result


def boost_saturation(oklab: np.ndarray, saturation: float) -> np.ndarray:
    """Return Oklab colours, float32 [N, 3], with the chroma of clear ones multiplied.

    Greys stay as they are, and so do the hues of wood, which a stronger chroma turns into those
    of bricks and oranges.
    """
    chroma = np.hypot(oklab[:, 1], oklab[:, 2])
    clear = np.clip((chroma - FAINT_CHROMA) / (CLEAR_CHROMA - FAINT_CHROMA), 0, 1)
    hue = np.degrees(np.arctan2(oklab[:, 2], oklab[:, 1]))
    off_wood = np.abs((hue - WOOD_HUE + 180) % 360 - 180)
    clear *= np.clip((off_wood - WOOD_REACH) / WOOD_FADE, 0, 1)
    result = oklab.astype(np.float32)
    result[:, 1:] *= (1 + (saturation - 1) * clear)[:, None]
    return result


def unify_paints(oklab: np.ndarray) -> np.ndarray:
    """Return the colours of a room's things, float32 [N, 3], each strong paint made one colour.

    Haze, shade and the mixing of neighbours in a cell make purple, brown and pink of one red. Where
    much of a room is of one strong hue, what lies near that hue takes its colour.
    """
    result = oklab.astype(np.float32)
    chroma = np.hypot(oklab[:, 1], oklab[:, 2])
    hue = np.degrees(np.arctan2(oklab[:, 2], oklab[:, 1]))
    off_wood = np.abs(_turn(hue - WOOD_HUE)) > WOOD_REACH + WOOD_FADE
    strong = (chroma >= STRONG_CHROMA) & off_wood
    for _ in range(MAX_PAINTS):
        bins = np.bincount((hue[strong] % 360 / HUE_BIN).astype(int), minlength=int(360 / HUE_BIN))
        wide = bins + np.roll(bins, 1)
        best = int(wide.argmax())
        if wide[best] < PAINT_CELLS:
            break
        near = np.abs(_turn(hue - best * HUE_BIN)) <= PAINT_REACH
        core = strong & near
        middle = np.median(oklab[core], axis=0)
        middle[1:] *= np.quantile(chroma[core], 0.75) / max(float(np.hypot(*middle[1:])), 1e-6)
        mine = near & off_wood & (chroma >= CLEAR_CHROMA)
        mine &= np.abs(oklab[:, 0] - middle[0]) <= PAINT_LIGHT
        result[mine] = middle
        strong &= ~near
    return result


def _turn(degrees: np.ndarray) -> np.ndarray:
    """Return angles from -180 to 180."""
    return (degrees + 180) % 360 - 180


def exposure_gains(linear: np.ndarray) -> np.ndarray:
    """Return the factors, float64 [3], that light a dim room and take away its colour cast.

    Args:
        linear: float64 [N, 3], the linear light of its surfaces.
    """
    if len(linear) < MIN_CELLS:
        return np.ones(3)
    light = linear @ np.array([0.2126, 0.7152, 0.0722])
    bright = np.quantile(light, BRIGHT_QUANTILE)
    exposure = np.clip(BRIGHT_LIGHT / max(bright, 1e-6), 1.0, GAIN_LIMIT)
    grey = linear[
        (np.hypot(*linear_to_oklab(linear)[:, 1:].T) < GREY_CHROMA) & (light >= 0.5 * bright)
    ]
    if len(grey) < MIN_CELLS:
        return np.full(3, exposure)
    mean = np.maximum(grey.mean(0), 1e-6)
    return exposure * np.clip(mean.mean() / mean, 1 / CAST_LIMIT, CAST_LIMIT)


def block_colour(block: str) -> np.ndarray:
    """Return the Oklab colour, float32 [3], of a block state."""
    return srgb_to_oklab(np.array(colour_of(block), np.uint8))


def group_medians(
    groups: np.ndarray, colours: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the median colour of each group, float32 [count, 3], and how many it has, int [count].

    Args:
        groups: int [N], the group of each colour.
        colours: float32 [N, 3].
        count: the number of groups; an empty one has median 0.
    """
    sizes = np.bincount(groups, minlength=count)
    starts = np.cumsum(sizes) - sizes
    medians = np.zeros((count, 3), np.float32)
    full = sizes > 0
    low = starts[full] + (sizes[full] - 1) // 2
    high = starts[full] + sizes[full] // 2
    for channel in range(3):
        ordered = colours[np.lexsort((colours[:, channel], groups)), channel]
        medians[full, channel] = (ordered[low] + ordered[high]) / 2
    return medians, sizes


def fill_colours(
    colours: np.ndarray, known: np.ndarray, wanted: np.ndarray, default: np.ndarray
) -> np.ndarray:
    """Return the colours, float32 [N, 3], at ``wanted``: each its own, or the nearest known one.

    Far from all known ones it is their median: a floor under a table is like the rest of it.

    Args:
        colours: float32 [X, Y, Z, 3].
        known: bool [X, Y, Z], where ``colours`` holds one.
        wanted: bool [X, Y, Z] with N cells set.
        default: float32 [3], for all where none is known.
    """
    if not known.any():
        return np.broadcast_to(default, (int(wanted.sum()), 3)).astype(np.float32)
    if known[wanted].all():
        return colours[wanted]
    nearest, away = nearest_set_cells(known)
    result = colours[tuple(axis[wanted] for axis in nearest)]
    result[away[wanted] > NEAR_BLOCKS] = np.median(colours[known], axis=0)
    return result
