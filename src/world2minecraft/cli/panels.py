"""Declare options alike in all verbs: their section of the help, their short forms, defaults.

An option is listed under "Options", or under "More options" where it is declared with
``rich_help_panel=MORE``. The first section, with usage and examples, fits in ``FIRST_LINES`` lines.

The help shows a default in one form, ``[default: X]``, which typer writes. Where the default is
None but stands for a value, name that value: ``typer.Option(..., show_default="vanilla")``. The
help text itself never names the default.
"""

from pathlib import Path
from typing import Annotated, Any

import typer

MORE = "More options"
FIRST_LINES = 50


def more_option(*names: str, help: str, **facts: Any) -> Any:
    """Return an option of the section "More options".

    Args:
        *names: the option's names, such as ``--seed``.
        help: one sentence for the help.
        **facts: further arguments of ``typer.Option``.
    """
    return typer.Option(*names, help=help, rich_help_panel=MORE, **facts)


def out_option(help: str, *names: str, **facts: Any) -> Any:
    """Return the option ``--out`` with its short form ``-o``.

    Args:
        help: one sentence for the help, such as "Write the picture to this file.".
        *names: further names of the option.
        **facts: further arguments of ``typer.Option``.

    Example:
        >>> Picture = Annotated[Path, out_option("Write the picture to this file.")]
    """
    return typer.Option("--out", "-o", *names, help=help, **facts)


OutFolder = Annotated[Path, out_option("Write the results to this folder.")]
OutFile = Annotated[Path, out_option("Write the result to this file.")]
