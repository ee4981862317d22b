"""Placement of furniture designs in rooms, block by block, without blocking paths.

An item of a metric layout keeps its position to within two blocks, its orientation and the wall at
its back. Other designs are placed at a wall, on the floor or on top of another piece.
"""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.furniture import BlockDesign, template
from world2minecraft.furniture.block_designs import block_size, lay_template
from world2minecraft.minecraft.rules.supports import UP, faces_of
from world2minecraft.procgen.rooms.placement import Item
from world2minecraft.procgen.worlds.block_house import BlockHouse, BlockRoom
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.clear_paths import ClearPaths
from world2minecraft.procgen.worlds.furniture_choice import (
    ALIKE,
    designs_for,
    recolour_design,
    room_allows,
)
from world2minecraft.procgen.worlds.styles import RoomLook

AT_WALL_M = 0.12  # Maximum distance of furniture that stands at a wall, in metres.
NUDGES = sorted(
    ((a, b) for a in range(-2, 3) for b in range(-2, 3)),
    key=lambda step: (abs(step[0]) + abs(step[1]), step),
)
PLACES_TRIED = 24
MAX_DROP = 2  # Blocks that an item of a layout may stand lower than its place.
HELD_SHARE = 0.6  # Share of the bottom or back of furniture that must be supported.
HANGING = ("curtain", "curtain_sheer", "curtain_single", "shower_curtain")
Corner = tuple[int, int, int]


@dataclass(frozen=True)
class PlacedFurniture:
    """A placed piece of furniture, with its box of house blocks and its orientation."""

    instance: int
    design: str
    class_id: int
    room: int
    low: Corner
    high: Corner
    quarter_turns: int


@dataclass
class Furnisher:
    """A placer of furniture designs in the rooms of one house."""

    canvas: WorldCanvas
    house: BlockHouse
    looks: tuple[RoomLook, ...]
    ways: ClearPaths
    things: list[PlacedFurniture] = field(default_factory=list)
    count: int = 0
    placed: defaultdict[int, Counter[str]] = field(  # Designs by room; None counts all rooms.
        default_factory=lambda: defaultdict(Counter)
    )
    alike: dict[tuple[int, str], str] = field(default_factory=dict)
    reserved: np.ndarray = field(init=False)  # bool [X, Y, Z] of the canvas; must remain air.

    def __post_init__(self):
        self.reserved = np.zeros(self.canvas.states.shape, bool)

    def next_instance(self) -> int:
        """Return an unused instance number."""
        self.count += 1
        return self.count

    def of(self, instance: int) -> PlacedFurniture:
        """Return a placed piece of furniture by its instance number."""
        return next(thing for thing in self.things if thing.instance == instance)

    def put_item(self, item: Item, room: BlockRoom, rng: np.random.Generator) -> int:
        """Place a design for an item of a metric layout.

        Returns:
            The instance number, or 0 if no design fits.
        """
        key = item.model.name
        names = self.rarest_first(designs_for(key, item.model.size_m), rng)
        if first := self.alike.get((room.number, key)):
            names = (first, *names)
        turns = round(item.yaw_deg / 90) % 4
        for name in names:
            found = self.design(name, room, turns, rng, item.model.size_m)
            if found is None:
                continue
            low = self._corner(item, found, room)
            if template(name).mount in ("floor", "any"):
                low[2] = self._on(low, found)
            if placed := self.put(name, found, low, room, turns, NUDGES):
                if key in ALIKE:
                    self.alike[room.number, key] = name
                return placed
        return 0

    def rarest_first(self, names: Sequence[str], rng: np.random.Generator) -> tuple[str, ...]:
        """Return designs in random order, those that the house holds least of first."""
        order = [names[int(n)] for n in rng.permutation(len(names))]
        return tuple(sorted(order, key=lambda name: sum(own[name] for own in self.placed.values())))

    def design(
        self,
        name: str,
        room: BlockRoom,
        turns: int,
        rng: np.random.Generator,
        size_m: Sequence[float] | None = None,
    ) -> BlockDesign | None:
        """Return a rotated design in the materials of a room, or None.

        None stands for a design that cannot be built or of which the room holds enough. The size is
        random if ``size_m`` is None.
        """
        if not room_allows(name, self.placed[room.number]):
            return None
        made = template(name)
        if size_m is None:
            share = rng.triangular(-1, 0, 1)
            size_m = [
                span.typical + share * (span.maximum - span.typical if share > 0
                else span.typical - span.minimum) for span in made.size_m
            ]  # fmt: skip
        size = np.array([span.clip(v) for span, v in zip(made.size_m, size_m, strict=True)])
        found = lay_template(made, block_size(size, self.house.blocks_per_metre), None, turns)
        return None if found is None else recolour_design(found, made, self.looks[room.number], rng)

    def put_at_wall(
        self,
        names: Sequence[str],
        room: BlockRoom,
        rng: np.random.Generator,
        *,
        above: int | None = None,
    ) -> int:
        """Place one of several designs with its back to a bare wall.

        Args:
            names: Names of the designs, which are tried in random order.
            room: The room.
            rng: Random generator for the design, its size and its position.
            above: Number of layers above the floor, for hanging designs.

        Returns:
            The instance number, or 0 if no design fits.
        """
        for name in self.rarest_first(names, rng):
            for turns in rng.permutation(4).tolist():
                found = self.design(name, room, turns, rng)
                if found is None:
                    break
                z = room.ground + (above or 0)
                for x, y in self._along(found, room, turns, rng):
                    fits = self._has_wall(found, (x, y, z), turns)
                    fits = fits and self._front_is_free(found, (x, y, z), room, turns)
                    if fits and (placed := self.put(name, found, [x, y, z], room, turns)):
                        return placed
        return 0

    def put_free(self, names: Sequence[str], room: BlockRoom, rng: np.random.Generator) -> int:
        """Place one of several designs on the floor, near the middle of the room if possible.

        Returns:
            The instance number, or 0 if the design does not fit.
        """
        name = self.rarest_first(names, rng)[0]
        turns = int(rng.integers(4))
        found = self.design(name, room, turns, rng)
        if found is None:
            return 0
        middle = [(a + b) / 2 for a, b in zip(room.low, room.high, strict=True)]
        most = [room.high[0] - found.size[0], room.high[1] - found.size[2]]
        if most[0] < room.low[0] or most[1] < room.low[1]:
            return 0
        spots = np.stack(
            [rng.integers(room.low[n], most[n] + 1, size=PLACES_TRIED) for n in (0, 1)], axis=1
        )
        off = spots + np.array([found.size[0], found.size[2]]) / 2 - middle
        for n in np.argsort(np.hypot(*off.T), kind="stable"):
            x, y = spots[n].tolist()
            if placed := self.put(name, found, [x, y, room.ground], room, turns):
                return placed
        return 0

    def put_on(self, names: Sequence[str], thing: PlacedFurniture, rng: np.random.Generator) -> int:
        """Place one of several small designs on top of a piece of furniture.

        Returns:
            The instance number, or 0 if there is no free space.
        """
        room = self.house.rooms[thing.room]
        name = self.rarest_first(names, rng)[0]
        found = self.design(name, room, thing.quarter_turns, rng)
        if found is None:
            return 0
        spots = [
            (x, y)
            for x in range(thing.low[0], thing.high[0] - found.size[0] + 1)
            for y in range(thing.low[1], thing.high[1] - found.size[2] + 1)
        ]
        for n in rng.permutation(len(spots)).tolist():
            place = [*spots[n], thing.high[2]]
            if self._carries(place, found, thing) and (
                placed := self.put(name, found, place, room, thing.quarter_turns)
            ):
                return placed
        return 0

    def put_flat(
        self,
        name: str,
        room: BlockRoom,
        rng: np.random.Generator,
        middle: Sequence[float],
        *,
        turns: int | None = None,
        size_m: Sequence[float] | None = None,
    ) -> int:
        """Place a rug around a position, leaving out occupied blocks.

        The rotation and the size are random if they are not given.

        Returns:
            The instance number, or 0 if the rug does not fit.
        """
        turns = int(rng.integers(4)) if turns is None else turns
        found = self.design(name, room, turns, rng, size_m)
        if found is None:
            return 0
        low = [round(middle[0] - found.size[0] / 2), round(middle[1] - found.size[2] / 2)]
        cells = self._cells(found) + np.array([*low, room.ground])
        inside = room.floor(self.house.size)
        within = (cells[:, :2] >= room.low) & (cells[:, :2] < room.high)
        good = np.asarray(within.all(axis=1))
        good[good] &= inside[tuple(cells[good, :2].T)]
        good[good] &= self.canvas.states[tuple((cells[good] + self.canvas.at(0, 0, 0)).T)] == 0
        if good.sum() < 0.3 * len(good):
            return 0
        blocks = tuple(b for b, keep in zip(found.blocks, good, strict=True) if keep)
        return self._set(name, BlockDesign(blocks, found.size), cells[good], room, turns)

    def put(
        self,
        name: str,
        found: BlockDesign,
        low: Sequence[int],
        room: BlockRoom,
        turns: int,
        nudges: Sequence[tuple[int, int]] = ((0, 0),),
    ) -> int:
        """Place a design at a position or near it, if all its blocks are free and it is held.

        Returns:
            The instance number, or 0 if the design does not fit.
        """
        cells, inside = self._cells(found), room.floor(self.house.size)
        for dx, dy in nudges:
            at = cells + np.array([low[0] + dx, low[1] + dy, low[2]])
            if self._is_free(at, room, inside) and self._is_held(name, found, at, turns):
                stands = self.ways.stands(room, at)
                if self.ways.stay(room, stands):
                    self.ways.take(room, stands)
                    return self._set(name, found, at, room, turns)
        return 0

    def _cells(self, found: BlockDesign) -> np.ndarray:
        """Return the cells of a design's blocks relative to its lowest corner, int [N, 3]."""
        offsets = np.array([block.offset for block in found.blocks])
        deep = found.size[2]
        return np.stack([offsets[:, 0], deep - 1 - offsets[:, 2], offsets[:, 1]], axis=1)

    def _is_free(self, at: np.ndarray, room: BlockRoom, inside: np.ndarray) -> bool:
        flat = at[:, :2]
        if (flat < room.low).any() or (flat >= room.high).any():
            return False
        if at[:, 2].min() < room.ground or at[:, 2].max() >= room.ground + room.height:
            return False
        own = tuple((at + self.canvas.at(0, 0, 0)).T)
        free = (self.canvas.states[own] == 0) & ~self.reserved[own]
        return bool(free.all() and inside[tuple(flat.T)].all())

    def _is_held(self, name: str, found: BlockDesign, at: np.ndarray, turns: int) -> bool:
        """Return whether a design at cells, int [N, 3], stands, hangs or is fixed to something."""
        made = template(name)
        step, end, least = [0, 0, -1], at[:, 2].min(), HELD_SHARE
        if made.mount == "wall" or name in HANGING:
            axis, low = turns % 2, turns < 2
            step, least = [0, 0, 0], HELD_SHARE
            step[axis] = -1 if low else 1
            end = at[:, axis].min() if low else at[:, axis].max()
        elif made.mount == "ceiling":
            step, end, least = [0, 0, 1], at[:, 2].max(), 0.0
        axis = int(np.flatnonzero(step)[0])
        own = at[:, axis] == end
        beside = tuple((at[own] + step + self.canvas.at(0, 0, 0)).T)
        own_blocks = [block for block, is_own in zip(found.blocks, own, strict=True) if is_own]
        for number, block in zip(self.canvas.states[beside].tolist(), own_blocks, strict=True):
            # A candle pops off a block without a top.
            if "candle" in block.state and not faces_of(self.canvas.palette[number]).centre[UP]:
                return False
        return bool((self.canvas.states[beside] > 0).mean() > least)

    def _set(
        self, name: str, found: BlockDesign, at: np.ndarray, room: BlockRoom, turns: int
    ) -> int:
        instance, class_id = self.next_instance(), template(name).class_id
        for (x, y, z), block in zip(at.tolist(), found.blocks, strict=True):
            self.canvas.set(self.canvas.at(x, y, z), block.state, class_id, instance, name)
        low, high = at.min(axis=0).tolist(), (at.max(axis=0) + 1).tolist()
        thing = PlacedFurniture(
            instance, name, class_id, room.number, tuple(low), tuple(high), turns
        )
        self.things.append(thing)
        self.placed[room.number][name] += 1
        return instance

    def _corner(self, item: Item, found: BlockDesign, room: BlockRoom) -> list[int]:
        """Return the lowest block (x, y, z) of an item's design in the house."""
        scale = self.house.blocks_per_metre
        box, cell = item.box_m, self.house.plan.cells[room.number]
        wide, tall, deep = found.size
        corner = []
        for axis, side in ((0, wide), (1, deep)):
            start, end = cell.rect[axis], cell.rect[axis + 2]
            low, high = room.low[axis], room.high[axis]
            middle = low + ((box[axis] + box[axis + 3]) / 2 - start) * scale
            place = round(middle - side / 2)
            if box[axis] - start < AT_WALL_M:
                place = low
            elif end - box[axis + 3] < AT_WALL_M:
                place = high - side
            corner.append(int(np.clip(place, low, max(low, high - side))))
        floor_m = cell.storey * self.house.plan.pitch_m
        above = round((box[2] - floor_m) * scale)
        return [*corner, room.ground + min(above, max(room.height - tall, 0))]

    def _on(self, low: list[int], found: BlockDesign) -> int:
        """Return the layer above the highest block under the middle of a design.

        It is at most one layer above the given place, and two below; else it is the given place.
        """
        x, y, _ = self.canvas.at(low[0] + found.size[0] // 2, low[1] + found.size[2] // 2, 0)
        top = self.canvas.at(0, 0, low[2] + 1)[2]
        filled = np.flatnonzero(self.canvas.states[x, y, : top + 1])
        on = int(filled.max()) + 1 - self.canvas.at(0, 0, 0)[2] if len(filled) else low[2]
        return on if low[2] - on <= MAX_DROP else low[2]

    def _carries(self, place: list[int], found: BlockDesign, thing: PlacedFurniture) -> bool:
        """Return whether each bottom block of a design is on a block of the furniture."""
        foot = self._cells(found)
        foot = foot[foot[:, 2] == 0] + np.array(place) - [0, 0, 1]
        at = tuple((foot + self.canvas.at(0, 0, 0)).T)
        return bool((self.canvas.instance[at] == thing.instance).all())

    def _along(
        self, found: BlockDesign, room: BlockRoom, turns: int, rng: np.random.Generator
    ) -> list[tuple[int, int]]:
        """Return positions at a wall in random order."""
        wide, deep = found.size[0], found.size[2]
        most = room.high[0] - wide, room.high[1] - deep
        axis = 1 - turns % 2  # That the wall runs along.
        if most[0] < room.low[0] or most[1] < room.low[1]:
            return []
        at = room.low[1 - axis] if turns < 2 else most[1 - axis]
        spots = np.arange(room.low[axis], most[axis] + 1)
        order = rng.permutation(spots)[:PLACES_TRIED].tolist()
        return [(at, one) if axis == 1 else (one, at) for one in order]

    def _has_wall(self, found: BlockDesign, low: Corner, turns: int) -> bool:
        """Return whether the whole back of a design is at a bare wall."""
        wide, tall, deep = found.size
        high = (low[0] + wide, low[1] + deep, low[2] + tall)
        axis = turns % 2
        a, b = list(low), list(high)
        a[axis] = low[axis] - 1 if turns < 2 else high[axis]
        b[axis] = a[axis] + 1
        behind = self.canvas.semantic[self.canvas.box((a[0], a[1], a[2]), (b[0], b[1], b[2]))]
        return bool((behind == SemanticClass.WALL).all())

    def _front_is_free(self, found: BlockDesign, low: Corner, room: BlockRoom, turns: int) -> bool:
        """Return whether the blocks in front of a design are free."""
        wide, tall, deep = found.size
        high = (low[0] + wide, low[1] + deep, low[2] + tall)
        axis = turns % 2
        a, b = list(low), list(high)
        a[axis] = high[axis] if turns < 2 else low[axis] - 1
        b[axis] = a[axis] + 1
        if a[axis] < room.low[axis] or b[axis] > room.high[axis]:
            return False
        box = self.canvas.box((a[0], a[1], a[2]), (b[0], b[1], b[2]))
        return not self.canvas.states[box].any()
