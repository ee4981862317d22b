"""Show the properties of a piece of furniture, and draw it: ``w2m furniture show``."""

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
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Name listed by `w2m furniture list`.")
    ],
    picture: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", "--picture", metavar="PNG", help="Draw the piece at three scales."
        ),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Show the sizes, parameters, materials and block counts of a piece at 1, 2 and 4 per metre.

    Raises:
        UnknownNameError: If the piece is unknown.
        OutputError: If the image cannot be written.
    """
    from world2minecraft.api.furniture import draw_furniture, furniture_json, furniture_piece

    one = furniture_piece(name)
    print(json.dumps(furniture_json(one), indent=1) if as_json else "\n".join(facts_of(one)))
    if picture is not None:
        draw_furniture(picture, [name], columns=1)
        if not as_json:
            print(f"\nImage written to {picture}")


def facts_of(one: "Template") -> list[str]:
    """Return the properties of a piece, one per line."""
    from world2minecraft.api.furniture import SCALES, block_counts
    from world2minecraft.core.classes import display_name

    lines = [f"{one.name}: {one.title} ({display_name(one.class_id)}, family {one.family})"]
    for side, span in zip(("deep", "wide", "high"), one.size_m, strict=True):
        lines.append(f"  {span.minimum:g} to {span.maximum:g} m {side}, typically {span.typical:g}")
    lines.append(f"  mount {one.mount}, {one.turns} distinct quarter turns")
    free = " ".join(f"{side:g}" for side in one.clearance_m)
    lines.append(f"  required free space in front, behind and at the sides: {free} m")
    lines += [f"  {name} {span.minimum:g} to {span.maximum:g}, typically {span.typical:g}"
              for name, span in one.parameters.items()]  # fmt: skip
    lines += [f"  {name}: {word}" for name, word in one.options.items()]
    for role, material in one.materials.items():
        taken = ", in the object's colour" if material.takes_colour else ""
        lines.append(f"  {role}: {material.kind} {material.value}{taken}")
    for scale in SCALES:
        counts = ", ".join(f"{count} {kind}" for kind, count in block_counts(one, scale).items())
        lines.append(f"  {scale:g} per metre: {counts or 'fitted shape'}")
    return lines
