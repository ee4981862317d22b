"""Common definitions of options: help sections, short forms and defaults.

An option is listed under "Options", or under "More options" if it is declared with
``rich_help_panel=MORE``. The first help section, with usage and examples, fits in ``FIRST_LINES``
lines.

Typer shows a default as ``[default: X]``. If the default is None but stands for a value, name that
value with ``typer.Option(..., show_default="vanilla")``. The help text itself never names the
default.
"""

from pathlib import Path
from typing import Annotated, Any

import typer

MORE = "More options"
FIRST_LINES = 50


def more_option(*names: str, help: str, **facts: Any) -> Any:
    """Return an option in the section "More options".

    Args:
        *names: Names of the option, such as ``--seed``.
        help: One sentence for the help.
        **facts: Further arguments of ``typer.Option``.
    """
    return typer.Option(*names, help=help, rich_help_panel=MORE, **facts)


def option(*names: str, text: str, more: bool = False, **facts: Any) -> Any:
    """Return an option, in the section "More options" if ``more`` is set.

    Args:
        *names: Names of the option, such as ``--seed``.
        text: One sentence for the help.
        more: Whether the option is in the section "More options".
        **facts: Further arguments of ``typer.Option``.
    """
    return (more_option if more else typer.Option)(*names, help=text, **facts)


def out_option(help: str, *names: str, **facts: Any) -> Any:
    """Return the option ``--out`` with its short form ``-o``.

    Args:
        help: One sentence for the help, such as "Write the image to this file.".
        *names: Further names of the option.
        **facts: Further arguments of ``typer.Option``.

    Example:
        >>> Picture = Annotated[Path, out_option("Write the image to this file.")]
    """
    return typer.Option("--out", "-o", *names, help=help, **facts)


Force = Annotated[
    bool, more_option("--force", help="Write into a folder that contains other files.")
]
OutFolder = Annotated[Path, out_option("Write the results to this folder.")]
OutFile = Annotated[Path, out_option("Write the result to this file.")]
