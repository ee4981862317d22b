"""``w2m scan``: what a capture holds, before any long work."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.scan import CaptureSummary

SHOWN_SKIPPED = 8
EXAMPLES = """\
w2m scan my_scan
"""


def run(
    capture: Annotated[Path, typer.Argument(help="A folder of posed RGB-D frames.")],
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="capture.KEY=VALUE", help="An option of the reader."),
    ] = None,
) -> None:
    """Tell what was found in a capture, and whether it can be reconstructed.

    Args:
        capture: the folder to look at. Nothing is written.
        settings: options of the reader, such as ``capture.depth_unit=mm``.
    """
    from world2minecraft.parameters import Parameters, with_settings
    from world2minecraft.scan import describe_capture

    options = with_settings(Parameters(), settings or []).capture
    for line in summary_lines(describe_capture(capture, options=options)):
        print(line)


def summary_lines(summary: "CaptureSummary") -> list[str]:
    """Return what is printed of a capture, the next command last."""
    lines = [
        f"{summary.folder}: {summary.source}, {summary.usable} of {summary.frames} frames usable",
        f"  colour    {_image(summary.colour_size_px, summary.colour_focal_px)}",
        f"  depth     {_image(summary.depth_size_px, summary.depth_focal_px)}"
        f", {summary.depth_unit}{' (guessed)' if summary.depth_unit_guessed else ''}"
        f", typically {summary.typical_depth_m:.1f} m away",
        f"  poses     {summary.frames - summary.lost_poses} good, {summary.lost_poses} lost"
        f", cameras up to {summary.cameras_apart_m:.1f} m apart",
    ]
    if summary.labelled:
        lines.append(f"  labels    {summary.labelled} frames")
    lines += [f"  note      {note}" for note in summary.notes]
    lines += [f"  skipped   {name}: {reason}" for name, reason in summary.skipped[:SHOWN_SKIPPED]]
    if len(summary.skipped) > SHOWN_SKIPPED:
        lines.append(f"  skipped   and {len(summary.skipped) - SHOWN_SKIPPED} more")
    lines += [f"  warning   {warning}" for warning in summary.warnings]
    return [*lines, f"next: {summary.next_command}"]


def _image(size_px: tuple[int, int] | None, focal_px: float | None) -> str:
    if size_px is None or focal_px is None:
        return "none"
    return f"{size_px[0]}x{size_px[1]}, focal length {focal_px:.0f} px"
