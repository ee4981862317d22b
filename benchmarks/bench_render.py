"""The renderer and the virtual scanner: CPU time per image, seconds per capture.

``python -m benchmarks.bench_render`` prints a table with wall time and spread. The scenes are a
furnished room built at 4 and 2 blocks per metre, and blocks of flats of 0.14 and 4.2 million cells;
cameras stand at random positions indoors. The rival is ``benchmarks.rival_rasteriser``.
"""

import argparse
import gc
import io
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from rich.console import Console
from rich.table import Table

from benchmarks.__main__ import machine
from benchmarks.render_scenes import (
    Timing,
    camera_of,
    large,
    poses,
    room,
    scene_looks,
    small,
    time_all,
)
from benchmarks.rival_rasteriser import Rasteriser, mesh_of, why_not
from benchmarks.rows import Row
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.rendering import BlockScene, prepare_scene, preview, render_volume
from world2minecraft.rendering.light import LightSettings

SCENES: dict[str, Callable[[], BlockVolume]] = {
    "room, 4 blocks/m": lambda: room(4.0),
    "room, 2 blocks/m": lambda: room(2.0),
    "flats 60x40x60": small,
    "flats 256x64x256": large,
}
# Width, height, CPU milliseconds of the issue, poses a round.
SIZES = ((224, 224, 5.0, 4), (640, 480, 15.0, 8), (1920, 1129, 120.0, 3))
RGB_DEPTH_IDS = ("colour", "depth", "semantic", "instance")
LIGHT, SUNNY = LightSettings(), LightSettings(sun_shadow=True)
# What is measured: the outputs and the light. "depth, ids" is what the way of the rays takes.
MODES = {
    "rgb, depth, ids": (RGB_DEPTH_IDS, LIGHT),
    "rgb, depth, ids, sun shadow": (RGB_DEPTH_IDS, SUNNY),
    "rgb, depth, blocks": (("colour",), LIGHT),
    "depth, blocks": ((), LIGHT),
}
RIVALS = ("llvmpipe", "llvmpipe, chunks culled")
JPEG_QUALITY = 90
DATASET_IMAGES, DATASET_CORES, DATASET_HOURS = 100_000, 2, 2.5
SLICE = 8  # Images of the slice that the data set's time is extrapolated from.


@dataclass(frozen=True)
class Measured:
    """One line: a scene, a size, what was made by whom, and how long it took."""

    scene: str
    width: int
    height: int
    what: str
    timing: Timing
    budget_ms: float | None


def run() -> list[Row]:
    """Measure; CPU time of the least of some rounds, because the machine may be shared."""
    rows = []
    for name, make in SCENES.items():
        volume = make()
        rows += _preparation(name, volume)
        rows += [row for measured in _of_size(measure(name, volume)) for row in _rows(measured)]
        gc.collect()
    rows += _data_set()
    volume = room(4.0)
    seconds = _least(lambda: preview(volume, 960, 720), 2)
    rows.append(Row("preview 960x720, 4 blocks a metre", seconds, "s"))
    rows.append(_scan())
    return rows


def measure(name: str, volume: BlockVolume) -> list[Measured]:
    """Time every size and mode of a scene, and the rival's where it can run."""
    scene = prepare_scene(volume, scene_looks())
    mesh = None if why_not() else mesh_of(scene.tables, LIGHT.parameters(scene.exposure or 1.0))
    found = []
    for width, height, budget, count in SIZES:
        camera = camera_of(width, height)
        works = {what: _ours(scene, camera, *mode) for what, mode in MODES.items()}
        rival = None
        if mesh is not None:
            rival = Rasteriser(mesh, scene.tables.texels, scene.side_px, camera)
            works |= {what: _rivals(rival, scene, "chunks" in what) for what in RIVALS}
        timings = time_all(works, poses(volume, count, 7))
        for what, timing in timings.items():
            own = budget if what == "rgb, depth, ids" else None
            found.append(Measured(name, width, height, what, timing, own))
        if rival is not None:
            rival.release()
    return found


def _ours(scene: BlockScene, camera: Camera, outputs, light: LightSettings):
    return lambda pose: render_volume(scene, camera, pose, outputs=outputs, light=light)


def _rivals(rival: Rasteriser, scene: BlockScene, by_chunk: bool):
    return lambda pose: rival.draw(scene.room_to_grid @ pose, by_chunk=by_chunk)


def _of_size(measured: list[Measured]) -> list[list[Measured]]:
    return [[one for one in measured if one.width == size[0]] for size in SIZES]


def _rows(group: list[Measured]) -> list[Row]:
    """Return a row for each of our modes; that with a budget says the rivals' ratios too."""
    by_what = {one.what: one for one in group}
    rows = []
    for what in MODES:
        one = by_what[what]
        head = f"{one.scene}, {one.width}x{one.height}"
        rows.append(Row(f"{head}: {what}", one.timing.cpu_ms, "ms", one.budget_ms))
        if one.budget_ms is None:
            continue
        for rival in RIVALS:
            if rival in by_what:
                ratio = by_what[rival].timing.cpu_ms / one.timing.cpu_ms
                value = by_what[rival].timing.cpu_ms
                rows.append(Row(f"{head}: {rival}", value, "ms", None, "ours is", ratio))
            else:
                rows.append(Row(f"{head}: {rival}", 0.0, "ms", None, f"skipped: {why_not()}"))
    return rows


def _preparation(name: str, volume: BlockVolume) -> list[Row]:
    """How long a scene takes to prepare, and what it holds a cell."""
    seconds = _least(lambda: prepare_scene(volume, scene_looks()), 2)
    tables = prepare_scene(volume, scene_looks()).tables
    by_cell = (tables.space, tables.bounds, tables.looks, tables.light)
    held = sum(array.nbytes for array in by_cell) / volume.states.size
    return [
        Row(f"{name}: prepare the scene", 1000 * seconds, "ms"),
        Row(f"{name}: memory of the scene", held, "bytes/cell"),
    ]


def _data_set() -> list[Row]:
    """A slice of a data set: pictures of 1920x1129 with depth and ids, encoded as JPEG."""
    volume = room(4.0)
    scene, camera = prepare_scene(volume, scene_looks()), camera_of(1920, 1129)

    def one(pose: np.ndarray) -> None:
        picture = render_volume(scene, camera, pose, outputs=RGB_DEPTH_IDS, light=LIGHT)
        Image.fromarray(np.asarray(picture.colour)).save(io.BytesIO(), "JPEG", quality=JPEG_QUALITY)

    timing = time_all({"slice": one}, poses(volume, SLICE, 11), rounds=2)["slice"]
    hours = timing.cpu_ms / 1000 * DATASET_IMAGES / DATASET_CORES / 3600
    return [
        Row(f"slice of {SLICE} images 1920x1129, JPEG too", timing.cpu_ms, "ms an image", 180.0),
        Row("100,000 of them on two cores, extrapolated", hours, "h", DATASET_HOURS),
    ]


def _scan() -> Row:
    room_ = generate_room(1, kind="living")
    with tempfile.TemporaryDirectory() as folder:
        scan_room(room_, Path(folder) / "warm", frames=1, width=320, height=240)
        start = time.process_time()
        scan_room(room_, Path(folder) / "scan", frames=40)
        seconds = time.process_time() - start
    # Kilobytes on Linux, bytes on macOS.
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    peak_mb = peak / (1 << 20 if sys.platform == "darwin" else 1 << 10)
    return Row(
        "virtual scan, 40 frames 640x480, files and truth", seconds, "s", 6.0, peak_mb=peak_mb
    )


def _least(work: Callable[[], object], rounds: int) -> float:
    work()
    times = []
    for _ in range(rounds):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


COLUMNS = (
    "scene", "size", "ours", "with sun", "no colour", "rival", "culled", "culled/ours",
    "spread", "wall: ours", "culled",
)  # fmt: skip


def line(group: list[Measured]) -> list[str]:
    """Return one line of the table: a scene at a size, in milliseconds."""
    one, timing = group[0], {measured.what: measured.timing for measured in group}
    ours = [timing[what] for what in ("rgb, depth, ids", "rgb, depth, ids, sun shadow")]
    ours.append(timing["depth, blocks"])
    rivals = [timing[what] for what in RIVALS if what in timing]
    cells = [one.scene, f"{one.width}x{one.height}", *(f"{each.cpu_ms:.1f}" for each in ours)]
    if not rivals:
        return [*cells, "-", "-", "-", f"+{ours[0].spread:.0%}", f"{ours[0].wall_ms:.1f}", "-"]
    ratio = f"{rivals[1].cpu_ms / ours[0].cpu_ms:.2f}"
    spread = f"+{max(ours[0].spread, rivals[1].spread):.0%}"
    walls = f"{ours[0].wall_ms:.1f}", f"{rivals[1].wall_ms:.1f}"
    return [*cells, *(f"{each.cpu_ms:.1f}" for each in rivals), ratio, spread, *walls]


def main() -> None:
    """Print a table of everything that is timed; ``--only TEXT`` takes the scenes with a text."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", default="", metavar="TEXT")
    chosen = parser.parse_args()
    table = Table(*COLUMNS, box=None)
    for name, make in SCENES.items():
        if chosen.only in name:
            for group in _of_size(measure(name, make())):
                table.add_row(*line(group))
            gc.collect()
    console = Console(width=130)
    console.print(machine())
    console.print(table)
    if why_not():
        console.print(f"The rival was skipped: {why_not()}.")


if __name__ == "__main__":
    main()
