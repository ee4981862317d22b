"""The shapes that a fit may choose from, and how much of each sub-cell of a block they fill.

A shape is a kind of block and the properties that turn it: ``stairs[facing=east,half=top]``. Which
block of that kind it becomes is a matter of colour and palette, decided later. A block has ``SUB``
sub-cells along each axis. The visual shape counts, not the collision shape. The boxes of a state
are in block axes (y up); masks are ``[x, y, z]`` with z up, like every array of a room.
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
    """Return which of ``PROBES``^3 cells of its block a state fills, bool, room axes, read-only.

    Raises:
        UsageError: the text is no block state.
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

    The first axis is the face's own (x, y, z), the second its low or high side; the others are
    the two remaining axes in order.
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
    """A kind of block, and its properties but for those that all of the kind share."""

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
        """A state that has this shape."""
        return self.of(SAMPLES[self.kind])


def _shape_in(state: str, kind: str, keys: Sequence[str]) -> Shape:
    held = dict(pair.split("=") for pair in state.partition("[")[2].rstrip("]").split(",") if pair)
    if held.get("open") == "false":
        held["facing"] = "east"  # A flat trapdoor is the same whichever way it faces.
    return Shape(kind, tuple((key, held[key]) for key in keys))


def rotate_shape(shape: Shape, quarter_turns: int) -> Shape:
    """Return a shape turned counter-clockwise from above."""
    keys = [key for key, _ in shape.properties]
    return _shape_in(turn_state(shape.sample, quarter_turns), shape.kind, keys)


def mirror_shape(shape: Shape, axis: Literal["x", "y"]) -> Shape:
    """Return a shape mirrored along a room axis: ``y`` swaps north and south."""
    keys = [key for key, _ in shape.properties]
    along: Literal["x", "z"] = "x" if axis == "x" else "z"
    return _shape_in(mirror_state(shape.sample, along), shape.kind, keys)


@dataclass(frozen=True, eq=False)
class ShapeSet:
    """Shapes by number; 0 is the empty block, ``shapes[n - 1]`` is number n.

    Numbers from ``free`` on are stair corners: nothing chooses them, neighbours make them.
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
        """float32 [S, 512]: the filled share of each sub-cell."""
        rows = [
            np.zeros(512, np.float32),
            *(subcell_mask(one.sample).ravel() for one in self.shapes),
        ]
        return np.stack(rows)

    @cached_property
    def volumes(self) -> np.ndarray:
        """float32 [S]: filled sub-cells of 512."""
        return self.masks.sum(1)

    @cached_property
    def faces(self) -> np.ndarray:
        """Bool [S, 3, 2, 8, 8]: which parts of its block's faces a shape touches."""
        none = np.zeros((3, 2, 8, 8), bool)
        return np.stack([none, *(contact_faces(one.sample) for one in self.shapes)])

    @cached_property
    def prices(self) -> np.ndarray:
        """float32 [S]: what a shape costs, in sub-cells."""
        return np.array([0.0, *(PRICES[one.kind] for one in self.shapes)], np.float32)

    @cached_property
    def kinds(self) -> np.ndarray:
        """Str [S]: the kind of each, ``empty`` for number 0."""
        return np.array(["empty", *(one.kind for one in self.shapes)])

    @cached_property
    def turns(self) -> np.ndarray:
        """Intp [4, S]: the number of each shape after so many quarter turns."""
        rows = [
            [0, *(self.number_of(rotate_shape(one, k)) for one in self.shapes)] for k in range(4)
        ]
        return np.array(rows, np.intp)

    @cached_property
    def mirrors(self) -> np.ndarray:
        """Intp [2, S]: the number of each shape mirrored along x, and along y."""
        rows = [
            [0, *(self.number_of(mirror_shape(one, axis)) for one in self.shapes)]
            for axis in ("x", "y")
        ]
        return np.array(rows, np.intp)

    @cached_property
    def is_low(self) -> np.ndarray:
        """Bool [S]: which shapes are flat and end below the top of their block."""
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
        """Bool [S]: which shapes are upright panels."""
        return np.array([False, *(("open", "true") in one.properties for one in self.shapes)])

    @cached_property
    def stairs(self) -> np.ndarray:
        """int16 [S]: for stairs 2 * facing + (half is top), facing as SIDES; else -1."""
        rows = np.full(len(self), -1, np.int16)
        for number, one in enumerate(self.shapes, 1):
            if one.kind == "stairs":
                held = dict(one.properties)
                rows[number] = 2 * SIDES.index(held["facing"]) + (held["half"] == "top")
        return rows

    @cached_property
    def corners(self) -> np.ndarray:
        """Intp [8, 5]: the number of stairs of each facing and half that are straight or corners.

        Columns: straight, inner_left, inner_right, outer_left, outer_right.
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
    """Return the set of the shapes of some kinds, always with the full block.

    Raises:
        KeyError: a kind is none of ``SAMPLES``.
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
