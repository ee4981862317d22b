"""The options that the verbs which read layouts share."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import MORE

DEFAULT_PX_M = 3.5 / 256  # paper.layouts.importers.PX_M, which a help page need not import.
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
        "--px-m", metavar="METRES", help="The side of a pixel, for layouts in pixels.",
        show_default="3.5/256", rich_help_panel=MORE,
    ),
]  # fmt: skip
Task = Annotated[
    Path | None,
    typer.Option(
        "--task",
        metavar="FILE",
        help="LayoutVLM's scene file, where it is not beside the layout.",
        rich_help_panel=MORE,
    ),
]
Assets = Annotated[
    Path | None,
    typer.Option(
        "--assets",
        metavar="DIR",
        help="LayoutVLM's folder of assets, for sizes.",
        rich_help_panel=MORE,
    ),
]


def print_skipped(lines: Sequence[str]) -> None:
    """Print which objects were left out, and why."""
    for line in lines[:MAX_LISTED]:
        print(f"note: left out: {line}")
    if len(lines) > MAX_LISTED:
        print(f"note: ... and {len(lines) - MAX_LISTED:,} more")
