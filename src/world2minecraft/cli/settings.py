"""List the keys of ``--set`` with their units, defaults and meanings: ``w2m settings``."""

import json
import shutil
import textwrap
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.core.parameters import ParameterInfo

EXAMPLES = """\
w2m settings                      list all keys
w2m settings find                 list the keys that start with find.
w2m settings fuse --json          print them as JSON
"""
INDENT = "    "
MAX_WIDTH = 100


def run(
    prefix: Annotated[
        str | None, typer.Argument(help="A group such as find, or a single key.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON list.")] = False,
) -> None:
    """List the keys of --set.

    Each key is followed by its default, its unit and its meaning. Change a value with --set
    KEY=VALUE. Keys that start with capture. are options of the capture reader, which are described
    in the documentation of each format.

    Args:
        prefix: Group or key to list. None lists all keys.
        as_json: Print a JSON list instead of text.

    Raises:
        UnknownNameError: If no key starts with ``prefix``. The message suggests the closest match.
    """
    from world2minecraft.api import settings

    found = settings(prefix)
    if as_json:
        print(json.dumps([vars(one) for one in found], indent=2))
        return
    width = min(MAX_WIDTH, shutil.get_terminal_size().columns)
    for one in found:
        print("\n".join(format_setting(one, width)))


def format_setting(setting: "ParameterInfo", width: int) -> Iterator[str]:
    """Yield the lines about a setting: ``key = default unit``, then the indented meaning.

    Example:
        >>> from world2minecraft.core.parameters import ParameterInfo
        >>> info = ParameterInfo("clean.hole_m", 0.2, "m", "holes up to this width are closed", "")
        >>> list(format_setting(info, 80))
        ['clean.hole_m = 0.2 m', '    Holes up to this width are closed.']
    """
    yield " ".join(filter(None, (f"{setting.key} = {_plain(setting.default)}", setting.unit)))
    meaning = setting.meaning[:1].upper() + setting.meaning[1:] + "."
    yield from textwrap.wrap(
        meaning.replace("``", ""), width, initial_indent=INDENT, subsequent_indent=INDENT
    )


def _plain(default: object) -> str:
    if isinstance(default, bool):
        return "yes" if default else "no"
    return "(none)" if default in ("", None) else str(default)
