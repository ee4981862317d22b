"""The paintings of the game: their sizes, what they show, and where their canvas is in the world.

The pictures themselves are the game's and not part of this program, which draws its own of the
same motif.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

PAINTING = "minecraft:painting"
THICK = 1 / 16  # Blocks.
# Sides by their number in a painting's NBT, clockwise seen from above.
SIDES = ("south", "west", "north", "east")


class Variant(NamedTuple):
    """A painting: its size in blocks, what it shows, and which colours it has."""

    width: int
    height: int
    motif: str
    tone: int = 0


VARIANTS: Mapping[str, Variant] = {
    "alban": Variant(1, 1, "figure", 1),
    "aztec": Variant(1, 1, "abstract"),
    "aztec2": Variant(1, 1, "abstract", 1),
    "bomb": Variant(1, 1, "abstract"),
    "kebab": Variant(1, 1, "still_life"),
    "plant": Variant(1, 1, "still_life", 1),
    "wasteland": Variant(1, 1, "landscape"),
    "courbet": Variant(2, 1, "landscape"),
    "creebet": Variant(2, 1, "landscape"),
    "pool": Variant(2, 1, "abstract", 1),
    "sea": Variant(2, 1, "landscape"),
    "sunset": Variant(2, 1, "landscape", 1),
    "graham": Variant(1, 2, "figure"),
    "wanderer": Variant(1, 2, "figure", 1),
    "bust": Variant(2, 2, "figure"),
    "match": Variant(2, 2, "still_life"),
    "skull_and_roses": Variant(2, 2, "still_life", 1),
    "stage": Variant(2, 2, "landscape"),
    "void": Variant(2, 2, "abstract"),
    "wither": Variant(2, 2, "abstract", 1),
    "fighters": Variant(4, 2, "landscape", 1),
    "donkey_kong": Variant(4, 3, "abstract"),
    "skeleton": Variant(4, 3, "abstract", 1),
    "burning_skull": Variant(4, 4, "abstract"),
    "pigscene": Variant(4, 4, "figure", 1),
    "pointer": Variant(4, 4, "landscape"),
}


def painting_cube(
    nbt: Mapping[str, Any], position: tuple[float, float, float]
) -> tuple[str, np.ndarray]:
    """Return the state that stands for a painting in a renderer, and the transform of its cube.

    The state, such as ``minecraft:painting[motif=figure,tone=0]``, is that of a unit cube with the
    picture on its south face. The transform, float64 [4, 4], maps it to world block coordinates.

    Args:
        nbt: NBT of a painting, of which ``variant`` and ``facing`` are read.
        position: The middle of the painting in world block coordinates.

    Raises:
        KeyError: If the variant is unknown or a key is missing.
        TypeError: If a key has a value of another type.
    """
    one = VARIANTS[str(nbt["variant"]).removeprefix("minecraft:")]
    quarters = int(nbt["facing"]) % 4
    x, z = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters]  # Where east goes, clockwise from above.
    turn = np.array([[x, 0, -z], [0, 1, 0], [z, 0, x]], np.float64)
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ np.diag([one.width, one.height, THICK])
    matrix[:3, 3] = np.asarray(position) - matrix[:3, :3] @ np.full(3, 0.5)
    return f"{PAINTING}[motif={one.motif},tone={one.tone}]", matrix
