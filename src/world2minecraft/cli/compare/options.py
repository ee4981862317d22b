"""What the verbs that read layouts share."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.paper.layouts import ComparedScene

DEFAULT_PX_M = 3.5 / 256  # As paper.layouts.importers has it, which a help page need not import.
MAX_LISTED = 5

Format = Annotated[
    str,
    typer.Option(
        "--format", help="layoutgpt, idesign, layoutvlm, stored or run.", show_default="found out"
    ),
]
PxM = Annotated[
    float,
    typer.Option(
        "--px-m", metavar="METRES", help="Of a pixel, for layouts in pixels.",
        show_default="3.5/256",
    ),
]  # fmt: skip
Task = Annotated[
    Path | None,
    typer.Option(
        "--task", metavar="FILE", help="LayoutVLM's scene file, where it is not beside the layout."
    ),
]
Assets = Annotated[
    Path | None,
    typer.Option("--assets", metavar="DIR", help="LayoutVLM's folder of assets, for sizes."),
]


def check_px(px_m: float) -> None:
    """Raise UsageError where a pixel is no length."""
    from world2minecraft.core.errors import UsageError

    if not 0 < px_m < 1:
        raise UsageError(f"--px-m is metres of a pixel, above 0 and under 1, not {px_m:g}")


def print_skipped(scenes: "Sequence[ComparedScene]") -> None:
    """Print which objects were left out, and why."""
    lines = [f"{scene.name}: {line}" for scene in scenes for line in scene.skipped]
    for line in lines[:MAX_LISTED]:
        print(f"note: left out: {line}")
    if len(lines) > MAX_LISTED:
        print(f"note: ... and {len(lines) - MAX_LISTED:,} more")
