"""Door leaves of generated rooms: how many become doors that open and lead through the wall.

``python -m benchmarks.check_doors --keep DIR [--rooms 10] [--scales 1 2 4] [--json FILE]``

Each room is scanned with noise and reconstructed, and its blocks are built at each scale. A leaf is
asked for if rays came to half of it. It counts as found if ``layout.json`` has a door within 0.3 m,
and as a door if a player of the game's size gets from 1 m inside the room to the other side of the
wall once the doors are open, but not before. Finished rooms are not repeated.
"""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.files import write_json
from world2minecraft.core.types import BlockVolume
from world2minecraft.evaluation.scoring.opening_scores import opening_facts
from world2minecraft.evaluation.scoring.score import TrueRoom, see_truth
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.minecraft.physics.shortest_paths import reachable
from world2minecraft.minecraft.physics.walk_graph import WalkRule, walk_graph
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.reconstruction.file_stages import built_volume
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct

FIRST_SEED, FRAMES = 9_300, 16
KINDS = ("bed", "study", "living", "kitchen", "dining", "children", "hall", "bathroom")
INSIDE_M = 1.0  # How far inside the room a walk begins.


def room_of(number: int) -> tuple[str, int]:
    """Return the kind and the seed of a room."""
    return KINDS[number % len(KINDS)], FIRST_SEED + number


def reconstructed(keep: Path, number: int) -> tuple[Path, TrueRoom]:
    """Scan and reconstruct a room if that was not done before; return the run and its truth."""
    kind, seed = room_of(number)
    folder = keep / f"{kind}-{seed}"
    capture, out = folder / "capture", folder / "run"
    if not (out / "placements.json").is_file():
        scan_room(generate_room(seed, kind=kind), capture, frames=FRAMES, seed=seed)
        reconstruct(capture, out, Parameters(), until="furnish")
    grid, scan_to_room = read_room(out / "room.npz")
    known = truth_of_run(out, capture)
    return out, see_truth(known, used_frames(out, known), scan_to_room, grid.voxel_m)


def checked(keep: Path, number: int, scales: list[float]) -> dict[str, Any]:
    """Return the figures of a room."""
    kind, seed = room_of(number)
    out, truth = reconstructed(keep, number)
    found = read_layouts(out / "layout.json")
    facts = opening_facts(found, truth.truth.layouts, truth.truth_to_room, truth.reached)
    doors = facts["by_kind"].get("door", {"true": 0, "found": 0, "matched": 0})
    row = {"kind": kind, "seed": seed, **{key: doors[key] for key in ("true", "found", "matched")}}
    middles = [
        apply(truth.truth_to_room, np.array([*(one.start_m + one.end_m) / 2, room.floor_z_m]))
        for room in truth.truth.layouts
        for one in room.openings
        if one.kind == "door"
    ]
    for scale in scales:
        volume = built_volume(out, replace(Parameters(), blocks_per_metre=scale))
        row[f"at {scale:g}"] = sum(leads_through(volume, middle) for middle in middles)
    return row


def leads_through(volume: BlockVolume, middle_m: np.ndarray) -> bool:
    """Return whether a player gets through the doors at a place, only after opening them.

    Args:
        volume: The blocks of the room.
        middle_m: Middle of the foot of the leaf in metres, float64 [3].
    """
    scale = volume.blocks_per_metre
    names = [name.partition("[")[0].endswith("_door") for name in volume.palette]
    cells = np.argwhere(np.array(names)[volume.states]) + np.array(volume.corner) + 0.5
    middle = apply(invert(volume.block_to_room), middle_m)
    cells = cells[np.abs(cells - middle).max(axis=1) <= max(scale, 2.0)]
    if not len(cells):
        return False
    facing = next(name for name in volume.palette if "_door[" in name).partition("facing=")[2]
    way = {"e": (1, 0, 0), "w": (-1, 0, 0), "s": (0, 0, 1), "n": (0, 0, -1)}[facing[0]]
    door = cells.mean(axis=0)
    door[1] = cells[:, 1].min() - 0.5
    inside, passes = -INSIDE_M * scale, []
    for opens in (True, False):
        graph = walk_graph(volume, WalkRule(scale=1.0, jump=True, opens_doors=opens))
        behind = graph.nearest(door + np.array(way))
        if np.abs(graph.feet[behind] - door - way).max() > 0.75:
            return False
        reached = graph.feet[reachable(graph, behind)]
        passes.append(bool(((reached - door) @ np.array(way) <= inside).any()))
    return passes == [True, False]


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR")
    parser.add_argument("--rooms", type=int, default=10)
    parser.add_argument("--scales", type=float, nargs="+", default=[1.0, 2.0, 4.0])
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    rows = []
    for number in range(chosen.rooms):
        rows.append(checked(chosen.keep, number, chosen.scales))
        print(*(f"{key} {value}" for key, value in rows[-1].items()), sep=", ", flush=True)
    for key in [key for key in rows[0] if key not in ("kind", "seed")]:
        print(f"{key}: {sum(row[key] for row in rows)}")
    if chosen.json:
        write_json(chosen.json, rows)


if __name__ == "__main__":
    main()
