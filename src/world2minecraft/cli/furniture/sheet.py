"""``w2m furniture sheet``: a picture of all furniture at 1, 2 and 4 blocks per metre."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.furniture import Template
    from world2minecraft.rendering.furniture_sheet import Card

EXAMPLES = """\
w2m furniture sheet --out furniture.png
w2m furniture sheet --class objs --out small_things.png
w2m furniture sheet sofa corner_sofa --out sofas.png
"""
SCALES = (1.0, 2.0, 4.0)


def run(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME]...", help="Which; all if none is said.")
    ] = None,
    out: Annotated[Path, typer.Option("--out", metavar="PNG", help="The picture to write.")] = Path(
        "furniture.png"
    ),
    kind: Annotated[
        str, typer.Option("--class", help="chair, bed, sofa, table, tvs, furn or objs.")
    ] = "",
) -> None:
    """Draw the furniture of the library and of your own, by class, at its usual sizes.

    Args:
        names: which pieces.
        out: where to draw.
        kind: one class; empty for all.

    Raises:
        UnknownNameError: there is no such piece or class. OutputError: it cannot be written.
    """
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.core.classes import class_id
    from world2minecraft.furniture import TEMPLATES, template

    number = class_id(kind) if kind else None
    every = [template(name) for name in (names or TEMPLATES.names())]
    chosen = [one for one in every if number in (None, one.class_id)]
    print_compile_note()
    draw(chosen, out)
    print(f"{out}: {len(chosen)} designs")


def draw(templates: Sequence["Template"], out: Path, columns: int = 4) -> None:
    """Draw templates by class and write the picture as a PNG.

    Raises:
        UsageError: there is nothing to draw. OutputError: it cannot be written.
    """
    from world2minecraft.core.errors import UsageError
    from world2minecraft.core.files import write_bytes
    from world2minecraft.furniture.library import group_by_class
    from world2minecraft.rendering.furniture_sheet import contact_sheet, sheet_png

    found = group_by_class(templates).items()
    groups = {
        heading: [card for one in members for card in _card(one)] for heading, members in found
    }
    if not any(groups.values()):
        raise UsageError("nothing of these has blocks at 1, 2 or 4 a metre, so nothing is drawn")
    write_bytes(out, sheet_png(contact_sheet(groups, columns)))


def _card(one: "Template") -> list["Card"]:
    from world2minecraft.furniture.preview_scene import preview_volume
    from world2minecraft.rendering.furniture_sheet import Card

    volumes = {f"{scale:g} a metre": preview_volume(one, scale, room=False) for scale in SCALES}
    drawn = {label: volume for label, volume in volumes.items() if volume is not None}
    size = " x ".join(f"{side:.2f}" for side in one.typical_m)
    return [Card(one.title, f"{one.name}   {size} m", drawn)] if drawn else []
