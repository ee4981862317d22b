"""Occupancy labels and masks against slow references and the id buffer.

``python -m benchmarks.check_labels [--frames 200 --size 160 120] [--spoil] [--json FILE]``

Cameras are at the eyes of people standing in generated houses. Each frame is rendered and
labelled; a float64 ray caster independent of the kernels (``tests/rendering/oracle.py``) casts each
pixel again, and ``tests/minecraftocc/label_reference.py`` derives from its depth, cell by cell,
what is hit, what lies in the frustum and, for a sample, which cells are crossed by a ray. The exit
code is 1 if any cell of any frame differs; ``--spoil`` shifts the labels by a millimetre to show
that the check can fail.

The second table compares with the id buffer: how many pixels of the visible cells, and how many
cells, have the cell's class. ``bench_labels.py`` measures the time.
"""

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.ndimage import minimum_filter
from tests.minecraftocc import label_reference as reference
from tests.rendering.oracle import oracle_picture

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.files import write_json
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.minecraftocc.labels.camera_region import RegionRule, region_in
from world2minecraft.minecraftocc.labels.image_labels import (
    cells_of_pixels,
    label_image,
    resize_camera,
)
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.minecraftocc.tours import nyu_camera
from world2minecraft.minecraftocc.types import LabelRegion, OccLabels, SceneVoxels
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.rendering import BlockScene, Picture, prepare_scene, render_volume
from world2minecraft.rendering.block_models import BuiltinModels

EYE_M, TALL_M, ASIDE_M = 1.62, 1.8, 0.3  # The last: as near as one stands to a wall.
NYU = nyu_camera()
GAME = Camera(1920, 1129, 806.19, 806.19, 960.0, 564.5)  # The paper's window at FOV 70.


@dataclass(frozen=True, eq=False)
class House:
    """A house that is ready to be looked at."""

    seed: int
    volume: BlockVolume
    scene: BlockScene
    voxels: SceneVoxels
    blocks: SceneVoxels  # one cell a block


def houses(seeds: range) -> Iterator[House]:
    """Give the house of each seed; they have four to eight rooms, each sixth two storeys."""
    for seed in seeds:
        made = generate_world(seed, rooms=4 + seed % 5, storeys=1 + (seed % 6 == 1))
        scene = prepare_scene(made.volume)
        designs = (made.design, made.designs)
        fine, coarse = (
            voxelize_scene(made.volume, designs, voxel_m=size, scene=scene) for size in (0.08, None)
        )
        yield House(seed, made.volume, scene, fine, coarse)


def standing_views(voxels: SceneVoxels, count: int, seed: int) -> list[np.ndarray]:
    """Return cameras at the eyes of people who stand on a floor with nothing in their way.

    They look any way, from 25 degrees down to 10 up.
    """
    rng = np.random.default_rng(seed)
    tall = int(np.ceil(TALL_M / voxels.voxel_m))
    empty = voxels.labels == 0
    below = np.cumsum(empty, axis=2, dtype=np.int32)
    on_floor = voxels.labels[:, :, :-tall] == SemanticClass.FLOOR
    free = below[:, :, tall:] - below[:, :, :-tall] == tall
    top = empty.shape[2] - 1 - np.argmax(~empty[:, :, ::-1], axis=2)
    indoors = top[..., None] > np.arange(on_floor.shape[2]) + tall
    side = 2 * int(np.ceil(ASIDE_M / voxels.voxel_m)) + 1
    roomy = minimum_filter(free.astype(np.uint8), (side, side, 1), mode="constant") > 0
    places = np.argwhere(on_floor & roomy & indoors)
    views = []
    for cell in places[rng.integers(len(places), size=count)]:
        within = np.array([*rng.random(2), 1.0])
        eye = voxels.origin_m + (cell + within) * voxels.voxel_m
        eye[2] += EYE_M
        yaw, pitch = rng.uniform(0, 2 * np.pi), np.radians(rng.uniform(-25, 10))
        ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
        views.append(look_at(eye, eye + np.array(ahead)))
    return views


FIRST_SEED, FRAMES_A_HOUSE = 600, 10
FREE_CELLS = 200  # Of each frame that are tested against every ray.
SPOIL_M = 1e-3


def check_frame(
    house: House, camera: Camera, pose: np.ndarray, counts: Counter, spoil_m: float
) -> None:
    """Compare one frame with the references and add up what was compared and what differs."""
    voxels = house.voxels
    region = region_in(voxels, pose)
    picture = render_volume(house.scene, camera, pose, outputs=("depth", "semantic"))
    beside = pose.copy()
    beside[:3, 3] += spoil_m * pose[:3, 0]
    occ = label_image(voxels, region, camera, beside, picture.depth_m)
    truth = oracle_picture(house.volume, BuiltinModels(16), camera, pose)
    depth = np.where(np.isfinite(truth.depth), truth.depth, 0).astype(np.float32)
    hits = reference.hits(voxels, region, reference.scene_cells_seen(voxels, camera, pose, depth))
    counts["frames"] += 1
    counts["pixels"] += depth.size
    counts["pixels of other depth"] += int((np.abs(depth - picture.depth_m) > 1e-5).sum())
    counts["cells hit"] += int((hits > 0).sum())
    counts["hit or not, wrong"] += int(((hits > 0) != occ.visible).sum())
    counts["hits counted otherwise"] += int(np.abs(hits - occ.hits.astype(int)).sum())
    counts["cells in the region"] += occ.labels.size
    counts["labels wrong"] += int((occ.labels != reference.labels_of(voxels, region)).sum())
    frustum = reference.in_frustum(region, camera, pose)
    counts["in frustum, wrong"] += int((occ.in_frustum != frustum).sum())
    _check_free(occ, region, camera, pose, depth, counts)


def _check_free(
    occ: OccLabels,
    region: LabelRegion,
    camera: Camera,
    pose: np.ndarray,
    depth: np.ndarray,
    counts: Counter,
) -> None:
    """Test cells of which half are free and half are not, and in the frustum."""
    rng = np.random.default_rng(counts["frames"])
    cells = [
        some[rng.permutation(len(some))[: FREE_CELLS // 2]]
        for some in (
            np.argwhere(occ.free),
            np.argwhere((occ.labels == 0) & ~occ.free & occ.in_frustum),
        )
    ]
    chosen = np.concatenate(cells)
    free = reference.crossed(region, chosen, camera, pose, depth)
    counts["cells asked whether free"] += len(chosen)
    counts["free, wrong"] += int((free != occ.free[tuple(chosen.T)]).sum())


def say_ids(
    name: str,
    voxels: SceneVoxels,
    pose: np.ndarray,
    picture: Picture,
    counts: Counter,
) -> None:
    """Compare the class of each visible cell with the id buffer at the cell's pixels."""
    region = region_in(voxels, pose, RegionRule(voxel_m=voxels.voxel_m))
    cells = cells_of_pixels(voxels, region, NYU, pose, picture.depth_m)
    occ = label_image(voxels, region, NYU, pose, picture.depth_m)
    seen = cells >= 0
    same = occ.labels.reshape(-1)[cells[seen]] == picture.semantic[seen]
    agreeing = np.bincount(cells[seen], same, minlength=occ.labels.size)
    total = np.bincount(cells[seen], minlength=occ.labels.size)
    there = total > 0
    counts[f"{name}: pixels"] += int(seen.sum())
    counts[f"{name}: pixels of the same class"] += int(same.sum())
    counts[f"{name}: cells"] += int(there.sum())
    counts[f"{name}: cells with some such pixel"] += int((agreeing[there] > 0).sum())
    counts[f"{name}: cells with such pixels for most"] += int(
        (agreeing[there] * 2 > total[there]).sum()
    )


def main() -> int:
    """Print the tables; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--size", type=int, nargs=2, default=(160, 120))
    parser.add_argument("--spoil", action="store_true", help="prove that the check can fail")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    console = Console(width=110)
    camera = resize_camera(NYU, chosen.size[0])
    counts, ids = Counter(), Counter()
    count = -(-chosen.frames // FRAMES_A_HOUSE)
    for house in houses(range(FIRST_SEED, FIRST_SEED + count)):
        views = min(FRAMES_A_HOUSE, chosen.frames - counts["frames"])
        poses = standing_views(house.voxels, views, house.seed)
        for pose in poses:
            check_frame(house, camera, pose, counts, SPOIL_M if chosen.spoil else 0.0)
            picture = render_volume(house.scene, NYU, pose, outputs=("depth", "semantic"))
            say_ids("0.08 m", house.voxels, pose, picture, ids)
            say_ids("a block", house.blocks, pose, picture, ids)
    for heading, rows in (("against float64", counts), ("against the id buffer", ids)):
        table = Table(heading, "", box=None)
        for what, number in rows.items():
            table.add_row(what, f"{number:,}")
        console.print(table, "")
    wrong = sum(number for what, number in counts.items() if "wrong" in what)
    console.print(f"{wrong} cells differ" if wrong else "no cell of any frame differs")
    if chosen.json:
        write_json(chosen.json, {"counts": counts, "ids": ids, "wrong": wrong})
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
