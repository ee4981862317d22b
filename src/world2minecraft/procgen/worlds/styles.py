"""Styles of houses, which are palettes of matching blocks, and the random look of a room.

The styles are defined in ``data/styles.json``.
"""

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

WET = ("bathroom", "kitchen", "laundry")
CALM, CALM_SHARE = 2, 0.7  # Most rooms have calm walls, so that furniture is what one sees.
ACCENT_SHARE = 0.45  # Share of rooms with one accent wall.


@dataclass(frozen=True)
class Style:
    """A style with lists of blocks to choose from. The first two walls are plain."""

    name: str
    walls: tuple[str, ...]
    wet_walls: tuple[str, ...]
    floors: tuple[tuple[str, ...], ...]
    wet_floors: tuple[tuple[str, ...], ...]
    ceilings: tuple[str, ...]
    glass: tuple[str, ...]
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
    glass: str
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


def draw_look(style: Style, kind: str, rng: np.random.Generator) -> RoomLook:
    """Choose a random look for a kind of room."""

    def one(choices: tuple[Any, ...]) -> Any:
        return choices[int(rng.integers(len(choices)))]

    wet = kind in WET
    floor = one(style.wet_floors if wet else style.floors)
    calm = style.walls[:CALM] if rng.random() < CALM_SHARE else style.walls
    wall = one(style.wet_walls if wet and rng.random() < 0.6 else calm)
    accents = [_block(wall)] * 4
    if rng.random() < ACCENT_SHARE:
        accents[int(rng.integers(4))] = _block(one(style.wet_walls if wet else style.walls))
    skirting = one(style.skirtings) if rng.random() < 0.6 else wall
    cloth = int(rng.integers(len(style.cloths)))
    wood = int(rng.integers(len(style.woods)))
    return RoomLook(
        wall=_block(wall),
        accents=(accents[0], accents[1], accents[2], accents[3]),
        floor=tuple(_block(name) for name in floor),
        floor_pattern=("rows", "checked")[int(wet)],
        ceiling=_block(one(style.ceilings)),
        skirting=_block(skirting),
        skirting_height=1,
        cornice=_block(skirting) if rng.random() < 0.3 else "",
        glass=_block(one(style.glass)),
        wood=style.woods[wood],
        second_wood=style.woods[(wood + 1) % len(style.woods)],
        cloth=style.cloths[cloth],
        second_cloth=style.cloths[(cloth + 1) % len(style.cloths)],
        stone=one(style.stones),
    )


def _block(name: str) -> str:
    return f"minecraft:{name}"
