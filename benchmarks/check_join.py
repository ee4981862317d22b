"""Rooms of a generated house, each scanned and reconstructed by itself, joined by their doors.

``python -m benchmarks.check_join [SEED ...]`` prints for each room of each house how far it stands
from its true place beside the first room, or what ``w2m join`` says where it cannot tell.
"""

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.coordinates import rotation_about_z
from world2minecraft.errors import UsageError
from world2minecraft.exchange.room import read_room
from world2minecraft.joining import place_runs, read_runs
from world2minecraft.metrics.layout import inside_polygon
from world2minecraft.pipeline import reconstruct
from world2minecraft.rooms import generate_house, room_views
from world2minecraft.rooms.shots import room_to_scan
from world2minecraft.scan import write_plain

SEEDS = {"505": 3, "517": 4, "530": 4}  # And how many rooms each house has, its hall among them.
FRAMES_EACH = 40
LEAST_VIEWS = 8


def scan_rooms(seed: int, rooms: int, folder: Path) -> dict[Path, np.ndarray]:
    """Write a capture for each room, each in a frame of its own; return house_to_scan of each."""
    house = generate_house(seed, rooms=rooms)
    house_to_scan = room_to_scan(seed)
    count = FRAMES_EACH * rooms
    views = list(room_views(house, frames=count, seed=seed, width=320, height=240))
    frames = {}
    for number, layout in enumerate(house.layouts):
        own_frame = rotation_about_z(37.0 * number)
        own_frame[:3, 3] = [number, 2 * number, -number]
        eyes = [(np.linalg.inv(house_to_scan) @ view.camera_to_scan)[:2, 3] for view in views]
        inside = inside_polygon(np.array(eyes), layout.floor_polygon_m, 0.05)
        own = [
            replace(view, camera_to_scan=own_frame @ view.camera_to_scan)
            for view, here in zip(views, inside, strict=True)
            if here
        ]
        if len(own) >= LEAST_VIEWS:
            place = folder / f"room{number}"
            write_plain(place, own)
            frames[place] = own_frame @ house_to_scan
    return frames


def main(seeds: list[str]) -> None:
    """Print a line a room."""
    for seed in seeds or list(SEEDS):
        with tempfile.TemporaryDirectory() as scratch:
            frames = scan_rooms(int(seed), SEEDS.get(seed, 4), Path(scratch))
            for capture in frames:
                reconstruct(capture, capture / "OUT")
            runs = read_runs([capture / "OUT" for capture in frames])
            try:
                placed = place_runs(runs)
            except UsageError as error:
                print(f"{seed}  {error}")
                continue
            first = None
            for capture, run, move in zip(frames, runs, placed.moves, strict=True):
                _, scan_to_room = read_room(capture / "OUT" / "room.npz")
                to_home = move.transform(run.grid.voxel_m) @ scan_to_room @ frames[capture]
                first = to_home if first is None else first
                off = to_home @ np.linalg.inv(first)
                turn = np.degrees(np.arctan2(off[1, 0], off[0, 0]))
                middle = first @ np.array([3.0, 3.0, 1.0, 1.0])
                metres = np.linalg.norm((off @ middle - middle)[:2])
                print(f"{seed}  {capture.name}  off by {metres:.3f} m, {turn:.2f} degrees")


if __name__ == "__main__":
    main(sys.argv[1:])
