"""Draw many images of a data set or a tour on one page: ``w2m dataset sheet``."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset sheet DATA                                    write 48 images to sheet.png
w2m dataset sheet DATA --split test --most 120 --columns 12
w2m dataset sheet DATA --labels                           show labels next to each image
w2m dataset sheet tour.jsonl --world WORLDS/house_0001    the views of a tour
w2m dataset sheet tour.jsonl --world WORLD --first        the first views of a tour
"""

Place = Annotated[
    Path, typer.Argument(metavar="DATA_OR_TOUR", help="Folder of a data set, or a tour file.")
]
World = Annotated[Path | None, typer.Option("--world", metavar="WORLD", help="World of the tour.")]
Out = Annotated[
    Path, typer.Option("--out", "-o", metavar="FILE", help="Output image, .png or .jpg.")
]
Most = Annotated[int, typer.Option("--most", metavar="N", help="Maximum number of images.")]
Columns = Annotated[int, typer.Option("--columns", metavar="N", help="Images per row.")]
Width = Annotated[int, typer.Option("--width", metavar="PX", help="Width of each image.")]
First = Annotated[
    bool, typer.Option("--first", help="Show the first images, instead of an even selection.")
]
Split = Annotated[
    str, typer.Option("--split", help="train or test (data sets only).", show_default="all")
]
Labels = Annotated[
    bool,
    typer.Option("--labels", help="Repeat each image with its labels overlaid (data sets only)."),
]
Hour = Annotated[float | None, typer.Option("--hour", help="Time of day, 0 to 24 (tours only).")]


def run(
    place: Place,
    world: World = None,
    out: Out = Path("sheet.png"),
    most: Most = 48,
    columns: Columns = 8,
    width: Width = 240,
    first: First = False,
    split: Split = "",
    labels: Labels = False,
    hour: Hour = None,
) -> None:
    """Draw a page of sample images from a data set, or of the planned views of a tour.

    Raises:
        UsageError: If a tour is given without its world, or if a number is out of range.
        InputError: If the data set or tour cannot be read.
    """
    from world2minecraft.api.dataset_contents import dataset_sheet

    page = dataset_sheet(
        place,
        world=world,
        images=most,
        columns=columns,
        width_px=width,
        first=first,
        split=split,
        labels=labels,
        hour=hour,
        out=out,
    )
    print(f"{out}: {page.width}x{page.height} pixels")
