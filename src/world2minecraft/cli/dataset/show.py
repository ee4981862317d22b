"""``w2m dataset show``: one sample of any data set as a picture."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset show DATA                                 what it holds, and its first sample
w2m dataset show DATA house_0001-t0-00012             one sample, by its key
w2m dataset show depthbin --labels preprocess         NYUv2 as MonoScene has it
w2m dataset show OccScanNet --picture look.png        the picture elsewhere
"""


def run(
    source: Annotated[
        Path, typer.Argument(help="A data set, or NYUv2, OccScanNet, EmbodiedOcc-ScanNet, npz.")
    ],
    key: Annotated[str | None, typer.Argument(help="Which sample; the first by default.")] = None,
    picture: Annotated[
        Path | None, typer.Option("--picture", help="Where it goes; KEY.png here by default.")
    ] = None,
    format: Annotated[str | None, typer.Option("--format", help="Found out by default.")] = None,
    labels: Annotated[
        Path | None,
        typer.Option("--labels", help="nyu: where MonoScene's base/ lies, if elsewhere."),
    ] = None,
) -> None:
    """Draw one sample: its picture, its depth, its labels cast into the picture, and from above.

    Where the labels' colours lie on the things that they name, camera, axes and labels fit.
    """
    from world2minecraft.core.files import write_bytes
    from world2minecraft.minecraftocc.importers import open_occupancy
    from world2minecraft.minecraftocc.sample_figure import draw_sample, share_of_depth_in_cells
    from world2minecraft.rendering.output.images import colour_bytes

    found = open_occupancy(source, format, labels=labels)
    print(f"{source}: {found.describe()}")
    sample = found[key or found.keys()[0]]
    share = share_of_depth_in_cells(sample)
    if share is not None:
        print(f"{share:.1%} of the depth within the region lies in labelled cells")
    path = picture or Path(f"{sample.key}.png")
    write_bytes(path, colour_bytes(draw_sample(sample), ".png"))
    print(f"picture: {path}")
    more = found.keys()[1:2]
    print(f"next: w2m dataset show {source} {more[0]}" if more and key is None else
          f"next: w2m dataset export {source} --format npz --out OUT")  # fmt: skip
