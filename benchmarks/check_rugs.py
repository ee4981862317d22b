"""Rugs of scanned generated rooms: how many are blocks of their own in the build.

``python -m benchmarks.check_rugs --keep DIR [--rooms 10]``

The rooms are those of ``check_doors``, and those in ``DIR`` are used again. A rug is kept if at
least half of it is built of blocks that cover less than a twentieth of the rest of the floor.
Printed are the share of each rug that is, and the share of the rest of the floor that is built of
the most common block of the rug.
"""

import argparse
from pathlib import Path

import numpy as np

from benchmarks.check_doors import reconstructed, room_of
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply, invert
from world2minecraft.procgen import generate_room
from world2minecraft.procgen.rooms.materials import Material, room_materials
from world2minecraft.reconstruction.file_stages import built_volume
from world2minecraft.reconstruction.parameters import Parameters

MAIN_SHARE, KEPT_SHARE, UNDER_M = 0.05, 0.5, 0.1


def shares(keep: Path, number: int) -> tuple[float, float] | None:
    """Return the kept share of a room's rugs and that of the floor in their block, or None."""
    kind, seed = room_of(number)
    out, truth = reconstructed(keep, number)
    room = generate_room(seed, kind=kind)
    floor = (room.labels == int(SemanticClass.FLOOR)).any(axis=2)
    rug = (room_materials(room) == int(Material.RUG)).any(axis=2)
    if not rug.any():
        return None
    volume = built_volume(out, Parameters())
    names = []
    for mask in (rug, floor & ~rug):
        cells = np.argwhere(mask)
        points = np.c_[room.origin_m[:2] + (cells + 0.5) * room.voxel_m, np.zeros(len(cells))]
        inside = apply(truth.truth_to_room, points) - np.array([0, 0, UNDER_M])
        at = np.floor(apply(invert(volume.block_to_room), inside)).astype(int) - volume.corner
        held = ((at >= 0) & (at < volume.states.shape)).all(axis=1)
        names.append(volume.states[tuple(at[held].T)])
    own, rest = names
    main = np.flatnonzero(np.bincount(rest) >= MAIN_SHARE * len(rest))
    other = own[~np.isin(own, main)]
    spread = np.bincount(other).argmax() if len(other) else -1
    return len(other) / len(own), float((rest == spread).mean())


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR")
    parser.add_argument("--rooms", type=int, default=10)
    chosen = parser.parse_args()
    rows = []
    for number in range(chosen.rooms):
        found = shares(chosen.keep, number)
        if found is not None:
            rows.append(found)
            print(*room_of(number), *(f"{share:.2f}" for share in found), flush=True)
    kept = sum(share >= KEPT_SHARE for share, _ in rows)
    print(f"rugs kept: {kept} of {len(rows)}")


if __name__ == "__main__":
    main()
