"""Write the class of each pixel of a capture's pictures as label images: ``w2m segment``."""

import json
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import Force

EXAMPLES = """\
w2m segment my_photos --out LABELS                label images of photos; no poses are needed
w2m segment IMG_2041.MOV --out LABELS             of the frames of a video
w2m segment my_scan --out LABELS --overlay        and pictures in the colours of their classes
w2m segment my_scan --out LABELS --min-probability 0.5 --json
w2m reconstruct my_scan --out OUT --labels LABELS
"""

Capture = Annotated[Path, typer.Argument(help="Photos, video, app export or RGB-D frames.")]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Output folder.")]
Semantics = Annotated[
    str,
    typer.Option("--semantics", metavar="nyu|generated",
                 help="Network: trained on real rooms too, or on generated rooms alone."),
]  # fmt: skip
MinProbability = Annotated[
    float,
    typer.Option("--min-probability", help="Pixels whose most likely class is below are 0."),
]
Overlay = Annotated[
    bool,
    typer.Option("--overlay", help="Also write NAME.overlay.jpg: the picture in the colours of its "
                 "classes, with a legend."),
]  # fmt: skip
AsJson = Annotated[bool, typer.Option("--json", help="Print the results as JSON.")]
ReaderSettings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="capture.KEY=VALUE", help="Option of the capture reader."),
]


def run(
    capture: Capture,
    out: Out,
    semantics: Semantics = "nyu",
    min_probability: MinProbability = 0.0,
    overlay: Overlay = False,
    force: Force = False,
    as_json: AsJson = False,
    settings: ReaderSettings = None,
) -> None:
    """Write a label image for each picture of a capture.

    DIR/NAME.png has the name of its frame and the size of its picture: 8-bit NYU40 ids from 1 to
    40, and 0 for unknown. Poses are not needed; depth, gravity and camera height are used if known.

    Raises:
        UsageError: If an argument is invalid, or the folder contains files.
        CaptureError: If the capture cannot be read or has no pictures.
    """
    from world2minecraft.api.captures import segment_capture
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.build.options import parse_settings

    with show_progress() as progress:
        made = segment_capture(
            capture, out, semantics=semantics, min_probability=min_probability, overlay=overlay,
            force=force, settings=parse_settings(settings), progress=progress,
        )  # fmt: skip
    if as_json:
        print(json.dumps(made.to_json(), indent=1))
    else:
        print("\n".join(made.lines))
