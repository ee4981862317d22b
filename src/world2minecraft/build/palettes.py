"""Which blocks a surface of a class may be made of: palette files, read and checked."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from world2minecraft.classes import CLASS_NAMES
from world2minecraft.errors import UnknownNameError
from world2minecraft.minecraft.states import check_state, complete, parse_state

# A block that is to stand by itself for good: it does not fall, grow, melt, shine or decay.
PALETTE_FILES = {"vanilla": "palette_vanilla.json"}


@dataclass(frozen=True)
class Palette:
    """Blocks by class. States are complete; ``slabs`` and ``fences`` go by full block.

    ``preferred`` are the blocks that win where colours are about as near: a table is of wood.
    """

    name: str
    blocks: Mapping[int, tuple[str, ...]]
    preferred: Mapping[int, frozenset[str]]
    defaults: Mapping[int, str]
    slabs: Mapping[str, str]
    fences: Mapping[str, str]
    glass: str
    pane: str

    def allows(self, state: str) -> bool:
        """Whether a full block may be used at all; a palette of its own kind may say no."""
        return True


@cache
def load_palette(name: str) -> Palette:
    """Return a palette by its name.

    Raises:
        UnknownNameError: no palette has this name, or it names a block that the game lacks.
    """
    if name not in PALETTE_FILES:
        raise UnknownNameError("palette", name, PALETTE_FILES)
    source = files("world2minecraft.build") / "data" / PALETTE_FILES[name]
    return palette_of(json.loads(source.read_text("utf-8")))


def palette_of(raw: Mapping) -> Palette:
    """Return the palette that a palette file holds; docs/building.md says how it is written."""
    groups = {name: [_full(block) for block in blocks] for name, blocks in raw["groups"].items()}
    classes = {CLASS_NAMES.index(name): chosen for name, chosen in raw["classes"].items()}
    return Palette(
        name=raw["name"],
        blocks={
            number: tuple(block for group in chosen for block in groups[group])
            for number, chosen in classes.items()
        },
        preferred={
            number: frozenset(
                block
                for group in raw["prefers"].get(CLASS_NAMES[number], ())
                for block in groups[group]
            )
            for number in classes
        },
        defaults={CLASS_NAMES.index(k): _full(block) for k, block in raw["defaults"].items()},
        slabs={_full(block): slab for block, slab in raw["slabs"].items()},
        fences={_full(block): fence for block, fence in raw["fences"].items()},
        glass=_full(raw["glass"]),
        pane=_full(raw["pane"]),
    )


def _full(text: str) -> str:
    return str(complete(check_state(parse_state(text))))
