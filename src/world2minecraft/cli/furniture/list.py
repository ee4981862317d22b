"""``w2m furniture list``: what the library holds."""

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.furniture import Template

EXAMPLES = """\
w2m furniture list                    all, by class
w2m furniture list --class furn       one class
w2m furniture list --markdown         the tables of docs/furniture-library.md
w2m furniture list fridge             those whose name or title has this word
"""


def run(
    word: Annotated[str, typer.Argument(metavar="WORD", help="Part of a name or title.")] = "",
    kind: Annotated[
        str, typer.Option("--class", help="chair, bed, sofa, table, tvs, furn or objs.")
    ] = "",
    as_markdown: Annotated[bool, typer.Option("--markdown", help="As tables in Markdown.")] = False,
) -> None:
    """List the furniture of the library and of your own, with its usual sizes.

    Args:
        word: part of a name or title; empty for all.
        kind: one class; empty for all.
        as_markdown: whether to print tables in Markdown.

    Raises:
        UnknownNameError: there is no such class.
    """
    from world2minecraft.core.classes import class_id
    from world2minecraft.furniture import TEMPLATES, template
    from world2minecraft.furniture.library import group_by_class, templates_to_markdown
    from world2minecraft.furniture.user_library import user_design_files

    number = class_id(kind) if kind else None
    every = [template(name) for name in TEMPLATES.names()]
    found = [one for one in every if _matches(one, word, number)]
    if as_markdown:
        print(templates_to_markdown(found), end="")
        return
    own = user_design_files()
    for heading, members in group_by_class(found).items():
        print(heading)
        for one in members:
            print(line_of(one, own=one.name in own))
    matched = sum(one.matched for one in found)
    print(f"\n{len(found)} designs; * {matched} that objects are matched against.")


def _matches(one: "Template", word: str, class_number: int | None) -> bool:
    text = f"{one.name} {one.title} {one.family}".lower()
    return word.lower() in text and class_number in (None, one.class_id)


def line_of(one: "Template", own: bool) -> str:
    """Return a template's line: its name, title, usual size, and whether it is matched."""
    size = " x ".join(f"{side:.2f}" for side in one.typical_m)
    mark = "*" if one.matched else " "
    return f"  {mark} {one.name:24s} {size} m  {one.title}{' (your own)' if own else ''}"
