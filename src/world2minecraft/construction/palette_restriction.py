"""Restriction of a canvas to the blocks that a palette lists.

Every other block is replaced by the nearest listed block: shapes by the same shape of a listed
block, mostly filled blocks by a full block. Small blocks such as buttons are removed. Light and
barrier blocks are kept, since they are invisible.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.palettes import Palette
from world2minecraft.core.types import AIR, Entity
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of, nearest_oklab
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.entities import BLOCK_DISPLAY
from world2minecraft.minecraft.visual_shapes import visual_boxes

UNSEEN = frozenset(f"minecraft:{name}" for name in ("air", "light", "barrier", "painting"))
# Endings of names that are one shape in many materials.
SHAPES = ("_stairs", "_slab", "_trapdoor", "_fence_gate", "_fence", "_wall", "_carpet", "_bed",
          "_door", "_button", "_pressure_plate", "_wall_sign", "_sign", "_wall_banner", "_banner",
          "_pane", "_candle", "_log", "_wood")  # fmt: skip
# Of a block: what fills more of it becomes a full block, what fills less goes.
MIN_FULL_SHARE = 0.5


def restrict_to_palette(canvas: Canvas, palette: Palette) -> None:
    """Replace, in place, all blocks of a canvas that the palette does not allow."""
    if palette.only is None:
        return
    number = np.array(
        [canvas.id_of(nearest_allowed(state, palette)) for state in canvas.palette], np.uint16
    )
    changed = number[canvas.states]
    gone = (changed == 0) & (canvas.states > 0)
    canvas.states[:] = changed
    canvas.semantic[gone] = canvas.instance[gone] = 0
    canvas.entities[:] = [_restrict_entity(entity, palette) for entity in canvas.entities]


def nearest_allowed(state: str, palette: Palette) -> str:
    """Return the nearest block state that a palette allows, or air if there is none."""
    name = state.partition("[")[0]
    if palette.only is None or name in UNSEEN or name in palette.only:
        return state
    return _replacement(state, palette.only)


@lru_cache(maxsize=4096)
def _replacement(state: str, only: frozenset[str]) -> str:
    name, _, _ = state.partition("[")
    shape = next((ending for ending in SHAPES if name.endswith(ending)), None)
    alike = [one for one in sorted(only) if shape and one.endswith(shape)]
    if shape and alike:
        properties = dict(parse_state(state).properties)
        best = _nearest(state, alike)
        known = dict(complete(parse_state(best)).properties)
        kept = {key: value for key, value in properties.items() if key in known}
        return str(complete(parse_state(best)).having(**kept))
    boxes = np.asarray(visual_boxes(state), np.float64).reshape(-1, 6)
    filled = float(np.prod(boxes[:, 3:] - boxes[:, :3], axis=1).sum())
    whole = [str(complete(parse_state(one))) for one in sorted(only)]
    whole = [one for one in whole if is_full_cube(one)]
    if "glass" in name:
        whole = [one for one in whole if "glass" in one] or whole
    else:
        whole = [one for one in whole if "glass" not in one] or whole
    return _nearest(state, whole) if filled > MIN_FULL_SHARE else AIR


def _nearest(state: str, choices: list[str]) -> str:
    """Return the choice whose colour is nearest to a state's."""
    wanted, offered = srgb_to_oklab(colours_of([state])), srgb_to_oklab(colours_of(choices))
    return choices[int(nearest_oklab(wanted, offered)[0])]


def _restrict_entity(entity: Entity, palette: Palette) -> Entity:
    if entity.id != BLOCK_DISPLAY:
        return entity
    held: Mapping[str, Any] = entity.nbt["block_state"]
    pairs = ",".join(f"{key}={value}" for key, value in held.get("Properties", {}).items())
    state = f"{held['Name']}[{pairs}]" if pairs else str(held["Name"])
    chosen = parse_state(nearest_allowed(state, palette))
    nbt = {"Name": chosen.name}
    if chosen.properties:
        nbt |= {"Properties": dict(chosen.properties)}  # type: ignore[dict-item]
    return replace(entity, nbt={**entity.nbt, "block_state": nbt})
