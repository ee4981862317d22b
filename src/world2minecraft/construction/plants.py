"""Leaves for plants that are built from their own cells."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import ObjectInstance
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of, nearest_oklab
from world2minecraft.minecraft.block_states import complete, parse_state

PLANT_NAMES = ("plant", "indoor tree", "flowers", "planter", "christmas tree")
GREEN_HUE, HUE_REACH, GREEN_CHROMA = 125.0, 30.0, 0.03
MIN_GREEN, SURE_GREEN = 0.25, 0.6  # Shares of cells, of a named plant and of an unnamed thing.
MAX_FILL, MIN_CELLS = 0.4, 30  # An object that fills more of its box is not foliage.
LEAVES = tuple(
    str(complete(parse_state(f"minecraft:{kind}_leaves[persistent=true]")))
    for kind in ("oak", "spruce", "jungle", "dark_oak", "azalea")
)
POT = "minecraft:terracotta"


def is_green(oklab: np.ndarray) -> np.ndarray:
    """Return which Oklab colours, float [N, 3], are those of leaves, as bool [N]."""
    hue = np.degrees(np.arctan2(oklab[:, 2], oklab[:, 1]))
    off = np.abs((hue - GREEN_HUE + 180) % 360 - 180)
    return (np.hypot(oklab[:, 1], oklab[:, 2]) >= GREEN_CHROMA) & (off <= HUE_REACH)


def is_plant(instance: ObjectInstance, oklab: np.ndarray) -> bool:
    """Return whether an object whose cells have some Oklab colours, float [N, 3], is a plant.

    Without a name, it must be mostly green and as loose as foliage.
    """
    if instance.class_id != SemanticClass.OBJS or not len(oklab):
        return False
    share = float(is_green(oklab).mean())
    if instance.name in PLANT_NAMES:
        return share >= MIN_GREEN
    box = np.prod(np.ptp(instance.cells, axis=0) + 1)
    loose = len(instance.cells) <= MAX_FILL * box and len(instance.cells) >= MIN_CELLS
    return instance.name in ("", "object") and loose and share >= SURE_GREEN


def leafy_states(states: np.ndarray, layers: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """Return the block states, object [N], of a plant: leaves over a pot.

    Args:
        states: Block states of the N painted blocks, object [N].
        layers: Their layers, int [N].
        colours: Their Oklab colours, float32 [N, 3].
    """
    green = is_green(colours)
    foot = (layers == layers.min()) & (layers.min() < layers.max())
    result = states.copy()
    result[foot & green] = POT
    leaf = green & ~foot
    if leaf.any():
        typical = np.median(colours[leaf], axis=0)[None]
        best = int(nearest_oklab(typical, srgb_to_oklab(colours_of(LEAVES)))[0])
        result[leaf] = LEAVES[best]
    return result
