"""Preview volumes of one piece of furniture: on a floor, against a wall or under a ceiling.

They are used for images and for checks of a design, such as the search for unstable blocks.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import BlockVolume
from world2minecraft.furniture.block_designs import BlockDesign, block_size, lay_template
from world2minecraft.furniture.template import Template
from world2minecraft.minecraft.painting_placement import hang_paintings
from world2minecraft.minecraft.rules.connections import update_connections

ROOM = "minecraft:smooth_stone"


def preview_volume(
    template: Template,
    blocks_per_metre: float,
    size_m: tuple[float, float, float] | None = None,
    *,
    quarter_turns: int = 0,
    room: bool = True,
) -> BlockVolume | None:
    """Return a template's vanilla block design as a volume, or None without one at this scale.

    Args:
        template: The template. It faces east (room +x) if it is not rotated.
        blocks_per_metre: Scale in blocks per metre.
        size_m: Depth, width and height in metres. None uses the typical size.
        quarter_turns: Rotation in quarter turns, counter-clockwise from above.
        room: Whether to add the floor, wall or ceiling that supports the piece, one block thick.
    """
    size = block_size(np.array(size_m or template.typical_m), blocks_per_metre)
    found = lay_template(template, size, None, quarter_turns)
    if found is None:
        return None
    return preview_design(found, template, blocks_per_metre, quarter_turns, room)


def preview_design(
    design: BlockDesign, template: Template, blocks_per_metre: float, quarter_turns: int, room: bool
) -> BlockVolume:
    """Return a block design as a volume, with its supporting structure if ``room`` is True."""
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
    volume = BlockVolume(
        states,
        palette,
        semantic,
        own.astype(np.uint16),
        (0, 0, 0),
        block_to_room(corner_m, blocks_per_metre),
    )
    return hang_paintings(volume)


def _put_room(states: np.ndarray, number: int, mount: str, quarter_turns: int) -> None:
    """Add a floor, and a wall or ceiling that supports wall or ceiling furniture."""
    if mount != "wall":
        states[:, 0 if mount != "ceiling" else -1, :] = number
        return
    inner = np.s_[1:-1]
    back = {
        0: np.s_[0, inner, inner],
        1: np.s_[inner, inner, -1],
        2: np.s_[-1, inner, inner],
        3: np.s_[inner, inner, 0],
    }[quarter_turns % 4]
    states[back] = number
