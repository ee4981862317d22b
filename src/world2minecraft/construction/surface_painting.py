"""Painting: choose the blocks of each surface of the shell and of each object.

A surface uses the block closest by CIEDE2000 among those its class allows. To avoid noise, a few
blocks are first chosen for the whole surface, and then each block weighs its own colour against its
neighbours. A plain wall becomes uniform, while the edge between a red front and a dark counter
stays.

A chair is small and often in the shadow of a table, so its median colour is that of shadow. The
lighter half of its cells shows its material and, for a frame with cushions, the saturated part
does. Chairs of similar colours form a set and share one paint.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.cell_colours import block_colour, fill_colours, group_medians
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.core.classes import STRUCTURE_CLASSES, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import ciede2000, oklab_to_lab, srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of

MIN_PART = 0.02  # Share of a surface that is a part; a guess: less is noise.
MIN_BLOCKS = 3.0
ROUNDS = 4
SPECK_BLOCKS = 3  # Fewer connected blocks of a paint are noise.
OKLAB_OF_CIEDE = 0.01  # Oklab distance that looks like a CIEDE2000 difference of 1.
# On walls and floors, too much chroma looks worse than too little: a dark floor came out purple.
MORE_CHROMA = 0.02
DULL_CHROMA, STRONG_CHROMA = 0.035, 0.055  # From where on a grey for a colour is a fault.
FADED = 0.05  # How great a fault, of an object; on walls and floors a calm grey is none.
SAME_PAINT = 0.06  # Oklab distance of two medians of one paint: about the noise of fused colours.
MAX_DISTANCES = 1 << 20  # Blocks times candidates compared at once: some 150 MB.
SAME_SET = 0.08  # Oklab, lightness as light as in the choice of blocks: brown and grey are 0.1.
LIGHTER_SHARE = 0.5
# Above sensor noise, and the share of a chair that its frame has beside grey cushions.
MIN_HUE_CHROMA, MIN_HUE_SHARE = 0.03, 0.3
NEW_PAINT = 0.05  # What a block must be nearer by to come in beside those that the room has.
DISTINGUISHABLE = 0.06  # Oklab distance of two blocks that one tells apart at a glance; a guess.


def colour_costs(
    colours: np.ndarray,
    candidates: Sequence[str],
    lightness_weight: float,
    handicaps: np.ndarray,
    fading: float = 0.0,
) -> np.ndarray:
    """Compute the squared distances, float32 [N, M], between Oklab colours [N, 3] and M blocks.

    The distance is the CIEDE2000 difference, in units of Oklab.

    Args:
        colours: Oklab colours, float32 [N, 3].
        candidates: M block states.
        lightness_weight: Weight of lightness compared to hue and chroma.
        handicaps: Distances added for each block, float [M].
        fading: Distance added for blocks that would turn a saturated colour grey.
    """
    offered = srgb_to_oklab(colours_of(candidates))
    differences = ciede2000(
        oklab_to_lab(colours)[:, None], oklab_to_lab(offered), lightness_weight
    ).astype(np.float32)
    own, chroma = (np.hypot(one[:, 1], one[:, 2]) for one in (colours, offered))
    faded = fading * np.clip((own - DULL_CHROMA) / (STRONG_CHROMA - DULL_CHROMA), 0, 1)
    faded = faded[:, None] * (chroma < own[:, None] / 2)
    gaudy = np.maximum(chroma - own[:, None] - MORE_CHROMA, 0) * (fading == 0)
    return (OKLAB_OF_CIEDE * differences + handicaps.astype(np.float32) + faded + gaudy) ** 2


def choose_blocks(costs: np.ndarray, most: int, noticed: float) -> np.ndarray:
    """Choose at most ``most`` columns of ``costs`` [N, M] that together serve all rows best.

    The choice is greedy: each further column must save more than it costs, measured by the number
    of blocks of a part at the Oklab distance ``noticed``.
    """
    price = noticed**2 * max(MIN_BLOCKS, MIN_PART * len(costs))
    chosen = [int(costs.sum(0).argmin())]
    served = costs[:, chosen[0]].copy()
    while len(chosen) < most:
        gains = np.maximum(served[:, None] - costs, 0).sum(0)
        best = int(gains.argmax())
        if gains[best] <= price:
            break
        chosen.append(best)
        np.minimum(served, costs[:, best], out=served)
    return np.array(sorted(chosen))


def neighbour_table(positions: np.ndarray) -> np.ndarray:
    """Return the six face neighbours, int64 [N, 6], of blocks int [N, 3]; N means no neighbour."""
    low = positions.min(0) - 1
    shape = positions.max(0) - low + 2
    flat = np.asarray(np.ravel_multi_index(tuple((positions - low).T), tuple(shape)))
    order = np.argsort(flat, kind="stable")
    strides = np.array([shape[1] * shape[2], shape[2], 1])
    steps = np.concatenate([strides, -strides])
    wanted = flat[:, None] + steps
    ordered = flat[order]
    found = np.minimum(np.searchsorted(ordered, wanted), len(positions) - 1)
    return np.where(ordered[found] == wanted, order[found], len(positions))


def smooth_blocks(costs: np.ndarray, positions: np.ndarray, step: float) -> np.ndarray:
    """Choose a column of ``costs`` [N, M] for each block, preferring agreement with neighbours.

    Blocks of even and odd positions are updated alternately.
    """
    chosen = costs.argmin(1)
    if costs.shape[1] == 1 or step == 0 or len(costs) == 1:
        return chosen
    neighbours = neighbour_table(positions)
    odd = positions.sum(1) % 2
    for turn in range(ROUNDS):
        mine = np.flatnonzero(odd == turn % 2)
        around = np.append(chosen, -1)[neighbours[mine]]
        energy = costs[mine].copy()
        for column in range(costs.shape[1]):
            differing = ((around != column) & (around >= 0)).sum(1)
            energy[:, column] += step**2 * differing
        chosen[mine] = energy.argmin(1)
    return _without_specks(chosen, neighbours)


def _without_specks(chosen: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """Return choices, int [N], in which specks take the commonest choice around them."""
    count = len(chosen)
    around = np.append(chosen, -1)[neighbours]
    rows, sides = np.nonzero(around == chosen[:, None])
    links = coo_array((np.ones(len(rows), bool), (rows, neighbours[rows, sides])), (count, count))
    parts = connected_components(links, directed=False)[1]
    speck = np.bincount(parts)[parts] < SPECK_BLOCKS
    result = chosen.copy()
    for row in np.flatnonzero(speck):
        others = neighbours[row][neighbours[row] < count]
        calm = others[~speck[others]]
        if len(calm):
            result[row] = np.bincount(chosen[calm]).argmax()
    return result


def paint(
    colours: np.ndarray,
    positions: np.ndarray,
    candidates: Sequence[str],
    *,
    most: int,
    lightness_weight: float,
    calm_step: float,
    noticed: float,
    match_weight: float | None = None,
    handicaps: np.ndarray | None = None,
    fading: float = 0.0,
) -> np.ndarray:
    """Choose the block of each position of a surface.

    Args:
        colours: Oklab colours of the N positions, float32 [N, 3].
        positions: Distinct positions, int [N, 3].
        candidates: M block states.
        most: Maximum number of different blocks.
        lightness_weight: Weight of lightness compared to hue and chroma.
        calm_step: Oklab distance accepted for each neighbour that agrees.
        noticed: Minimum Oklab distance at which a part gets its own block.
        match_weight: Lightness weight of the final match of each part's median; None uses
            ``lightness_weight``. A low ``lightness_weight`` finds the parts of an unevenly lit
            floor, a higher ``match_weight`` finds the block of the right lightness.
        handicaps: Oklab distance added for each candidate, float [M]; None adds no distance.
        fading: Oklab distance added for greys that represent a saturated colour.

    Returns:
        The indices into ``candidates``, intp [N].
    """
    if not len(colours):
        return np.zeros(0, np.intp)
    stride = -(-len(colours) * len(candidates) // MAX_DISTANCES)
    extra = np.zeros(len(candidates)) if handicaps is None else handicaps
    sample = colour_costs(colours[::stride], candidates, lightness_weight, extra, fading)
    few = choose_blocks(sample, most, noticed)
    offered = [str(candidates[index]) for index in few]
    costs = colour_costs(colours, offered, lightness_weight, extra[few], fading)
    parts = smooth_blocks(costs, positions, calm_step)
    weight = lightness_weight if match_weight is None else match_weight
    parts = _merge_similar(parts, colours, len(few), lightness_weight, SAME_PAINT)
    matched = _nearest_candidates(parts, colours, candidates, weight, extra, fading)
    shown = srgb_to_oklab(colours_of([str(candidates[index]) for index in matched]))
    parts = _merge_similar(parts, shown[parts], len(few), lightness_weight, noticed)
    return _nearest_candidates(parts, colours, candidates, weight, extra, fading)[parts]


def _nearest_candidates(
    parts: np.ndarray,
    colours: np.ndarray,
    candidates: Sequence[str],
    weight: float,
    handicaps: np.ndarray,
    fading: float,
) -> np.ndarray:
    """Return the candidate closest to the median of each part, intp [parts]."""
    medians, _ = group_medians(parts, colours, int(parts.max()) + 1)
    return colour_costs(medians, candidates, weight, handicaps, fading).argmin(1)


def _merge_similar(
    parts: np.ndarray, colours: np.ndarray, count: int, lightness_weight: float, noticed: float
) -> np.ndarray:
    """Return parts, int [N], in which smaller parts are merged with similar larger parts."""
    medians, sizes = group_medians(parts, colours, count)
    medians[:, 0] *= np.sqrt(lightness_weight)
    result = np.arange(count)
    kept: list[int] = []
    for part in np.argsort(-sizes, kind="stable").tolist():
        alike = [k for k in kept if np.linalg.norm(medians[part] - medians[k]) < noticed]
        if alike:
            result[part] = alike[0]
        else:
            kept.append(part)
    return result[parts]


def chair_paints(
    grid: OccupancyGrid, colours: np.ndarray, usable: np.ndarray, lightness_weight: float
) -> dict[int, np.ndarray]:
    """Return the Oklab colour, float32 [3], of each chair by instance number.

    Args:
        grid: Grid of the room.
        colours: Oklab colours, float32 [X, Y, Z, 3].
        usable: Bool [X, Y, Z] mask of the cells whose colour was seen from outside.
        lightness_weight: Weight of lightness compared to hue and chroma.
    """
    chairs = np.equal(grid.labels, SemanticClass.CHAIR) & usable & (grid.instance > 0)
    weight = np.array([lightness_weight, 1, 1], np.float32)
    own = {
        int(number): lit_colour(colours[chairs & (grid.instance == number)], LIGHTER_SHARE)
        for number in np.unique(grid.instance[chairs])
    }
    sets: list[list[int]] = []
    for number, colour in own.items():
        near = (s for s in sets if _distance(colour, own[s[0]], weight) <= SAME_SET)
        found = next(near, None)
        if found is None:
            sets.append([number])
        else:
            found.append(number)
    shared = {}
    for group in sets:
        paint = np.median([own[number] for number in group], axis=0).astype(np.float32)
        shared |= dict.fromkeys(group, paint)
    return shared


def lit_colour(colours: np.ndarray, share: float = 1.0) -> np.ndarray:
    """Return the median, float32 [3], of the lighter ``share`` of Oklab colours [N, 3].

    If a sufficient share of the colours is saturated, only these count.
    """
    clear = np.hypot(colours[:, 1], colours[:, 2]) >= MIN_HUE_CHROMA
    counted = colours[clear] if clear.mean() >= MIN_HUE_SHARE else colours
    order = np.argsort(counted[:, 0], kind="stable")
    lighter = counted[order[int(len(order) * (1 - share)) :]]
    return np.median(lighter, axis=0).astype(np.float32)


def _distance(one: np.ndarray, other: np.ndarray, weight: np.ndarray) -> float:
    return float(np.linalg.norm((one - other) * weight))


def block_colours(
    shape: tuple[int, ...], blocks: np.ndarray, colours: np.ndarray, usable: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the median colour of each block, float32 [X, Y, Z, 3], and the mask of valid colours.

    Args:
        shape: Shape of the lattice.
        blocks: Block of each colour, int [N, 3]; blocks outside the lattice are ignored.
        colours: Oklab colours, float32 [N, 3].
        usable: Bool [N] mask of valid colours.
    """
    inside = usable & ((blocks >= 0) & (blocks < np.array(shape))).all(1)
    flat = np.ravel_multi_index(tuple(blocks[inside].T), shape)
    used, groups = np.unique(flat, return_inverse=True)
    medians, _ = group_medians(groups, colours[inside], len(used))
    result = np.zeros((int(np.prod(shape)), 3), np.float32)
    known = np.zeros(len(result), bool)
    result[used], known[used] = medians, True
    return result.reshape((*shape, 3)), known.reshape(shape)


class BlockChoice(NamedTuple):
    """The blocks that a surface of a class may use."""

    class_id: int  # Whose blocks of the palette may be used.
    palette: Palette
    parameters: BuildParameters  # How colours are weighed.
    max_blocks: int  # At most so many different blocks.


def paint_surface(
    mask: np.ndarray,
    colours: np.ndarray,
    known: np.ndarray,
    choice: BlockChoice,
    *,
    beside: frozenset[str] = frozenset(),
    used: frozenset[str] = frozenset(),
    only: tuple[str, ...] = (),
) -> np.ndarray:
    """Return the block states, object [N], of the N blocks of one surface.

    Args:
        mask: Bool [X, Y, Z] mask of the surface.
        colours: Oklab colours, float32 [X, Y, Z, 3].
        known: Bool [X, Y, Z] mask of valid colours.
        choice: Blocks that may be used.
        beside: Blocks the surface must differ from; similar blocks are not used.
        used: Blocks already used in the room; they win over others of similar colour.
        only: Blocks of the class that may be used; an empty tuple allows all.
    """
    class_id, palette, parameters, max_blocks = choice
    default = palette.defaults[class_id]
    if not (known & mask).any():
        return np.full(int(mask.sum()), default, object)
    choices = _distinct_choices(only or palette.blocks[class_id], beside)
    preferred = palette.preferred[class_id] or choices
    handicaps = np.array([parameters.preference * (block not in preferred) for block in choices])
    if used:
        handicaps += [NEW_PAINT * (block not in used) for block in choices]
    shell, weight = class_id in STRUCTURE_CLASSES, parameters.lightness_weight
    index = paint(
        fill_colours(colours, known & mask, mask, block_colour(default)),
        np.argwhere(mask),
        choices,
        most=max_blocks,
        lightness_weight=parameters.structure_lightness_weight if shell else weight,
        noticed=parameters.structure_noticed if shell else parameters.object_noticed,
        match_weight=weight,
        calm_step=parameters.calm,
        handicaps=handicaps,
        fading=0.0 if shell else FADED,
    )
    return np.array(choices, object)[index]


def _distinct_choices(choices: tuple[str, ...], beside: frozenset[str]) -> tuple[str, ...]:
    """Return the choices that look different from some blocks, or all if there are none."""
    if not beside:
        return choices
    offered = srgb_to_oklab(colours_of(choices))
    others = srgb_to_oklab(colours_of(sorted(beside)))
    is_distinct = np.linalg.norm(offered[:, None] - others, axis=-1).min(1) >= DISTINGUISHABLE
    return tuple(np.array(choices)[is_distinct].tolist()) or choices


def place_painted(canvas: Canvas, mask: np.ndarray, states: np.ndarray, class_id: int) -> None:
    """Set the blocks of a mask to the states returned by ``paint_surface``."""
    names, index = np.unique(states.astype(str), return_inverse=True)
    canvas.put(mask, canvas.ids_of(names.tolist())[index], class_id)
