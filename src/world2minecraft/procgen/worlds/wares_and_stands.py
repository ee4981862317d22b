"""Display of all blocks of the game ("wares") on racks, plinths, planters and basins.

``data/wares.json`` lists the blocks that cannot simply be placed on a board: plants need soil,
hanging blocks need a block above, and blocks of two halves need the other half. ``home`` lists the
blocks that are also suitable for homes.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.procgen.worlds.block_house import BlockRoom
from world2minecraft.procgen.worlds.furnishing import Furnisher, PlacedFurniture
from world2minecraft.procgen.worlds.shell import FACINGS
from world2minecraft.procgen.worlds.styles import NEUTRALS, colour_of

MOUNTS = ("board", "tall", "soil", "wall", "hanging", "water", "bed")
HOME = "home"
DEALS_TRIED = 12
MIN_RACK = 4  # Blocks.
FURN, OBJS = int(SemanticClass.FURN), int(SemanticClass.OBJS)
WALL = int(SemanticClass.WALL)
Corner = tuple[int, int, int]


@dataclass(frozen=True)
class Ware:
    """A block to display: a column of states from bottom to top, or the two halves of a bed.

    ``{facing}`` in a state is replaced by the direction of its front.
    """

    name: str
    mount: str
    states: tuple[str, ...]

    def turned(self, facing: str) -> list[str]:
        """Return the full states of the ware with its front facing a side."""
        return [f"minecraft:{state.replace('{facing}', facing)}" for state in self.states]


@cache
def mount_table() -> dict[str, Any]:
    """Load the table of blocks that cannot simply be placed on a board."""
    source = files("world2minecraft.procgen.worlds") / "data" / "wares.json"
    return json.loads(source.read_text("utf-8"))


@cache
def load_wares() -> tuple[Ware, ...]:
    """Load all wares, sorted by name."""
    raw = mount_table()
    by_name: dict[str, Ware] = {}
    for mount in MOUNTS[1:]:
        for states in raw[mount]:
            column = [states] if isinstance(states, str) else states
            name = next((s for s in column if s.startswith("*")), column[-1]).removeprefix("*")
            name = name.partition("[")[0]
            by_name[name] = Ware(name, mount, tuple(s.removeprefix("*") for s in column))
    skipped = {name for names in raw["skipped"].values() for name in names}
    for block in known_blocks():
        name = block.removeprefix("minecraft:")
        if name not in by_name and name not in skipped:
            by_name[name] = Ware(name, "board", (name + raw["states"].get(name, ""),))
    return tuple(by_name[name] for name in sorted(by_name))


@cache
def _pile(mount: str) -> list[Ware]:
    if mount != HOME:
        return [ware for ware in load_wares() if ware.mount == mount]
    likes = mount_table()[HOME]
    return [ware for ware in _pile("board") if any(fnmatch(ware.name, like) for like in likes)]


class WareDeck:
    """A shuffled sequence of all wares, so that a series of houses shows every ware.

    Args:
        seed: Seed of the order, the same for a whole series.
        start: Approximate number of wares already used per kind of mount.
    """

    def __init__(self, seed: int, start: int):
        rng = np.random.default_rng([seed, 17])
        self._piles: dict[str, list[Ware]] = {}
        self._next: dict[str, int] = {}
        for mount in (*MOUNTS, HOME):
            pile = _pile(mount)
            self._piles[mount] = [pile[int(n)] for n in rng.permutation(len(pile))]
            every = sum(ware.mount == "board" for ware in load_wares())
            self._next[mount] = round(start * len(pile) / every) if len(pile) < every else start

    def deal(self, mount: str) -> Ware:
        """Return the next ware for a kind of mount."""
        pile = self._piles[mount]
        self._next[mount] += 1
        return pile[(self._next[mount] - 1) % len(pile)]


class StandBuilder:
    """A placer of wares and their stands in the rooms of one house."""

    def __init__(self, furnisher: Furnisher, deck: WareDeck, rng: np.random.Generator):
        self.furnisher, self.deck, self.rng = furnisher, deck, rng
        self.canvas = furnisher.canvas

    def put_ware(self, ware: Ware, at: Corner, facing: str) -> bool:
        """Place a ware with its lowest block at a position, and return whether it fits."""
        states = ware.turned(facing)
        cells = [self.canvas.at(at[0], at[1], at[2] + n) for n in range(len(states))]
        if any(self.canvas.states[cell] or self.furnisher.reserved[cell] for cell in cells):
            return False
        instance = self.furnisher.next_instance()
        for cell, state in zip(cells, states, strict=True):
            self.canvas.set(cell, state, OBJS, instance)
        return True

    def _deal(self, mount: str, room: BlockRoom, *, home: bool) -> Ware | None:
        """Return the next ware for a kind of mount; in a home, the next that suits the room."""
        look = self.furnisher.looks[room.number]
        for _ in range(DEALS_TRIED if home else 1):
            ware = self.deck.deal(mount)
            if not home or colour_of(ware.name) in ("", *NEUTRALS, look.cloth):
                return ware
        return None

    def put_rack(
        self,
        room: BlockRoom,
        boards: Sequence[int],
        board: str,
        *,
        most: int = 99,
        home: bool = False,
    ) -> int:
        """Place a rack with wares along the longest bare stretch of wall.

        Args:
            room: The room.
            boards: Layers of the boards above the floor.
            board: Material of the boards: a block that has a slab, such as ``oak``.
            most: Maximum length in blocks. The minimum is ``MIN_RACK``.
            home: Whether the wares are those of homes, in the colours of the room.

        Returns:
            The number of wares on the rack, or 0 if the rack does not fit.
        """
        if not boards:  # At two blocks a metre a room is too low for some.
            return 0
        found = self._longest_wall(room, (boards[0], boards[-1] + 2))
        if found is None:
            return 0
        cells, turns = found
        start = int(self.rng.integers(max(len(cells) - most, 0) + 1))
        columns = np.array(cells[start : start + most])
        if boards[0] < self.furnisher.ways.head:
            if not self.furnisher.ways.stay(room, columns):
                columns = columns[: max(MIN_RACK, len(columns) // 2)]
                if not self.furnisher.ways.stay(room, columns):
                    return 0
            self.furnisher.ways.take(room, columns)
        instance = self.furnisher.next_instance()
        held, last = 0, len(columns) - 1
        for n, (x, y) in enumerate(columns.tolist()):
            for level in boards:
                state = f"minecraft:{board}_slab[type=top]"
                self._set((x, y, room.ground + level), state, FURN, instance)
            if n not in (0, last) and n % 3:  # Pairs, with air between.
                held += self._fill((x, y), room, boards, turns, home=home)
        return held

    def put_plinth(self, room: BlockRoom, pillar: str, height: int = 3) -> int:
        """Place a pillar with a ware on top in a room. Return 1 if it fits, or else 0."""
        furnisher = self.furnisher
        for _ in range(12):
            x = int(self.rng.integers(room.low[0] + 1, max(room.high[0] - 1, room.low[0] + 2)))
            y = int(self.rng.integers(room.low[1] + 1, max(room.high[1] - 1, room.low[1] + 2)))
            box = self.canvas.box(
                (x - 1, y - 1, room.ground), (x + 2, y + 2, room.ground + height + 3)
            )
            column = np.array([[x, y]])
            if self.canvas.states[box].any() or not furnisher.ways.free(room)[x, y]:
                continue
            if furnisher.ways.stay(room, column):
                furnisher.ways.take(room, column)
                instance = furnisher.next_instance()
                for z in range(height):
                    self._set((x, y, room.ground + z), f"minecraft:{pillar}", FURN, instance)
                self.put_ware(self.deck.deal("board"), (x, y, room.ground + height), "south")
                return 1
        return 0

    def put_bed(self, room: BlockRoom) -> int:
        """Place a two-block bed with its head at a wall. Return 1 if it fits, or else 0."""
        furnisher = self.furnisher
        for _ in range(12):
            turns = int(self.rng.integers(4))  # Where its foot looks.
            axis, step = turns % 2, 1 if turns < 2 else -1
            head = [0, 0]
            head[1 - axis] = int(self.rng.integers(room.low[1 - axis], room.high[1 - axis]))
            head[axis] = room.low[axis] if turns < 2 else room.high[axis] - 1
            foot = list(head)
            foot[axis] += step
            columns = np.array([foot, head])
            cells = [self.canvas.at(x, y, room.ground) for x, y in columns.tolist()]
            free = not any(self.canvas.states[at] or furnisher.reserved[at] for at in cells)
            if free and self._is_bare((head[0], head[1]), room, turns, (0, 2)):
                if not furnisher.ways.stay(room, columns):
                    continue
                furnisher.ways.take(room, columns)
                instance = furnisher.next_instance()
                states = self.deck.deal("bed").turned(FACINGS[(turns + 2) % 4])
                for cell, state in zip(cells, states, strict=True):
                    self.canvas.set(cell, state, OBJS, instance)
                return 1
        return 0

    def put_on(
        self, thing: PlacedFurniture, mounts: Sequence[str] = ("board",), most: int = 3
    ) -> int:
        """Place wares on top of a piece of furniture with gaps, and return their number."""
        held = 0
        spots = [
            (x, y)
            for x in range(thing.low[0], thing.high[0])
            for y in range(thing.low[1], thing.high[1])
            if (x + y) % 2 == 0
        ]
        for n in self.rng.permutation(len(spots)).tolist():
            if held == most:
                break
            x, y = spots[n]
            under = self.canvas.at(x, y, thing.high[2] - 1)
            if self.canvas.instance[under] != thing.instance or not self._is_top(under):
                continue
            mount = mounts[int(self.rng.integers(len(mounts)))]
            room = self.furnisher.house.rooms[thing.room]
            ware = self._deal(mount, room, home=mount == HOME)
            if ware is None:
                break
            held += self.put_ware(ware, (x, y, thing.high[2]), FACINGS[thing.quarter_turns])
        return held

    def hang_on_walls(self, room: BlockRoom, count: int, level: int, *, home: bool = False) -> int:
        """Hang up to ``count`` wares on bare walls at a layer above the floor; return the count.

        In a home they have the colours of the room.
        """
        hung = 0
        for _ in range(count * 4):
            if hung >= count:
                break
            turns = int(self.rng.integers(4))
            axis = turns % 2
            at = [0, 0]
            at[1 - axis] = int(self.rng.integers(room.low[1 - axis], room.high[1 - axis]))
            at[axis] = room.low[axis] if turns < 2 else room.high[axis] - 1
            behind = list(at)
            behind[axis] += -1 if turns < 2 else 1
            z = room.ground + level
            here = self.canvas.at(at[0], at[1], z)
            wall = self.canvas.at(behind[0], behind[1], z)
            near = self.canvas.states[here[0] - 1 : here[0] + 2, here[1] - 1 : here[1] + 2, here[2]]
            if self.canvas.semantic[wall] != WALL or (near > 0).sum() > 3:
                continue
            below = self.canvas.at(at[0], at[1], z - 1)
            if self.canvas.states[below] == 0 and self._takes(room, at, level):
                ware = self._deal("wall", room, home=home)
                if ware is not None:
                    hung += self.put_ware(ware, (at[0], at[1], z), FACINGS[turns])
        return hung

    def hang_from_ceiling(self, room: BlockRoom, count: int) -> int:
        """Hang up to ``count`` wares from the ceiling of a room, and return their number."""
        hung = 0
        for _ in range(count * 3):
            if hung >= count:
                break
            x = int(self.rng.integers(room.low[0] + 1, room.high[0] - 1))
            y = int(self.rng.integers(room.low[1] + 1, room.high[1] - 1))
            ware = self.deck.deal("hanging")
            top = room.ground + room.height - 1
            cells = [self.canvas.at(x, y, top - n) for n in range(len(ware.states))]
            near = self.canvas.states[
                cells[0][0] - 1 : cells[0][0] + 2, cells[0][1] - 1 : cells[0][1] + 2, cells[0][2]
            ]
            free = not near.any() and not any(self.canvas.states[cell] for cell in cells)
            free = free and bool(room.floor(self.furnisher.house.size)[x, y])
            if free and self._takes(room, [x, y], room.height - len(ware.states)):
                # Of two blocks the first is the lower.
                low = (x, y, top - len(ware.states) + 1)
                hung += self.put_ware(ware, low, "south")
        return hung

    def put_trough(self, room: BlockRoom, rim: str, mount: str, size: tuple[int, int]) -> int:
        """Place a planter with soil or a basin with water, and return the number of wares in it.

        Args:
            room: The room.
            rim: The block name of the rim.
            mount: The kind of wares, ``soil`` or ``water``.
            size: Number of inner blocks along x and y.
        """
        deep, wide = size[0] + 2, size[1] + 2
        spots = [
            (x, y)
            for x in range(room.low[0], room.high[0] - deep + 1)
            for y in range(room.low[1], room.high[1] - wide + 1)
        ]
        for n in self.rng.permutation(len(spots)).tolist()[:24]:
            low = spots[n]
            if grown := self._trough_at(room, low, (deep, wide), rim, mount):
                return grown
        return 0

    def _trough_at(
        self, room: BlockRoom, low: tuple[int, int], size: tuple[int, int], rim: str, mount: str
    ) -> int:
        ground = room.ground
        box = self.canvas.box((*low, ground), (low[0] + size[0], low[1] + size[1], ground + 4))
        columns = np.argwhere(np.ones(size, bool)) + low
        inside = room.floor(self.furnisher.house.size)[tuple(columns.T)].all()
        if self.canvas.states[box].any() or self.furnisher.reserved[box].any() or not inside:
            return 0
        if not self.furnisher.ways.stay(room, columns):
            return 0
        self.furnisher.ways.take(room, columns)
        instance, grown = self.furnisher.next_instance(), 0
        for x, y in columns.tolist():
            edge = x in (low[0], low[0] + size[0] - 1) or y in (low[1], low[1] + size[1] - 1)
            if edge:
                self._set((x, y, ground), f"minecraft:{rim}", FURN, instance)
            else:
                grown += self._grow((x, y, ground), mount, instance)
        return grown

    def _grow(self, at: Corner, mount: str, instance: int) -> int:
        ware = self.deck.deal(mount)
        if mount == "soil" or len(ware.states) == 1 or ware.states[0].startswith("water"):
            return int(self.put_ware(ware, at, "south"))
        self._set(at, "minecraft:water[level=0]", FURN, instance)
        return 0

    def _fill(
        self,
        column: tuple[int, int],
        room: BlockRoom,
        boards: Sequence[int],
        turns: int,
        *,
        home: bool,
    ) -> int:
        """Place wares in one column of a rack, as high as the boards allow."""
        held = 0
        tops = (*boards[1:], min(boards[-1] + 3, room.height))
        for level, top in zip(boards, tops, strict=True):
            free = top - level - 1
            board = mount = HOME if home else "board"
            if free >= 2 and self.rng.random() < 0.35:
                mount = ("soil", "tall")[int(self.rng.random() < 0.3 and not home)]
            ware = self._deal(mount, room, home=home)
            if ware is not None and len(ware.states) > free:
                ware = self._deal(board, room, home=home)
            if free >= 1 and ware is not None:
                at = (*column, room.ground + level + 1)
                held += self.put_ware(ware, at, FACINGS[turns])
        return held

    def _longest_wall(
        self, room: BlockRoom, layers: tuple[int, int]
    ) -> tuple[list[tuple[int, int]], int] | None:
        """Return the columns of the longest free stretch of bare wall, and its direction."""
        best: tuple[list[tuple[int, int]], int] | None = None
        for turns in range(4):
            run: list[tuple[int, int]] = []
            for column in [*self._at_wall(room, turns), None]:
                if column is not None and self._is_bare(column, room, turns, layers):
                    run.append(column)
                    continue
                if len(run) >= MIN_RACK and (best is None or len(run) > len(best[0])):
                    best = (run, turns)
                run = []
        return best

    def _at_wall(self, room: BlockRoom, turns: int) -> list[tuple[int, int]]:
        axis = turns % 2
        at = room.low[axis] if turns < 2 else room.high[axis] - 1
        along = range(room.low[1 - axis], room.high[1 - axis])
        return [(at, one) if axis == 0 else (one, at) for one in along]

    def _is_bare(
        self, column: tuple[int, int], room: BlockRoom, turns: int, layers: tuple[int, int]
    ) -> bool:
        axis, behind = turns % 2, list(column)
        behind[axis] += -1 if turns < 2 else 1
        low, high = (room.ground + min(layer, room.height) for layer in layers)
        wall = self.canvas.box((behind[0], behind[1], low), (behind[0] + 1, behind[1] + 1, high))
        here = self.canvas.box((*column, low), (column[0] + 1, column[1] + 1, high))
        bare = (self.canvas.semantic[wall] == WALL).all() and not self.canvas.states[here].any()
        bare &= not self.furnisher.reserved[here].any()
        return bool(bare and room.floor(self.furnisher.house.size)[column])

    def _takes(self, room: BlockRoom, column: Sequence[int], level: int) -> bool:
        """Reserve a column for a hanging ware, and return whether the paths remain clear."""
        ways, columns = self.furnisher.ways, np.array([column])
        if level >= ways.head:
            return True
        if not ways.stay(room, columns):
            return False
        ways.take(room, columns)
        return True

    def _is_top(self, cell: Corner) -> bool:
        """Return whether a block has a full top face."""
        boxes = boxes_of(self.canvas.palette[int(self.canvas.states[cell])])
        whole = (boxes[:, 3] - boxes[:, 0] > 0.99) & (boxes[:, 5] - boxes[:, 2] > 0.99)
        return bool((whole & (boxes[:, 4] > 0.99)).any())

    def _set(self, at: Corner, state: str, class_id: int, instance: int) -> None:
        self.canvas.set(self.canvas.at(*at), state, class_id, instance)
