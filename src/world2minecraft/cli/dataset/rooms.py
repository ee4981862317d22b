"""Build a labelled data set of photo-like images of generated rooms: ``w2m dataset rooms``."""

from typing import Annotated

import typer

from world2minecraft.cli.dataset import options as option
from world2minecraft.cli.panels import Force

EXAMPLES = """\
w2m dataset rooms PHOTO                                   400 images of 20 rooms
w2m dataset rooms PHOTO --rooms 60 --images 3000 --seed 2
w2m train monoscene --data PHOTO --data BLOCKS:3 --out JOINT     few photos, many block worlds
"""


def run(
    folder: option.NewFolder = None,
    out: option.OutFolder = None,
    rooms: Annotated[int, typer.Option("--rooms", help="Number of rooms.")] = 20,
    images: Annotated[int, typer.Option("--images", help="Total number of images.")] = 400,
    test_share: Annotated[
        float, typer.Option("--test-share", help="Fraction of the rooms to use for testing.")
    ] = 0.25,
    size: Annotated[
        str,
        typer.Option("--size", metavar="WxH", help="Image size in pixels.", show_default="640x480"),
    ] = "",
    seed: Annotated[
        int, typer.Option("--seed", min=0, help="The same seed gives the same data set.")
    ] = 0,
    force: Force = False,
) -> None:
    """Build a data set of photo-like images of generated rooms, with exact labels.

    The ground truth comes from the generated rooms, in 8 cm cells that are labelled as in NYUv2.
    The images take the place of real photos, of which there are few, next to the block worlds of
    w2m dataset build. See docs/how-to/train-a-network.md.
    """
    from world2minecraft.api.datasets import build_photo_dataset
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.arguments import output_of, size_of
    from world2minecraft.core.precompile import compile_first

    target = output_of(folder, out)
    with show_progress() as progress:
        build_photo_dataset(
            target,
            rooms=rooms,
            images=images,
            test_share=test_share,
            size=size_of(size),
            seed=seed,
            force=force,
            progress=compile_first(progress),
        )
    print(f"{images:,} images of {rooms:,} rooms written to {target}")
    print(f"next: w2m dataset show {target}")
    print(f"then: w2m train monoscene --data {target} --out RUN")
