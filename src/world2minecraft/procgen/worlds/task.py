"""What a recipe of a room works with: words for walls, floor and ceiling, seats and racks."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.procgen.worlds.display_stands import Show
from world2minecraft.procgen.worlds.dressing import hang_one
from world2minecraft.procgen.worlds.furnishing import Furnisher, Thing
from world2minecraft.procgen.worlds.house import BlockRoom

BOARDS = (  # Blocks with a slab that racks are made of, light and dark.
    "oak", "spruce", "birch", "jungle", "acacia", "dark_oak", "mangrove", "cherry", "bamboo",
    "bamboo_mosaic", "crimson", "warped", "smooth_stone", "stone", "smooth_quartz", "andesite",
    "polished_andesite", "polished_diorite", "polished_granite", "brick", "mud_brick",
    "stone_brick", "sandstone", "smooth_sandstone", "cut_sandstone", "smooth_red_sandstone",
    "purpur", "prismarine", "prismarine_brick", "dark_prismarine", "nether_brick",
    "red_nether_brick", "blackstone", "polished_blackstone", "polished_deepslate",
    "deepslate_tile", "end_stone_brick", "waxed_cut_copper", "waxed_oxidized_cut_copper",
    "waxed_weathered_cut_copper", "waxed_exposed_cut_copper", "quartz", "diorite", "granite",
    "cobblestone", "mossy_cobblestone", "cobbled_deepslate", "deepslate_brick",
    "polished_blackstone_brick", "red_sandstone", "cut_red_sandstone", "mossy_stone_brick",
)  # fmt: skip


@dataclass(frozen=True)
class Task:
    """What a recipe works with."""

    furnisher: Furnisher
    show: Show
    room: BlockRoom
    rng: np.random.Generator

    def one(self, *choices: str) -> str:
        """Return one of some words."""
        return choices[int(self.rng.integers(len(choices)))]

    def wall(self, *names: str, above_m: float | None = None) -> Thing | None:
        """Set one of some designs at a wall."""
        scale = self.furnisher.house.blocks_per_metre
        above = None if above_m is None else round(above_m * scale)
        number = self.furnisher.put_at_wall(names, self.room, self.rng, above=above)
        return self.furnisher.of(number) if number else None

    def free(self, *names: str) -> Thing | None:
        """Set one of some designs anywhere on the floor."""
        number = self.furnisher.put_free(names, self.room, self.rng)
        return self.furnisher.of(number) if number else None

    def hang(self, name: str, count: int) -> None:
        """Hang things of one design from the ceiling, in a row."""
        for n in range(count):
            hang_one(self.furnisher, self.room, name, (n + 0.5) / count, self.rng)

    def on(self, thing: Thing | None, *names: str) -> None:
        """Set one of some small designs on a thing."""
        if thing is not None:
            self.furnisher.put_on(names, thing, self.rng)

    def seats(self, table: Thing | None, most: int, *names: str) -> None:
        """Set seats of one design around a table, looking at it."""
        if table is None:
            return
        name = self.one(*names)
        for turns in self.rng.permutation(4)[:most].tolist():
            found = self.furnisher.design(name, self.room, turns, self.rng)
            if found is None:
                return
            # A seat that looks along a turn stands on the other side of the table.
            axis, low = turns % 2, [0, 0, self.room.ground]
            sides = (found.size[0], found.size[2])
            low[axis] = table.low[axis] - sides[axis] if turns < 2 else table.high[axis]
            other = 1 - axis
            low[other] = (table.low[other] + table.high[other] - sides[other]) // 2
            self.furnisher.put(name, found, low, self.room, turns, ((0, 0), (1, 0), (0, 1)))

    def racks(self, count: int, boards: tuple[int, ...] | None = None) -> int:
        """Stand racks of one material along the walls; return how many wares they hold."""
        board, held = self.one(*BOARDS), 0
        for _ in range(count):
            levels = (
                boards or ((0, 2, 4, 6), (0, 3, 5), (0, 2, 5), (1, 3, 5))[int(self.rng.integers(4))]
            )
            own = tuple(level for level in levels if level < self.room.height - 1)
            held += self.show.put_rack(self.room, own, board)
        return held
