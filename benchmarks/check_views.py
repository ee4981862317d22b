"""How flat, empty and repeated the planned views of generated houses are.

``python -m benchmarks.check_views [--houses 5] [--views 40]``

Printed are, for each house of six rooms and for all, the share of views of which one wall, door or
side of furniture takes up more than 35 %, of those with fewer than three things, and of those that
are within 0.5 m and 20 degrees of an earlier view of the room, as well as the CPU time of a view.
"""

import argparse
import time

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraftocc.tours import PlannedView, TourRule, plan_views
from world2minecraft.minecraftocc.tours.view_quality import assess_views
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering.scene import BlockScene

FIRST_SEED, ROOMS = 3, 6
MAX_PLANE_SHARE, MIN_THINGS = 0.35, 3
APART_M, APART_DEG = 0.5, 20.0


def shares(volume: BlockVolume, scene: BlockScene, views: list[PlannedView]) -> np.ndarray:
    """Return whether each view is flat, empty and like an earlier one, bool [N, 3]."""
    poses = np.array([view.camera_to_room for view in views])
    seen = assess_views(scene, volume, poses, TourRule())
    flat, empty = seen.plane > MAX_PLANE_SHARE, seen.count < MIN_THINGS
    return np.stack([flat, empty, _repeated(views, volume.blocks_per_metre)], axis=1)


def _repeated(views: list[PlannedView], blocks_per_metre: float) -> np.ndarray:
    rows = np.array(
        [(v.pose.x, v.pose.y, v.pose.z, v.pose.yaw_deg, v.pose.pitch_deg) for v in views]
    )
    rooms = np.array([view.room for view in views])
    repeated = np.zeros(len(views), bool)
    for n in range(1, len(views)):
        near = np.abs(rows[:n, :3] - rows[n, :3]).max(axis=1) < APART_M * blocks_per_metre
        turn = np.abs((rows[:n, 3] - rows[n, 3] + 180) % 360 - 180) < APART_DEG
        pitch = np.abs(rows[:n, 4] - rows[n, 4]) < APART_DEG
        repeated[n] = (near & turn & pitch & (rooms[:n] == rooms[n])).any()
    return repeated


def main() -> None:
    """Plan the views and print a row for each house."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--houses", type=int, default=5)
    parser.add_argument("--views", type=int, default=40)
    chosen = parser.parse_args()
    found = []
    for seed in range(FIRST_SEED, FIRST_SEED + chosen.houses):
        volume = generate_world(seed, rooms=ROOMS).volume
        scene = prepare_scene(volume)
        begun = time.process_time()
        views = plan_views(volume, chosen.views, scene=scene)
        each_ms = (time.process_time() - begun) * 1000 / len(views)
        found.append(shares(volume, scene, views))
        print(seed, len(views), np.round(found[-1].mean(axis=0), 3), f"{each_ms:.1f} ms a view")
    print("all", np.round(np.concatenate(found).mean(axis=0), 3), "flat, empty, repeated")


if __name__ == "__main__":
    main()
