"""Places of photos against the truth: how many are placed, how exactly, and what it costs.

``python -m benchmarks.check_posing CAPTURE... [--every 2] [--jitter-deg 1.5 --jitter-m 0.02]``

Each capture is placed twice: from its pixels alone (find), and from the poses and cameras that it
states (check), jittered where that is asked for. What a generated capture has in ``truth.npz`` is
the truth; else the stated poses are what is compared with. Centres and turns are those left after
the best similarity; ``frame`` is how far the centres are off as they stand, for check. Each row
runs in a process of its own, which gives the peak memory.
"""

import argparse
import resource
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.spatial.transform import Rotation

from world2minecraft.errors import InputError
from world2minecraft.posing import align_similarity, check_poses, find_poses
from world2minecraft.scan.judged import judge_capture
from world2minecraft.scan.options import ScanOptions
from world2minecraft.scan.photos import CapturePhotos, judged_photos
from world2minecraft.types import SparseScene

COLUMNS = (
    "placed", "centre mm", "worst", "turn deg", "frame mm", "before px", "error px", "focal",
    "points", "CPU s", "MB",
)  # fmt: skip


@dataclass(frozen=True)
class Trial:
    """One row: a capture, how it is placed, and what is done to its poses before."""

    capture: str
    mode: str
    every: int
    jitter_deg: float
    jitter_m: float


def photos_of(trial: Trial) -> CapturePhotos:
    """Return the photos as the trial hands them in."""
    photos = judged_photos(judge_capture(Path(trial.capture), ScanOptions(every=trial.every)))
    if trial.mode == "find":
        blind = [replace(one, camera_to_world=None, colour_camera=None) for one in photos.frames]
        return replace(photos, frames=tuple(blind))
    rng = np.random.default_rng(5)
    moved = []
    for one in photos.frames:
        pose = np.array(one.camera_to_world)
        turn = Rotation.from_rotvec(np.radians(trial.jitter_deg) * direction(rng)).as_matrix()
        pose[:3, :3] = turn @ pose[:3, :3]
        pose[:3, 3] += trial.jitter_m * direction(rng)
        moved.append(replace(one, camera_to_world=pose))
    return replace(photos, frames=tuple(moved))


def direction(rng: np.random.Generator) -> np.ndarray:
    """Return a random direction [3]."""
    way = rng.standard_normal(3)
    return way / np.linalg.norm(way)


def true_poses(trial: Trial) -> dict[str, np.ndarray]:
    """Return what the poses are compared with, by name, in the frame of the stated ones."""
    frames = judge_capture(Path(trial.capture), ScanOptions(every=trial.every)).frames
    stated = {one.name: np.array(one.camera_to_world) for one in frames}
    path = Path(trial.capture) / "truth.npz"
    if not path.is_file():
        return stated
    with np.load(path) as truth:
        to_scan = truth["truth_room_to_scan"]
        return {
            str(name): to_scan @ pose
            for name, pose in zip(truth["frame_names"], truth["camera_to_truth"], strict=True)
        }


def run(trial: Trial) -> list[str]:
    """Return one row of the table, or the error in its place."""
    place = check_poses if trial.mode == "check" else find_poses
    begun = time.process_time()
    try:
        scene = place(photos_of(trial))
    except InputError as error:
        return [f"{type(error).__name__}: {error}"]
    seconds = time.process_time() - begun
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    return [*figures(scene, true_poses(trial), trial.mode), f"{seconds:.1f}", f"{memory:.0f}"]


def figures(scene: SparseScene, truth: dict[str, np.ndarray], mode: str) -> list[str]:
    """Return the figures of a scene against true poses by name."""
    true = np.array([truth[name] for name in scene.names])
    off = align_similarity(scene.camera_to_scan, true)
    frame = np.linalg.norm(scene.camera_to_scan[:, :3, 3] - true[:, :3, 3], axis=1)
    facts = scene.facts
    return [
        f"{facts['photos_placed']}/{facts['photos_given']}",
        f"{1000 * np.median(off.off_m):.1f}",
        f"{1000 * off.off_m.max():.0f}",
        f"{np.median(off.off_deg):.2f}",
        f"{1000 * np.median(frame):.0f}" if mode == "check" else "",
        f"{facts['error_before_px']:.2f}" if mode == "check" else "",
        f"{scene.error_px:.2f}",
        f"{facts['focal_found_px']:.0f}",
        str(facts["points"]),
    ]


def main() -> None:
    """Print a row for each capture and way."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("captures", nargs="+")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--modes", default="find,check")
    parser.add_argument("--jitter-deg", type=float, default=0.0)
    parser.add_argument("--jitter-m", type=float, default=0.0)
    chosen = parser.parse_args()
    table = Table("capture", "", *COLUMNS)
    for capture in chosen.captures:
        for mode in chosen.modes.split(","):
            trial = Trial(capture, mode, chosen.every, chosen.jitter_deg, chosen.jitter_m)
            with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as one:
                table.add_row(Path(capture).name, mode, *one.submit(run, trial).result())
    Console(width=170).print(table)


if __name__ == "__main__":
    main()
