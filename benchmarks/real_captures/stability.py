"""Stability: how much of a result remains when the room frame is turned by up to a degree."""

import shutil
from pathlib import Path

import numpy as np

from benchmarks.real_captures.scoring import Stability, thing_stability
from world2minecraft.core.files import read_json, write_json
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.scan_record import read_room_size
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct

RUNS = 5
MAX_TURN_DEG = 1.0
MAX_SHIFT_CELLS = 0.5
REGISTERED = ("scan.json", "poses.npz", "manifest.json")


def perturbation(rng: np.random.Generator, middle_m: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return a random rotation about a point and a random shift, as a 4x4 transform.

    The rotation is by up to ``MAX_TURN_DEG`` about any axis, the shift by up to
    ``MAX_SHIFT_CELLS`` along each.

    Args:
        rng: Random number generator.
        middle_m: Centre of the rotation, float64 [3].
        voxel_m: Cell size in metres.
    """
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angle = np.radians(rng.uniform(0, MAX_TURN_DEG))
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew
    moved = np.eye(4)
    moved[:3, :3] = turn
    moved[:3, 3] = middle_m - turn @ middle_m
    moved[:3, 3] += rng.uniform(-MAX_SHIFT_CELLS, MAX_SHIFT_CELLS, 3) * voxel_m
    return moved


def measure_stability(capture: Path, folder: Path, chosen: Parameters) -> Stability | None:
    """Fuse and label a registered capture five times in slightly different frames.

    Args:
        capture: Path of the capture.
        folder: Folder of the scene, which contains its finished ``run``.
        chosen: Parameters of the run.

    Returns:
        The shares of cells of things on whose class all runs agree, or None without things.
    """
    rng, grids = np.random.default_rng(0), []
    for number in range(RUNS):
        turned = folder / f"turned-{number}"
        _copy_registered(folder / "run", turned)
        scan = read_json(turned / "scan.json")
        middle_m = read_room_size(turned / "scan.json") / 2
        moved = perturbation(rng, middle_m, chosen.voxel_m)
        write_json(
            turned / "scan.json",
            scan | {"scan_to_room": (moved @ np.array(scan["scan_to_room"])).tolist()},
        )
        reconstruct(capture, turned, chosen, start="fuse", until="label")
        grids.append(read_room(turned / "room.npz"))
        shutil.move(turned / "room.npz", folder / f"turned-{number}.npz")
        shutil.rmtree(turned)
    return thing_stability(grids)


def _copy_registered(run: Path, turned: Path) -> None:
    """Copy what a run needs to start at the fuse stage."""
    shutil.rmtree(turned, ignore_errors=True)
    turned.mkdir(parents=True)
    for name in REGISTERED:
        shutil.copyfile(run / name, turned / name)
    if (run / "capture").is_dir():
        shutil.copytree(run / "capture", turned / "capture")
