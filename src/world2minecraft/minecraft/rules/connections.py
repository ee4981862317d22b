"""Connections and shapes that the game computes from neighbouring blocks, for a whole volume.

The game does not update blocks of a world file when it loads them, so a pane without connection
properties stays unconnected. This module sets the properties that every block would have after an
update: the corners of stairs; the sides of panes, bars and fences; gates lowered between walls; the
sides and posts of walls; the halves of doors and double chests; the distance of leaves from a log;
snow on grass; the smoke of campfires on hay. Redstone is not changed. docs/reference/states.md
lists the rules.

A block is recognised as stairs, a fence and so on by the end of its name and its properties, so
that blocks of mods and newer games are connected too if they follow the game's naming. Directions
are those of ``supports``: north, east, south, west, up, down.
"""

from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from world2minecraft.core.errors import LimitError
from world2minecraft.core.former_names import getter
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.rules.block_traits import is_among
from world2minecraft.minecraft.rules.supports import (
    DIRECTIONS,
    DOWN,
    EAST,
    NORTH,
    OPPOSITE,
    SOUTH,
    STEPS,
    UP,
    WEST,
    faces_of,
)

__getattr__ = getter(__name__)

(OTHER, STAIRS, PANE, FENCE, BRICK_FENCE, GATE, WALL, DOOR, CHEST, LEAVES, SNOWY, CAMPFIRE,
 LOG, OLD_WALL) = range(14)  # fmt: skip
SIDES = DIRECTIONS[:4]
TYPES = ("single", "left", "right")
_ENDS = (  # The end of the name, the properties that it needs, and the kind.
    ("_stairs", ("facing", "half", "shape"), STAIRS),
    ("_pane", SIDES, PANE),
    ("_bars", SIDES, PANE),
    ("nether_brick_fence", SIDES, BRICK_FENCE),
    ("_fence", SIDES, FENCE),
    ("_fence_gate", ("facing", "in_wall"), GATE),
    ("_wall", (*SIDES, "up"), WALL),
    ("_door", ("facing", "half", "hinge", "open"), DOOR),
    ("chest", ("facing", "type"), CHEST),
    ("_leaves", ("distance",), LEAVES),
    ("", ("snowy",), SNOWY),
    ("campfire", ("signal_fire",), CAMPFIRE),
)
MAX_STATES = 1 << 16  # A volume's states are uint16.
_NONE = np.empty(0, np.int32)
SHAPES = ("straight", "inner_left", "inner_right", "outer_left", "outer_right")
HEIGHTS = ("none", "low", "tall")
MAX_LEAF_DISTANCE = 7  # A leaf's distance from a log that it does not reach.
_DOOR_KEYS = ("facing", "hinge", "open", "powered")
_FLAT = (NORTH, EAST, SOUTH, WEST)


class Traits(NamedTuple):
    """The properties of a block state that its neighbours depend on, as integers."""

    kind: int = OTHER
    block: int = 0  # The same for all states of one block.
    facing: int = -1  # 0 north, 1 east, 2 south, 3 west.
    top: int = 0  # 1 for the upper half of stairs or doors.
    sturdy: int = 0  # Bits by direction: full faces of a block to which others connect.
    arms: int = 0  # Bits: lower face from the middle to each of the four sides; 16 for the middle.
    post: int = 0  # Whether the block raises the post of a wall below it.
    up: int = 0  # Whether a wall has a post.
    variant: int = 0  # The type of a chest; the distance of leaves; 1 for snow, 2 for hay.


@lru_cache(maxsize=1 << 16)
def connection_traits(text: str) -> Traits:
    """Return the traits of a block state. ``block`` is 0 and must be set by the caller.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    state = complete(parse_state(text))
    values = dict(state.properties)
    kind = _kind(state.name, values)
    if kind in (STAIRS, GATE, DOOR, CHEST) and values["facing"] not in SIDES:
        kind = OTHER
    faces = faces_of(str(state))
    joined = not is_among(state.name, "unjoinable")
    arms = sum(1 << side for side, held in enumerate(faces.down_arms) if held)
    return Traits(
        kind=kind,
        facing=SIDES.index(values["facing"]) if values.get("facing") in SIDES else -1,
        top=int(values.get("half") in ("top", "upper")),
        sturdy=sum(1 << way for way, held in enumerate(faces.full) if held and joined),
        arms=arms,
        post=int(is_among(state.name, "wall_posts")),
        up=int(kind == WALL and values.get("up") == "true"),
        variant=_variant(state.name, kind, values),
    )


def _kind(name: str, values: dict[str, str]) -> int:
    for end, needed, kind in _ENDS:
        if name.endswith(end) and all(key in values for key in needed):
            if kind == WALL and values["north"] in ("true", "false"):
                return OLD_WALL  # Of 1.15 and older: its sides are not low or tall.
            return kind
    return LOG if is_among(name, "logs") else OTHER


def _variant(name: str, kind: int, values: dict[str, str]) -> int:
    if kind == CHEST:
        return TYPES.index(values["type"]) if values["type"] in TYPES else 0
    if kind == OTHER:
        return int(is_among(name, "snow")) + 2 * (name == "minecraft:hay_block")
    return 0


class StateGrid:
    """A volume of block states with a margin of air, which rules modify by looking at neighbours.

    Cells are indices into ``flat``, the padded volume in C order.
    """

    def __init__(self, states: np.ndarray, palette: Iterable[str]):
        self.palette = list(palette)
        self._ids = {state: number for number, state in reversed([*enumerate(self.palette)])}
        self._columns: dict[str, np.ndarray] = {}
        self._blocks: dict[str, int] = {}
        self.shape = tuple(side + 2 for side in states.shape)
        padded = np.full(self.shape, self.id_of(AIR), np.uint16)
        padded[1:-1, 1:-1, 1:-1] = states
        self.flat = padded.ravel()
        strides = np.array([self.shape[1] * self.shape[2], self.shape[2], 1])
        self.steps = np.array(STEPS) @ strides
        kinds = self.column("kind").astype(np.uint8)
        # Rules change the properties of blocks and never their kinds, so one look is enough.
        self._cells = np.flatnonzero((kinds > 0)[self.flat]) if kinds.any() else np.empty(0, int)
        self._kinds = kinds[self.flat[self._cells]]

    def result(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """Return the states without the margin, as uint16 [X, Y, Z], and the palette."""
        inner = self.flat.reshape(self.shape)[1:-1, 1:-1, 1:-1]
        return np.ascontiguousarray(inner), tuple(self.palette)

    def column(self, name: str) -> np.ndarray:
        """Return one trait of every state in the palette, as int32 [P]."""
        known = self._columns.get(name, _NONE)
        if len(known) < len(self.palette):  # States that have joined since the last call.
            more = [self._trait(text, name) for text in self.palette[len(known) :]]
            self._columns[name] = known = np.concatenate([known, np.array(more, np.int32)])
        return known

    def cells_of(self, kind: int) -> np.ndarray:
        """Return the cells, int [N], whose states have the given kind."""
        return self._cells[self._kinds == kind]

    def at(self, cells: np.ndarray, direction: int | None = None) -> np.ndarray:
        """Return the states, uint16 [N], of cells or of their neighbours in one direction."""
        return self.flat[cells if direction is None else cells + self.steps[direction]]

    def towards(self, cells: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Return the state, uint16 [N], of one neighbour per cell, each in its own direction."""
        return self.flat[cells + self.steps[directions]]

    def heights(self, cells: np.ndarray) -> np.ndarray:
        """Return the layer of each cell as int [N], including the margin."""
        return cells // self.shape[2] % self.shape[1]

    def change(
        self, cells: np.ndarray, values: np.ndarray, write: Callable[[list[int]], dict[str, str]]
    ) -> None:
        """Set properties of cells.

        Args:
            cells: The cells to change, int [N].
            values: Values that determine the properties of each cell, int [N, K].
            write: Function that returns the properties for one row of ``values``.
        """
        if not len(cells):
            return
        own = self.at(cells)
        width = values.max(initial=0) + 1
        keys = own.astype(np.int64)
        for value in values.T:
            keys = keys * width + value
        _, first, index = np.unique(keys, return_index=True, return_inverse=True)
        numbers = [self._with_properties(int(own[i]), write(values[i].tolist())) for i in first]
        self.flat[cells] = np.array(numbers, np.uint16)[index.ravel()]

    def _with_properties(self, number: int, changed: dict[str, str]) -> int:
        state = complete(parse_state(self.palette[number]))
        if all(state.get(key) == value for key, value in changed.items()):
            return number
        return self.id_of(str(state.having(**changed)))

    def id_of(self, text: str) -> int:
        """Return the index of a state in the palette, after adding the state if it is new.

        Raises:
            LimitError: If the palette is full.
        """
        if text not in self._ids:
            if len(self.palette) >= MAX_STATES:
                raise LimitError("palette", "exceeds the limit of 65,536 block states")
            self._ids[text] = len(self.palette)
            self.palette.append(text)
        return self._ids[text]

    def _trait(self, text: str, name: str) -> int:
        if name == "block":
            block = parse_state(text).name
            return self._blocks.setdefault(block, len(self._blocks))
        return int(getattr(connection_traits(text), name))


def update_connections(
    states: np.ndarray, palette: Iterable[str]
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return a volume with the connections and shapes that the game would compute.

    The space outside the volume counts as air. A second call changes nothing.

    Args:
        states: Palette indices, uint16 [X, Y, Z] in block axes (x east, y up, z south).
        palette: Block states. Properties may be missing.

    Returns:
        The updated states as uint16 [X, Y, Z], and the given palette with new states appended.

    Raises:
        UsageError: If a palette entry is not a valid block state.

    Example:
        >>> pair = np.array([[[1]], [[2]]], np.uint16)
        >>> states, palette = update_connections(pair, ("minecraft:air", "oak_fence", "stone"))
        >>> palette[states[0, 0, 0]]
        'minecraft:oak_fence[east=true,north=false,south=false,waterlogged=false,west=false]'
    """
    grid = StateGrid(states, palette)
    for rule in (
        _doors,
        _chests,
        _stairs,
        _gates,
        _panes_and_fences,
        _walls,
        _leaves,
        _snowy,
        _campfires,
    ):
        rule(grid)
    return grid.result()


def _doors(grid: StateGrid) -> None:
    """Copy properties from the lower to the upper halves of doors."""
    cells = grid.cells_of(DOOR)
    if not len(cells):
        return
    below = grid.at(cells, DOWN)
    top, block = grid.column("top"), grid.column("block")
    own = grid.at(cells)
    pairs = (top[own] == 1) & (grid.column("kind")[below] == DOOR)
    pairs &= (top[below] == 0) & (block[own] == block[below])
    lower = grid.palette

    def write(row: list[int]) -> dict[str, str]:
        state = complete(parse_state(lower[row[0]]))
        return {key: state.get(key) for key in _DOOR_KEYS if state.get(key)}

    grid.change(cells[pairs], below[pairs][:, None], write)


def _chests(grid: StateGrid) -> None:
    """Set chests without another half to single, and join chests to halves that face them."""
    for rule in (_orphan_chests, _requested_chests):
        cells = grid.cells_of(CHEST)
        if len(cells):
            rule(grid, cells)


def _orphan_chests(grid: StateGrid, cells: np.ndarray) -> None:
    own = grid.at(cells)
    halves = grid.column("variant")[own] > 0
    cells, own = cells[halves], own[halves]
    other = grid.towards(cells, _partner(grid)[own])
    block = grid.column("block")
    alone = block[own] != block[other]
    grid.change(cells[alone], np.zeros((alone.sum(), 1), int), lambda _: {"type": "single"})


def _requested_chests(grid: StateGrid, cells: np.ndarray) -> None:
    own = grid.at(cells)
    variant, facing, block = (grid.column(name) for name in ("variant", "facing", "block"))
    partner = _partner(grid)
    chosen = np.zeros(len(cells), int)
    for side in _FLAT:
        other = grid.at(cells, side)
        asks = (block[other] == block[own]) & (facing[other] == facing[own])
        asks &= (variant[own] == 0) & (variant[other] > 0) & (partner[other] == OPPOSITE[side])
        chosen[asks & (chosen == 0)] = 3 - variant[other][asks & (chosen == 0)]
    joins = chosen > 0
    grid.change(cells[joins], chosen[joins][:, None], lambda row: {"type": TYPES[row[0]]})


def _partner(grid: StateGrid) -> np.ndarray:
    """Return the direction of the other half of each chest state, int [P]."""
    return (grid.column("facing") + np.where(grid.column("variant") == 1, 1, 3)) % 4


def _stairs(grid: StateGrid) -> None:
    """Set the shape of stairs from the stairs in front of and behind them."""
    cells = grid.cells_of(STAIRS)
    if not len(cells):
        return
    kind, facing, top = (grid.column(name) for name in ("kind", "facing", "top"))
    own = grid.at(cells)
    side, half = facing[own], top[own]
    shape = np.zeros(len(cells), int)
    for way, first in ((side, 3), ((side + 2) % 4, 1)):
        other = grid.towards(cells, way)
        turned = facing[other]
        bends = (kind[other] == STAIRS) & (top[other] == half) & ((turned - side) % 2 == 1)
        # A stair of the same turn beside it, where the corner would open, keeps it straight.
        adjacent = grid.towards(cells, np.where(first == 3, turned + 2, turned) % 4)
        alike = (kind[adjacent] == STAIRS) & (facing[adjacent] == side) & (top[adjacent] == half)
        bends &= ~alike & (shape == 0)
        shape[bends] = first + (turned[bends] != (side[bends] + 3) % 4)
    grid.change(cells, shape[:, None], lambda row: {"shape": SHAPES[row[0]]})


def _gates(grid: StateGrid) -> None:
    """Lower the gates that are next to walls."""
    cells = grid.cells_of(GATE)
    if not len(cells):
        return
    walls = np.isin(grid.column("kind"), (WALL, OLD_WALL))
    facing = grid.column("facing")[grid.at(cells)]
    adjacent = [walls[grid.towards(cells, (facing + turn) % 4)] for turn in (1, 3)]
    sunk = (adjacent[0] | adjacent[1]).astype(int)
    grid.change(cells, sunk[:, None], lambda row: {"in_wall": _text(row[0])})


def _panes_and_fences(grid: StateGrid) -> None:
    """Connect panes, bars and fences to compatible neighbours and to full faces."""
    for kind in (PANE, FENCE, BRICK_FENCE):
        cells = grid.cells_of(kind)
        if len(cells):
            joined = np.stack([_joins_neighbour(grid, cells, side, kind) for side in _FLAT], axis=1)
            grid.change(
                cells,
                joined.astype(int),
                lambda row: {side: _text(held) for side, held in zip(SIDES, row, strict=True)},
            )


def _joins_neighbour(grid: StateGrid, cells: np.ndarray, side: int, kind: int) -> np.ndarray:
    """Return whether cells of a kind connect to their neighbours at a side, bool [N]."""
    other = grid.at(cells, side)
    kinds = grid.column("kind")[other]
    joined = (grid.column("sturdy")[other] >> OPPOSITE[side] & 1).astype(bool)
    if kind in (PANE, WALL):
        joined |= np.isin(kinds, (PANE, WALL, OLD_WALL))
    else:
        joined |= kinds == kind
    if kind != PANE:  # A gate is joined at its two ends.
        joined |= (kinds == GATE) & ((grid.column("facing")[other] - side) % 2 == 1)
    return joined


def _walls(grid: StateGrid) -> None:
    """Set the sides and posts of walls from top to bottom, as each depends on the one above."""
    cells = grid.cells_of(WALL)
    if not len(cells):
        return
    joined = np.stack([_joins_neighbour(grid, cells, side, WALL) for side in _FLAT], axis=1)
    heights = grid.heights(cells)
    for level in np.unique(heights)[::-1]:
        here = heights == level
        _wall_layer(grid, cells[here], joined[here])


def _wall_layer(grid: StateGrid, cells: np.ndarray, joined: np.ndarray) -> None:
    above = grid.at(cells, UP)
    arms = grid.column("arms")[above][:, None]
    covered = (arms >> np.arange(4) & 1).astype(bool)
    sides = np.where(joined, np.where(covered, 2, 1), 0)
    none = sides == 0
    ends = none.all(axis=1) | (none[:, NORTH] != none[:, SOUTH]) | (none[:, EAST] != none[:, WEST])
    tall = sides == 2
    through = tall[:, NORTH] & tall[:, SOUTH] | tall[:, EAST] & tall[:, WEST]
    pressed = (grid.column("post")[above] == 1) | (arms[:, 0] >> 4 & 1 == 1)
    post = (grid.column("up")[above] == 1) | ends | (~through & pressed)
    grid.change(
        cells,
        np.column_stack([sides, post]),
        lambda row: {
            **{side: HEIGHTS[height] for side, height in zip(SIDES, row, strict=False)},
            "up": _text(row[4]),
        },
    )


def _leaves(grid: StateGrid) -> None:
    """Set the distance of leaves to the nearest log through leaves, at most seven."""
    cells = grid.cells_of(LEAVES)
    if not len(cells):
        return
    kinds = grid.column("kind").astype(np.uint8)[grid.flat]
    distance = np.where(kinds == LOG, 0, MAX_LEAF_DISTANCE).astype(np.uint8)
    for _ in range(MAX_LEAF_DISTANCE - 1):
        around = [distance[cells + step] for step in grid.steps]
        distance[cells] = np.minimum(np.min(around, axis=0) + 1, MAX_LEAF_DISTANCE)
    found = distance[cells].astype(int)
    grid.change(cells, found[:, None], lambda row: {"distance": str(row[0])})


def _snowy(grid: StateGrid) -> None:
    """Set grass and similar blocks below snow to snowy."""
    cells = grid.cells_of(SNOWY)
    if len(cells):
        snow = grid.column("variant")[grid.at(cells, UP)] == 1
        snow &= grid.column("kind")[grid.at(cells, UP)] == OTHER
        grid.change(cells, snow.astype(int)[:, None], lambda row: {"snowy": _text(row[0])})


def _campfires(grid: StateGrid) -> None:
    """Set campfires on hay to signal fires."""
    cells = grid.cells_of(CAMPFIRE)
    if len(cells):
        hay = grid.column("variant")[grid.at(cells, DOWN)] == 2
        hay &= grid.column("kind")[grid.at(cells, DOWN)] == OTHER
        grid.change(cells, hay.astype(int)[:, None], lambda row: {"signal_fire": _text(row[0])})


def _text(held: int) -> str:
    return "true" if held else "false"
