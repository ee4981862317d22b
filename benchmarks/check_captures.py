"""One generated room, captured in four ways, gives one room.

``python -m benchmarks.check_captures [--seed 505] [--kind living]``

The room becomes a mesh, a point cloud, an RGB-D folder and a video without poses; each is given
to ``w2m reconstruct``. Printed is, for each two of the results, the share of the surface of the
one that lies within one voxel of the other's, over the cells that all four have observed. The
video, whose scale is judged from habits, is laid on the room by its cameras with its scale: what is
asked is its shape. What lies in the work folder already is not made again.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.photo_solids import write_cloud, write_mesh
from benchmarks.photo_table import (
    REACH_VOXELS,
    Cells,
    best_similarity,
    looked_up,
    moved,
    poses_of,
    read_cells,
)
from world2minecraft.cli import run
from world2minecraft.evaluate.truth import read_truth
from world2minecraft.rooms import Room, generate_room, scan_room
from world2minecraft.scan.options import ScanOptions
from world2minecraft.scan.solids.formats import load_solid
from world2minecraft.scan.solids.source import world_of

WAYS = ("mesh", "cloud", "rgbd", "video")
ASKED = 0.95


def main() -> int:
    """Print the table; the exit code says whether all agree."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=505)
    parser.add_argument("--kind", default="living")
    parser.add_argument("--work", type=Path, default=Path("OUT-captures"))
    parser.add_argument("--frames", type=int, default=100)
    chosen = parser.parse_args()
    room = generate_room(chosen.seed, kind=chosen.kind)
    capture(room, chosen.work, chosen.seed, chosen.frames)
    found = {}
    for way, (place, words) in inputs(chosen.work).items():
        out = chosen.work / f"out-{way}"
        made = (out / "report.json").is_file()
        if not made and run(["reconstruct", str(place), "--out", str(out), *words]):
            print(f"{way}: failed")
            return 1
        found[way] = in_truth(out, place, way)
    print_table(found)
    return 0


def capture(room: Room, work: Path, seed: int, frames: int) -> None:
    """Write the four captures."""
    work.mkdir(parents=True, exist_ok=True)
    write_mesh(room, work / "mesh.glb")
    write_cloud(room, work / "cloud.ply", seed)
    if not (work / "rgbd" / "capture.json").is_file():
        scan_room(room, work / "rgbd", sensor="rgbd", frames=frames, seed=seed)
    if not (work / "video" / "truth.npz").is_file():
        scan_room(room, work / "video", sensor="video", frames=frames, seed=seed)


def inputs(work: Path) -> dict[str, tuple[Path, list[str]]]:
    """Return what ``w2m reconstruct`` is given for each way."""
    return {
        "mesh": (work / "mesh.glb", ["--set", "capture.unit=m", "--set", "capture.up=z"]),
        "cloud": (work / "cloud.ply", ["--set", "capture.unit=m", "--set", "capture.up=z"]),
        "rgbd": (work / "rgbd", []),
        "video": (work / "video", []),
    }


def in_truth(out: Path, place: Path, way: str) -> tuple[Cells, np.ndarray]:
    """Return a run's cells, and the 4x4 from its capture's frame to the room's own."""
    if way in ("mesh", "cloud"):
        return read_cells(out / "room.npz"), np.linalg.inv(placed_solid(place))
    truth = read_truth(place)
    if way == "video":
        found = poses_of(out / "capture" / "capture.json")
        return read_cells(out / "room.npz"), best_similarity(found, truth.camera_to_truth or {})
    return read_cells(out / "room.npz"), np.linalg.inv(truth.truth_to_scan)


def placed_solid(place: Path) -> np.ndarray:
    """Return the 4x4 from a solid's own coordinates to the world in which it is looked at."""
    loaded = load_solid(place)
    file_to_world, _ = world_of(place, loaded, ScanOptions(unit="m", up="z"))
    near_origin = np.eye(4)
    near_origin[:3, 3] = -loaded.offset
    return file_to_world @ near_origin


def print_table(found: dict[str, tuple[Cells, np.ndarray]]) -> None:
    """Print the share of each one's surface that lies near each other's."""
    near = {}
    for way, (cells, to_truth) in found.items():
        points = moved(cells.occupied_m, to_truth)
        known = np.ones(len(points), bool)
        for other, other_to_truth in found.values():
            known &= looked_up(other, moved(points, np.linalg.inv(other_to_truth))) != 255
        near[way] = (points, known)
    print(" ".join([f"{'of, near':12}", *(f"{way:>8}" for way in WAYS)]) + "   cells all observed")
    least = 1.0
    for way in WAYS:
        points, known = near[way]
        row = []
        for other in WAYS:
            off, _ = cKDTree(near[other][0]).query(points[known])
            row.append(float((off <= REACH_VOXELS * found[way][0].voxel_m).mean()))
        least = min(least, *row)
        print(" ".join([f"{way:12}", *(f"{share:8.3f}" for share in row)]), f"{known.sum():12,}")
    print(f"least {least:.3f}, asked {ASKED}")


if __name__ == "__main__":
    sys.exit(main())
