"""Does the graphics card draw what the CPU draws, and how fast?

``python -m benchmarks.check_gpu [--adapter NAME] [--poses 4] [--size 320 240] [--fast]``

It lists the adapters, then takes the same pictures on both: of a furnished room by day, with the
sun's shadows, by the game's light at night and in neutral light, from free cells and from inside
furniture; of display entities; of flats; of a heap of odd models. Then it times both in turn, a
picture at a time and all in one call. ``--fast`` leaves the times out; ``--picture`` keeps a pair
side by side, CPU left. Without ``--adapter`` the best hardware is taken, and software where there
is none. It leaves with 1 where a row is not equal enough, and with 2 where there is no adapter.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.check_render import CASES, Case
from benchmarks.render_scenes import camera_of, large, poses, room, scene_looks
from benchmarks.render_timing import time_all
from world2minecraft.render import LookLight, Picture, prepare_scene, render_volume
from world2minecraft.render.gpu import GpuRenderer, list_adapters
from world2minecraft.render.lamps import NEUTRAL
from world2minecraft.render.looks import OwnLooks
from world2minecraft.render.scene import BlockScene
from world2minecraft.report.pictures import as_png
from world2minecraft.types import Camera

LEAST_IDS, MOST_MEDIAN_M, LEAST_COLOUR = 0.9999, 1e-4, 0.99
MOST_APART = 2  # Of 255.
OUTPUTS = ("colour", "semantic", "instance", "opaque", "normal")
LIGHTS = (
    LookLight(),
    LookLight(sun_shadow=True, hour=9.0),
    LookLight(preset="game", hour=21.0),
    NEUTRAL,
)
TEXTURE_PX = 16
SIZES = ((224, 224), (640, 480), (1920, 1129))
TIMED = ("colour", "semantic", "instance")


class Agreement(NamedTuple):
    """What one row of the table says."""

    pixels: int
    ids: float  # share of pixels with the same cell, thing and face, and the same behind glass
    median_m: float
    worst_m: float
    colour: float  # share of pixels within MOST_APART
    farthest: int

    @property
    def holds(self) -> bool:
        """Whether it is as good as it has to be."""
        return (
            self.ids >= LEAST_IDS and self.median_m < MOST_MEDIAN_M and self.colour >= LEAST_COLOUR
        )


def agreement(pairs: Sequence[tuple[Picture, Picture]]) -> Agreement:
    """Compare pictures of the GPU with those of the CPU."""
    same, depth, colour = [], [], []
    for ours, truth in pairs:
        equal = np.ones(truth.face.shape, bool)
        for name in ("block_index", "cube_index", "face", "opaque_index", "opaque_cube_index"):
            equal &= getattr(ours, name) == getattr(truth, name)
        same.append(equal.ravel())
        depth.append(np.abs(ours.depth_m - truth.depth_m)[equal & (truth.depth_m > 0)])
        colour.append(np.abs(ours.colour.astype(int) - truth.colour).max(axis=2).ravel())
    ids, errors, apart = (np.concatenate(each) for each in (same, depth, colour))
    return Agreement(
        ids.size, float(ids.mean()), float(np.median(errors)), float(errors.max()),
        float((apart <= MOST_APART).mean()), int(apart.max()),
    )  # fmt: skip


def compare(case: Case, camera: Camera, count: int, seed: int, adapter: str) -> list[tuple]:
    """Return the pictures of a case, GPU and CPU; each light has its turn."""
    volume, looks = case.volume(), case.looks()
    if case.looks is scene_looks:
        looks = OwnLooks(TEXTURE_PX)
    scene = prepare_scene(volume, looks, texture_px=TEXTURE_PX)
    gpu = GpuRenderer(scene, adapter=adapter)
    pairs = []
    for n, pose in enumerate(poses(volume, count, seed, looks=looks, inside=case.inside)):
        how = {"outputs": OUTPUTS, "light": LIGHTS[n % len(LIGHTS)]}
        truth = render_volume(scene, camera, pose, **how)
        pairs.append((gpu.render(camera, pose, **how), truth))
    gpu.close()
    return pairs


def equality(console: Console, chosen: argparse.Namespace, adapter: str) -> bool:
    """Print the table of equality; return whether all rows hold."""
    table = Table(
        "scene", "pixels", "equal ids", "median depth error", "worst",
        f"colour within {MOST_APART}", "worst", "", box=None,
    )  # fmt: skip
    camera, holds = camera_of(*chosen.size), True
    cases = [*CASES, Case("flats 256x64x256, free cells", large, scene_looks, False)]
    for number, case in enumerate(cases):
        pairs = compare(case, camera, chosen.poses, 200 + number, adapter)
        if number == 0 and chosen.picture:
            ours, truth = pairs[1]
            chosen.picture.write_bytes(as_png(np.hstack([truth.colour, ours.colour])))
        row = agreement(pairs)
        holds &= row.holds
        table.add_row(
            case.name, f"{row.pixels:,}", f"{row.ids:.4%}", f"{row.median_m:.1e} m",
            f"{row.worst_m:.1e} m", f"{row.colour:.3%}", str(row.farthest),
            "ok" if row.holds else "WRONG",
        )  # fmt: skip
    console.print(table)
    return holds


def times(console: Console, chosen: argparse.Namespace, adapter: str) -> None:
    """Print how long a picture takes on both, taken in turn."""
    table = Table(
        "scene and size", "CPU: wall", "its CPU time", "spread", "GPU: wall", "its CPU time",
        "spread", "GPU, all in one call: wall", box=None,
    )  # fmt: skip
    for name, volume in (("room", room(4.0)), ("flats 256x64x256", large())):
        scene = prepare_scene(volume, OwnLooks(TEXTURE_PX), texture_px=TEXTURE_PX)
        gpu = GpuRenderer(scene, adapter=adapter)
        cameras = poses(volume, chosen.poses, 300)
        for size in SIZES:
            table.add_row(
                f"{name} {size[0]}x{size[1]}", *_times(scene, gpu, size, cameras, chosen.rounds)
            )
        gpu.close()
    console.print(table)


def _times(
    scene: BlockScene, gpu: GpuRenderer, size: tuple[int, int], cameras: list, rounds: int
) -> list[str]:
    camera = camera_of(*size)
    took = time_all(
        {
            "cpu": lambda pose: render_volume(scene, camera, pose, outputs=TIMED),
            "gpu": lambda pose: gpu.render(camera, pose, outputs=TIMED),
        },
        cameras,
        rounds,
    )
    walls = []
    for _ in range(rounds):
        start = time.perf_counter()
        for _picture in gpu.render_many(camera, cameras, outputs=TIMED):
            pass
        walls.append(1000 * (time.perf_counter() - start) / len(cameras))
    cells = []
    for one in (took["cpu"], took["gpu"]):
        cells += [f"{one.wall_ms:.1f} ms", f"{one.cpu_ms:.1f} ms", f"{one.spread:.0%}"]
    return [*cells, f"{min(walls):.1f} to {max(walls):.1f} ms"]


def main() -> int:
    """Print all; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--adapter", help="a part of its name, or software")
    parser.add_argument("--poses", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--fast", action="store_true", help="no times")
    parser.add_argument("--picture", type=Path, help="where a pair goes, PNG")
    chosen = parser.parse_args()
    console = Console(width=150)
    found = list_adapters()
    for one in found:
        kind = "software" if one.is_software else "hardware"
        console.print(f"adapter: {one.name}, {one.backend}, {kind}")
    if not found:
        console.print("no adapter: pip install 'world2minecraft[gpu]', and a Vulkan driver")
        return 2
    adapter = chosen.adapter or ("software" if found[0].is_software else found[0].name)
    if all(one.is_software for one in found):
        console.print("No graphics card here: the times are those of software on the CPU.")
    holds = equality(console, chosen, adapter)
    if not chosen.fast:
        times(console, chosen, adapter)
    return int(not holds)


if __name__ == "__main__":
    sys.exit(main())
