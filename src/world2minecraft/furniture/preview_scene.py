"""Preview volumes of one piece of furniture: on a floor, against a wall or under a ceiling.

For pictures and checks of a design: what a look at it and a look for unstable blocks need.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import BlockVolume
from world2minecraft.furniture.block_designs import BlockDesign, block_size, lay_template
from world2minecraft.furniture.template import Parameters, Template
from world2minecraft.minecraft.rules.connections import update_connections

ROOM = "minecraft:smooth_stone"


def preview_volume(
    template: Template,
    blocks_per_metre: float,
    size_m: tuple[float, float, float] | None = None,
    parameters: Parameters | None = None,
    *,
    quarter_turns: int = 0,
    room: bool = True,
) -> BlockVolume | None:
    """Return a template's vanilla design as a volume; None where it has none at this scale.

    Args:
        template: what to lay; it looks east (room +x) where it is not turned.
        blocks_per_metre: the scale.
        size_m: depth, width and height; the usual ones where it is None.
        parameters: some of the template's parameters; the others are usual.
        quarter_turns: counter-clockwise from above.
        room: whether the floor, wall or ceiling that holds it is there too, one block thick.

    Raises:
        ParameterError: the template refuses a parameter.
    """
    size = block_size(np.array(size_m or template.typical_m), blocks_per_metre)
    found = lay_template(template, size, parameters, quarter_turns)
    if found is None:
        return None
    return preview_design(found, template, blocks_per_metre, quarter_turns, room)


def preview_design(
    design: BlockDesign, template: Template, blocks_per_metre: float, quarter_turns: int, room: bool
) -> BlockVolume:
    """Return a design as a volume, with what holds it where ``room`` says so."""
    margin = 1 if room else 0
    states = np.zeros(np.array(design.size) + 2 * margin, np.uint16)
    palette = ["minecraft:air"]
    for offset, state, _role in design.blocks:
        if state not in palette:
            palette.append(state)
        states[tuple(np.array(offset) + margin)] = palette.index(state)
    own = states > 0
    if room:
        palette.append(ROOM)
        _put_room(states, len(palette) - 1, template.mount, quarter_turns)
    states, palette = update_connections(states, palette)
    semantic = np.where(own, template.class_id, 0).astype(np.uint8)
    semantic[(states > 0) & ~own] = SemanticClass.FLOOR
    corner_m = np.zeros(3)
    return BlockVolume(
        states,
        palette,
        semantic,
        own.astype(np.uint16),
        (0, 0, 0),
        block_to_room(corner_m, blocks_per_metre),
    )


def _put_room(states: np.ndarray, number: int, mount: str, quarter_turns: int) -> None:
    """Put a floor, and behind what hangs on a wall a wall, over what hangs a ceiling, in place."""
    if mount != "wall":
        states[:, 0 if mount != "ceiling" else -1, :] = number
        return
    back = {0: np.s_[0], 1: np.s_[:, :, -1], 2: np.s_[-1], 3: np.s_[:, :, 0]}[quarter_turns % 4]
    states[back] = number
