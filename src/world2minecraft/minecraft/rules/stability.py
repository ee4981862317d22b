"""Detection of unstable blocks: blocks that fall, pop off, break, flow or change when updated.

The game does not update blocks of a world file when it loads them, so a torch without a wall stays
until the first neighbouring block changes. This module checks whether every block has the support
that it needs, by the rules in ``data/support_rules.json`` (which documents their format), and
whether an update would change its connections.
"""

from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from re import Pattern
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.former_names import getter
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import AIRS, BlockState, complete, parse_state
from world2minecraft.minecraft.data_files import read_data
from world2minecraft.minecraft.rules.block_traits import pattern_of
from world2minecraft.minecraft.rules.connections import StateGrid, update_connections
from world2minecraft.minecraft.rules.light import block_light, lets_light_through
from world2minecraft.minecraft.rules.supports import (
    DIRECTIONS,
    DOWN,
    OPPOSITE,
    UP,
    faces_of,
    has_centre_below,
    is_solid,
)

__getattr__ = getter(__name__)

_WATER = ("water", "bubble_column", "seagrass", "tall_seagrass", "kelp", "kelp_plant")
MELTS_ABOVE = 11  # Ice and snow melt in brighter block light.
_MELTING = ("minecraft:ice", "minecraft:snow")


class SupportOption(NamedTuple):
    """One way in which a block can be supported by its neighbours.

    At least one neighbour in the given directions must offer the support. With ``none``, none of
    them may.
    """

    directions: tuple[int, ...]
    offer: str
    none: bool


class Demand(NamedTuple):
    """The support that a block state needs, as alternative options.

    ``reason`` describes what happens if no option is met.
    """

    options: tuple[SupportOption, ...]
    reason: str


class _Rule(NamedTuple):
    blocks: Pattern[str]
    unless: Pattern[str]
    when: dict[str, str]
    unless_values: dict[str, str]
    needs: tuple[str, ...]
    reason: str


@lru_cache(maxsize=1 << 16)
def support_demands(text: str) -> tuple[Demand, ...]:
    """Return all support demands of a block state.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    state = complete(parse_state(text))
    bare, values = state.name.partition(":")[2], dict(state.properties)
    if _names("never_asked").match(bare):
        return ()
    return tuple(
        Demand(
            tuple(_support_option(need, state) for need in rule.needs if need != "never"),
            rule.reason,
        )
        for rule in _rules()
        if rule.blocks.match(bare)
        and not rule.unless.match(bare)
        and all(values.get(key) == value for key, value in rule.when.items())
        and not any(values.get(key) == value for key, value in rule.unless_values.items())
    )


@lru_cache(maxsize=1 << 18)
def offers_support(text: str, offer: str, direction: int) -> bool:
    """Return whether a block state offers a kind of support to a neighbour.

    Args:
        text: The block state.
        offer: A word of the rules, such as ``full`` or ``block:stone``.
        direction: The direction of this block, seen from the block that needs support.

    Raises:
        UsageError: If the text is not a valid block state.
        KeyError: If the word is not in the rules.
    """
    state = complete(parse_state(text))
    word, _, rest = offer.partition(":")
    toward = OPPOSITE[direction]
    bare = state.name.partition(":")[2]
    faces = faces_of(text)
    if word in ("full", "rigid", "centre"):
        return getattr(faces, word)[toward]
    answers = {
        "any": lambda: state.name not in AIRS,
        "holds": lambda: not _names("replaceable").match(bare),
        "solid": lambda: is_solid(text),
        "loose": lambda: not is_solid(text),
        "rigid_top": lambda: faces.rigid[UP],
        "hangs": lambda: has_centre_below(state),
        "clear": lambda: lets_light_through(text),
        "wet": lambda: holds_water(text),
        "powers": lambda: _names("powers").match(bare),
        "block": lambda: _listed(rest).match(bare),
        "no": lambda: not _listed(rest).match(bare),
        "exact": lambda: _is_exactly(state, rest),
        "vine": lambda: bare == "vine" and state.get(rest) == "true",
    }
    return bool(answers[word]())


def holds_water(text: str) -> bool:
    """Return whether a block state contains water that can flow out."""
    state = complete(parse_state(text))
    return state.name.partition(":")[2] in _WATER or state.get("waterlogged") == "true"


@lru_cache(maxsize=1 << 16)
def is_floodable(text: str) -> bool:
    """Return whether flowing water would replace a block state."""
    state = complete(parse_state(text))
    if state.name in AIRS:
        return True
    if holds_water(text) or state.get("waterlogged"):
        return False
    return not (is_solid(text) or _names("unflooded").match(state.name.partition(":")[2]))


def _support_option(need: str, state: BlockState) -> SupportOption:
    where, _, offer = need.partition(" ")
    where, dash, _ = where.partition("-")
    if offer.startswith("same:"):
        offer = f"exact:{state.name}:{offer.removeprefix('same:')}"
    return SupportOption(_directions(where, state), offer, bool(dash))


def _directions(where: str, state: BlockState) -> tuple[int, ...]:
    if where in ("ahead", "behind"):
        facing = state.get("facing")
        if facing not in DIRECTIONS:
            return ()
        way = DIRECTIONS.index(facing)
        return (way if where == "ahead" else OPPOSITE[way],)
    groups = {
        "around": tuple(range(6)),
        "beside": tuple(range(UP)),
        "above": (UP,),
        "below": (DOWN,),
    }
    return groups.get(where) or (DIRECTIONS.index(where),)


def _is_exactly(state: BlockState, wanted: str) -> bool:
    name, _, pair = wanted.rpartition(":")
    key, _, value = pair.partition("=")
    return state.name == name and state.get(key) == value


@cache
def _listed(names: str) -> Pattern[str]:
    """Return the pattern of a list of names, where @dirt refers to the file's list ``dirt``."""
    groups = _raw()["names"]
    flat: list[str] = []
    for name in names.split(","):
        flat += groups[name[1:]] if name.startswith("@") else [name]
    return pattern_of(flat)


@cache
def _names(key: str) -> Pattern[str]:
    return pattern_of(_raw()[key])


@cache
def _rules() -> tuple[_Rule, ...]:
    return tuple(
        _Rule(
            pattern_of(rule["blocks"]),
            pattern_of(rule.get("unless", [])),
            rule.get("when", {}),
            rule.get("unless_values", {}),
            tuple(rule["needs"]),
            rule["reason"],
        )
        for rule in _raw()["rules"]
    )


@cache
def _raw() -> dict[str, Any]:
    return read_data("support_rules.json")


class UnstableBlock(NamedTuple):
    """A block that would not stay as it is, with the reason."""

    block_pos: tuple[int, int, int]
    state: str
    reason: str


def find_unstable(volume: BlockVolume) -> list[UnstableBlock]:
    """Find the blocks of a volume that would not stay as they are, ordered by x, y, z.

    The space outside the volume counts as air. Redstone and growth caused by a player are ignored.
    Blocks that grow, melt, weather or decay by themselves are reported.

    Args:
        volume: The blocks. Positions in the result are in world coordinates.
    """
    found = find_unstable_cells(volume.states, volume.palette) + _melting(volume)
    corner = volume.corner
    return [
        UnstableBlock((x + corner[0], y + corner[1], z + corner[2]), state, reason)
        for (x, y, z), state, reason in sorted(found)
    ]


def find_unstable_cells(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    """Find the unstable cells of a design, with their states and the reasons, in order.

    Args:
        states: Palette indices, uint16 [X, Y, Z] in block axes.
        palette: Block states. Index 0 need not be air.
    """
    return sorted(find_unmet_cells(states, palette) + _changing(states, palette))


def find_unmet_cells(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    """Find the cells of a design that lack support or from which water would flow.

    Cells whose connections or shape would change are not included.
    """
    grid = StateGrid(states, palette)
    found = [*_unmet(grid), *_flowing(grid)]
    return sorted((_place(grid, cell), palette[int(grid.flat[cell])], why) for cell, why in found)


def _place(grid: StateGrid, cell: int) -> tuple[int, int, int]:
    x, y, z = (int(i) - 1 for i in np.unravel_index(cell, grid.shape))
    return x, y, z


def _unmet(grid: StateGrid) -> Iterable[tuple[int, str]]:
    """Yield the cells that lack support, with the reason."""
    demands = [support_demands(text) for text in grid.palette]
    asking = np.array([bool(held) for held in demands])
    if not asking.any():
        return
    cells = np.flatnonzero(asking[grid.flat])
    own = grid.flat[cells]
    for number in np.unique(own).tolist():
        mine = cells[own == number]
        for demand in demands[number]:
            for cell in mine[~_is_met(grid, mine, demand)].tolist():
                yield cell, demand.reason


def _is_met(grid: StateGrid, cells: np.ndarray, demand: Demand) -> np.ndarray:
    """Return which cells have a neighbour that meets a demand, as bool [N]."""
    met = np.zeros(len(cells), bool)
    for option in demand.options:
        answers = [
            _offers_each(grid, grid.at(cells, way), option.offer, way) for way in option.directions
        ]
        if answers:
            met |= ~np.any(answers, axis=0) if option.none else np.any(answers, axis=0)
    return met


def _offers_each(grid: StateGrid, neighbours: np.ndarray, offer: str, way: int) -> np.ndarray:
    """Return which neighbours, uint16 [N], offer a kind of support, as bool [N]."""
    met, index = np.unique(neighbours, return_inverse=True)
    return np.array([offers_support(grid.palette[one], offer, way) for one in met], bool)[
        index.ravel()
    ]


def _changing(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    """Return the cells whose connections or shape would change in an update."""
    renewed, names = update_connections(states, palette)
    numbers: dict[BlockState, int] = {}  # The same for texts that leave defaults out.
    whole = np.array(
        [numbers.setdefault(complete(parse_state(text)), len(numbers)) for text in names]
    )
    changed = np.argwhere(whole[renewed] != whole[states])
    return [
        ((x, y, z), palette[int(states[x, y, z])], f"changes to {names[renewed[x, y, z]]}")
        for x, y, z in changed.tolist()
    ]


def _flowing(grid: StateGrid) -> Iterable[tuple[int, str]]:
    """Yield the cells whose water would flow into a neighbour beside or below."""
    wet = np.array([holds_water(text) for text in grid.palette])
    if not wet.any():
        return
    floodable = np.array([is_floodable(text) for text in grid.palette])
    shut = np.array([faces_of(text).full for text in grid.palette])
    cells = np.flatnonzero(wet[grid.flat])
    own = grid.flat[cells]
    runs = np.zeros(len(cells), bool)
    for way in (*range(UP), DOWN):
        runs |= floodable[grid.at(cells, way)] & ~shut[own, way]
    for cell in cells[runs].tolist():
        yield cell, "flows: its water is not enclosed"


def _melting(volume: BlockVolume) -> list[tuple[tuple[int, int, int], str, str]]:
    """Return the snow and ice in bright block light."""
    melts = np.array([parse_state(text).name in _MELTING for text in volume.palette])
    if not melts[volume.states].any():
        return []
    # Light comes to a block from its brightest neighbour, and ice lets it in.
    bright = block_light(volume) > MELTS_ABOVE
    return [
        ((x, y, z), volume.palette[volume.states[x, y, z]], "melts in the light")
        for x, y, z in np.argwhere(melts[volume.states] & bright).tolist()
    ]
