"""The main job against its budgets: fusion, building, the warm pipeline and the first run."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.check_tsdf import integrate
from benchmarks.clean_runs import user_environment
from benchmarks.rows import Row
from world2minecraft.construction import build_volume, write_build
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.minecraft.schematics.sponge import write_schem
from world2minecraft.procgen import generate_room, room_views, scan_room
from world2minecraft.reconstruction.fusion import EvidenceMap
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor

FRAMES = 40
REPEATS = 3


def run() -> list[Row]:
    """Return the rows of the main job."""
    return [*fusion(), building(), *whole_way()]


def best(work: Callable[[], object]) -> float:
    """Return the least of some wall times of ``work``, in seconds; the first warms up."""
    work()
    times = []
    for _ in range(REPEATS):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def fusion() -> list[Row]:
    """Fuse one 640x480 frame, against a TSDF in numpy on the same cells."""
    views = list(room_views(generate_room(0, kind="living"), frames=4, seed=0))
    lift = DepthPredictor().lift
    evidence = [lift(view) for view in views]
    map_ = EvidenceMap(np.eye(4))
    for item in evidence:
        map_.add(item)
    seconds = best(lambda: [map_.add(item) for item in evidence]) / len(views)
    frames = [(view.depth_m, view.depth_camera_to_scan) for view in views]
    shape = np.array(map_.fused().log_odds.shape) * 2
    low = map_.fused().origin_m
    rival = best(lambda: integrate(frames, np.eye(4), low, shape)) / len(views)
    return [
        Row("fusion of a 640x480 frame", 1e3 * seconds, "ms", 25, "numpy TSDF", rival / seconds),
        Row("lifting of a 640x480 frame", 1e3 * best(lambda: lift(views[0])), "ms"),
    ]


def furnished_grid() -> OccupancyGrid:
    """A room of 75 x 75 x 36 cells with a shell and coloured boxes."""
    random = np.random.default_rng(0)
    labels = np.zeros((75, 75, 36), np.uint8)
    labels[:, :, 0], labels[:, :, -1] = 2, 1
    labels[0], labels[-1], labels[:, 0], labels[:, -1] = 3, 3, 3, 3
    for number in range(30):
        x, y = random.integers(2, 64, 2)
        width, depth, height = random.integers(4, 9, 3)
        labels[x : x + width, y : y + depth, 1 : height + 1] = 5 + number % 7
    return OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=random.integers(0, 256, (*labels.shape, 3)).astype(np.uint8),
        source=np.ones(labels.shape, np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )


def building() -> Row:
    """From a fused grid to a finished world and schematic: find, furnish, build and write."""
    from world2minecraft.reconstruction.instances import InstanceParameters, find_objects
    from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates

    grid = furnished_grid()

    def work() -> None:
        found = find_objects(grid, InstanceParameters())
        placements = place_templates(found.grid, found.instances, RetrievalParameters())
        volume = build_volume(
            found.grid, placements, found.instances, corner_m=np.array([0.08, 5.92])
        )
        with tempfile.TemporaryDirectory() as folder:
            write_build(folder, volume)
            write_schem(volume, Path(folder) / "again.schem")

    return Row("grid 75x75x36 to world and schematic", best(work), "s", 1.5)


def whole_way() -> list[Row]:
    """A capture of 40 frames to world, report and preview: warm, and with nothing compiled."""
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder)
        scan_room(generate_room(0, kind="living"), base / "capture", frames=FRAMES)
        words = ["reconstruct", str(base / "capture"), "--out"]
        reconstruct(words, base / "first", {})
        scored, _ = reconstruct(words, base / "scored", {})
        for name in ("truth.npz", "truth.json"):  # What a user's capture lacks.
            (base / "capture" / name).unlink()
        warm, peak_mb = reconstruct(words, base / "warm", {})
        cold, _ = reconstruct(["demo", "--out"], base / "cold", {"W2M_CACHE_DIR": str(base / "c")})
    return [
        Row(f"{FRAMES} frames to world and report, warm", warm, "s", 8, peak_mb=peak_mb),
        Row("memory of the same", peak_mb, "MB", 1000),
        Row("the same, scored against its truth", scored, "s"),
        Row("demo, kernels compiling", cold, "s", 45),
    ]


def reconstruct(words: list[str], out: Path, environment: dict[str, str]) -> tuple[float, float]:
    """Run ``w2m`` apart; return its seconds and its peak memory in MB."""
    code = (
        "import resource, sys; from world2minecraft.cli import run; code = run(sys.argv[1:]);"
        "print('PEAK', resource.getrusage(resource.RUSAGE_SELF).ru_maxrss); sys.exit(code)"
    )
    begun = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", code, *words, str(out)],
        env=user_environment() | environment,
        check=True,
        capture_output=True,
        text=True,
    )
    seconds = time.perf_counter() - begun
    return seconds, int(done.stdout.split("PEAK")[-1]) / 1024
