"""The renderer against a slow float64 ray caster: ids, faces and depth, pixel by pixel.

``python -m benchmarks.check_render [--poses 6 --size 320 240] [--spoil] [--json FILE]``

Scenes: a generated room built at 4 and 2 blocks per metre and as display entities, furnished
flats, and random models (rotated, flat, hollow, perforated boxes, glass). Cameras stand in free
cells and inside furniture. The reference is ``tests/rendering/oracle.py``. The exit code is 1 if
less than 99.99 % of the pixels of a row are equal or the median depth error is 0.1 mm or more;
``--spoil`` moves the cameras of a row by a millimetre to show that the check can fail.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table
from tests.rendering.oracle import has_face, oracle_picture

from benchmarks.render_scenes import (
    RandomLooks,
    camera_of,
    poses,
    random_models,
    room,
    scene_looks,
    small,
)
from world2minecraft.core.files import write_json
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering import Picture, prepare_scene, render_volume
from world2minecraft.rendering.block_elements import ModelSource

LEAST_EQUAL, MOST_MEDIAN_M = 0.9999, 1e-4
SPOIL_M = 1e-3


class Case(NamedTuple):
    """A scene and where its cameras stand."""

    name: str
    volume: Callable[[], BlockVolume]
    looks: Callable[[], ModelSource]
    inside: bool


class Agreement(NamedTuple):
    """What one row of the table says."""

    pixels: int
    equal: float  # share of pixels with the same cell, entity and face
    median_m: float  # of depth, where ids are equal
    worst_m: float

    @property
    def holds(self) -> bool:
        """Whether it is as good as it has to be."""
        return self.equal >= LEAST_EQUAL and self.median_m < MOST_MEDIAN_M


CASES = (
    Case("room, 4 blocks/m, free cells", lambda: room(4.0), scene_looks, False),
    Case("room, 4 blocks/m, inside furniture", lambda: room(4.0), scene_looks, True),
    Case("room, 2 blocks/m, free cells", lambda: room(2.0), scene_looks, False),
    Case("room, display entities", lambda: room(4.0, 1, "living", "display"),
         scene_looks, False),
    Case("flats 60x40x60, free cells", small, scene_looks, False),
    Case("flats 60x40x60, inside furniture", small, scene_looks, True),
    Case("random models, free cells", lambda: random_models(0), lambda: RandomLooks(0), False),
    Case("random models, inside them", lambda: random_models(0), lambda: RandomLooks(0), True),
)  # fmt: skip


def compare(
    volume: BlockVolume,
    looks: ModelSource,
    camera: Camera,
    cameras: list[np.ndarray],
    spoil_m: float = 0.0,
) -> Agreement:
    """Take all pictures both ways, the fast one from ``spoil_m`` beside, and compare them."""
    scene = prepare_scene(volume, looks)
    equal, total, errors = 0, 0, [np.zeros(0)]
    for pose in cameras:
        beside = pose.copy()
        beside[:3, 3] += spoil_m * pose[:3, 0]
        same, error = differences(
            render_volume(scene, camera, beside, outputs=()), volume, looks, camera, pose
        )
        equal, total = equal + int(same.sum()), total + same.size
        errors.append(error)
    every = np.concatenate(errors)
    median, worst = (float(np.median(every)), float(every.max())) if len(every) else (0.0, 0.0)
    return Agreement(total, equal / total, median, worst)


def differences(
    picture: Picture, volume: BlockVolume, looks: ModelSource, camera: Camera, pose: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return bool [H, W] of the pixels with equal ids, and the depth errors of those, in metres."""
    truth = oracle_picture(volume, looks, camera, pose)
    same = (picture.block_index == truth.index) & (picture.cube_index == truth.thing)
    same &= has_face(truth, picture.face)
    met = same & np.isfinite(truth.depth)
    return same, np.abs(picture.depth_m[met] - truth.depth[met])


def results(count: int, size: tuple[int, int], spoil: bool) -> Iterator[tuple[str, Agreement]]:
    """Give the name and the figures of each row."""
    camera = camera_of(*size)
    for number, case in enumerate(CASES):
        volume, looks = case.volume(), case.looks()
        cameras = poses(volume, count, 100 + number, looks=looks, inside=case.inside)
        spoil_m = SPOIL_M if spoil and number == 0 else 0.0
        name = case.name + (", spoilt" if spoil_m else "")
        yield name, compare(volume, looks, camera, cameras, spoil_m)


def main() -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--poses", type=int, default=6)
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--spoil", action="store_true", help="prove that the check can fail")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    table = Table("scene", "pixels", "equal ids", "median depth error", "worst", "", box=None)
    failed, kept = False, []
    for name, row in results(chosen.poses, tuple(chosen.size), chosen.spoil):
        failed |= not row.holds
        kept.append({"scene": name, **row._asdict()})
        table.add_row(
            name, f"{row.pixels:,}", f"{row.equal:.4%}", f"{row.median_m:.1e} m",
            f"{row.worst_m:.1e} m", "ok" if row.holds else "WRONG",
        )  # fmt: skip
    Console(width=120).print(table)
    if chosen.json:
        write_json(chosen.json, kept)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
