"""Numbering of the fine classes in a world: combinations of block and furniture design."""

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
    """The fine class of each cell of a volume and of each display entity.

    Attributes:
        classes: All fine classes; the first is ``EMPTY``.
        table: Fine class index for each palette entry and design, uint16 [P, D].
        states: Palette index of each cell in the volume, uint16 [N].
        designs: Design index of each cell, uint16 [N], or None without designs.
        of_thing: Fine class index of each display entity, uint16 [S].
    """

    classes: tuple[FineClass, ...]
    table: np.ndarray
    states: np.ndarray
    designs: np.ndarray | None
    of_thing: np.ndarray

    def of_cells(self, cells: np.ndarray) -> np.ndarray:
        """Return the fine class indices, uint16, of cells with the given flat indices."""
        design = 0 if self.designs is None else self.designs[cells]
        return self.table[self.states[cells], design]


def map_fine_classes(volume: BlockVolume, designs: Designs | None = None) -> FineClassMap:
    """Number the fine classes of a volume.

    A display entity gets the most frequent design among the blocks of its object.

    Args:
        volume: Volume of blocks.
        designs: Design index of each block (0 for none), and the names of the designs.

    Raises:
        ValueError: If the designs do not match the volume.
        UsageError: If there are more classes than a 16-bit index allows.
    """
    codes, names = _checked(volume, designs)
    blocks = [state.partition("[")[0] for state in volume.palette]
    pairs = _pairs_there(volume, codes, len(names))
    things = _things(volume, codes, names)
    found = {FineClass(blocks[row], names[design]) for row, design in pairs} | set(things)
    classes = (EMPTY, *sorted(found - {EMPTY}))
    if len(classes) > MAX_CLASSES:
        raise UsageError(
            f"the world has {len(classes):,} fine classes, the limit is {MAX_CLASSES:,}"
        )
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
        raise ValueError(
            f"designs must have the shape of the volume, {volume.states.shape}, got {codes.shape}"
        )
    if codes.size and int(codes.max()) >= len(names):
        raise ValueError(
            f"designs must contain indices below {len(names)}, the number of names; got "
            f"{codes.max()}"
        )
    return np.ascontiguousarray(codes).reshape(-1), ("", *names[1:])


def _pairs_there(volume: BlockVolume, codes: np.ndarray | None, count: int) -> np.ndarray:
    """Return the pairs of palette entry and design that occur in the volume, int64 [K, 2]."""
    states = volume.states.reshape(-1)
    if codes is None:
        rows = np.flatnonzero(np.bincount(states, minlength=1))
        return np.column_stack([rows, np.zeros_like(rows)])
    there = np.zeros(len(volume.palette) * count, bool)
    for first in range(0, len(states), 1 << 20):  # In parts, to save memory.
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
