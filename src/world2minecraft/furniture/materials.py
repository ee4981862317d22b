"""Materials of furniture roles, and their vanilla blocks in each shape.

``data/materials.json`` contains the kinds wood, cloth, paint, glass, stone and metal, each with its
values (oak, red, smooth_quartz) and the block of every shape. ``plain`` stands for any full block
of the right colour, ``fixed`` for one particular block. Shapes that do not exist in the game are
omitted.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from world2minecraft.minecraft.block_states import known_blocks

PLAIN, FIXED = "plain", "fixed"
PLAIN_KINDS = ("paint", "stone", "wood")
# Woods whose trapdoors have holes, and the wood of the nearest one without.
HOLED_TRAPDOORS = {"oak": "spruce", "jungle": "spruce", "acacia": "mangrove", "cherry": "birch"}


class Swatch(NamedTuple):
    """A material that a role may have, and the block that shows its colour."""

    kind: str
    value: str
    sample: str


class Kind(NamedTuple):
    """A kind of material: its values, the block of each shape, and the blocks chosen by colour."""

    blocks: Mapping[str, Mapping[str, str]]  # value -> shape -> block
    chosen: tuple[str, ...]


@dataclass(frozen=True)
class Material:
    """The material of a role.

    kind: A kind of ``kinds()``, ``plain`` or ``fixed``.
    value: Value of the kind, or the name of the full block for ``plain`` and ``fixed``.
    takes_colour: Whether to use the value of the kind that best matches the real object's colour. A
    ``fixed`` material is replaced by plain blocks if the object's colour is very different.
    shapes: Blocks of a ``fixed`` material by shape, besides its full block.
    """

    kind: str
    value: str
    takes_colour: bool = False
    shapes: tuple[tuple[str, str], ...] = ()

    def __post_init__(self):
        if self.kind in (PLAIN, FIXED):
            for name in (self.value, *(block for _, block in self.shapes)):
                if f"minecraft:{name}" not in known_blocks():
                    raise ValueError(f"unknown block {name!r}")
        elif self.kind not in kinds():
            known = ", ".join((*kinds(), PLAIN, FIXED))
            raise ValueError(f"unknown kind of material {self.kind!r}; kinds: {known}")
        elif self.value not in kinds()[self.kind].blocks:
            known = ", ".join(kinds()[self.kind].blocks)
            raise ValueError(f"unknown {self.kind} {self.value!r}; known: {known}")

    def block(self, shape: str) -> str | None:
        """Return the block name for a shape, such as ``minecraft:oak_slab``, or None."""
        if self.kind == FIXED:
            name = dict(self.shapes).get(shape, self.value if shape == "full" else None)
            return name and f"minecraft:{name}"
        if self.kind != PLAIN:
            return kinds()[self.kind].blocks[self.value].get(shape)
        whole = f"minecraft:{self.value}"
        found = [place for place in block_uses(whole) if place.shape == "full"]
        if shape == "full":
            return whole
        held = (kinds()[place.kind].blocks[place.value].get(shape) for place in found)
        return next((block for block in held if block), None)


class BlockUse(NamedTuple):
    """The position of a block in the table of materials."""

    kind: str
    value: str
    shape: str


@cache
def kinds() -> Mapping[str, Kind]:
    """Return the kinds of materials in ``data/materials.json``, restricted to existing blocks."""
    source = files("world2minecraft.furniture") / "data" / "materials.json"
    return {name: _kind(raw) for name, raw in json.loads(source.read_text("utf-8")).items()}


def _kind(raw: Mapping) -> Kind:
    known = set(known_blocks())
    blocks = {}
    for value, own in raw["values"].items():
        names = {shape: pattern.format(value) for shape, pattern in raw["names"].items()} | own
        named = {shape: f"minecraft:{name}" for shape, name in names.items()}
        blocks[value] = {shape: name for shape, name in named.items() if name in known}
    return Kind(blocks, tuple(raw.get("chosen", blocks)))


@cache
def block_uses(block: str) -> tuple[BlockUse, ...]:
    """Return every position of a block, such as ``minecraft:oak_slab``, in the table."""
    return tuple(
        BlockUse(name, value, shape)
        for name, kind in kinds().items()
        for value, shapes in kind.blocks.items()
        for shape, held in shapes.items()
        if held == block
    )


@cache
def list_swatches(kind: str, shapes: frozenset[str]) -> tuple[Swatch, ...]:
    """Return the materials of a kind that have all of the given shapes.

    ``plain`` includes the materials of three kinds.
    """
    names = PLAIN_KINDS if kind == PLAIN else (kind,) if kind in kinds() else ()
    return tuple(
        Swatch(name, value, kinds()[name].blocks[value]["full"])
        for name in names
        for value in kinds()[name].chosen
        if shapes <= set(kinds()[name].blocks[value])
    )


def shape_of(state: str, kind: str) -> str | None:
    """Return the shape of a block state within a kind, or None if the kind has no such block."""
    names = PLAIN_KINDS if kind == PLAIN else (kind,)
    block = state.partition("[")[0]
    return next((place.shape for place in block_uses(block) if place.kind in names), None)


def with_swatch(state: str, shape: str, swatch: Swatch) -> str:
    """Return a block state in another material, with its shape and properties unchanged."""
    _, bracket, properties = state.partition("[")
    return f"{kinds()[swatch.kind].blocks[swatch.value][shape]}{bracket}{properties}"


def without_holes(state: str) -> str:
    """Return a block state, with a trapdoor without holes in place of one with holes."""
    name, bracket, properties = state.partition("[")
    wood = name.removeprefix("minecraft:").removesuffix("_trapdoor")
    if not name.endswith("_trapdoor") or wood not in HOLED_TRAPDOORS:
        return state
    return f"minecraft:{HOLED_TRAPDOORS[wood]}_trapdoor{bracket}{properties}"
