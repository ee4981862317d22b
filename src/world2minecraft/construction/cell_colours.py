"""Oklab colours of cells and of the blocks that cover them."""

import numpy as np

from world2minecraft.core.classes import STRUCTURE_CLASSES, SemanticClass
from world2minecraft.core.types import COMPLETED, OccupancyGrid
from world2minecraft.geometry.colour import linear_to_oklab, srgb_to_linear, srgb_to_oklab
from world2minecraft.geometry.morphology import nearest_set_cells
from world2minecraft.minecraft.block_colours import colour_of

# Exposure: photos of rooms come out darker than their surfaces are, by one factor. The linear light
# that surfaces usually reflect, and how far that varies, in natural logarithms: paint of ceilings
# and walls is pale, floors and objects vary.
REFLECTANCES = {
    int(SemanticClass.CEILING): (0.75, 0.4),
    int(SemanticClass.WALL): (0.6, 0.5),
    int(SemanticClass.FLOOR): (0.25, 1.5),
    int(SemanticClass.FURN): (0.25, 1.5),
    int(SemanticClass.OBJS): (0.25, 1.5),
}
EXPOSURE_SIGMA, MAX_GAIN = 0.15, 1.4  # How far cameras err, likewise.
MIN_CELLS = 50
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# Chroma under which a colour is a grey with a cast, and from which it is meant.
FAINT_CHROMA, CLEAR_CHROMA = 0.02, 0.06
# Wood lies within these degrees of hue; red begins where they fade out.
WOOD_HUE, WOOD_REACH, WOOD_FADE = 65.0, 20.0, 10.0
# A paint: so many cells (1 m2 at 8 cm) of a strong chroma within a few degrees of one hue. The
# reach is that of the kitchen's reds in haze; lightness distinguishes pink from red.
STRONG_CHROMA, PAINT_CELLS, MAX_PAINTS = 0.09, 150, 3
HUE_BIN, PAINT_REACH, PAINT_LIGHT = 15.0, 25.0, 0.2
NEAR_BLOCKS = 2.0  # Unseen blocks take the colour of the nearest seen one within this.


def coloured_cells(grid: OccupancyGrid) -> np.ndarray:
    """Return the bool [X, Y, Z] mask of cells with a colour; black (exactly 0) means no colour.

    The colour of structure that was completed is that of its nearest edge, often shadow, and counts
    only where nothing else of its class has a colour.
    """
    result = grid.occupied & grid.colour.any(-1)
    guessed = result & (grid.source == COMPLETED)
    for class_id in STRUCTURE_CLASSES:
        own = grid.labels == class_id
        if (result & own & ~guessed).any():
            result &= ~(own & guessed)
    return result


def cell_colours(grid: OccupancyGrid, expose: bool, saturation: float) -> np.ndarray:
    """Return the Oklab colours of all cells, float32 [X, Y, Z, 3]; cells without colour are 0.

    Args:
        grid: The grid of the room.
        expose: Whether to brighten a dark room.
        saturation: Factor on the chroma of saturated colours; greys are not changed.
    """
    seen = coloured_cells(grid)
    result = np.zeros((*grid.shape, 3), np.float32)
    colours = grid.colour[seen]
    if not len(colours):
        return result
    if expose:
        linear = srgb_to_linear(colours)
        gain = exposure_gain(linear, grid.labels[seen])
        result[seen] = linear_to_oklab(np.clip(linear * gain, 0, 1))
    else:
        result[seen] = srgb_to_oklab(colours)
    result[seen] = boost_saturation(result[seen], saturation)
    return result


def boost_saturation(oklab: np.ndarray, saturation: float) -> np.ndarray:
    """Multiply the chroma of saturated Oklab colours, float32 [N, 3].

    Greys are not changed, nor are the hues of wood, which would otherwise turn into brick or
    orange.
    """
    chroma = np.hypot(oklab[:, 1], oklab[:, 2])
    clear = np.clip((chroma - FAINT_CHROMA) / (CLEAR_CHROMA - FAINT_CHROMA), 0, 1)
    hue = np.degrees(np.arctan2(oklab[:, 2], oklab[:, 1]))
    off_wood = np.abs(_turn(hue - WOOD_HUE))
    clear *= np.clip((off_wood - WOOD_REACH) / WOOD_FADE, 0, 1)
    result = oklab.astype(np.float32)
    result[:, 1:] *= (1 + (saturation - 1) * clear)[:, None]
    return result


def unify_paints(oklab: np.ndarray) -> np.ndarray:
    """Unify the variants of each dominant strong hue in Oklab colours, float32 [N, 3].

    Haze, shadow and mixed cells turn one red into purple, brown and pink. If a strong hue covers
    much of a room, the colours close to this hue are replaced by its colour.
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


def exposure_gain(linear: np.ndarray, labels: np.ndarray) -> float:
    """Estimate the gain, from 1 to ``MAX_GAIN``, that gives surfaces their usual brightness.

    The estimate is the most probable one, given how bright surfaces of each class usually are and
    how far cameras usually err. Colour casts are not removed: a warm light and a cream paint look
    the same, and the photos of cameras that balance white by themselves have no cast to remove.

    Args:
        linear: Linear light of the room's surfaces, float64 [N, 3].
        labels: Their classes, uint8 [N].
    """
    light = linear @ LUMINANCE
    total, weights = 0.0, 1 / EXPOSURE_SIGMA**2
    for class_id, (usual, sigma) in REFLECTANCES.items():
        own = light[labels == class_id]
        if len(own) >= MIN_CELLS:
            total += np.log(usual / max(float(np.median(own)), 1e-3)) / sigma**2
            weights += 1 / sigma**2
    return float(np.clip(np.exp(total / weights), 1.0, MAX_GAIN))


def block_colour(block: str) -> np.ndarray:
    """Return the Oklab colour of a block state, float32 [3]."""
    return srgb_to_oklab(np.array(colour_of(block), np.uint8))


def group_medians(
    groups: np.ndarray, colours: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the median colour of each group, float32 [count, 3], and its size, int [count].

    Args:
        groups: Group index of each colour, int [N].
        colours: Colours, float32 [N, 3].
        count: Number of groups; the median of an empty group is 0.
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
    """Return the colours of the ``wanted`` cells, filled from the nearest cell with a known colour.

    Cells far from every known colour get the median of all known colours.

    Args:
        colours: Colours of all cells, float32 [X, Y, Z, 3].
        known: Bool [X, Y, Z] mask of the cells with a valid colour.
        wanted: Bool [X, Y, Z] mask with N cells set.
        default: Colour to use if no colour is known, float32 [3].

    Returns:
        The colours of the N wanted cells, float32 [N, 3].
    """
    if not known.any():
        return np.broadcast_to(default, (int(wanted.sum()), 3)).astype(np.float32)
    if known[wanted].all():
        return colours[wanted]
    nearest, away = nearest_set_cells(known)
    result = colours[tuple(axis[wanted] for axis in nearest)]
    result[away[wanted] > NEAR_BLOCKS] = np.median(colours[known], axis=0)
    return result
