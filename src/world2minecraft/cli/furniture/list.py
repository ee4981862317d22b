"""List the pieces of the furniture library: ``w2m furniture list``."""

import json
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.furniture import Template

EXAMPLES = """\
w2m furniture list                    list all pieces by class
w2m furniture list --class furniture  list one class
w2m furniture list --markdown         print the tables in docs/reference/furniture-library.md
w2m furniture list fridge --json      search names and titles, and print JSON
"""


def run(
    word: Annotated[str, typer.Argument(metavar="WORD", help="Part of a name or title.")] = "",
    kind: Annotated[
        str,
        typer.Option(
            "--class",
            help="chair, bed, sofa, table, television, furniture or object.",
            show_default="all",
        ),
    ] = "",
    as_markdown: Annotated[
        bool, typer.Option("--markdown", help="Print tables in Markdown.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the furniture of the library and your own furniture, with typical sizes.

    Raises:
        UnknownNameError: If the class is unknown.
    """
    from world2minecraft.api import furniture

    if as_markdown and as_json:
        raise UsageError("--markdown and --json exclude each other; omit one of them")
    found = furniture.list_furniture(word, class_name=kind)
    if as_markdown:
        print(furniture.furniture_markdown(found), end="")
        return
    if as_json:
        print(json.dumps([furniture.furniture_json(one) for one in found], indent=1))
        return
    for heading, members in furniture.by_heading(found).items():
        print(heading)
        for one in members:
            print(line_of(one, own=furniture.is_own(one)))
    matched = sum(one.matched for one in found)
    print(f"\n{len(found)} designs; objects are matched with the {matched} designs marked *.")


def line_of(one: "Template", own: bool) -> str:
    """Return a line about a piece: name, title, typical size, and a mark if objects match it."""
    size = " x ".join(f"{side:.2f}" for side in one.typical_m)
    mark = "*" if one.matched else " "
    return f"  {mark} {one.name:24s} {size} m  {one.title}{' (your own)' if own else ''}"
