"""Draw one sample of a data set as an image: ``w2m dataset show``."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset show DATA                                 describe the data set, draw one sample
w2m dataset show DATA house_0001-t0-00012             draw the sample with this key
w2m dataset show depthbin --labels preprocess         NYUv2 as MonoScene has it
w2m dataset show OccScanNet --out look.png            write the image to another file
"""


def run(
    source: Annotated[
        Path,
        typer.Argument(help="Data set, including NYUv2, OccScanNet, EmbodiedOcc-ScanNet, npz."),
    ],
    key: Annotated[
        str | None,
        typer.Argument(help="Key of the sample.", show_default="the first"),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", "--picture", help="Output PNG file.", show_default="KEY.png"),
    ] = None,
    format: Annotated[
        str | None,
        typer.Option("--format", help="nyu, occscannet, embodied or npz.", show_default="detected"),
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option(
            "--labels", help="Folder with MonoScene's base/, if stored elsewhere (nyu only)."
        ),
    ] = None,
) -> None:
    """Draw a sample: the image, the depth, the labels overlaid on the image, and a view from above.

    If the label colours match the objects in the image, the camera, axes and labels are consistent.
    """
    from world2minecraft.api import open_dataset
    from world2minecraft.api.dataset_contents import draw_sample

    found = open_dataset(source, format=format, labels=labels)
    print(f"{source}: {found.describe()}")
    keys = found.keys()
    chosen = key or keys[0]
    path = out or Path(f"{chosen}.png")
    figure = draw_sample(found, chosen, out=path)
    if figure.depth_in_cells is not None:
        share = figure.depth_in_cells
        print(f"{share:.1%} of the depth pixels within the region are in labelled cells")
    print(f"image: {path}")
    more = keys[1:2]
    print(f"next: w2m dataset show {source} {more[0]}" if more and key is None else
          f"next: w2m dataset export {source} --format npz --out OUT")  # fmt: skip
