"""``w2m scan``: what a capture holds, before any long work."""

from pathlib import Path
from typing import Annotated

import typer

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
    summary = describe_capture(capture, options=options)
    for line in summary.lines():
        print(line)
