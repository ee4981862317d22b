"""Draw the paper's figure for a reconstruction: ``w2m paper figure``."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m demo && w2m paper figure OUT                       the demo's room
w2m paper figure OUT --capture MY_SCAN -o room.png
w2m paper figure OUT --capture MY_SCAN --walk RUN      with images from a w2m vln run below
"""

Run = Annotated[Path, typer.Argument(metavar="OUT", help="Finished reconstruction.")]
Capture = Annotated[
    Path | None,
    typer.Option(
        "--capture",
        metavar="SCAN",
        help="Capture of the reconstruction.",
        show_default="OUT/capture",
    ),
]
Walk = Annotated[
    Path | None, typer.Option("--walk", metavar="RUN", help="Run of w2m vln run, shown below.")
]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="Write this PNG file.")]


def run(
    folder: Run, capture: Capture = None, walk: Walk = None, out: Out = Path("figure.png")
) -> None:
    """Draw three views of a room as in the paper: photo, world, predicted cells, construction.

    The photo and the world are shown from the same pose. The cells and the construction are shown
    from outside, without the ceiling and near walls. A walk adds a row of images seen by its agent.

    Raises:
        CaptureError: If the capture has no posed photo that the run used.
        InputError: If a file is missing or damaged.
    """
    from world2minecraft.api.paper import paper_figure

    figure = paper_figure(folder, capture=capture, walk=walk, out=out)
    print(f"figure  {out}, {figure.width}x{figure.height}")
    if walk is None:
        print(f'next: w2m vln run {folder} "Go to the table" --out RUN, then --walk RUN')
