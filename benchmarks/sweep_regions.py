"""How much of what an image shows does its region hold, by the fallback offset?

``python -m benchmarks.sweep_regions [--houses 50 --views 6]``

People stand in generated houses of seeds 500 on and look any way. A cell of the scene is visible
where some pixel sees it first, wherever it lies. The table says which share of those cells, and of
the pixels, lies in the region, for each of the paper's two cases and each offset; ``free`` is the
region that turns with the view.
"""

import argparse
import sys

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.label_views import GAME, NYU, houses, standing_views
from world2minecraft.coordinates import apply, invert
from world2minecraft.dataset.labels import cast_depth, cells_of_pixels
from world2minecraft.dataset.region import RegionRule, region_in
from world2minecraft.dataset.values import LabelRegion, SceneVoxels

OFFSETS = (0, 2, 4, 6, 8, 10, 12, 14, 16, 20, 24)
FIRST_SEED = 500
CAMERAS = {"640x480, f 518.86": NYU, "1920x1129, FOV 70": GAME}


def whole_scene(voxels: SceneVoxels) -> LabelRegion:
    """Return the region that has all cells of a scene."""
    to_room = np.eye(4)
    to_room[:3, 3] = voxels.origin_m
    return LabelRegion(voxels.labels.shape, voxels.voxel_m, to_room)


def held(voxels: SceneVoxels, region: LabelRegion, seen: np.ndarray, pixels: np.ndarray):
    """Return the share of seen cells and of their pixels that a region holds."""
    middle = voxels.origin_m + (np.stack(np.unravel_index(seen, voxels.labels.shape), -1) + 0.5) * (
        voxels.voxel_m
    )
    at = apply(invert(region.region_to_room), middle) / region.voxel_m
    inside = ((at >= 0) & (at < region.shape)).all(axis=1)
    return inside.mean(), pixels[inside].sum() / pixels.sum()


def shares(count: int, views: int) -> dict[tuple[str, str, int], list[tuple[float, float]]]:
    """Return the shares of each view by camera, case and offset."""
    found: dict[tuple[str, str, int], list[tuple[float, float]]] = {}
    for house in houses(range(FIRST_SEED, FIRST_SEED + count)):
        voxels, whole = house.voxels, whole_scene(house.voxels)
        for pose in standing_views(voxels, views, house.seed):
            for name, lens in CAMERAS.items():
                camera, depth = cast_depth(house.scene, lens, pose)
                cells = cells_of_pixels(voxels, whole, camera, pose, depth)
                seen, pixels = np.unique(cells[cells >= 0], return_counts=True)
                if not len(seen):  # Who stands on a ledge may look away from the house.
                    continue
                for offset in OFFSETS:
                    rule = RegionRule(axis_offset_cells=offset, diagonal_offset_cells=offset)
                    region = region_in(voxels, pose, rule)
                    key = (name, region.kind, offset)
                    found.setdefault(key, []).append(held(voxels, region, seen, pixels))
                region = region_in(voxels, pose, RegionRule("free"))
                key = (name, "free", 0)
                found.setdefault(key, []).append(held(voxels, region, seen, pixels))
    return found


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--houses", type=int, default=50)
    parser.add_argument("--views", type=int, default=6)
    chosen = parser.parse_args()
    table = Table("camera", "case", "offset", "views", "cells held", "pixels held", box=None)
    for (camera, kind, offset), rows in sorted(shares(chosen.houses, chosen.views).items()):
        cells, pixels = np.mean(rows, axis=0)
        table.add_row(camera, kind, str(offset), str(len(rows)), f"{cells:.1%}", f"{pixels:.1%}")
    Console(width=110).print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
