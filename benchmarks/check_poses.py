"""Registration on generated scans: poses, depth scales and the room's frame, before and after.

``python -m benchmarks.check_poses [--first 500 --rooms 2 --frames 40]``

Each room is scanned once with true poses; then its patches are moved and stretched as a tracker
and a depth sensor would, by 0, 5 and 10 mm (and 0.2 degrees for each 5 mm) and by 0, 3 and 5 %.
Poses are compared after the best common turn and shift, which belong to the frame's error.
"""

import argparse
import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.spatial.transform import Rotation

from world2minecraft.geometry.surface import Surface, collect_surface
from world2minecraft.register import RegisterParameters
from world2minecraft.register.refine import register_surface
from world2minecraft.rooms import KINDS, generate_room
from world2minecraft.rooms.shots import Shooting, room_shots, room_to_scan
from world2minecraft.scan.align import align_surface
from world2minecraft.types import View

JITTERS_M = (0.0, 0.005, 0.010)
DEG_PER_M = 0.2 / 0.005
SCALES = (0.0, 0.03, 0.05)
COLUMNS = (
    "pose mm", "after", "turn deg", "after", "scale %", "after", "mean %", "tilt deg", "after",
    "yaw deg", "after", "floor cm", "after", "wall cm", "after", "s",
)  # fmt: skip


def true_surface(seed: int, frames: int) -> tuple[Surface, np.ndarray, np.ndarray]:
    """Return the patches of a room's scan with true poses, room_to_scan and the room's size."""
    room = generate_room(seed, kind=sorted(KINDS)[seed % len(KINDS)])
    to_scan = room_to_scan(seed)

    def views() -> Iterator[View]:
        for shot in room_shots(room, Shooting(frames=frames, seed=seed)):
            yield replace(shot.view, camera_to_scan=to_scan @ shot.truth.camera_to_truth)

    return collect_surface(views()), to_scan, np.asarray(room.size_m)


def disturbed(surface: Surface, jitter_m: float, scale_sigma: float, seed: int):
    """Return the surface as stated poses and stretched depth would show it, and the stretches."""
    rng = np.random.default_rng([seed, 5])
    frames = len(surface.cameras)
    turn = Rotation.from_rotvec(
        np.radians(rng.standard_normal((frames, 3)) * jitter_m * DEG_PER_M)
    ).as_matrix()
    shift = rng.standard_normal((frames, 3)) * jitter_m
    scale = np.exp(rng.standard_normal(frames) * scale_sigma)
    cameras = surface.cameras.copy()
    cameras[:, :3, :3] = turn @ cameras[:, :3, :3]
    cameras[:, :3, 3] += shift
    owner = surface.owner
    from_eye = (surface.points_m - surface.cameras[owner, :3, 3]) * scale[owner, None]
    points = np.einsum("iab,ib->ia", turn[owner], from_eye) + cameras[owner, :3, 3]
    normals = np.einsum("iab,ib->ia", turn[owner], surface.normals)
    return replace(surface, points_m=points, normals=normals, cameras=cameras), scale


def pose_error(cameras: np.ndarray, true: np.ndarray) -> tuple[float, float]:
    """Return the median error in mm and degrees, the best common turn and shift taken away."""
    turns = Rotation.from_matrix((cameras @ np.linalg.inv(true))[:, :3, :3])
    common = turns.mean()
    moved = cameras[:, :3, 3] - common.apply(true[:, :3, 3])
    off = np.linalg.norm(moved - np.median(moved, axis=0), axis=1)
    left = np.degrees((common.inv() * turns).magnitude())
    return 1000 * float(np.median(off)), float(np.median(left))


def frame_error(scan_to_room: np.ndarray, to_scan: np.ndarray, size: np.ndarray, found):
    """Return tilt and yaw in degrees, and floor and worst wall or ceiling in cm."""
    turn = scan_to_room @ to_scan
    tilt = np.degrees(np.arccos(min(1.0, turn[2, 2])))
    yaw = np.degrees(np.arctan2(turn[1, 0], turn[0, 0]))
    corners = np.array([[0.0, 0.0, 0.0], [*size[:2], 0.0]]) @ turn[:3, :3].T + turn[:3, 3]
    low, high = corners.min(axis=0), corners.max(axis=0)
    walls = max(*np.abs(low[:2]), *np.abs(high[:2] - found[:2]))
    middle = np.array([*size[:2] / 2, 0.0]) @ turn[:3, :3].T + turn[:3, 3]
    return tilt, abs((yaw + 45) % 90 - 45), 100 * abs(middle[2]), 100 * walls


def row(true: tuple, jitter_m: float, scale_sigma: float, seed: int, passes: int) -> list[float]:
    """Return the figures of one disturbed scan."""
    surface, to_scan, size = true
    given, scale = disturbed(surface, jitter_m, scale_sigma, seed)
    first = align_surface(given)
    begun = time.process_time()
    found = register_surface(given, first.scan_to_room, RegisterParameters(passes=passes))
    seconds = time.process_time() - begun
    second = align_surface(found.surface)
    before = pose_error(given.cameras, surface.cameras)
    after = pose_error(found.corrections.pose_change @ given.cameras, surface.cameras)
    left = scale * found.corrections.depth_scale
    frames = [
        frame_error(one.scan_to_room, to_scan, size, one.room_size_m) for one in (first, second)
    ]
    pairs = [*zip(before, after, strict=True), (100 * scale.std(), 100 * left.std())]
    figures = [value for pair in pairs for value in pair] + [100 * (left.mean() - 1)]
    return [*figures, *(v for pair in zip(*frames, strict=True) for v in pair), seconds]


def main() -> None:
    """Print a row for each room and disturbance."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--first", type=int, default=500)
    parser.add_argument("--rooms", type=int, default=2)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--passes", type=int, default=RegisterParameters().passes)
    chosen = parser.parse_args()
    table = Table("room", "given", *COLUMNS)
    for seed in range(chosen.first, chosen.first + chosen.rooms):
        true = true_surface(seed, chosen.frames)
        for jitter_m in JITTERS_M:
            for scale_sigma in SCALES:
                given = f"{1000 * jitter_m:.0f} mm {scale_sigma:.0%}"
                figures = row(true, jitter_m, scale_sigma, seed, chosen.passes)
                table.add_row(str(seed), given, *(f"{value:.2f}" for value in figures))
    Console(width=190).print(table)


if __name__ == "__main__":
    main()
