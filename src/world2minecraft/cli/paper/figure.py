"""``w2m paper figure``: draw the paper's figure of a reconstruction of your own."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m demo && w2m paper figure OUT                       the demo's room
w2m paper figure OUT --capture MY_SCAN -o room.png
w2m paper figure OUT --capture MY_SCAN --walk RUN      with the strip of a w2m vln run below
"""

Run = Annotated[Path, typer.Argument(metavar="OUT", help="A finished reconstruction.")]
Capture = Annotated[
    Path | None,
    typer.Option("--capture", metavar="SCAN", help="Its capture.", show_default="OUT/capture"),
]
Walk = Annotated[
    Path | None, typer.Option("--walk", metavar="RUN", help="A walk, for the strip below.")
]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="Write this PNG file.")]


def run(
    folder: Run, capture: Capture = None, walk: Walk = None, out: Out = Path("figure.png")
) -> None:
    """Draw three views of a room: photo, world, predicted cells, construction.

    The photo and the world are seen from one pose, the cells and the construction from outside,
    without ceiling and near walls. A walk adds a strip of what its agent saw.

    Raises:
        CaptureError: the capture has no posed photo that the run used.
        InputError: a file is missing or damaged.
    """
    from world2minecraft.api.paper import paper_figure

    figure = paper_figure(folder, capture=capture, walk=walk, out=out)
    print(f"figure  {out}, {figure.width}x{figure.height}")
    if walk is None:
        print(f'next: w2m vln run {folder} "Go to the table" --out RUN, then --walk RUN')
