"""Predict the class of every cell in a frame or a captured room: ``w2m occupy``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.panels import MORE, Force

if TYPE_CHECKING:
    from world2minecraft.api.networks import PredictedCells

EXAMPLES = """\
w2m occupy NYU0001_0000.png --grid NYU0001_0000.bin --out pred.npz       SSCNet's NYUv2
w2m occupy depth.png --grid geometry.npz --out pred.npz --depth-code mm  plain millimetres
w2m occupy NYU0001_0000.png --grid NYU0001_0000.bin --out pred.npz --colour NYU0001_0000_color.jpg
w2m occupy NYU0001_0000_color.jpg --grid NYU0001_0000.bin --out pred.npz --predictor mono
w2m occupy my_scan --out room.npz                                        a whole captured room
w2m occupy photo.jpg --out room.npz --predictor mono --fov 55
"""


Source = Annotated[
    Path, typer.Argument(metavar="INPUT", help="16-bit depth PNG, photo, or capture.")
]
GridFile = Annotated[
    Path | None,
    typer.Option("--grid", help="Grid of the frame: an SSCNet .bin (only its header is used) or "
                 "an npz."),
]  # fmt: skip
Out = Annotated[Path, typer.Option("--out", "-o", help="Output npz file.")]
Colour = Annotated[
    Path | None, typer.Option("--colour", help="Photo from the camera of the depth image.")
]
DepthCode = Annotated[
    str,
    typer.Option(
        "--depth-code",
        help="Depth encoding of the PNG: auto, rotated, mm or 8000.",
        rich_help_panel=MORE,
    ),
]
FocalPx = Annotated[
    float,
    typer.Option(
        "--focal-px", help="Focal length in pixels at the size of the frame.", rich_help_panel=MORE
    ),
]
PredictorName = Annotated[
    str, typer.Option("--predictor", help="depth; for photos, mono or mono:FILE.onnx.")
]
LabelImages = Annotated[
    Path | None, typer.Option("--labels", help="Folder of 2D label images (captures only).")
]
FieldOfView = Annotated[
    float | None,
    typer.Option("--fov", help="Vertical field of view in degrees, for a photo without --grid."),
]
Keep = Annotated[
    Path | None,
    typer.Option("--keep", help="Write the files of the run to this folder (captures only)."),
]


def run(
    source: Source,
    grid: GridFile = None,
    out: Out = Path("pred.npz"),
    colour: Colour = None,
    depth_code: DepthCode = "auto",
    focal_px: FocalPx = 518.8579,
    predictor: PredictorName = "depth",
    labels: LabelImages = None,
    fov: FieldOfView = None,
    keep: Keep = None,
    force: Force = False,
) -> None:
    """Predict the class of every cell in the grid of a frame, or in a captured room.

    With --grid and an image, the cells are those of the grid file: 60x36x60 cells of 8 cm, x right,
    z up, y forward. Only the grid and camera positions are read from a .bin file, never its labels.
    For a depth image, the completion network labels visible cells and predicts hidden cells. For a
    photo, a monocular network (--predictor mono) predicts all cells.

    Without --grid, a capture is registered, fused and labelled as by w2m reconstruct, and the cells
    are in the room frame with z up. With --grid, they are resampled to that grid, which must be in
    the same world frame. ``labels`` is uint8 with class ids 0 to 11, or 255 for unobserved cells.
    """
    from world2minecraft.api import predict_occupancy
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as progress:
        cells = predict_occupancy(
            source,
            out,
            grid=grid,
            colour=colour,
            depth_code=depth_code,
            focal_px=focal_px,
            predictor=predictor,
            labels=labels,
            fov_deg=fov,
            run_folder=keep,
            force=force,
            progress=compile_first(progress),
        )
    for line in summary_lines(source, out, cells, grid):
        print(line)


def summary_lines(source: Path, out: Path, cells: "PredictedCells", grid: Path | None) -> list[str]:
    """Return the lines to print about predicted cells."""
    import numpy as np

    from world2minecraft.core.classes import CLASS_NAMES, display_name

    counts = np.bincount(cells.labels.reshape(-1), minlength=len(CLASS_NAMES))
    found = ", ".join(
        f"{display_name(n)} {counts[n]:,}" for n in range(1, len(CLASS_NAMES)) if counts[n]
    )
    sides = " x ".join(map(str, cells.labels.shape))
    next_step = f"w2m evaluate sscnet {out} {grid}"
    if grid is None:
        next_step = f"w2m reconstruct {source} --out OUT     builds a world from the same capture"
    return [
        f"{out}: {found}" if found else f"{out}: all cells are empty",
        f"{cells.observed.mean():.0%} of the {sides} cells were observed; the rest are predicted "
        "by a network or unknown",
        f"next: {next_step}",
    ]
