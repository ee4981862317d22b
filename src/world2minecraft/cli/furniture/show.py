"""``w2m furniture show``: the facts about a piece, and a picture of it."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.furniture import Template

EXAMPLES = """\
w2m furniture show sofa
w2m furniture show bathtub -o bathtub.png
w2m furniture show bathtub --json
"""


def run(
    name: Annotated[str, typer.Argument(metavar="NAME", help="A name of `w2m furniture list`.")],
    picture: Annotated[
        Path | None,
        typer.Option("--out", "-o", "--picture", metavar="PNG", help="Draw it at three scales."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Show a piece's sizes, parameters, materials, and its blocks at 1, 2 and 4 per metre.

    Raises:
        UnknownNameError: there is none. OutputError: the picture cannot be written.
    """
    from world2minecraft.api.furniture import draw_furniture, furniture_json, furniture_piece

    one = furniture_piece(name)
    print(json.dumps(furniture_json(one), indent=1) if as_json else "\n".join(facts_of(one)))
    if picture is not None:
        draw_furniture(picture, [name], columns=1)
        if not as_json:
            print(f"\nDrawn to {picture}")


def facts_of(one: "Template") -> list[str]:
    """Return the facts about a piece, a line each."""
    from world2minecraft.api.furniture import SCALES, block_counts
    from world2minecraft.core.classes import display_name

    lines = [f"{one.name}: {one.title} ({display_name(one.class_id)}, family {one.family})"]
    for side, span in zip(("deep", "wide", "high"), one.size_m, strict=True):
        lines.append(f"  {span.minimum:g} to {span.maximum:g} m {side}, usually {span.typical:g}")
    lines.append(f"  mount {one.mount}, {one.turns} different quarter turns")
    free = " ".join(f"{side:g}" for side in one.clearance_m)
    lines.append(f"  free space in front, behind and beside: {free} m")
    lines += [f"  {name} {span.minimum:g} to {span.maximum:g}, usually {span.typical:g}"
              for name, span in one.parameters.items()]  # fmt: skip
    lines += [f"  {name}: {word}" for name, word in one.options.items()]
    for role, material in one.materials.items():
        taken = ", in the object's colour" if material.takes_colour else ""
        lines.append(f"  {role}: {material.kind} {material.value}{taken}")
    for scale in SCALES:
        counts = ", ".join(f"{count} {kind}" for kind, count in block_counts(one, scale).items())
        lines.append(f"  {scale:g} per metre: {counts or 'its shape, fitted'}")
    return lines
