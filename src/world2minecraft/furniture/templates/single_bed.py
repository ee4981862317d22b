"""A bed for one."""

from world2minecraft.classes import SemanticClass
from world2minecraft.furniture.designs import bed
from world2minecraft.furniture.shapes import backrest, part, slab
from world2minecraft.furniture.template import (
    BlockSize,
    LocalBlock,
    Parameters,
    Part,
    Span,
    Template,
)


def _build(depth: float, width: float, height: float, p: Parameters) -> list[Part]:
    top = min(p["mattress_height"], max(height - 0.1, height / 2))
    parts = [
        slab("mattress", depth, width, 0.0, top),
        backrest(depth, width, top, height, 0.08),
    ]
    across = (-width / 3, width / 3)
    parts.append(part("pillow", (0.08 - depth / 2, 0.45 - depth / 2), across, (top, top + 0.1)))
    return parts


def _design(size: BlockSize, p: Parameters) -> list[LocalBlock]:
    panel = "minecraft:spruce_trapdoor[facing=east,half=bottom,open=true]"
    blocks = bed(size, "blue")
    if size.depth > 2:
        rows = range(size.width)
        blocks += [
            LocalBlock((0, j, k), panel, "back") for k in range(1, size.height) for j in rows
        ]
    return blocks


TEMPLATE = Template(
    name="single_bed",
    class_id=SemanticClass.BED,
    size_m=(Span(1.7, 2.05, 2.35), Span(0.75, 0.95, 1.25), Span(0.4, 0.8, 1.3)),
    build=_build,
    design=_design,
    parameters={"mattress_height": Span(0.3, 0.5, 0.7)},
)
