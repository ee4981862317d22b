"""Occupancy labels: the cells of a house of twelve rooms, and the labels and masks of an image."""

import time
import tracemalloc

import numpy as np

from benchmarks.check_labels import GAME, NYU, standing_views
from benchmarks.render_scenes import time_all
from benchmarks.rows import Row
from world2minecraft.minecraftocc.labels.camera_region import RegionRule, region_in
from world2minecraft.minecraftocc.labels.image_labels import cast_depth, label_image
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.rendering import prepare_scene

VIEWS, ROOMS = 6, 12
IMAGE_MS, HOUSE_S, HOUSE_MB = 60.0, 2.0, 500.0


def run() -> list[Row]:
    """Return the figures of a house of seed 700."""
    made = generate_world(700, rooms=ROOMS)
    scene = prepare_scene(made.volume)
    designs = (made.design, made.designs)
    voxels = voxelize_scene(made.volume, designs, scene=scene)
    begin = time.process_time()
    voxelize_scene(made.volume, designs, scene=scene)
    spent = time.process_time() - begin
    tracemalloc.start()
    voxelize_scene(made.volume, designs, scene=scene)
    peak_mb = tracemalloc.get_traced_memory()[1] / 1e6
    tracemalloc.stop()
    cells = "x".join(map(str, voxels.labels.shape))
    rows = [
        Row(f"cells of a house of {ROOMS} rooms, {cells} at 0.08 m", spent, "s", HOUSE_S),
        Row("their memory", peak_mb, "MB", HOUSE_MB),
    ]
    poses = standing_views(voxels, VIEWS, 700)

    def whole(pose: np.ndarray) -> object:
        region = region_in(voxels, pose)
        camera, depth = cast_depth(scene, NYU, pose)
        return label_image(voxels, region, camera, pose, depth)

    depths = {id(pose): cast_depth(scene, GAME, pose, width_px=None)[1] for pose in poses}

    def given(kind: str):
        rule = RegionRule(kind)
        return lambda pose: label_image(
            voxels, region_in(voxels, pose, rule), GAME, pose, depths[id(pose)]
        )

    works = {
        "depth, labels and masks, 640x480": whole,
        "labels and masks, 1920x1129, its depth given": given("paper"),
        "the same, turned with the view": given("free"),
    }
    return rows + [
        Row(what, timing.cpu_ms, "ms", IMAGE_MS) for what, timing in time_all(works, poses).items()
    ]
