"""The exposure of a scene, chosen so that rooms are neither too dark nor overexposed.

There is one value per scene, or for all camera positions of a tour, so that images match. It is the
geometric mean of the light at surfaces, like a camera's meter reading if all surfaces were grey.
"""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.rules.light import (
    BRIGHTEST,
    SHUT,
    SOLID,
    light_units,
    neighbour_steps,
)
from world2minecraft.rendering.light.light_field import LightField
from world2minecraft.rendering.light.light_settings import LightSettings

# The light that surfaces shall have by day, at night under lamps, at night without: a night stays
# a night.
DAY_KEY, LAMP_KEY, NIGHT_KEY = 1.20, 0.50, 0.16
ADAPTATION = 0.80  # Degree of adaptation: dim rooms remain slightly dimmer than bright ones.
MIN_EXPOSURE, MAX_EXPOSURE = 0.6, 4.0
REACH_BLOCKS = 24  # Steps from an eye: at 4 blocks per metre, a room.
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def scene_exposure(field: LightField, look: LightSettings, eyes: np.ndarray | None = None) -> float:
    """Return the exposure of a scene for ``LightSettings.parameters`` and ``background``.

    Args:
        field: Light of the volume.
        look: Light settings. Their exposure is returned if it is set. Presets other than ``shader``
            have exposure 1.
        eyes: Camera positions in cells of the volume, float [N, 3]. Only their surroundings are
            used, or the open air for a volume seen from outside. None uses all places where a
            player can stand.
    """
    if look.exposure is not None:
        return look.exposure
    if look.preset != "shader":
        return 1.0
    cells = standing_cells(field)
    if eyes is not None:
        near = _cells_near_eyes(field, np.atleast_2d(np.asarray(eyes, np.float64)))
        cells = near if len(near) else _outdoors(field, cells)
    if not len(cells):
        return 1.0
    sky, lamps = _surface_light(field, look, cells)
    light = np.exp(np.log(sky + lamps).mean())
    daylight = min(float(LUMINANCE @ look.sky.light), 1.0)
    at_night = NIGHT_KEY + (LAMP_KEY - NIGHT_KEY) * (lamps.sum() / (sky + lamps).sum()) ** 2
    key = at_night + (DAY_KEY - at_night) * daylight
    return float(np.clip((key / light) ** ADAPTATION, MIN_EXPOSURE, MAX_EXPOSURE))


def _surface_light(field: LightField, look: LightSettings, cells: np.ndarray) -> np.ndarray:
    """Return the luminance of the sky's and of the lamps' light in cells, float64 [2, N]."""
    lit = look.parameters(1.0)
    ambient, sky, block = (
        float(LUMINANCE @ colour)
        for colour in (
            (lit.ambient_r, lit.ambient_g, lit.ambient_b),
            (lit.sky_r, lit.sky_g, lit.sky_b),
            (lit.block_r, lit.block_g, lit.block_b),
        )
    )
    full = 15 * field.reach
    levels = (field.sky.reshape(-1)[cells] / full, field.block.reshape(-1)[cells] / full)
    curves = zip(levels, (lit.curve, lit.block_curve), strict=True)
    shines = [level / (1 + curve * (1 - level)) for level, curve in curves]
    sky_light = ambient + sky * shines[0]
    if look.sun_shadow:  # In the open the sun shines on about as much as it does not.
        sky_light += (levels[0] == 1) * (float(LUMINANCE @ look.sky.light) - sky)
    return np.array([sky_light, block * shines[1]])


def standing_cells(field: LightField) -> np.ndarray:
    """Return the flat indices of free cells above a surface, int64 [N], including the margin."""
    words = field.words[field.kinds]
    free = words & (SHUT | SOLID) == 0
    below = np.zeros_like(free)
    below[:, 1:] = words[:, :-1] & (0b1111 << 12 | SOLID) != 0
    below[:, 1] = False  # The margin holds nobody.
    return np.flatnonzero(free & below)


def _outdoors(field: LightField, cells: np.ndarray) -> np.ndarray:
    """Return those of some flat cells that have the whole light of the sky, or all, if none has."""
    sky = field.sky.reshape(-1)[cells]
    open_air = cells[sky >= light_units(BRIGHTEST, field.reach)]
    return open_air if len(open_air) else cells


def _cells_near_eyes(field: LightField, eyes: np.ndarray) -> np.ndarray:
    """Return the flat free cells near surfaces that light reaches from the eyes in few steps."""
    shape = np.array(field.kinds.shape)
    cells = np.floor(eyes).astype(np.int64) + 1
    inside = ((cells >= 1) & (cells < shape - 1)).all(axis=1)
    if not inside.any():
        return np.empty(0, np.int64)
    starts = np.unique(np.ravel_multi_index(tuple(cells[inside].T), field.kinds.shape))
    kinds, steps = field.kinds.reshape(-1), neighbour_steps(field.kinds.shape)
    return _reachable_near_surfaces(kinds, field.words, steps, starts, REACH_BLOCKS)


@njit
def _reachable_near_surfaces(kinds, words, steps, starts, most):
    """Return the free cells up to ``most`` steps from the starts that touch a solid one."""
    seen = np.zeros(len(kinds), np.bool_)
    queue, count = np.empty(1024, np.int64), 0
    found, kept = np.empty(1024, np.int64), 0
    for start in starts:
        if words[kinds[start]] & SOLID == 0:
            seen[start] = True
            if count == len(queue):
                queue = np.concatenate((queue, np.empty(count, np.int64)))
            queue[count] = start
            count += 1
    first = 0
    for _ in range(most):
        last = count
        for n in range(first, last):
            cell, touches = queue[n], False
            for side in range(6):
                near = cell + steps[side]
                touches |= words[kinds[near]] & SOLID != 0
                if seen[near] or words[kinds[near]] & SHUT == SHUT:
                    continue
                seen[near] = True
                if count == len(queue):
                    queue = np.concatenate((queue, np.empty(count, np.int64)))
                queue[count] = near
                count += 1
            if touches:
                if kept == len(found):
                    found = np.concatenate((found, np.empty(kept, np.int64)))
                found[kept] = cell
                kept += 1
        first = last
    return found[:kept]
