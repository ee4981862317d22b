"""``w2m occupy``: predict the class of every cell of a frame, or of a captured room."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.panels import MORE

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
    Path, typer.Argument(metavar="INPUT", help="A depth PNG of 16 bits, a photo, or a capture.")
]
GridFile = Annotated[
    Path | None,
    typer.Option("--grid", help="The frame's grid: an SSCNet .bin (only its header is read) or "
                 "an npz."),
]  # fmt: skip
Out = Annotated[Path, typer.Option("--out", "-o", help="The npz file to write.")]
Colour = Annotated[
    Path | None, typer.Option("--colour", help="The photo of a depth picture's camera.")
]
DepthCode = Annotated[
    str,
    typer.Option(
        "--depth-code",
        help="How a depth PNG holds metres: auto, rotated, mm or 8000.",
        rich_help_panel=MORE,
    ),
]
FocalPx = Annotated[
    float,
    typer.Option("--focal-px", help="Focal length of a frame, at its size.", rich_help_panel=MORE),
]
PredictorName = Annotated[
    str, typer.Option("--predictor", help="depth; or mono or mono:FILE.onnx, which sees photos.")
]
LabelImages = Annotated[
    Path | None, typer.Option("--labels", help="Of a capture: a folder of 2D label images.")
]
FieldOfView = Annotated[
    float | None,
    typer.Option("--fov", help="Of one photo without --grid: vertical field of view in degrees."),
]
Keep = Annotated[
    Path | None,
    typer.Option("--keep", help="Of a capture: write the files of the run to this folder."),
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
) -> None:
    """Predict the class of every cell: of a frame's grid, or of a captured room.

    With --grid and a picture, the cells are those of the file: 60x36x60 of 8 cm, x right, z up, y
    forward. Of a .bin only the places of grid and camera are read, never a label. Of a depth
    picture the completion network names what is seen and predicts what is hidden; of a photo a
    network (--predictor mono) predicts all of it.

    Without --grid, a capture is registered, fused and labelled as w2m reconstruct does: the cells
    are the room's, x, y, z up. With --grid they are resampled to that grid, which must be of the
    same world. ``labels`` is uint8, ids 0 to 11, 255 where nothing was observed.
    """
    from world2minecraft.api import predict_occupancy
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import with_compile_note

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
            progress=with_compile_note(progress),
        )
    for line in summary_lines(source, out, cells, grid):
        print(line)


def summary_lines(source: Path, out: Path, cells: "PredictedCells", grid: Path | None) -> list[str]:
    """Return what is printed of the cells of a capture or a photo."""
    import numpy as np

    from world2minecraft.core.classes import CLASS_NAMES, display_name

    counts = np.bincount(cells.labels.reshape(-1), minlength=len(CLASS_NAMES))
    found = ", ".join(
        f"{display_name(n)} {counts[n]:,}" for n in range(1, len(CLASS_NAMES)) if counts[n]
    )
    sides = " x ".join(map(str, cells.labels.shape))
    next_step = f"w2m evaluate occupancy {out} {grid} --protocol monoscene"
    if grid is None:
        next_step = f"w2m reconstruct {source} --out OUT     builds a world from the same capture"
    return [
        f"{out}: {found}" if found else f"{out}: nothing but empty cells",
        f"{cells.observed.mean():.0%} of its {sides} cells were observed; the rest is predicted "
        "by a network, or unknown",
        f"next: {next_step}",
    ]
