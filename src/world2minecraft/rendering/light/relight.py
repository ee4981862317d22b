"""Incremental update of light after an edit: only the affected region is computed again.

The light of the changed cells, and all light that may have passed through them, is removed. The
remaining light around the region then spreads back in. The result equals a complete new flood fill.
"""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.rules.light import (
    BRIGHTEST,
    enters,
    falls_into,
    flood_light,
    light_tables,
    light_units,
    neighbour_steps,
)
from world2minecraft.rendering.light.light_field import (
    MAX_STATES,
    LightField,
    fill_lattice,
    quarter_level_table,
)


def edit_light(
    field: LightField,
    corner: tuple[int, int, int],
    states: np.ndarray,
    palette: tuple[str, ...] | None = None,
) -> None:
    """Update the light of a volume in place after a box of its cells was set.

    Args:
        field: Light before the edit.
        corner: First cell of the box.
        states: New states of the cells in the box, uint16 [A, B, C].
        palette: New palette if the edit extended it, else None.

    Raises:
        ValueError: If the box is not within the volume, or if the palette is too long or shorter
            than before.
    """
    low = np.array(corner, np.int64) + 1
    high = low + states.shape
    if (low < 1).any() or (high > np.array(field.kinds.shape) - 1).any():
        raise ValueError(
            f"the box at {tuple(corner)} with size {states.shape} is not within the volume"
        )
    if palette is not None:
        _add_states(field, palette)
    if not states.size:
        return
    box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    field.kinds[box] = states.astype(np.uint16) + np.uint16(1)
    unit = np.array([light_units(level, field.reach) for level in range(BRIGHTEST + 1)], np.uint8)
    top = light_units(BRIGHTEST, field.reach)
    first, last = low.copy(), high.copy()
    dark = np.zeros_like(field.gives)
    for light, gives, full in ((field.sky, dark, top), (field.block, unit[field.gives], 0)):
        reached = _affected_box(light.shape, low, high, top, full > 0)
        before = light[reached].copy()
        _relight(light, field.kinds, field.words, gives, low, high, full)
        _extend_box(first, last, reached, before != light[reached])
    table = quarter_level_table(field.reach)
    fill_lattice(
        field.lattice, field.sky, field.block, field.kinds, field.words, table, first, last
    )


def _affected_box(shape, low, high, top: int, to_ground: bool) -> tuple[slice, ...]:
    """Return the box that a change between ``low`` and ``high`` may light or darken."""
    first, last = np.maximum(low - top, 0), np.minimum(high + top, shape)
    if to_ground:  # Full light of the sky goes straight down.
        first[1] = 0
    return tuple(slice(int(a), int(b)) for a, b in zip(first, last, strict=True))


def _extend_box(first, last, reached: tuple[slice, ...], changed: np.ndarray) -> None:
    """Let ``first`` and ``last`` hold all cells that changed."""
    for axis in range(3):
        others = tuple(n for n in range(3) if n != axis)
        found = np.flatnonzero(changed.any(axis=others)) + reached[axis].start
        if len(found):
            first[axis] = min(first[axis], found[0])
            last[axis] = max(last[axis], found[-1] + 1)


def _add_states(field: LightField, palette: tuple[str, ...]) -> None:
    """Add the rows of states that are new."""
    known = len(field.words) - 1
    if not known <= len(palette) <= MAX_STATES:
        raise ValueError(f"the new palette must have {known} to {MAX_STATES:,} states")
    words, gives = light_tables(palette[known:], field.hidden_lamps)
    field.words = np.concatenate([field.words, words[1:]])
    field.gives = np.concatenate([field.gives, gives[1:]])


def _relight(light, kinds, words, gives, low, high, top: int) -> None:
    """Renew one kind of light; ``top`` is the sky's full light, 0 for the light of blocks."""
    flat, steps = light.reshape(-1), neighbour_steps(light.shape)
    ranges = [np.arange(a, b) for a, b in zip(low, high, strict=True)]
    cells = np.ravel_multi_index(np.meshgrid(*ranges, indexing="ij"), light.shape).reshape(-1)
    rows = kinds.reshape(-1)
    dark, edge = _darken(flat, rows, steps, cells, top)
    seeds = _find_seeds(flat, rows, words, gives, steps, dark, edge, top)
    flood_light(flat, rows, words, steps, seeds)


@njit
def _darken(light, kinds, steps, cells, top):
    """Darken cells and all that they may have lit; return those, and the lit cells beside them."""
    dark, levels, edge = cells.copy(), light[cells], np.empty(64, np.int64)
    count, edges, done = len(cells), 0, 0
    light[cells] = 0
    while done < count:
        cell, level = dark[done], levels[done]
        done += 1
        for side in range(6):
            near = cell + steps[side]
            if light[near] == 0 or kinds[near] == 0:
                continue
            fell = side == 2 and level == top and light[near] == top
            if light[near] < level or fell:
                if count == len(dark):
                    dark = np.concatenate((dark, np.empty(count, np.int64)))
                    levels = np.concatenate((levels, np.empty(count, np.uint8)))
                dark[count], levels[count] = near, light[near]
                count += 1
                light[near] = 0
            else:
                if edges == len(edge):
                    edge = np.concatenate((edge, np.empty(edges, np.int64)))
                edge[edges] = near
                edges += 1
    return dark[:count], edge[:edges]


@njit
def _find_seeds(light, kinds, words, gives, steps, dark, edge, top):
    """Light again what shines by itself or under the sky; return all cells to spread from."""
    seeds, count = np.empty(len(dark) + len(edge) + 64, np.int64), 0
    for cell in edge:
        if light[cell] > 0:
            seeds[count] = cell
            count += 1
    for cell in dark:
        level = gives[kinds[cell]]
        for side in range(6):
            beside_air = top > 0 and side != 2 and kinds[cell + steps[side]] == 0
            if beside_air and enters(words, kinds[cell], side):
                level = max(level, np.uint8(top - 1))
        if level > light[cell]:
            light[cell] = level
        if light[cell] > 0:
            seeds[count] = cell
            count += 1
    for start in dark if top > 0 else dark[:0]:
        cell, above = start, start + steps[3]
        while kinds[cell] != 0 and light[cell] < top and light[above] == top:
            if not falls_into(words, kinds[above], kinds[cell]):
                break
            light[cell] = top
            if count == len(seeds):
                seeds = np.concatenate((seeds, np.empty(count, np.int64)))
            seeds[count] = cell
            count += 1
            cell, above = cell + steps[2], cell
    return seeds[:count]
