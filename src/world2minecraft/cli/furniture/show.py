"""``w2m furniture show``: all that is known of a piece, and a picture of it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.furniture import Template

EXAMPLES = """\
w2m furniture show sofa
w2m furniture show bathtub --picture bathtub.png
"""


def run(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A name of `w2m furniture list`.")],
    picture: Annotated[
        Path | None, typer.Option("--picture", metavar="PNG", help="Draw it at three scales.")
    ] = None,
) -> None:
    """Show a piece's sizes, parameters, materials, and its blocks at 1, 2 and 4 per metre.

    Args:
        name: which.
        picture: where to draw it.

    Raises:
        UnknownNameError: there is none. OutputError: the picture cannot be written.
    """
    from world2minecraft.furniture import template

    one = template(name)
    print("\n".join(facts_of(one)))
    if picture is not None:
        from world2minecraft.cli.furniture.sheet import draw

        draw([one], picture, columns=1)
        print(f"\nDrawn to {picture}")


def facts_of(one: "Template") -> list[str]:
    """Return what is known of a template, a line each."""
    from world2minecraft.core.classes import CLASS_NAMES

    lines = [f"{one.name}: {one.title} ({CLASS_NAMES[one.class_id]}, family {one.family})"]
    for side, span in zip(("deep", "wide", "high"), one.size_m, strict=True):
        lines.append(f"  {span.minimum:g} to {span.maximum:g} m {side}, usually {span.typical:g}")
    lines.append(f"  mount {one.mount}, {one.turns} different quarter turns")
    free = " ".join(f"{side:g}" for side in one.clearance_m)
    lines.append(f"  room before, behind and beside it: {free} m")
    lines += [f"  {name} {span.minimum:g} to {span.maximum:g}, usually {span.typical:g}"
              for name, span in one.parameters.items()]  # fmt: skip
    lines += [f"  {name}: {word}" for name, word in one.options.items()]
    for role, material in one.materials.items():
        taken = ", in the object's colour" if material.takes_colour else ""
        lines.append(f"  {role}: {material.kind} {material.value}{taken}")
    return [*lines, *_blocks_of(one)]


def _blocks_of(one: "Template") -> list[str]:
    from collections import Counter

    import numpy as np

    from world2minecraft.furniture.block_designs import block_size

    lines = []
    for scale in (1.0, 2.0, 4.0):
        blocks = one.blocks(block_size(np.array(one.typical_m), scale))
        kinds = Counter(block.state.partition("[")[0].rpartition(":")[2] for block in blocks)
        told = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        lines.append(f"  at {scale:g} a metre: {told or 'its shape, fitted'}")
    return lines
