"""Options shared by the verbs that read layouts."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import MORE

# Equals paper.layouts.importers.PX_M, without importing it for a help page.
DEFAULT_PX_M = 3.5 / 256
MAX_LISTED = 5

Format = Annotated[
    str,
    typer.Option(
        "--format",
        help="layoutgpt, idesign, layoutvlm, stored or run.",
        show_default="detected",
    ),
]
PxM = Annotated[
    float,
    typer.Option(
        "--px-m", metavar="METRES", help="Side length of a pixel, for layouts in pixels.",
        show_default="3.5/256", rich_help_panel=MORE,
    ),
]  # fmt: skip
Task = Annotated[
    Path | None,
    typer.Option(
        "--task",
        metavar="FILE",
        help="LayoutVLM's scene file, if it is not next to the layout.",
        rich_help_panel=MORE,
    ),
]
Assets = Annotated[
    Path | None,
    typer.Option(
        "--assets",
        metavar="DIR",
        help="LayoutVLM's asset folder, used for object sizes.",
        rich_help_panel=MORE,
    ),
]


def print_skipped(lines: Sequence[str]) -> None:
    """Print which objects were skipped and why."""
    for line in lines[:MAX_LISTED]:
        print(f"note: skipped: {line}")
    if len(lines) > MAX_LISTED:
        print(f"note: ... and {len(lines) - MAX_LISTED:,} more")
