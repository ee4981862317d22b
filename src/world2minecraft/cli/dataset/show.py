"""``w2m dataset show``: one sample of any data set as a picture."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset show DATA                                 the data set, and its first sample
w2m dataset show DATA house_0001-t0-00012             one sample, by its key
w2m dataset show depthbin --labels preprocess         NYUv2 as MonoScene has it
w2m dataset show OccScanNet --out look.png            write the picture elsewhere
"""


def run(
    source: Annotated[
        Path, typer.Argument(help="A data set, or NYUv2, OccScanNet, EmbodiedOcc-ScanNet, npz.")
    ],
    key: Annotated[
        str | None,
        typer.Argument(help="The key of the sample.", show_default="the first"),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", "--picture", help="The PNG file to write.", show_default="KEY.png"
        ),
    ] = None,
    format: Annotated[
        str | None,
        typer.Option("--format", help="nyu, occscannet, embodied or npz.", show_default="detected"),
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option("--labels", help="Of nyu, the folder of MonoScene's base/, if elsewhere."),
    ] = None,
) -> None:
    """Draw one sample: its image, its depth, its labels in the image, and from above.

    Where the colours of the labels lie on the things that they name, camera, axes and labels fit.
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
        print(f"{share:.1%} of the depth within the region lies in labelled cells")
    print(f"picture: {path}")
    more = keys[1:2]
    print(f"next: w2m dataset show {source} {more[0]}" if more and key is None else
          f"next: w2m dataset export {source} --format npz --out OUT")  # fmt: skip
