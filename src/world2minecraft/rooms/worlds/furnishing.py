"""Things of a layout become designs of the library, block by block, where they fit.

A thing keeps its place in the room to within two blocks, its front, and the wall it stands at.
"""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.furniture import Idiom, template
from world2minecraft.furniture.idiom import block_size, laid
from world2minecraft.rooms.place import Item
from world2minecraft.rooms.worlds.canvas import WorldCanvas
from world2minecraft.rooms.worlds.choices import designs_for, dressed
from world2minecraft.rooms.worlds.house import BlockHouse, BlockRoom
from world2minecraft.rooms.worlds.looks import RoomLook

AT_WALL_M = 0.12  # What stands nearer to a wall than this stands at it.
NUDGES = sorted(
    ((a, b) for a in range(-2, 3) for b in range(-2, 3)),
    key=lambda step: (abs(step[0]) + abs(step[1]), step),
)


@dataclass(frozen=True)
class Thing:
    """A piece of furniture in its place, for people and for tests."""

    instance: int
    design: str
    class_id: int
    room: int
    low: tuple[int, int, int]
    high: tuple[int, int, int]
    quarter_turns: int


@dataclass
class Furnisher:
    """Puts things into the rooms of one house."""

    canvas: WorldCanvas
    house: BlockHouse
    things: list[Thing] = field(default_factory=list)
    count: int = 0
    kept: np.ndarray = field(init=False)  # bool [X, Y, Z] of the canvas: must stay air.

    def __post_init__(self):
        self.kept = np.zeros(self.canvas.states.shape, bool)

    def next_instance(self) -> int:
        """Return a number that no thing has yet."""
        self.count += 1
        return self.count

    def put_item(
        self, item: Item, room: BlockRoom, look: RoomLook, rng: np.random.Generator
    ) -> bool:
        """Set the design that stands for a thing of the metric layout, if one fits there."""
        names = designs_for(item.model.name, item.model.size_m)
        turns = round(item.yaw_deg / 90) % 4
        for number in rng.permutation(len(names)):
            name = names[int(number)]
            found = self._design(name, item.model.size_m, turns, look, rng)
            if found is None:
                continue
            low = self._corner(item, found, room)
            if template(name).mount == "floor":
                low[2] = self._on(low, found)
            if self.put(name, found, low, room, turns, NUDGES):
                return True
        return False

    def _design(
        self,
        name: str,
        size_m: tuple[float, float, float],
        turns: int,
        look: RoomLook,
        rng: np.random.Generator,
    ) -> Idiom | None:
        """Return a design in the size of a thing, as far as it is made in that size."""
        made = template(name)
        size = np.array([span.clip(v) for span, v in zip(made.size_m, size_m, strict=True)])
        found = laid(made, block_size(size, self.house.blocks_per_metre), None, turns)
        return None if found is None else dressed(found, made, look, rng)

    def _corner(self, item: Item, found: Idiom, room: BlockRoom) -> list[int]:
        """Return the least block of a thing's design, x y z of the house."""
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

    def _on(self, low: list[int], found: Idiom) -> int:
        """Return the layer on the highest thing under a design's middle, not over its place."""
        x, y, _ = self.canvas.at(low[0] + found.size[0] // 2, low[1] + found.size[2] // 2, 0)
        top = self.canvas.at(0, 0, low[2] + 1)[2]
        filled = np.flatnonzero(self.canvas.states[x, y, : top + 1])
        return int(filled.max()) + 1 - self.canvas.at(0, 0, 0)[2] if len(filled) else low[2]

    def put(
        self,
        name: str,
        found: Idiom,
        low: list[int],
        room: BlockRoom,
        turns: int,
        nudges: list[tuple[int, int]] | None = None,
    ) -> bool:
        """Set a design at a place or beside it, where all its blocks are free; say whether."""
        offsets = np.array([block.offset for block in found.blocks])
        cells = np.stack([offsets[:, 0], found.size[2] - 1 - offsets[:, 2], offsets[:, 1]], axis=1)
        inside = room.floor(self.house.size)
        for dx, dy in nudges or [(0, 0)]:
            place = np.array([low[0] + dx, low[1] + dy, low[2]])
            if self._is_free(cells + place, room, inside):
                self._set(name, found, cells + place, room, turns)
                return True
        return False

    def _is_free(self, at: np.ndarray, room: BlockRoom, inside: np.ndarray) -> bool:
        flat = at[:, :2]
        if (flat < room.low).any() or (flat >= room.high).any():
            return False
        if at[:, 2].min() < room.ground or at[:, 2].max() >= room.ground + room.height:
            return False
        own = tuple((at + self.canvas.at(0, 0, 0)).T)
        free = (self.canvas.states[own] == 0) & ~self.kept[own]
        return bool(free.all() and inside[tuple(flat.T)].all())

    def _set(self, name: str, found: Idiom, at: np.ndarray, room: BlockRoom, turns: int) -> None:
        instance, class_id = self.next_instance(), template(name).class_id
        for (x, y, z), block in zip(at.tolist(), found.blocks, strict=True):
            self.canvas.set(self.canvas.at(x, y, z), block.state, class_id, instance, name)
        low, high = at.min(axis=0), at.max(axis=0) + 1
        self.things.append(
            Thing(
                instance,
                name,
                class_id,
                room.number,
                (int(low[0]), int(low[1]), int(low[2])),
                (int(high[0]), int(high[1]), int(high[2])),
                turns,
            )
        )
