"""Number the fine classes of a world: each block and each furniture design."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.minecraftocc.types import FineClass

EMPTY = FineClass("minecraft:air")
MAX_CLASSES = 65_535
Designs = tuple[np.ndarray, tuple[str, ...]]  # uint16 [X, Y, Z] of block axes; names, "" first


@dataclass(frozen=True, eq=False)
class FineClassMap:
    """The fine class of each cell of a volume and of each standing thing."""

    classes: tuple[FineClass, ...]  # the first is ``EMPTY``
    table: np.ndarray  # uint16 [P, D]: of a palette entry and a design
    states: np.ndarray  # uint16 [N], the volume's cells
    designs: np.ndarray | None  # uint16 [N], their designs
    of_thing: np.ndarray  # uint16 [S]

    def of_cells(self, cells: np.ndarray) -> np.ndarray:
        """Return the fine classes, uint16, of cells in C order."""
        design = 0 if self.designs is None else self.designs[cells]
        return self.table[self.states[cells], design]


def map_fine_classes(volume: BlockVolume, designs: Designs | None = None) -> FineClassMap:
    """Number the blocks and designs of a volume.

    A display entity has the design that most blocks of its object have.

    Args:
        volume: the blocks.
        designs: which design each block is a part of, and the designs' names; 0 is none.

    Raises:
        ValueError: the designs do not fit the volume.
        UsageError: there are more classes than 16 bits count.
    """
    codes, names = _checked(volume, designs)
    blocks = [state.partition("[")[0] for state in volume.palette]
    pairs = _pairs_there(volume, codes, len(names))
    things = _things(volume, codes, names)
    found = {FineClass(blocks[row], names[design]) for row, design in pairs} | set(things)
    classes = (EMPTY, *sorted(found - {EMPTY}))
    if len(classes) > MAX_CLASSES:
        raise UsageError(f"a world may have {MAX_CLASSES:,} kinds of blocks, not {len(classes):,}")
    number = {fine: place for place, fine in enumerate(classes)}
    table = np.zeros((len(blocks), len(names)), np.uint16)
    for row, design in pairs:
        table[row, design] = number[FineClass(blocks[row], names[design])]
    return FineClassMap(
        classes=classes,
        table=table,
        states=volume.states.reshape(-1),
        designs=codes,
        of_thing=np.array([number[fine] for fine in things], np.uint16),
    )


def _checked(
    volume: BlockVolume, designs: Designs | None
) -> tuple[np.ndarray | None, tuple[str, ...]]:
    if designs is None:
        return None, ("",)
    codes, names = designs
    if codes.shape != volume.states.shape:
        raise ValueError(f"designs of {codes.shape} do not fit blocks of {volume.states.shape}")
    if codes.size and int(codes.max()) >= len(names):
        raise ValueError(f"designs go to {codes.max()}, and {len(names)} have a name")
    return np.ascontiguousarray(codes).reshape(-1), ("", *names[1:])


def _pairs_there(volume: BlockVolume, codes: np.ndarray | None, count: int) -> np.ndarray:
    """Return the pairs, int64 [K, 2], of palette entry and design that some cell has."""
    states = volume.states.reshape(-1)
    if codes is None:
        rows = np.flatnonzero(np.bincount(states, minlength=1))
        return np.column_stack([rows, np.zeros_like(rows)])
    there = np.zeros(len(volume.palette) * count, bool)
    for first in range(0, len(states), 1 << 20):  # A piece at a time: few copies in memory.
        piece = slice(first, first + (1 << 20))
        there[states[piece].astype(np.int64) * count + codes[piece]] = True
    return np.column_stack(np.divmod(np.flatnonzero(there), count))


def _things(
    volume: BlockVolume, codes: np.ndarray | None, names: tuple[str, ...]
) -> list[FineClass]:
    design_of: dict[int, int] = {}
    if codes is not None and volume.entities:
        mine = np.flatnonzero(codes)
        pairs = volume.instance.reshape(-1)[mine].astype(np.int64) * len(names) + codes[mine]
        keys, counts = np.unique(pairs, return_counts=True)
        for key in keys[np.argsort(counts, kind="stable")].tolist():
            design_of[key // len(names)] = key % len(names)  # The most frequent comes last.
        design_of.pop(0, None)
    return [
        FineClass(cube.state.partition("[")[0], names[design_of.get(cube.instance, 0)])
        for cube in display_cubes(volume.entities)
    ]
