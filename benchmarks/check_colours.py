"""Do built things have the hue of the true ones? Generated rooms, scanned, rebuilt and compared.

``python -m benchmarks.check_colours [--seeds 1 2 --frames 40 --keep FOLDER --build-only]``

One thing is an object of the room, a rug or all its walls. Each voxel of its true surface, 2 cm
wide, stands for the block nearest to it. A thing is coloured where the mean of its true colours has
a chroma of ``CLEAR`` or more in Oklab; its blocks agree where their mean hue is within ``HUE_DEG``
and their chroma is at least half of the true one. ``kinds on walls`` counts the block kinds that
make up more than 1 % of a room's walls, pictures set aside: plain walls are to stay plain.
"""

import argparse
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.coordinates import apply
from world2minecraft.exchange.room import read_room
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.colours import colours_of
from world2minecraft.parameters import Parameters
from world2minecraft.pipeline import reconstruct
from world2minecraft.report.scene import read_built
from world2minecraft.rooms import BASE_KINDS, Room, generate_room, scan_room
from world2minecraft.rooms.capture import room_to_scan
from world2minecraft.types import BlockVolume

CLEAR, HUE_DEG = 0.05, 30.0
REACH_M = 0.25  # A voxel without a block so near is not built at all.
LEAST_VOXELS = 300  # 0.12 m2; smaller things are no whole block at 4 blocks a metre.
RUG_AREA_M2 = 0.5
FLOOR, WALL = 2, 3


class Thing(NamedTuple):
    """A true thing and how it was built; colours are Oklab means."""

    name: str
    true: np.ndarray  # float [3]
    built: np.ndarray  # float [3]
    blocks: tuple[str, ...]  # the three commonest

    @property
    def coloured(self) -> bool:
        """Whether its true colour is no grey."""
        return chroma(self.true) >= CLEAR

    @property
    def agrees(self) -> bool:
        """Whether it was built in its hue, at no less than half its chroma."""
        (_, true_a, true_b), (_, a, b) = self.true, self.built
        turn = np.degrees(np.arctan2(true_b, true_a) - np.arctan2(b, a))
        near = abs((turn + 180) % 360 - 180) <= HUE_DEG
        return bool(near and chroma(self.built) >= 0.5 * chroma(self.true))


def chroma(oklab: np.ndarray) -> float:
    """Return the chroma of one Oklab colour."""
    return float(np.hypot(oklab[1], oklab[2]))


def true_things(room: Room) -> dict[str, np.ndarray]:
    """Return the voxels, int [N, 3], of each thing's surface that faces the room's air."""
    surface = (room.labels > 0) & np.asarray(ndimage.binary_dilation(room.labels == 0), bool)
    things = {}
    for number, item in enumerate(room.layout.objects, start=1):
        things[f"{item.name} {number}"] = np.argwhere(surface & (room.instance == number))
    floor = np.argwhere(surface & (room.labels == FLOOR))
    colours = oklab_of_srgb(room.colour[tuple(floor.T)])
    odd = np.zeros(room.labels.shape, bool)
    odd[tuple(floor[np.linalg.norm(colours - np.median(colours, 0), axis=1) > 0.1].T)] = True
    parts = np.zeros(odd.shape, np.int32)
    ndimage.label(odd, output=parts)
    for part in range(1, int(parts.max()) + 1):
        cells = np.argwhere(parts == part)
        if len(cells) * room.voxel_m**2 >= RUG_AREA_M2:
            things[f"rug {part}"] = cells
    things["walls"] = np.argwhere(surface & (room.labels == WALL))
    return {name: cells for name, cells in things.items() if len(cells) >= LEAST_VOXELS}


def compare(room: Room, volume: BlockVolume, truth_to_room: np.ndarray) -> tuple[list[Thing], int]:
    """Return the things of a room, and how many kinds of blocks its walls are made of."""
    solid = np.argwhere(volume.semantic > 0)
    states = volume.states[tuple(solid.T)]
    centres = apply(volume.block_to_room, solid + np.array(volume.corner) + 0.5)
    tree = KDTree(centres)
    offered = oklab_of_srgb(colours_of(volume.palette))
    things, kinds = [], 0
    for name, cells in true_things(room).items():
        points = apply(truth_to_room, room.origin_m + (cells + 0.5) * room.voxel_m)
        away, nearest = tree.query(points)
        near = states[np.asarray(nearest)[np.asarray(away) <= REACH_M]]
        if not len(near):
            continue
        counts = np.bincount(near, minlength=len(volume.palette))
        common = np.argsort(-counts, kind="stable")[:3]
        blocks = tuple(
            f"{volume.palette[n].partition('[')[0].removeprefix('minecraft:')} "
            f"{counts[n] / len(near):.0%}"
            for n in common
            if counts[n]
        )
        true = oklab_of_srgb(room.colour[tuple(cells.T)]).mean(0)
        things.append(Thing(name, true, offered[near].mean(0), blocks))
        if name == "walls":
            kinds = int((counts > 0.01 * len(near)).sum())
    return things, kinds


def main() -> None:
    """Print the coloured things of each room and their share that is built in its hue."""
    parser = argparse.ArgumentParser(description="Compare built hues with true ones.")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--build-only", action="store_true")
    parser.add_argument("--all", action="store_true", help="print the things that agree as well")
    chosen = parser.parse_args()
    base = chosen.keep or Path(tempfile.mkdtemp())
    table = Table("room", "thing", "true", "built", "blocks", "agrees")
    found: list[Thing] = []
    wall_kinds: list[int] = []
    for kind in sorted(BASE_KINDS):
        for seed in chosen.seeds:
            room = generate_room(seed, kind=kind)
            out = base / f"{kind}_{seed}"
            capture = out / "capture"
            if not capture.is_dir():
                scan_room(room, capture, frames=chosen.frames, seed=seed)
            start = "build" if chosen.build_only and (out / "placements.json").is_file() else None
            reconstruct(capture, out, Parameters(), start=start)
            _, scan_to_room = read_room(out / "room.npz")
            things, kinds = compare(
                room, read_built(out / "build"), scan_to_room @ room_to_scan(seed)
            )
            wall_kinds.append(kinds)
            found += [thing for thing in things if thing.coloured]
            for thing in things:
                if thing.coloured and (chosen.all or not thing.agrees):
                    table.add_row(
                        f"{kind} {seed}", thing.name, str(thing.true.round(2)),
                        str(thing.built.round(2)), ", ".join(thing.blocks), str(thing.agrees),
                    )  # fmt: skip
    console = Console(width=170)
    console.print(table)
    share = np.mean([thing.agrees for thing in found])
    console.print(f"{len(found)} coloured things, {share:.0%} built in their hue")
    console.print(f"kinds on walls: {np.mean(wall_kinds):.1f} a room {wall_kinds}")


if __name__ == "__main__":
    main()
