"""Block formats, written and read, compared with the public packages in the same run.

The region has 4.2 million cells, of which 1.75 million are not air. mcschematic and anvil-parser2
process all of it. nbtlib and litemapy hold one object per block and process a part; rates are
compared. litemapy takes part where it is installed (see ``rivals_minecraft``).
"""

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from benchmarks import rivals_minecraft as rivals
from benchmarks.rows import Row
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.block_states import states_of
from world2minecraft.minecraft.commands.datapack import write_datapack
from world2minecraft.minecraft.nbt import Short, pack_gzip, write_nbt
from world2minecraft.minecraft.schematics.litematic import read_litematic, write_litematic
from world2minecraft.minecraft.schematics.mcedit import read_schematic
from world2minecraft.minecraft.schematics.pre_flattening import legacy_state
from world2minecraft.minecraft.schematics.sponge import read_schem, write_schem
from world2minecraft.minecraft.schematics.structure import read_structure, write_structure
from world2minecraft.minecraft.versions import GameVersion, game_version
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

SHAPE = (256, 64, 256)  # 4.2 million cells in 256 chunks.
PART_SHAPE = (48, 48, 48)  # What nbtlib does.
BLOCKS = 1_750_000  # Of the region, not air.
REPEATS = 5
WRITE_BUDGET, READ_BUDGET = 20.0, 25.0  # Million cells a second.


def run() -> list[Row]:
    """Measure writing and reading, the best of a few runs after one to compile the kernels."""
    region, part = furnished_region(SHAPE), furnished_region(PART_SHAPE)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        return [
            *_worlds(region, place),
            *_schematics(region, part, place),
            *_litematics(region, part, place),
            *_structures(part, place),
            *_old_schematics(region, part, place),
            _row("data pack write", region, lambda: write_datapack(region, place / "pack.zip")),
        ]


def _worlds(region: BlockVolume, folder: Path) -> Iterator[Row]:
    x, y, z = region.corner
    box = (x, y, z, x + SHAPE[0], y + SHAPE[1], z + SHAPE[2])
    rival = ("anvil-parser2", _rate(region, lambda: rivals.anvil_write(region, folder / "a.mca")))
    yield _row("Anvil write", region, lambda: write(region, folder / "w"), rival, WRITE_BUDGET)
    old = game_version("1.15.2")
    yield _row("Anvil write, 1.15", region, lambda: write(region, folder / "o", old), rival)
    theirs = folder / "w" / "region" / "r.0.0.mca"
    rival = ("anvil-parser2", _rate(region, lambda: rivals.anvil_read(theirs, SHAPE)))
    ours = lambda: read_world(folder / "w", box=box)  # noqa: E731
    yield _row("Anvil read", region, ours, rival, READ_BUDGET)
    yield _row("Anvil read, 1.15", region, lambda: read_world(folder / "o", box=box), rival)


def _schematics(region: BlockVolume, part: BlockVolume, folder: Path) -> Iterator[Row]:
    rival = ("mcschematic", _rate(region, lambda: rivals.mcschematic_write(region, folder)))
    for number in (2, 3):
        path = folder / f"{number}.schem"
        work = lambda n=number, p=path: write_schem(region, p, schem_version=n)  # noqa: E731
        yield _row(f"Sponge {number} write", region, work, rival)
    path = folder / "rival.schem"
    rival = ("mcschematic", _rate(region, lambda: rivals.mcschematic_read(path)))
    for number in (2, 3):
        work = lambda n=number: read_schem(folder / f"{n}.schem")  # noqa: E731
        yield _row(f"Sponge {number} read", region, work, rival)
    write_schem(part, folder / "part.schem")
    path = folder / "part.schem"
    rival = ("nbtlib", _rate(part, lambda: rivals.nbtlib_schem_read(path)))
    yield _row("Sponge 2 read", region, lambda: read_schem(folder / "2.schem"), rival)


def _litematics(region: BlockVolume, part: BlockVolume, folder: Path) -> Iterator[Row]:
    path, small = folder / "a.litematic", folder / "b.litematic"
    rival = ("nbtlib", _rate(part, lambda: rivals.nbtlib_litematic_write(part, small)))
    yield _row("Litematica write", region, lambda: write_litematic(region, path), rival)
    rival = ("nbtlib", _rate(part, lambda: rivals.nbtlib_litematic_read(small)))
    yield _row("Litematica read", region, lambda: read_litematic(path), rival)
    if rivals.HAS_LITEMAPY:
        rival = ("litemapy", _rate(part, lambda: rivals.litemapy_write(part, small)))
        yield _row("Litematica write", region, lambda: write_litematic(region, path), rival)
        rival = ("litemapy", _rate(part, lambda: rivals.litemapy_read(small)))
        yield _row("Litematica read", region, lambda: read_litematic(path), rival)


def _structures(part: BlockVolume, folder: Path) -> Iterator[Row]:
    path, theirs = folder / "a.nbt", folder / "b.nbt"
    rival = ("nbtlib", _rate(part, lambda: rivals.nbtlib_structure_write(part, theirs)))
    yield _row("structure write", part, lambda: write_structure(part, path), rival)
    rival = ("nbtlib", _rate(part, lambda: rivals.nbtlib_structure_read(theirs)))
    yield _row("structure read", part, lambda: read_structure(path), rival)


def _old_schematics(region: BlockVolume, part: BlockVolume, folder: Path) -> Iterator[Row]:
    path, small = folder / "a.schematic", folder / "b.schematic"
    path.write_bytes(_old_schematic(region))
    small.write_bytes(_old_schematic(part))
    names = {(n, v): legacy_state(n, v, {})[0] for n in range(256) for v in range(16)}
    rival = ("nbtlib", _rate(part, lambda: rivals.nbtlib_schematic_read(small, names)))
    yield _row("old schematic read", region, lambda: read_schematic(path), rival)


def _old_schematic(volume: BlockVolume) -> bytes:
    """The same cells as wool and its colours, in numbers."""
    cells = np.ascontiguousarray(volume.states.transpose(1, 2, 0)).ravel()
    width, height, length = map(Short, volume.states.shape)
    tree = {"Width": width, "Height": height, "Length": length, "Materials": "Alpha"}
    tree["Blocks"] = np.where(cells > 0, 35, 0).astype(np.int8)
    tree["Data"] = (cells & 15).astype(np.int8)
    return pack_gzip(write_nbt(tree))


def _row(
    what: str,
    volume: BlockVolume,
    work: Callable[[], object],
    rival: tuple[str | None, float] = (None, 0.0),
    budget: float | None = None,
) -> Row:
    rate = volume.states.size / 1e6 / best(work)
    name, theirs = rival
    return Row(what, round(rate, 2), "Mcell/s", budget, name, rate / theirs if theirs else None)


def _rate(volume: BlockVolume, work: Callable[[], object]) -> float:
    """Million cells a second of one run."""
    return volume.states.size / 1e6 / once(work)


def furnished_region(shape: tuple[int, int, int]) -> BlockVolume:
    """Boxes of one state each and 1 % noise: 1.75 million of 4.2 are not air, in 20 states."""
    rng = np.random.default_rng(0)
    states = np.zeros(shape, np.uint16)
    noise = rng.random(shape) < 0.01
    states[noise] = rng.integers(1, 20, noise.sum())
    wanted = BLOCKS * states.size // (256 * 64 * 256)
    missing = wanted - np.count_nonzero(states)
    while missing > 0:
        low = rng.integers(0, shape)
        size = np.minimum(rng.integers(4, 40, 3), (1 << 30) if missing > 64_000 else 4)
        states[tuple(map(slice, low, low + size))] = rng.integers(1, 20)
        missing = wanted - np.count_nonzero(states)
    empty = np.zeros(shape, np.uint8)
    return BlockVolume(
        states=states,
        palette=(AIR, *map(str, states_of("oak_stairs")[:19])),
        semantic=empty,
        instance=empty.astype(np.uint16),
        corner=(0, 0, 0),
        block_to_room=block_to_room(np.zeros(2), 4.0),
    )


def write(volume: BlockVolume, folder: Path, version: GameVersion | None = None) -> None:
    spawn = {"spawn": (0.5, 64.0, 0.5), "spawn_yaw_deg": 0.0}
    write_world(volume, folder, name="bench", version=version, **spawn)


def best(work: Callable[[], object]) -> float:
    """Seconds of the fastest of a few runs."""
    work()
    return min(once(work) for _ in range(REPEATS))


def once(work: Callable[[], object]) -> float:
    """Seconds of one run."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start
