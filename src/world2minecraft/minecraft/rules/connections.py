"""Connections and shapes that the game computes from neighbours, for a whole volume at once.

A world file gets no block updates, so a pane that does not say whom it joins stands alone. Here
every state takes the properties that it would have after an update of all its neighbours: the
corners of stairs; the sides of panes, bars and fences; gates sunk between walls; the sides and
posts of walls; the halves of doors and of double chests; the distance of leaves from a log; snow
on grass; the smoke of campfires on hay. Redstone is left alone. docs/states.md has the rules.
"""

from collections.abc import Iterable

import numpy as np

from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.rules import traits
from world2minecraft.minecraft.rules.board import Board
from world2minecraft.minecraft.rules.supports import DOWN, EAST, NORTH, OPPOSITE, SOUTH, UP, WEST
from world2minecraft.minecraft.rules.traits import SIDES, TYPES

SHAPES = ("straight", "inner_left", "inner_right", "outer_left", "outer_right")
HEIGHTS = ("none", "low", "tall")
FARTHEST = 7  # A leaf's distance from a log that it does not reach.
_DOOR_KEYS = ("facing", "hinge", "open", "powered")
_FLAT = (NORTH, EAST, SOUTH, WEST)


def connected(states: np.ndarray, palette: Iterable[str]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return a volume with the connections and shapes that the game would compute.

    What lies outside the volume counts as air. Doing it twice changes nothing more.

    Args:
        states: uint16 [X, Y, Z] in block axes (x east, y up, z south), indices into the palette.
        palette: block states; those of one kind need not be complete.

    Returns:
        uint16 [X, Y, Z] and the palette: the one given, with new states behind it.

    Raises:
        UsageError: a text of the palette is no block state.

    Example:
        >>> pair = np.array([[[1]], [[2]]], np.uint16)
        >>> states, palette = connected(pair, ("minecraft:air", "oak_fence", "stone"))
        >>> palette[states[0, 0, 0]]
        'minecraft:oak_fence[east=true,north=false,south=false,waterlogged=false,west=false]'
    """
    board = Board(states, palette)
    for rule in (_doors, _chests, _stairs, _gates, _joints, _walls, _leaves, _snowy, _campfires):
        rule(board)
    return board.result()


def _doors(board: Board) -> None:
    """The upper half of a door follows its lower half."""
    cells = board.cells_of(traits.DOOR)
    if not len(cells):
        return
    below = board.at(cells, DOWN)
    top, block = board.column("top"), board.column("block")
    own = board.at(cells)
    pairs = (top[own] == 1) & (board.column("kind")[below] == traits.DOOR)
    pairs &= (top[below] == 0) & (block[own] == block[below])
    lower = board.palette

    def write(row: list[int]) -> dict[str, str]:
        state = complete(parse_state(lower[row[0]]))
        return {key: state.get(key) for key in _DOOR_KEYS if state.get(key)}

    board.change(cells[pairs], below[pairs][:, None], write)


def _chests(board: Board) -> None:
    """A half of a double chest without its other half is single; a chest joins one that asks."""
    for rule in (_orphan_chests, _asked_chests):
        cells = board.cells_of(traits.CHEST)
        if len(cells):
            rule(board, cells)


def _orphan_chests(board: Board, cells: np.ndarray) -> None:
    own = board.at(cells)
    halves = board.column("variant")[own] > 0
    cells, own = cells[halves], own[halves]
    other = board.towards(cells, _partner(board)[own])
    block = board.column("block")
    alone = block[own] != block[other]
    board.change(cells[alone], np.zeros((alone.sum(), 1), int), lambda _: {"type": "single"})


def _asked_chests(board: Board, cells: np.ndarray) -> None:
    own = board.at(cells)
    variant, facing, block = (board.column(name) for name in ("variant", "facing", "block"))
    partner = _partner(board)
    chosen = np.zeros(len(cells), int)
    for side in _FLAT:
        other = board.at(cells, side)
        asks = (block[other] == block[own]) & (facing[other] == facing[own])
        asks &= (variant[own] == 0) & (variant[other] > 0) & (partner[other] == OPPOSITE[side])
        chosen[asks & (chosen == 0)] = 3 - variant[other][asks & (chosen == 0)]
    asked = chosen > 0
    board.change(cells[asked], chosen[asked][:, None], lambda row: {"type": TYPES[row[0]]})


def _partner(board: Board) -> np.ndarray:
    """Return the direction, int [P], of the other half: a left half's is clockwise."""
    return (board.column("facing") + np.where(board.column("variant") == 1, 1, 3)) % 4


def _stairs(board: Board) -> None:
    """A stair bends around the stair before it, else into the one behind it."""
    cells = board.cells_of(traits.STAIRS)
    if not len(cells):
        return
    kind, facing, top = (board.column(name) for name in ("kind", "facing", "top"))
    own = board.at(cells)
    side, half = facing[own], top[own]
    shape = np.zeros(len(cells), int)
    for way, first in ((side, 3), ((side + 2) % 4, 1)):
        other = board.towards(cells, way)
        turned = facing[other]
        bends = (kind[other] == traits.STAIRS) & (top[other] == half) & ((turned - side) % 2 == 1)
        # A stair of the same turn beside it, where the corner would open, keeps it straight.
        beside = board.towards(cells, np.where(first == 3, turned + 2, turned) % 4)
        alike = (kind[beside] == traits.STAIRS) & (facing[beside] == side) & (top[beside] == half)
        bends &= ~alike & (shape == 0)
        shape[bends] = first + (turned[bends] != (side[bends] + 3) % 4)
    board.change(cells, shape[:, None], lambda row: {"shape": SHAPES[row[0]]})


def _gates(board: Board) -> None:
    """A gate beside a wall hangs lower."""
    cells = board.cells_of(traits.GATE)
    if not len(cells):
        return
    walls = np.isin(board.column("kind"), (traits.WALL, traits.OLD_WALL))
    facing = board.column("facing")[board.at(cells)]
    beside = [walls[board.towards(cells, (facing + turn) % 4)] for turn in (1, 3)]
    sunk = (beside[0] | beside[1]).astype(int)
    board.change(cells, sunk[:, None], lambda row: {"in_wall": _text(row[0])})


def _joints(board: Board) -> None:
    """Panes, bars and fences join what they know, and full faces."""
    for kind in (traits.PANE, traits.FENCE, traits.BRICK_FENCE):
        cells = board.cells_of(kind)
        if len(cells):
            joined = np.stack([_joins(board, cells, side, kind) for side in _FLAT], axis=1)
            board.change(
                cells,
                joined.astype(int),
                lambda row: {side: _text(held) for side, held in zip(SIDES, row, strict=True)},
            )


def _joins(board: Board, cells: np.ndarray, side: int, kind: int) -> np.ndarray:
    """Return whether cells of a kind join their neighbours at a side, bool [N]."""
    other = board.at(cells, side)
    kinds = board.column("kind")[other]
    joined = (board.column("sturdy")[other] >> OPPOSITE[side] & 1).astype(bool)
    if kind in (traits.PANE, traits.WALL):
        joined |= np.isin(kinds, (traits.PANE, traits.WALL, traits.OLD_WALL))
    else:
        joined |= kinds == kind
    if kind != traits.PANE:  # A gate is joined at its two ends.
        joined |= (kinds == traits.GATE) & ((board.column("facing")[other] - side) % 2 == 1)
    return joined


def _walls(board: Board) -> None:
    """Walls from the top down: a wall's sides and post depend on what stands on it."""
    cells = board.cells_of(traits.WALL)
    if not len(cells):
        return
    joined = np.stack([_joins(board, cells, side, traits.WALL) for side in _FLAT], axis=1)
    heights = board.heights(cells)
    for level in np.unique(heights)[::-1]:
        here = heights == level
        _wall_layer(board, cells[here], joined[here])


def _wall_layer(board: Board, cells: np.ndarray, joined: np.ndarray) -> None:
    above = board.at(cells, UP)
    arms = board.column("arms")[above][:, None]
    covered = (arms >> np.arange(4) & 1).astype(bool)
    sides = np.where(joined, np.where(covered, 2, 1), 0)
    none = sides == 0
    ends = none.all(axis=1) | (none[:, NORTH] != none[:, SOUTH]) | (none[:, EAST] != none[:, WEST])
    tall = sides == 2
    through = tall[:, NORTH] & tall[:, SOUTH] | tall[:, EAST] & tall[:, WEST]
    pressed = (board.column("post")[above] == 1) | (arms[:, 0] >> 4 & 1 == 1)
    post = (board.column("up")[above] == 1) | ends | (~through & pressed)
    board.change(
        cells,
        np.column_stack([sides, post]),
        lambda row: {
            **{side: HEIGHTS[height] for side, height in zip(SIDES, row, strict=False)},
            "up": _text(row[4]),
        },
    )


def _leaves(board: Board) -> None:
    """Leaves count the way to the nearest log through leaves, up to seven."""
    cells = board.cells_of(traits.LEAVES)
    if not len(cells):
        return
    kinds = board.column("kind").astype(np.uint8)[board.flat]
    distance = np.where(kinds == traits.LOG, 0, FARTHEST).astype(np.uint8)
    for _ in range(FARTHEST - 1):
        around = [distance[cells + step] for step in board.steps]
        distance[cells] = np.minimum(np.min(around, axis=0) + 1, FARTHEST)
    found = distance[cells].astype(int)
    board.change(cells, found[:, None], lambda row: {"distance": str(row[0])})


def _snowy(board: Board) -> None:
    """Grass and its kin are white under snow."""
    cells = board.cells_of(traits.SNOWY)
    if len(cells):
        snow = board.column("variant")[board.at(cells, UP)] == 1
        snow &= board.column("kind")[board.at(cells, UP)] == traits.OTHER
        board.change(cells, snow.astype(int)[:, None], lambda row: {"snowy": _text(row[0])})


def _campfires(board: Board) -> None:
    """A campfire on hay smokes high."""
    cells = board.cells_of(traits.CAMPFIRE)
    if len(cells):
        hay = board.column("variant")[board.at(cells, DOWN)] == 2
        hay &= board.column("kind")[board.at(cells, DOWN)] == traits.OTHER
        board.change(cells, hay.astype(int)[:, None], lambda row: {"signal_fire": _text(row[0])})


def _text(held: int) -> str:
    return "true" if held else "false"
