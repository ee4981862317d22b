"""Depth from colour against a sensor's: one row for each choice of parameters.

``python -m benchmarks.check_stereo CAPTURE [ROW ...]``, where CAPTURE has colour, depth and poses,
and each ROW is such as ``noise=1,angle_deg=6``, or ``sgbm`` for OpenCV's StereoSGBM in place of the
sweep. The poses are measured and put right once. Printed are the share of the sensor's pixels that
have depth, how many of these are over 10 % off, and how many lie over 10 % behind; then, fused and
held against the map that the sensor's depth makes, within one voxel: precision, that of cells which
the sensor knows, recall, free cells found, occupied cells called free; and CPU seconds a photo.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy import ndimage

from benchmarks.rival_sgbm import depth_maps as sgbm_maps
from benchmarks.rival_sgbm import sensed_in
from world2minecraft.fuse import EvidenceMap, FuseParameters
from world2minecraft.live import placed_scan
from world2minecraft.occupy.depth import DepthPredictor
from world2minecraft.parameters import Parameters
from world2minecraft.posing import check_poses
from world2minecraft.scan.judged import judge_capture
from world2minecraft.scan.options import parse_options
from world2minecraft.scan.photos import judged_photos
from world2minecraft.stereo import StereoParameters, depth_maps
from world2minecraft.types import FusedEvidence, Scan, View

COLUMNS = ("kept", "off", "behind", "precision", "known", "recall", "free", "wrong free", "CPU s")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("capture", type=Path)
    parser.add_argument("rows", nargs="*", default=[""])
    chosen = parser.parse_args()
    scan = placed_scan(chosen.capture, Parameters())
    sensed = {view.name: view for view in scan.views}
    reference = fused(scan, (DepthPredictor().lift(view) for view in sensed.values()), "sensor")
    photos = judged_photos(judge_capture(chosen.capture, parse_options({})))
    scene = check_poses(photos)
    print(f"{len(scene.names)} photos, points meet to {scene.error_px:.2f} px")
    print(f"{'':34}", *(f"{name:>10}" for name in COLUMNS))
    for row in chosen.rows:
        begun = time.process_time()
        made = sgbm_maps if row == "sgbm" else depth_maps
        maps = list(made(photos, scene, StereoParameters() if row == "sgbm" else parsed(row)))
        spent = (time.process_time() - begun) / len(maps)
        poses = dict(zip(scene.names, scene.camera_to_scan, strict=True))
        views = [
            View(m.name, poses[m.name], depth_m=m.depth_m, depth_camera=m.camera, trust=m.trust)
            for m in maps
        ]
        figures = [*by_pixel(views, sensed)]
        found = fused(scan, (DepthPredictor().lift(v) for v in views if v.depth_m.any()), "stereo")
        figures += [*by_cell(found, reference), spent]
        print(f"{row or 'as it is':34}", *(f"{value:10.3f}" for value in figures), flush=True)


def parsed(row: str) -> StereoParameters:
    """Return the parameters that a row such as ``noise=1,angle_deg=6`` means."""
    values = StereoParameters()
    for setting in filter(None, row.split(",")):
        key, _, text = setting.partition("=")
        values = replace(values, **{key: type(getattr(values, key))(text)})
    return values


def fused(scan: Scan, evidence, kind: str) -> FusedEvidence:
    """Return all evidence in one map."""
    map_ = EvidenceMap(scan.scan_to_room, FuseParameters().suited(kind))
    for item in evidence:
        map_.add(item)
    return map_.fused()


def by_pixel(views, sensed) -> tuple[float, float, float]:
    """Return the share of the sensor's pixels kept, and of these over 10 % off, and behind."""
    pixels, errors = 0, []
    for view in views:
        true_m = sensed_in(sensed[view.name], view.depth_camera, view.camera_to_scan)
        both = (true_m > 0) & (view.depth_m > 0)
        errors.append(view.depth_m[both] / true_m[both] - 1)
        pixels += (true_m > 0).sum()
    off = np.concatenate(errors)
    return len(off) / pixels, (np.abs(off) > 0.1).mean(), (off > 0.1).mean()


def by_cell(found: FusedEvidence, true: FusedEvidence) -> tuple[float, ...]:
    """Return precision, that of known cells, recall, free cells found, occupied called free."""
    starts = [np.round(one.origin_m / one.voxel_m).astype(int) for one in (found, true)]
    low = np.minimum(*starts) - 1
    ends = [start + one.log_odds.shape for start, one in zip(starts, (found, true), strict=True)]
    grids = []
    for start, one in zip(starts, (found, true), strict=True):
        grid = np.zeros(np.maximum(*ends) + 1 - low, np.float32)
        at = tuple(slice(a, a + n) for a, n in zip(start - low, one.log_odds.shape, strict=True))
        grid[at] = one.log_odds
        grids.append(grid)
    mine, theirs = grids
    cube = np.ones((3, 3, 3), bool)
    near_true = ndimage.binary_dilation(theirs > 0, cube)
    near_mine = ndimage.binary_dilation(mine > 0, cube)
    return (
        near_true[mine > 0].mean(),
        near_true[(mine > 0) & (theirs != 0)].mean(),
        near_mine[theirs > 0].mean(),
        (mine < 0)[theirs < 0].mean(),
        (mine < 0)[theirs > 0].mean(),
    )


if __name__ == "__main__":
    main()
