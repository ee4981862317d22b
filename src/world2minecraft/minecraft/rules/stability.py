"""What of a volume would not stay: falls, pops off, breaks, flows, or changes at an update.

A written file gets no block updates, so a torch without a wall hangs there until the first block
beside it changes. Here every state is asked what it needs, by the rules of
``data/support_rules.json``, and whether a neighbour's update would give it other connections.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.rules.board import Board
from world2minecraft.minecraft.rules.connections import connected
from world2minecraft.minecraft.rules.light import block_light
from world2minecraft.minecraft.rules.needs import (
    Demand,
    holds_water,
    is_floodable,
    needs_of,
    offers,
)
from world2minecraft.minecraft.rules.supports import DOWN, UP, faces_of

MELTS_ABOVE = 11  # Ice and snow melt in brighter block light.
_MELTING = ("minecraft:ice", "minecraft:snow")


class Unstable(NamedTuple):
    """A block that would not stay as it is, and why."""

    block_pos: tuple[int, int, int]
    state: str
    reason: str


def unstable(volume: BlockVolume) -> list[Unstable]:
    """Return the blocks of a volume that would not stay, in the order of x, y, z.

    What lies outside the volume counts as air. Redstone and growth by hand are left out; what
    grows, melts, weathers or decays by itself is told.

    Args:
        volume: the blocks; positions come in its world coordinates.
    """
    found = [
        (cell, state, reason) for cell, state, reason in _all_cells(volume.states, volume.palette)
    ]
    found += _melting(volume)
    corner = volume.corner
    return [
        Unstable((x + corner[0], y + corner[1], z + corner[2]), state, reason)
        for (x, y, z), state, reason in sorted(found)
    ]


def unstable_cells(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    """Return the cells of a design that would not stay: cell, state and reason, in order.

    Args:
        states: uint16 [X, Y, Z] in block axes, indices into the palette.
        palette: block states; index 0 need not be air.
    """
    return sorted(_all_cells(states, palette))


def unmet_cells(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    """Return the same but for those that an update would only connect or shape otherwise."""
    board = Board(states, palette)
    found = [*_unmet(board), *_flowing(board)]
    return sorted((_place(board, cell), palette[int(board.flat[cell])], why) for cell, why in found)


def _all_cells(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    return unmet_cells(states, palette) + _changing(states, palette)


def _place(board: Board, cell: int) -> tuple[int, int, int]:
    x, y, z = (int(i) - 1 for i in np.unravel_index(cell, board.shape))
    return x, y, z


def _unmet(board: Board) -> Iterable[tuple[int, str]]:
    """Yield the cells whose needs no neighbour meets, with the reason."""
    demands = [needs_of(text) for text in board.palette]
    asking = np.array([bool(held) for held in demands])
    if not asking.any():
        return
    cells = np.flatnonzero(asking[board.flat])
    own = board.flat[cells]
    for number in np.unique(own).tolist():
        mine = cells[own == number]
        for demand in demands[number]:
            for cell in mine[~_met(board, mine, demand)].tolist():
                yield cell, demand.reason


def _met(board: Board, cells: np.ndarray, demand: Demand) -> np.ndarray:
    """Return which cells, bool [N], have one of the neighbours that a demand wants."""
    met = np.zeros(len(cells), bool)
    for wish in demand.wishes:
        answers = [
            _answers(board, board.at(cells, way), wish.asked, way) for way in wish.directions
        ]
        if answers:
            met |= ~np.any(answers, axis=0) if wish.none else np.any(answers, axis=0)
    return met


def _answers(board: Board, neighbours: np.ndarray, asked: str, way: int) -> np.ndarray:
    """Return which neighbours, uint16 [N], give what is asked of them, bool [N]."""
    met, index = np.unique(neighbours, return_inverse=True)
    return np.array([offers(board.palette[one], asked, way) for one in met], bool)[index.ravel()]


def _changing(
    states: np.ndarray, palette: Sequence[str]
) -> list[tuple[tuple[int, int, int], str, str]]:
    """Return the cells whose connections or shape an update would change."""
    renewed, names = connected(states, palette)
    numbers: dict[BlockState, int] = {}  # The same for texts that leave defaults out.
    whole = np.array(
        [numbers.setdefault(complete(parse_state(text)), len(numbers)) for text in names]
    )
    changed = np.argwhere(whole[renewed] != whole[states])
    return [
        ((x, y, z), palette[int(states[x, y, z])], f"changes to {names[renewed[x, y, z]]}")
        for x, y, z in changed.tolist()
    ]


def _flowing(board: Board) -> Iterable[tuple[int, str]]:
    """Yield the cells whose water would run into a neighbour at its side or under it."""
    wet = np.array([holds_water(text) for text in board.palette])
    if not wet.any():
        return
    floodable = np.array([is_floodable(text) for text in board.palette])
    shut = np.array([faces_of(text).full for text in board.palette])
    cells = np.flatnonzero(wet[board.flat])
    own = board.flat[cells]
    runs = np.zeros(len(cells), bool)
    for way in (*range(UP), DOWN):
        runs |= floodable[board.at(cells, way)] & ~shut[own, way]
    for cell in cells[runs].tolist():
        yield cell, "flows: nothing holds its water"


def _melting(volume: BlockVolume) -> list[tuple[tuple[int, int, int], str, str]]:
    """Return snow and ice in bright block light."""
    melts = np.array([parse_state(text).name in _MELTING for text in volume.palette])
    if not melts[volume.states].any():
        return []
    # Light comes to a block from its brightest neighbour, and ice lets it in.
    bright = block_light(volume) > MELTS_ABOVE
    return [
        ((x, y, z), volume.palette[volume.states[x, y, z]], "melts in the light")
        for x, y, z in np.argwhere(melts[volume.states] & bright).tolist()
    ]
