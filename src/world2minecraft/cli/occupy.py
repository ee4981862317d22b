"""``w2m occupy``: a depth picture, a photo or a whole capture becomes cells with names."""

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.core.types import Camera
    from world2minecraft.minecraftocc.cell_predictions import PredictedCells
    from world2minecraft.minecraftocc.scene_completion import GridPlace

EXAMPLES = """\
w2m occupy NYU0001_0000.png --grid NYU0001_0000.bin --out pred.npz       SSCNet's NYUv2
w2m occupy depth.png --grid geometry.npz --out pred.npz --depth-code mm  plain millimetres
w2m occupy NYU0001_0000.png --grid NYU0001_0000.bin --out pred.npz --colour NYU0001_0000_color.jpg
w2m occupy NYU0001_0000_color.jpg --grid NYU0001_0000.bin --out pred.npz --predictor mono
w2m occupy my_scan --out room.npz                                        a whole captured room
w2m occupy photo.jpg --out room.npz --predictor mono --fov 55
"""
LAST_STAGE = "label"


Source = Annotated[
    Path, typer.Argument(metavar="INPUT", help="A depth PNG of 16 bits, a photo, or a capture.")
]
GridFile = Annotated[
    Path | None,
    typer.Option("--grid", help="An SSCNet .bin (its header alone is read), or an npz."),
]
Out = Annotated[Path, typer.Option("--out", help="The npz to write.")]
Colour = Annotated[
    Path | None, typer.Option("--colour", help="The photo of a depth picture's camera.")
]
DepthCode = Annotated[
    str, typer.Option("--depth-code", help="rotated, mm or 8000; found out by default.")
]
FocalPx = Annotated[
    float, typer.Option("--focal-px", help="Of a frame, at its size; NYUv2's by default.")
]
PredictorName = Annotated[
    str, typer.Option("--predictor", help="depth; mono, or mono:FILE.onnx, looks at photos.")
]
LabelImages = Annotated[
    Path | None, typer.Option("--labels", help="Of a capture: a folder of 2D label images.")
]
FieldOfView = Annotated[
    float | None, typer.Option("--fov", help="Of one photo without --grid, in degrees.")
]
Keep = Annotated[
    Path | None, typer.Option("--keep", help="Of a capture: keep the run's files here.")
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
    """Say what each cell is: of a frame's grid from one picture, or of a room from a capture.

    With --grid and a picture, the grid is the file's: 60x36x60 cells of 8 cm in its own axes, x
    right, z up, y forward; of a .bin only where its grid and its camera are is read, never a
    label. From a depth picture the completion network names what is seen and guesses what is
    hidden; from a photo a network (--predictor mono) says all of it.

    Without --grid, whatever w2m reconstruct takes is registered, fused and labelled: the cells of
    the room, x, y, z up. A capture with --grid answers in that grid, whose world must be the
    capture's. ``labels`` is uint8, ids 0 to 11, 255 where nobody looked.
    """
    from world2minecraft.capture.readers.photo_folder import PHOTO_SUFFIXES
    from world2minecraft.core.errors import InputError
    from world2minecraft.minecraftocc.scene_completion import read_grid_place

    if not source.exists():
        raise InputError(source, "is not there; give a depth PNG, a photo or a capture")
    place = None if grid is None else read_grid_place(grid)
    if place is not None and source.is_file() and source.suffix.lower() in PHOTO_SUFFIXES:
        frame = _Frame(source, colour, depth_code, focal_px)
        cells = frame.by_network(place, predictor) if _is_mono(predictor) else frame.by_depth(place)
        _write_frame(out, cells, place)
    else:
        _check_no_depth(source)
        if colour is not None:
            raise typer.BadParameter("--colour goes with one depth picture and its --grid")
        cells = _from_capture(source, out, place, predictor, labels, fov, keep)
    for line in summary_lines(source, out, cells, grid):
        print(line)


def _check_no_depth(source: Path) -> None:
    """Refuse a depth picture of which nobody says where it was taken."""
    from world2minecraft.capture.images import read_header
    from world2minecraft.core.errors import UsageError

    if source.suffix.lower() == ".png" and read_header(source).mode.startswith("I"):
        raise UsageError(f"{source} is a depth picture; --grid tells where its cells lie")


def _is_mono(predictor: str) -> bool:
    from world2minecraft.core.errors import UnknownNameError

    kind = predictor.partition(":")[0]
    if kind not in ("depth", "mono"):
        raise UnknownNameError("predictor", kind, ("depth", "mono"))
    return kind == "mono"


class _Frame:
    """One picture of a known place: what its grid holds, by its depth or by its colours."""

    def __init__(self, source: Path, colour: Path | None, depth_code: str, focal_px: float):
        self.source, self.colour = source, colour
        self.depth_code, self.focal_px = depth_code, focal_px

    def by_depth(self, place: "GridPlace") -> "PredictedCells":
        """Return what the completion network says."""
        from world2minecraft.capture.depth_images import check_depth_kind
        from world2minecraft.capture.images import read_colour, read_header, read_raw
        from world2minecraft.core.errors import CaptureError
        from world2minecraft.minecraftocc.cell_predictions import PredictedCells
        from world2minecraft.minecraftocc.scene_completion import (
            VOXEL_M,
            complete_frame,
            depth_of_png,
        )

        header = read_header(self.source)
        if header.mode in ("RGB", "RGBA", "CMYK", "YCbCr"):
            raise CaptureError(
                self.source,
                "is a photo; give its depth picture, or a network that needs none: "
                "--predictor mono",
            )
        check_depth_kind(self.source, header)
        depth_m = depth_of_png(self.source, read_raw(self.source), self.depth_code)
        photo = None if self.colour is None else read_colour(self.colour)
        if photo is not None and photo.shape[:2] != depth_m.shape:
            raise typer.BadParameter(
                f"{self.colour} is {photo.shape[1]} x {photo.shape[0]}, not the depth's"
            )
        camera = self._camera(*depth_m.shape)
        found = complete_frame(depth_m, place, colour=photo, camera=camera)
        return PredictedCells(
            found.labels, found.confidence, found.observed, VOXEL_M, place.origin_m
        )

    def by_network(self, place: "GridPlace", predictor: str) -> "PredictedCells":
        """Return what a monocular network says."""
        from world2minecraft.capture.images import read_colour, read_header
        from world2minecraft.core.errors import CaptureError
        from world2minecraft.minecraftocc.cell_predictions import predict_cells
        from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor

        photo = self.colour or self.source
        if read_header(photo).mode.startswith(("I", "F")):
            raise CaptureError(
                photo, "is a depth picture; --predictor mono looks at the photo: --colour PHOTO"
            )
        network = MonoPredictor(predictor.partition(":")[2]).network
        pixels = read_colour(photo)
        return predict_cells(pixels, self._camera(*pixels.shape[:2]), place, network)

    def _camera(self, height: int, width: int) -> "Camera":
        from world2minecraft.core.types import Camera

        focal_px = self.focal_px
        return Camera(width, height, focal_px, focal_px, width / 2 + 0.5, height / 2 + 0.5)


def _from_capture(
    capture: Path,
    out: Path,
    place: "GridPlace | None",
    predictor: str,
    labels: Path | None,
    fov: float | None,
    keep: Path | None,
) -> "PredictedCells":
    """Run a capture as far as its labels, and write what they are."""
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.formats.run_arrays import read_room
    from world2minecraft.minecraftocc.cell_predictions import (
        cells_of_room,
        resample_to_grid,
        write_cells,
    )
    from world2minecraft.reconstruction.parameters import Parameters, with_settings
    from world2minecraft.reconstruction.pipeline import reconstruct

    chosen = Parameters(predictor=predictor)
    chosen = with_settings(chosen, [] if fov is None else [f"capture.fov_deg={fov}"])
    print_compile_note()
    with tempfile.TemporaryDirectory() as spare, show_progress() as progress:
        run_folder = Path(spare) if keep is None else keep
        reconstruct(capture, run_folder, chosen, until=LAST_STAGE, labels=labels, progress=progress)
        room, scan_to_room = read_room(run_folder / "room.npz")
    cells = cells_of_room(room)
    if place is None:
        write_cells(out, cells, "xyz", scan_to_room=scan_to_room)
        return cells
    cells = resample_to_grid(cells, scan_to_room, place)
    _write_frame(out, cells, place)
    return cells


def _write_frame(out: Path, cells: "PredictedCells", place: "GridPlace") -> None:
    """Write a frame in its file's own axes."""
    from world2minecraft.minecraftocc.cell_predictions import write_cells

    write_cells(out, cells, "xzy", camera_to_world=place.camera_to_world)


def summary_lines(source: Path, out: Path, cells: "PredictedCells", grid: Path | None) -> list[str]:
    """Return what is printed of the cells of a capture or a photo."""
    import numpy as np

    from world2minecraft.core.classes import CLASS_NAMES

    counts = np.bincount(cells.labels.reshape(-1), minlength=len(CLASS_NAMES))
    found = ", ".join(
        f"{CLASS_NAMES[n]} {counts[n]:,}" for n in range(1, len(CLASS_NAMES)) if counts[n]
    )
    sides = " x ".join(map(str, cells.labels.shape))
    next_step = f"w2m evaluate occupancy {out} {grid} --protocol monoscene"
    if grid is None:
        next_step = f"w2m reconstruct {source} --out OUT     makes a world of the same"
    return [
        f"{out}: {found}" if found else f"{out}: nothing but empty cells",
        f"{cells.observed.mean():.0%} of its {sides} cells were seen; the rest is a network's "
        "guess, or unknown",
        f"next: {next_step}",
    ]
