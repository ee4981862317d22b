"""The block shapes that a fit may use, and the share of each sub-cell that they fill.

A shape is a kind of block and the properties that orient it, such as
``stairs[facing=east,half=top]``. The block of this kind is chosen later by colour and palette. A
block has ``SUB`` sub-cells along each axis. Shapes are defined by visual geometry, not by
collision. The boxes of a state are in block axes (y up); masks are ``[x, y, z]`` with z up, as all
arrays of a room.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import Literal

import numpy as np

from world2minecraft.core.coordinates import block_axes_to_grid
from world2minecraft.minecraft.turn_and_mirror import mirror_state, turn_state
from world2minecraft.minecraft.visual_shapes import visual_boxes

SUB = 8  # Finer masks gained 0.003 to 0.013 of IoU for three times the time (reference/fit.md).
PROBES = 32  # Along each axis: every box of the game's that matters lies on 32nds.
SIDES = ("east", "north", "west", "south")  # Counter-clockwise.
CORNERS = ("inner_left", "inner_right", "outer_left", "outer_right")
# A block of each kind, which says what the kind looks like.
SAMPLES = {
    "full": "minecraft:oak_planks",
    "slab": "minecraft:oak_slab",
    "stairs": "minecraft:oak_stairs",
    "trapdoor": "minecraft:oak_trapdoor",
    "carpet": "minecraft:white_carpet",
    "post": "minecraft:oak_fence",
}
DRY = {"slab", "stairs", "trapdoor", "post"}  # What states whether it stands in water.
# Of two shapes that fit alike the commoner is taken; in sub-cells of 512. A carpet is the colour
# of cloth alone and needs what it lies on; an open trapdoor can be clicked shut.
PRICES = {"full": 0.0, "slab": 2.0, "stairs": 6.0, "trapdoor": 4.0, "carpet": 2.0, "post": 4.0}
CALM = frozenset(("full", "slab", "stairs", "trapdoor"))


@lru_cache(maxsize=1 << 14)
def probe_state(state: str) -> np.ndarray:
    """Return which of the ``PROBES``^3 cells of its block a state fills, as a read-only bool mask.

    The mask is in room axes.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    solid = np.zeros((PROBES,) * 3, bool)
    for box in np.clip(visual_boxes(state), 0, 1):
        low = np.ceil(box[:3] * PROBES - 0.5).astype(int)
        high = np.ceil(box[3:] * PROBES - 0.5).astype(int)
        solid[tuple(map(slice, low, high))] = True
    solid = block_axes_to_grid(solid)
    solid.flags.writeable = False
    return solid


@lru_cache(maxsize=1 << 14)
def subcell_mask(state: str) -> np.ndarray:
    """Return the filled share of each sub-cell of a state, float32 [8, 8, 8], read-only.

    Example:
        >>> float(subcell_mask("minecraft:oak_slab[type=bottom]").mean())
        0.5
        >>> float(subcell_mask("minecraft:oak_slab[type=bottom]")[:, :, 0].mean())
        1.0
    """
    step = PROBES // SUB
    mask = probe_state(state).reshape(SUB, step, SUB, step, SUB, step).mean((1, 3, 5))
    mask = mask.astype(np.float32)
    mask.flags.writeable = False
    return mask


@lru_cache(maxsize=1 << 14)
def contact_faces(state: str) -> np.ndarray:
    """Return which parts of a block's faces a state touches, bool [3, 2, 8, 8], read-only.

    The first axis is the axis of the face normal (x, y, z), the second its low or high side. The
    others are the two remaining axes in order.
    """
    solid, step = probe_state(state), PROBES // SUB
    faces = np.zeros((3, 2, SUB, SUB), bool)
    for axis in range(3):
        for side in (0, 1):
            plane = np.take(solid, -side, axis)
            faces[axis, side] = plane.reshape(SUB, step, SUB, step).any((1, 3))
    faces.flags.writeable = False
    return faces


@dataclass(frozen=True, order=True)
class Shape:
    """A kind of block with the properties that distinguish its shape from others of that kind."""

    kind: str
    properties: tuple[tuple[str, str], ...] = ()

    def of(self, block: str) -> str:
        """Return the state of a block of this kind that has this shape.

        Example:
            >>> Shape("slab", (("type", "top"),)).of("minecraft:oak_slab")
            'minecraft:oak_slab[type=top,waterlogged=false]'
        """
        held = dict(self.properties)
        if self.kind == "trapdoor":
            held |= {"powered": "false"}
        if self.kind == "post":
            held |= dict.fromkeys(SIDES, "false")
        if self.kind in DRY:
            held |= {"waterlogged": "false"}
        stated = ",".join(f"{key}={held[key]}" for key in sorted(held))
        return f"{block}[{stated}]" if stated else block

    @property
    def sample(self) -> str:
        """An example block state that has this shape."""
        return self.of(SAMPLES[self.kind])


def _shape_in(state: str, kind: str, keys: Sequence[str]) -> Shape:
    held = dict(pair.split("=") for pair in state.partition("[")[2].rstrip("]").split(",") if pair)
    if held.get("open") == "false":
        held["facing"] = "east"  # A flat trapdoor is the same whichever way it faces.
    return Shape(kind, tuple((key, held[key]) for key in keys))


def rotate_shape(shape: Shape, quarter_turns: int) -> Shape:
    """Return a shape rotated by quarter turns, counter-clockwise from above."""
    keys = [key for key, _ in shape.properties]
    return _shape_in(turn_state(shape.sample, quarter_turns), shape.kind, keys)


def mirror_shape(shape: Shape, axis: Literal["x", "y"]) -> Shape:
    """Return a shape mirrored along a room axis; ``y`` swaps north and south."""
    keys = [key for key, _ in shape.properties]
    along: Literal["x", "z"] = "x" if axis == "x" else "z"
    return _shape_in(mirror_state(shape.sample, along), shape.kind, keys)


@dataclass(frozen=True, eq=False)
class ShapeSet:
    """A numbered set of shapes: 0 is the empty block, number n is ``shapes[n - 1]``.

    Numbers from ``free`` on are stair corners, which are never chosen but result from neighbours.
    """

    shapes: tuple[Shape, ...]
    free: int

    def __len__(self) -> int:
        return len(self.shapes) + 1

    def number_of(self, shape: Shape) -> int:
        """Return the number of a shape of the set."""
        return self.shapes.index(shape) + 1

    @cached_property
    def masks(self) -> np.ndarray:
        """The filled share of each sub-cell of each shape, float32 [S, 512]."""
        rows = [
            np.zeros(512, np.float32),
            *(subcell_mask(one.sample).ravel() for one in self.shapes),
        ]
        return np.stack(rows)

    @cached_property
    def volumes(self) -> np.ndarray:
        """The number of filled sub-cells of each shape, of 512, float32 [S]."""
        return self.masks.sum(1)

    @cached_property
    def faces(self) -> np.ndarray:
        """Bool [S, 3, 2, 8, 8]: the parts of the block faces that each shape touches."""
        none = np.zeros((3, 2, 8, 8), bool)
        return np.stack([none, *(contact_faces(one.sample) for one in self.shapes)])

    @cached_property
    def prices(self) -> np.ndarray:
        """The cost of each shape in sub-cells, float32 [S]."""
        return np.array([0.0, *(PRICES[one.kind] for one in self.shapes)], np.float32)

    @cached_property
    def kinds(self) -> np.ndarray:
        """The kind of each shape, str [S]; number 0 is ``empty``."""
        return np.array(["empty", *(one.kind for one in self.shapes)])

    @cached_property
    def turns(self) -> np.ndarray:
        """The number of each shape after 0 to 3 quarter turns, intp [4, S]."""
        rows = [
            [0, *(self.number_of(rotate_shape(one, k)) for one in self.shapes)] for k in range(4)
        ]
        return np.array(rows, np.intp)

    @cached_property
    def mirrors(self) -> np.ndarray:
        """The number of each shape mirrored along x and along y, intp [2, S]."""
        rows = [
            [0, *(self.number_of(mirror_shape(one, axis)) for one in self.shapes)]
            for axis in ("x", "y")
        ]
        return np.array(rows, np.intp)

    @cached_property
    def is_low(self) -> np.ndarray:
        """Bool [S]: whether a shape is flat and ends below the top of its block."""
        low = [("type", "bottom"), ("half", "bottom")]
        rows = [
            one.kind == "carpet"
            or (one.kind == "slab" and low[0] in one.properties)
            or (one.kind == "trapdoor" and {low[1], ("open", "false")} <= set(one.properties))
            for one in self.shapes
        ]
        return np.array([False, *rows])

    @cached_property
    def is_upright(self) -> np.ndarray:
        """Bool [S]: whether a shape is an upright panel."""
        return np.array([False, *(("open", "true") in one.properties for one in self.shapes)])

    @cached_property
    def stairs(self) -> np.ndarray:
        """The code ``2 * facing + (half is top)`` of stairs shapes, -1 for others, int16 [S]."""
        rows = np.full(len(self), -1, np.int16)
        for number, one in enumerate(self.shapes, 1):
            if one.kind == "stairs":
                held = dict(one.properties)
                rows[number] = 2 * SIDES.index(held["facing"]) + (held["half"] == "top")
        return rows

    @cached_property
    def corners(self) -> np.ndarray:
        """The numbers of the straight and corner stairs of each facing and half, intp [8, 5].

        The columns are straight, inner_left, inner_right, outer_left and outer_right.
        """
        table = np.zeros((8, 5), np.intp)
        for number, one in enumerate(self.shapes, 1):
            if one.kind == "stairs":
                shape = dict(one.properties)["shape"]
                table[self.stairs[number], ("straight", *CORNERS).index(shape)] = number
        return table


def _stairs(shape: str) -> list[Shape]:
    return [
        Shape("stairs", (("facing", side), ("half", half), ("shape", shape)))
        for half in ("bottom", "top")
        for side in SIDES
    ]


def _trapdoors() -> list[Shape]:
    flat = [("east", half, "false") for half in ("bottom", "top")]
    upright = [(side, "bottom", "true") for side in SIDES]
    return [
        Shape("trapdoor", (("facing", side), ("half", half), ("open", is_open)))
        for side, half, is_open in (*flat, *upright)
    ]


@cache
def shape_set(kinds: frozenset[str]) -> ShapeSet:
    """Return the set of all shapes of the given kinds; the full block is always included.

    Raises:
        KeyError: If a kind is not in ``SAMPLES``.
    """
    chosen: list[Shape] = [Shape("full")]
    makers = {
        "slab": [Shape("slab", (("type", kind),)) for kind in ("bottom", "top")],
        "stairs": _stairs("straight"),
        "trapdoor": _trapdoors(),
        "carpet": [Shape("carpet")],
        "post": [Shape("post")],
    }
    for kind in sorted(kinds - {"full"}):
        chosen += makers[kind]
    free = len(chosen) + 1
    if "stairs" in kinds:
        chosen += [one for corner in CORNERS for one in _stairs(corner)]
    return ShapeSet(tuple(chosen), free)
