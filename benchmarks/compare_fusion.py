"""Fusion of RGB-D frames against Open3D's VoxelBlockGrid, in one run on one thread.

``python -m benchmarks.compare_fusion CAPTURE [--open3d FOLDER] [--frames 8] [--repeats 9]
[--voxel 0.08] [--json FILE]``

Both sides integrate the depth and the colour of the same decoded frames into voxels of the same
size and compute the normals of each frame. Reading and decoding are not timed. Timed are:

- ours: lifting, which gives each pixel a point, a normal and a colour, and ``EvidenceMap.add``,
  which sums points, colours and planes in cells and carves free space along rays;
- Open3D: ``create_vertex_map`` and ``create_normal_map``, the choice of blocks within the
  truncation of 4 voxels, and ``integrate``. Its images, float32 as it requires, are made before.
  It neither stores the normals nor carves the space in front of the truncation.

The extraction at the end, our ``fused`` and its ``extract_point_cloud`` with normals, is timed
separately, per capture. Figures are seconds of CPU of the whole process: the least and the median
of the repeats, which alternate between both sides. Open3D is no dependency: install it with
``pip install --target FOLDER open3d`` and name the folder. Without it, only our figures are
printed.
"""

import argparse
import importlib
import itertools
import os
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from world2minecraft.capture import open_scan
from world2minecraft.core.files import write_json
from world2minecraft.core.types import Camera, View
from world2minecraft.reconstruction.fusion import EvidenceMap, FusionParameters
from world2minecraft.reconstruction.occupancy.depth_evidence import MAX_DEPTH_M, DepthPredictor

BLOCK_SIDE, BLOCKS, TRUNCATION_VOXELS = 8, 4000, 4.0


@dataclass(frozen=True)
class Cost:
    """The CPU time of one repeat.

    Attributes:
        frame_s: Seconds per frame.
        extraction_s: Seconds for the extraction of all frames together.
    """

    frame_s: float
    extraction_s: float


def every_nth(items: Sequence[Any], count: int) -> list[Any]:
    """Return at most ``count`` items, spread evenly from the first."""
    step = max(1, len(items) // max(count, 1))
    return list(itertools.islice(items, 0, None, step))[:count]


def summary(ours: Sequence[Cost], rival: Sequence[Cost]) -> dict[str, float]:
    """Return the least and the median cost of each side in milliseconds, and their ratios.

    A ratio above 1 means that ours is faster. Without costs of the rival, its figures are missing.
    """
    figures = {}
    for name, costs in (("ours", ours), ("open3d", rival)):
        if costs:
            frames_ms = [1e3 * cost.frame_s for cost in costs]
            figures[f"{name}_frame_ms"] = min(frames_ms)
            figures[f"{name}_frame_median_ms"] = statistics.median(frames_ms)
            figures[f"{name}_extraction_ms"] = min(1e3 * cost.extraction_s for cost in costs)
    if rival:
        figures["ratio"] = figures["open3d_frame_ms"] / figures["ours_frame_ms"]
        medians = figures["open3d_frame_median_ms"], figures["ours_frame_median_ms"]
        figures["ratio_of_medians"] = medians[0] / medians[1]
    return figures


def fuse_ours(views: Sequence[View], scan_to_room: np.ndarray, voxel_m: float) -> Cost:
    """Fuse views with this program."""
    lift = DepthPredictor().lift
    map_ = EvidenceMap(scan_to_room, FusionParameters(voxel_m))
    begun = time.process_time()
    for view in views:
        map_.add(lift(view, scan_to_room))
    integrated = time.process_time()
    map_.fused()
    return Cost((integrated - begun) / len(views), time.process_time() - integrated)


def rival_of(views: Sequence[View], voxel_m: float, open3d: ModuleType) -> Callable[[], Cost]:
    """Return a function that fuses views with Open3D; its images are made at once."""
    core, vision = open3d.core, open3d.t.geometry
    frames = [
        (
            vision.Image(core.Tensor(np.ascontiguousarray(view.depth_m))),
            vision.Image(core.Tensor(np.asarray(view.colour, np.float32) / 255)),
            core.Tensor(intrinsics(view.depth_camera)),
            core.Tensor(intrinsics(view.colour_camera)),
            core.Tensor(np.linalg.inv(view.depth_camera_to_scan)),
        )
        for view in views
    ]

    def fuse() -> Cost:
        grid = vision.VoxelBlockGrid(
            ("tsdf", "weight", "color"), (core.float32,) * 3, ((1), (1), (3)), voxel_m,
            BLOCK_SIDE, BLOCKS, core.Device("CPU:0"),
        )  # fmt: skip
        begun = time.process_time()
        for depth, colour, inner, outer, extrinsic in frames:
            depth.create_vertex_map(inner, 0.0).create_normal_map(0.0)
            limits = 1.0, MAX_DEPTH_M, TRUNCATION_VOXELS
            blocks = grid.compute_unique_block_coordinates(depth, inner, extrinsic, *limits)
            grid.integrate(blocks, depth, colour, inner, outer, extrinsic, *limits)
        integrated = time.process_time()
        grid.extract_point_cloud(0.0)
        return Cost((integrated - begun) / len(frames), time.process_time() - integrated)

    return fuse


def intrinsics(camera: Camera | None) -> np.ndarray:
    """Return the matrix of a camera as Open3D takes it, float64 [3, 3]."""
    if camera is None:
        raise SystemExit("a frame has no camera for its depth or its colour")
    return np.ascontiguousarray(camera.matrix)


def load_open3d(folder: Path | None) -> tuple[ModuleType | None, str]:
    """Return the module, or None and the reason, after limiting it to one thread."""
    os.environ["OMP_NUM_THREADS"] = "1"
    if folder is not None:
        sys.path.append(str(folder))  # Last: numpy and others stay those of the project.
    try:
        return importlib.import_module("open3d"), ""
    except ImportError as error:
        return None, f"Open3D is not available ({error}); install it and name it with --open3d"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.compare_fusion")
    parser.add_argument("capture", type=Path)
    parser.add_argument("--open3d", type=Path, help="folder in which Open3D is installed")
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--voxel", type=float, default=0.08, help="size of a voxel in metres")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    options = parser.parse_args()
    open3d, reason = load_open3d(options.open3d)
    scan = open_scan(options.capture)
    chosen = every_nth(range(len(scan.views)), options.frames)
    numbered = enumerate(scan.views)
    views = [
        v for n, v in numbered if n in chosen and v.depth_m is not None and v.colour is not None
    ]
    if not views:
        raise SystemExit(f"{options.capture} has no frames with depth and colour")
    rival = None if open3d is None else rival_of(views, options.voxel, open3d)
    ours_costs: list[Cost] = []
    rival_costs: list[Cost] = []
    for turn in range(options.repeats + 1):
        mine = fuse_ours(views, scan.scan_to_room, options.voxel)
        other = None if rival is None else rival()
        if turn:  # The first compiles the kernels.
            ours_costs.append(mine)
            rival_costs += [] if other is None else [other]
    figures = summary(ours_costs, rival_costs)
    for name, value in figures.items():
        print(f"{name:<26}{value:8.2f}")
    if reason:
        print(reason)
    if options.json:
        write_json(options.json, figures)


if __name__ == "__main__":
    main()
