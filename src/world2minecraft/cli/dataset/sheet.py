"""``w2m dataset sheet``: many images of a data set or a tour on one page."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset sheet DATA                                    48 of its images, to sheet.png
w2m dataset sheet DATA --split test --most 120 --columns 12
w2m dataset sheet DATA --labels                           each beside itself with its labels
w2m dataset sheet tour.jsonl --world WORLDS/house_0001    the views of a tour
w2m dataset sheet tour.jsonl --world WORLD --first        the first views of a tour
"""

Place = Annotated[
    Path, typer.Argument(metavar="DATA_OR_TOUR", help="A data set's folder, or a tour file.")
]
World = Annotated[
    Path | None, typer.Option("--world", metavar="WORLD", help="The world of a tour.")
]
Out = Annotated[
    Path, typer.Option("--out", "-o", metavar="FILE", help="The page to write, .png or .jpg.")
]
Most = Annotated[int, typer.Option("--most", metavar="N", help="Number of images at most.")]
Columns = Annotated[int, typer.Option("--columns", metavar="N", help="Images per row.")]
Width = Annotated[int, typer.Option("--width", metavar="PX", help="Width of each image.")]
First = Annotated[
    bool, typer.Option("--first", help="Show the first images, instead of some spread over all.")
]
Split = Annotated[
    str, typer.Option("--split", help="Of a data set: train or test.", show_default="all")
]
Labels = Annotated[
    bool,
    typer.Option("--labels", help="Of a data set: show each image again with its labels over it."),
]
Hour = Annotated[
    float | None, typer.Option("--hour", help="Of a tour: time of day, 0 to 24, for the light.")
]


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
    """Draw one page of images, to look at what a data set holds or what a tour will give.

    Raises:
        UsageError: a tour without its world, a number out of range. InputError: it cannot be read.
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
