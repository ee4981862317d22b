"""A plant in a pot."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.shapes import column, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    pot = height * p["pot_share"]
    crown = pot + 0.15 * height
    return [
        slab("pot", 0.6 * depth, 0.6 * width, 0.0, pot),
        column("stem", min(0.06, depth, width), pot, crown),
        slab("leaves", depth, width, crown, height),
    ]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    if size.height == 1:
        return [LocalBlock((0, 0, 0), "minecraft:potted_fern", "leaves")]
    leaves = "minecraft:azalea_leaves[distance=7,persistent=true,waterlogged=false]"
    crown = [LocalBlock((0, 0, k), leaves, "leaves") for k in range(1, size.height)]
    return [LocalBlock((0, 0, 0), "minecraft:terracotta", "pot"), *crown]


TEMPLATE = Template(
    name="plant",
    class_id=SemanticClass.OBJS,
    size_m=(Span(0.28, 0.45, 1.0), Span(0.28, 0.45, 1.0), Span(0.5, 0.9, 2.0)),
    build=_build,
    design=_design,
    parameters={"pot_share": Span(0.15, 0.3, 0.45)},
    turns=1,
    mount="any",
)
