"""``w2m dataset rooms``: photo-like pictures of generated rooms, labelled."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset rooms PHOTO                                   400 pictures of 20 rooms
w2m dataset rooms PHOTO --rooms 60 --images 3000 --seed 2
w2m train monoscene --data PHOTO --data BLOCKS:3 --out JOINT     few photos, many block worlds
"""


def run(
    out: Annotated[Path, typer.Argument(metavar="DIR", help="The data set, a new folder.")],
    rooms: Annotated[int, typer.Option("--rooms", help="How many rooms.")] = 20,
    images: Annotated[int, typer.Option("--images", help="How many pictures in all.")] = 400,
    test_share: Annotated[
        float, typer.Option("--test-share", help="Of the rooms, kept for the test.")
    ] = 0.25,
    size: Annotated[
        str, typer.Option("--size", metavar="WxH", help="Pixels, instead of NYUv2's 640x480.")
    ] = "",
    seed: Annotated[int, typer.Option("--seed", min=0, help="The same seed, the same set.")] = 0,
) -> None:
    """Make a labelled data set of photo-like pictures of generated rooms.

    Truth is the rooms' own, in cells of 8 cm by NYUv2's rule. Beside the block worlds of w2m
    dataset build it stands for real photos, of which there are few: see docs/training.md.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.dataset.options import parse_camera
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.minecraftocc.store import write_store
    from world2minecraft.minecraftocc.synthetic_photos import PhotoRooms, photo_samples

    plan = PhotoRooms(rooms, images, test_share, seed, parse_camera("nyu", size, None))
    print_compile_note()
    facts = {"rooms": rooms, "images": images, "test_share": test_share, "seed": seed}
    with show_progress() as progress:
        write_store(
            out,
            photo_samples(plan),
            {"photo_rooms": facts},
            progress=lambda stage, done, total, note="": progress(stage, done, images, note),
        )
    print(f"{images:,} pictures of {rooms:,} rooms written to {out}")
    print(f"next: w2m dataset show {out}")
    print(f"then: w2m train monoscene --data {out} --out RUN")
