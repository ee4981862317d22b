"""Styles of houses, which are palettes of matching blocks, and the random look of a room.

The styles are defined in ``data/styles.json``.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

WET = ("bathroom", "kitchen", "laundry")
CALM = 2  # The first walls of a style are calm, so that the furniture stands out.
ACCENT_SHARE = 0.35  # Share of rooms with one accent wall, where the style has one.
NEUTRALS = ("white", "light_gray", "gray", "black", "brown")  # Dyes that go with all others.
COLOURS = (  # Other dyes. None starts with the name of another one before it.
    "light_blue", "blue", "cyan", "green", "lime", "magenta", "orange", "pink", "purple", "red",
    "yellow",
)  # fmt: skip
WOODS = (
    "oak", "spruce", "birch", "jungle", "acacia", "dark_oak", "mangrove", "cherry", "bamboo",
    "crimson", "warped",
)  # fmt: skip


@dataclass(frozen=True)
class Style:
    """A style with lists of blocks to choose from. The first two walls are plain."""

    name: str
    walls: tuple[str, ...]
    wet_walls: tuple[str, ...]
    floors: tuple[tuple[str, ...], ...]
    wet_floors: tuple[tuple[str, ...], ...]
    ceilings: tuple[str, ...]
    woods: tuple[str, ...]
    cloths: tuple[str, ...]
    stones: tuple[str, ...]
    skirtings: tuple[str, ...]
    facades: tuple[str, ...]
    roofs: tuple[str, ...]  # Blocks with a slab, without its ending.
    plinths: tuple[str, ...]
    hours: tuple[int, ...]


@dataclass(frozen=True)
class RoomLook:
    """The materials of one room, as block states and as values of material kinds."""

    wall: str
    accents: tuple[str, str, str, str]  # Wall states by direction into the room, quarter turns.
    floor: tuple[str, ...]
    floor_pattern: str
    ceiling: str
    skirting: str
    skirting_height: int
    cornice: str
    wood: str
    second_wood: str
    cloth: str
    second_cloth: str
    stone: str

    @property
    def stairs(self) -> str:
        """The name of the stairs block."""
        return f"minecraft:{self.wood}_stairs"

    @property
    def frame(self) -> str:
        """The name of the block for frames, slightly different from the planks of the wood."""
        bare = {"crimson": "crimson_hyphae", "warped": "warped_hyphae", "bamboo": "bamboo_block"}
        return f"minecraft:stripped_{bare.get(self.wood, f'{self.wood}_wood')}"

    @property
    def handrail(self) -> str:
        """The name of the slab block on top of railings."""
        return f"minecraft:{self.wood}_slab"


@cache
def styles() -> dict[str, Style]:
    """Load the styles by name, in the order of the file."""
    source = files("world2minecraft.procgen.worlds") / "data" / "styles.json"
    return {name: _style(name, raw) for name, raw in json.loads(source.read_text("utf-8")).items()}


def _style(name: str, raw: dict[str, Any]) -> Style:
    lists: dict[str, Any] = {
        key: tuple(tuple(v) if isinstance(v, list) else v for v in value)
        for key, value in raw.items()
    }
    return Style(name=name, **lists)


def draw_look(style: Style, kind: str, wood: str, rng: np.random.Generator) -> RoomLook:
    """Choose a random look for a kind of room in a house of one wood.

    A room has one calm wall, the wood of the house, and one accent colour: of its cloths, and of
    one wall where the style has a wall of that colour.
    """

    def one(choices: Sequence[Any]) -> Any:
        return choices[int(rng.integers(len(choices)))]

    def calm(choices: Sequence[str]) -> list[str]:
        """Return the choices without colour, or of the wood."""
        return [
            name
            for name in choices
            if wood in name or not (_is_wood(name) or colour_of(name) or "glazed" in name)
        ]

    wet, cloth = kind in WET, one(style.cloths)
    floors = (style.wet_floors, style.floors) if wet else (style.floors,)
    calm_floors = ([floor for floor in own if calm(floor) == [*floor]] for own in floors)
    own_floors = next((found for found in calm_floors if found), floors[0])
    plain = [name for name in style.walls[:CALM] if not _is_wood(name)]
    tiles = [name for name in calm(style.wet_walls) if wood not in name]
    wall = one(tiles if wet and tiles and rng.random() < 0.6 else plain)
    accents = [_block(wall)] * 4
    bold = [name for name in (*style.walls, *style.wet_walls) if colour_of(name) == cloth]
    bold += [name for name in style.walls if wood in name and not wet]
    if bold and rng.random() < ACCENT_SHARE:
        accents[int(rng.integers(4))] = _block(one(bold))
    skirtings = calm(style.skirtings)
    skirting = one(skirtings) if skirtings and rng.random() < 0.6 else wall
    neutral = [name for name in NEUTRALS if name in style.cloths] or [*NEUTRALS[:3]]
    others = [name for name in style.woods if name != wood]
    return RoomLook(
        wall=_block(wall),
        accents=(accents[0], accents[1], accents[2], accents[3]),
        floor=tuple(_block(name) for name in one(own_floors)),
        floor_pattern=("rows", "checked")[int(wet)],
        ceiling=_block(one(calm(style.ceilings) or style.ceilings)),
        skirting=_block(skirting),
        skirting_height=1,
        cornice=_block(skirting) if rng.random() < 0.3 else "",
        wood=wood,
        second_wood=others[0],
        cloth=cloth,
        second_cloth=one(neutral),
        stone=one(style.stones),
    )


def colour_of(name: str) -> str:
    """Return the colour that the name of a block starts with, or an empty string.

    White, greys, black and brown count as none.

    Example:
        >>> colour_of("light_blue_wool"), colour_of("light_gray_concrete"), colour_of("bricks")
        ('light_blue', '', '')
    """
    found = [colour for colour in COLOURS if name.startswith(f"{colour}_")]
    return found[0] if found else ""


def _is_wood(name: str) -> bool:
    return any(f"{wood}_" in f"{name}_" for wood in WOODS)


def _block(name: str) -> str:
    return f"minecraft:{name}"
