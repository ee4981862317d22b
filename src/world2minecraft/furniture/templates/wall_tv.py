"""A flat screen on a wall."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import fill
from world2minecraft.furniture.shapes import slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)

THIN_BLOCKS = 0.5  # A screen under half a block deep would be a lump as a whole block.


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    return [slab("screen", depth, width, 0.0, height)]


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    if size.exact[0] < THIN_BLOCKS:
        panel = "minecraft:dark_oak_trapdoor[facing=east,half=bottom,open=true]"
        return fill(size._replace(depth=1), panel, "screen")
    return fill(size, "minecraft:black_concrete", "screen")


TEMPLATE = Template(
    name="wall_tv",
    class_id=SemanticClass.TVS,
    size_m=(Span(0.04, 0.1, 0.25), Span(0.45, 1.1, 2.2), Span(0.3, 0.65, 1.3)),
    build=_build,
    design=_design,
    mount="wall",
)
