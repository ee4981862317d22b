"""Completion of single frames by SSCNet's protocol, scored beyond the room too.

``python -m benchmarks.check_single_frames [--split tune] [--trials 2] [--scans FOLDER]
[--verbose] [--json FILE]``

Each trial of the scan benchmark gives one frame: of its almost level images, the one that looks
farthest. The depth is bent smoothly by up to 2 cm at 2.5 m, growing with the depth squared, and the
stated pose leans by 0.6 degrees about each horizontal axis. The frame is completed in a grid along
the walls, in one along the camera, as in NYUv2, and without its floor in view. In the ground truth
walls are 4 cm thick, and everything behind them is empty.

Figures are in percent: IoU, precision and recall over hidden and surface cells, IoU over hidden
cells alone, the mIoU of 11 classes over all frames, and the mean over the frames of the mIoU of the
classes that they show. ``beyond`` is the number of filled cells behind walls in a frame, and
``low`` the precision from 0.08 to 0.6 m above the floor.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy import ndimage
from scipy.spatial.transform import Rotation

from benchmarks.check_faithful import chosen_trials
from world2minecraft.capture.images import read_colour, read_raw
from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts, count_occupancy
from world2minecraft.evaluation.metrics.protocols import (
    PROTOCOLS,
    KnownCells,
    ProtocolCounts,
    count_frame,
)
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.evaluation.scoring.truth_files import Truth, read_truth
from world2minecraft.furniture.layout_checks import inside_polygon
from world2minecraft.minecraftocc.importers.imported_samples import ImportedFrame, make_sample
from world2minecraft.minecraftocc.scene_completion import SHAPE, VOXEL_M, GridPlace, complete_frame
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, write_trial
from world2minecraft.procgen.sensors.depth_camera import bend_depth
from world2minecraft.reconstruction.semantics.completion_labeller import CompletionModel

GROUPS = ("along the walls", "along the camera", "no floor in view")
PITCH_DEG = (-28.0, 0.0)
MIN_DEPTH_SHARE = 0.6
BEND_M = 0.02
TILT_DEG, CAMERA_YAW_DEG = 0.6, 3.0
SHELL_CELLS = 2  # Of the truth's 2 cm.
LOW_M = (0.08, 0.6)
WHOLE = ("beyond", "frames")
FLOOR_M, FLOOR_ROW_SHARE = 0.15, 0.01  # A row shows floor if this share of it is so low.


@dataclass(frozen=True, eq=False)
class View:
    """One depth image of a scan with its true pose, and the noise of the sensor in it.

    Attributes:
        depth_m: Bent depth in metres, float32 [H, W]; 0 for holes.
        colour: Colour image, uint8 [H, W, 3].
        camera: Camera of both.
        camera_to_truth: True pose in the frame of the ground truth, float64 [4, 4].
        lean: Error of the stated pose about the horizontal axes, float64 [3, 3].
    """

    depth_m: np.ndarray
    colour: np.ndarray
    camera: Camera
    camera_to_truth: np.ndarray
    lean: np.ndarray


@dataclass(frozen=True)
class Scores:
    """The counts of one completed frame.

    Attributes:
        ssc: Counts by SSCNet's protocol.
        low: Counts close above the floor, in the image.
        beyond: Number of filled cells in the image behind walls.
    """

    ssc: ProtocolCounts
    low: OccupancyCounts
    beyond: int


def pick_view(capture: Path, truth: Truth, rng: np.random.Generator) -> View | None:
    """Return the image that looks farthest of the almost level ones, or None if there is none."""
    stated = read_json(capture / "capture.json")
    camera = Camera(**{k: v for k, v in stated["depth_camera"].items() if k != "distortion"})
    best, best_m = "", 0.0
    for name, pose in (truth.camera_to_truth or {}).items():
        if PITCH_DEG[0] < np.degrees(np.arcsin(pose[2, 2])) < PITCH_DEG[1]:
            raw = read_raw(capture / "depth" / f"{name}.png")
            if (raw > 0).mean() >= MIN_DEPTH_SHARE and np.median(raw[raw > 0]) / 1000 > best_m:
                best, best_m = name, float(np.median(raw[raw > 0])) / 1000
    if not best:
        return None
    depth_m = read_raw(capture / "depth" / f"{best}.png") / 1000.0
    depth_m = bend_depth(depth_m / (truth.depth_scale or {}).get(best, 1.0), BEND_M, rng)
    lean = Rotation.from_rotvec(np.radians([*rng.normal(0, TILT_DEG, 2), 0])).as_matrix()
    colour = read_colour(capture / "colour" / f"{best}.png")
    return View(depth_m, colour, camera, truth.camera_to_truth[best], lean)  # type: ignore[index]


def without_floor(view: View) -> View:
    """Return the view cut off above the first row that shows floor."""
    camera, pose = view.camera, view.camera_to_truth
    rows, columns = np.indices(view.depth_m.shape) + 0.5
    rays = np.stack(
        [
            (columns - camera.cx_px) / camera.fx_px,
            (rows - camera.cy_px) / camera.fy_px,
            np.ones(rows.shape),
        ],
        axis=-1,
    )
    height_m = (rays * view.depth_m[..., None]) @ pose[2, :3] + pose[2, 3]
    low = (view.depth_m > 0) & (height_m < FLOOR_M)
    shows = np.flatnonzero(low.mean(axis=1) > FLOOR_ROW_SHARE)
    end = int(shows[0]) if len(shows) else len(low)
    return replace(
        view,
        depth_m=np.where(low, 0, view.depth_m)[:end].astype(np.float32),
        colour=np.ascontiguousarray(view.colour[:end]),
        camera=replace(camera, height_px=end),
    )


def open_truth(truth: Truth) -> np.ndarray:
    """Return the labels of the truth, 255 everywhere behind thin walls, floors and ceilings."""
    shape, voxel_m = truth.labels.shape, truth.voxel_m
    plan_m = (np.indices(shape[:2]).reshape(2, -1).T + 0.5) * voxel_m + truth.origin_m[:2]
    height_m = (np.arange(shape[2]) + 0.5) * voxel_m + truth.origin_m[2]
    around = np.zeros(shape, bool)
    edge_m = SHELL_CELLS * voxel_m
    for layout in truth.layouts:
        inside = inside_polygon(plan_m, layout.floor_polygon_m, 0.0).reshape(shape[:2])
        inside = ndimage.binary_dilation(inside, np.ones((3, 3)), iterations=SHELL_CELLS)
        top_m = layout.floor_z_m + layout.wall_height_m
        level = (height_m > layout.floor_z_m - edge_m) & (height_m < top_m + edge_m)
        around |= inside[..., None] & level
    return np.where(around, truth.labels, np.uint8(UNKNOWN))


def grid_of(view: View, group: str, rng: np.random.Generator) -> tuple[GridPlace, np.ndarray]:
    """Return the grid with the stated pose, and the transform from the truth to its world."""
    turn = np.eye(4)
    forward = view.camera_to_truth[:2, 2] / np.linalg.norm(view.camera_to_truth[:2, 2])
    if group == "along the camera":
        yaw_deg = 90 - np.degrees(np.arctan2(forward[1], forward[0]))
        turn = rotation_about_z(yaw_deg + rng.normal(0, CAMERA_YAW_DEG))
    pose = turn @ view.camera_to_truth
    half_m = SHAPE[0] * VOXEL_M / 2
    plan = pose[:2, 3] + (turn[:2, :2] @ forward) * (half_m if group == "along the camera" else 2.0)
    plan = np.round((plan - half_m) / VOXEL_M) * VOXEL_M + rng.uniform(-0.5, 0.5, 2) * VOXEL_M
    low = np.array([*plan, -VOXEL_M * rng.uniform(1, 2)])
    pose[:3, :3] = view.lean @ pose[:3, :3]
    return GridPlace(low, pose), turn


def score_view(
    view: View, group: str, truth: Truth, seed: int, model: CompletionModel
) -> Scores | None:
    """Complete a view and count its cells; None if the view shows nothing without its floor."""
    if group == "no floor in view":
        view = without_floor(view)
    if not view.depth_m.any():
        return None
    place, turn = grid_of(view, group, np.random.default_rng([seed, 2]))
    carried = carry_truth(
        open_truth(truth), truth.voxel_m, truth.origin_m, turn, SHAPE, place.origin_m, VOXEL_M
    )
    known = known_cells(view, place, np.where(carried == UNKNOWN, np.uint8(0), carried))
    labels = complete_frame(
        view.depth_m, place, colour=view.colour, camera=view.camera, model=model
    ).labels
    in_image = np.asarray(known.in_frustum)
    height_m = place.origin_m[2] + (np.arange(SHAPE[2]) + 0.5) * VOXEL_M
    low = in_image & ~np.asarray(known.free) & (height_m > LOW_M[0]) & (height_m < LOW_M[1])
    beyond = (carried == UNKNOWN) & (labels > 0) & in_image & ~np.asarray(known.seen)
    return Scores(
        count_frame(PROTOCOLS["ssc"], labels, known),
        count_occupancy(labels, known.labels, low),
        int(beyond.sum()),
    )


def known_cells(view: View, place: GridPlace, labels: np.ndarray) -> KnownCells:
    """Return the true cells of a frame and which of them its image shows."""
    frame = ImportedFrame(
        Path("frame"), labels, place.origin_m, place.camera_to_world, view.camera, None,
        view.depth_m,
    )  # fmt: skip
    occ = make_sample(
        frame, "frame", scene_id="frame", tour_id="", frame=0, split="", format="nyu"
    ).occ
    return KnownCells(labels, occ.in_frustum, occ.visible, occ.free & (labels == 0) & ~occ.visible)


def figures(scores: Sequence[Scores]) -> dict[str, float]:
    """Return the figures of some frames, in percent except for ``beyond`` and ``frames``."""
    ssc = sum((one.ssc for one in scores), ProtocolCounts())
    low = sum((one.low for one in scores), OccupancyCounts())
    shares = {
        "iou": ssc.classes.iou,
        "precision": ssc.classes.precision,
        "recall": ssc.classes.recall,
        "hidden_iou": ssc.geometry.iou,
        "miou": ssc.classes.miou,
        "miou_present": float(np.mean([one.ssc.classes.miou_present for one in scores])),
        "low": low.precision,
    }
    return {name: round(100 * value, 2) for name, value in shares.items()} | {
        "beyond": float(np.mean([one.beyond for one in scores])),
        "frames": len(scores),
    }


def figures_table(rows: dict[str, dict[str, float]]) -> Table:
    """Return a table with one row of figures for each name."""
    columns = list(next(iter(rows.values()), {}))
    table = Table("frame", *columns, box=None, pad_edge=False, header_style="bold")
    for column in table.columns[1:]:
        column.justify = "right"
    for name, row in rows.items():
        table.add_row(
            name, *(f"{row[c]:.{0 if c in ('beyond', 'frames') else 1}f}" for c in columns)
        )
    return table


def scans(base: Path, split: str, trials: int) -> Iterator[tuple[str, int, Path]]:
    """Yield the name, seed and capture of each trial; those that are missing are written."""
    for trial in chosen_trials(split, DIFFICULTIES, trials):
        folder = base / trial.name
        if not (folder / "truth.json").is_file():
            write_trial(trial, folder)
        yield trial.name, trial.seed, folder


def main() -> None:
    """Print the table of figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--split", choices=("tune", "test"), default="tune")
    parser.add_argument("--trials", type=int, default=2, help="trials of each difficulty")
    parser.add_argument("--scans", type=Path, help="a folder for the scans, to run again sooner")
    parser.add_argument("--verbose", action="store_true", help="a row for each frame")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    model = CompletionModel()
    found: dict[str, dict[str, Scores]] = {group: {} for group in GROUPS}
    with tempfile.TemporaryDirectory() as temporary:
        base = chosen.scans or Path(temporary)
        for name, seed, capture in scans(base, chosen.split, chosen.trials):
            truth = read_truth(capture)
            view = pick_view(capture, truth, np.random.default_rng([seed, 1]))
            if view is None:
                print(f"{name}: no image that is almost level", file=sys.stderr)
                continue
            for group in GROUPS:
                scores = score_view(view, group, truth, seed, model)
                if scores is not None:
                    found[group][name] = scores
    rows = {}
    for group, frames in found.items():
        if chosen.verbose:
            rows |= {f"{group}: {name}": figures([one]) for name, one in frames.items()}
        if frames:
            rows[group] = figures(list(frames.values()))
    Console(width=150).print(figures_table(rows))
    if chosen.json:
        write_json(chosen.json, {"figures": rows})


if __name__ == "__main__":
    main()
