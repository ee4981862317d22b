"""Wares: any block of the game as something to look at, with what it needs to stay.

``data/wares.json`` says which blocks stand otherwise than on a board: what grows needs soil, what
hangs a block above, what is two blocks high its other half. All others stand by themselves; of them
``home`` names those that lie about in homes too.
"""

import json
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from world2minecraft.minecraft.block_states import known_blocks

MOUNTS = ("board", "tall", "soil", "wall", "hanging", "water", "bed")
HOME = "home"


@dataclass(frozen=True)
class Ware:
    """Blocks in a column from its foot up, those of a bed one before the other.

    ``{facing}`` in a state is where its front looks.
    """

    name: str
    mount: str
    states: tuple[str, ...]

    def turned(self, facing: str) -> list[str]:
        """Return its states with its front to a side."""
        return [f"minecraft:{state.replace('{facing}', facing)}" for state in self.states]


@cache
def table() -> dict[str, Any]:
    """Return the table of blocks that stand otherwise than on a board."""
    source = files("world2minecraft.procgen.worlds") / "data" / "wares.json"
    return json.loads(source.read_text("utf-8"))


@cache
def wares() -> tuple[Ware, ...]:
    """Return all wares, sorted by name."""
    raw = table()
    told: dict[str, Ware] = {}
    for mount in MOUNTS[1:]:
        for states in raw[mount]:
            column = [states] if isinstance(states, str) else states
            name = next((s for s in column if s.startswith("*")), column[-1]).removeprefix("*")
            name = name.partition("[")[0]
            told[name] = Ware(name, mount, tuple(s.removeprefix("*") for s in column))
    skipped = {name for names in raw["skipped"].values() for name in names}
    for block in known_blocks():
        name = block.removeprefix("minecraft:")
        if name not in told and name not in skipped:
            told[name] = Ware(name, "board", (name + raw["states"].get(name, ""),))
    return tuple(told[name] for name in sorted(told))


@cache
def _pile(mount: str) -> list[Ware]:
    if mount != HOME:
        return [ware for ware in wares() if ware.mount == mount]
    likes = table()[HOME]
    return [ware for ware in _pile("board") if any(fnmatch(ware.name, like) for like in likes)]


class Deck:
    """Wares in a shuffled order, dealt one after another, so that a series shows them all.

    Args:
        seed: of the order; one for a whole series.
        start: how many of each mount were dealt before, about.
    """

    def __init__(self, seed: int, start: int):
        rng = np.random.default_rng([seed, 17])
        self._piles: dict[str, list[Ware]] = {}
        self._next: dict[str, int] = {}
        for mount in (*MOUNTS, HOME):
            pile = _pile(mount)
            self._piles[mount] = [pile[int(n)] for n in rng.permutation(len(pile))]
            every = sum(ware.mount == "board" for ware in wares())
            self._next[mount] = round(start * len(pile) / every) if len(pile) < every else start

    def deal(self, mount: str) -> Ware:
        """Return the next ware of a mount."""
        pile = self._piles[mount]
        self._next[mount] += 1
        return pile[(self._next[mount] - 1) % len(pile)]
