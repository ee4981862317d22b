"""``w2m occupy``: one depth picture in the grid of its frame, named and completed."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.dataset.frame_completion import CompletedFrame, GridPlace

EXAMPLES = """\
w2m occupy NYU0001_0000.png --grid NYU0001_0000.bin --out pred.npz       SSCNet's NYUv2
w2m occupy depth.png --grid geometry.npz --out pred.npz --depth-code mm  plain millimetres
w2m occupy NYU0001_0000.png --grid NYU0001_0000.bin --out pred.npz --colour NYU0001_0000_color.jpg
"""


def run(
    picture: Annotated[Path, typer.Argument(help="A depth PNG of 16 bits.")],
    grid: Annotated[
        Path,
        typer.Option("--grid", help="An SSCNet .bin (its header alone is read), or an npz."),
    ],
    out: Annotated[Path, typer.Option("--out", help="The npz to write.")] = Path("pred.npz"),
    colour: Annotated[
        Path | None, typer.Option("--colour", help="The photo of the same camera.")
    ] = None,
    depth_code: Annotated[
        str, typer.Option("--depth-code", help="rotated, mm or 8000; found out by default.")
    ] = "auto",
    focal_px: Annotated[
        float, typer.Option("--focal-px", help="At the picture's size; NYUv2's by default.")
    ] = 518.8579,
) -> None:
    """Say what each cell of a frame's grid is, from one depth picture.

    The completion network names what the picture shows and guesses what it hides. Of a .bin only
    where its grid and its camera are is read, never a label. ``labels`` of the npz is uint8
    [60, 36, 60] of 8 cm in the file's own axes: x right, z up, y forward; ids 0 to 11.
    """
    from world2minecraft.dataset.frame_completion import (
        complete_frame,
        depth_of_png,
        read_grid_place,
    )
    from world2minecraft.scan.depth import check_depth_kind
    from world2minecraft.scan.images import read_colour, read_header, read_raw
    from world2minecraft.types import Camera

    place = read_grid_place(grid)
    check_depth_kind(picture, read_header(picture))
    depth_m = depth_of_png(picture, read_raw(picture), depth_code)
    height, width = depth_m.shape
    camera = Camera(width, height, focal_px, focal_px, width / 2 + 0.5, height / 2 + 0.5)
    photo = None if colour is None else read_colour(colour)
    if photo is not None and photo.shape[:2] != depth_m.shape:
        raise typer.BadParameter(
            f"{colour} is {photo.shape[1]} x {photo.shape[0]}, not the depth's"
        )
    frame = complete_frame(depth_m, place, colour=photo, camera=camera)
    write_frame(out, frame, place)
    for line in told(out, frame, grid):
        print(line)


def write_frame(out: Path, frame: "CompletedFrame", place: "GridPlace") -> None:
    """Write a frame in its file's own axes."""
    import numpy as np

    from world2minecraft.dataset.frame_completion import FILE_AXES, VOXEL_M
    from world2minecraft.files import write_npz

    write_npz(
        out,
        {
            "labels": frame.labels.transpose(FILE_AXES),
            "confidence": frame.confidence.astype(np.float16).transpose(FILE_AXES),
            "observed": frame.observed.transpose(FILE_AXES),
            "voxel_m": np.array(VOXEL_M),
            "origin_m": place.origin_m,
        },
    )


def told(out: Path, frame: "CompletedFrame", grid: Path) -> list[str]:
    """Return what is printed of a frame."""
    import numpy as np

    from world2minecraft.classes import CLASS_NAMES

    counts = np.bincount(frame.labels.reshape(-1), minlength=len(CLASS_NAMES))
    found = ", ".join(f"{CLASS_NAMES[n]} {counts[n]:,}" for n in range(1, len(counts)) if counts[n])
    return [
        f"{out}: {found}",
        f"{frame.observed.mean():.0%} of the grid was seen; the rest is the network's guess",
        f"next: w2m evaluate occupancy {out} {grid} --protocol monoscene",
    ]
