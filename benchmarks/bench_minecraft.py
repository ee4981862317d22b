"""Worlds and schematics, written and read, beside anvil-parser2 and mcschematic."""

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import anvil
import mcschematic
import numpy as np

from benchmarks.rows import Row
from world2minecraft.coordinates import block_to_room
from world2minecraft.minecraft.datapack import write_datapack
from world2minecraft.minecraft.schem import read_schem, write_schem
from world2minecraft.minecraft.states import parse_state, states_of
from world2minecraft.minecraft.world import read_world, write_world
from world2minecraft.types import AIR, BlockVolume

SHAPE = (256, 64, 256)  # 4.2 million cells in 256 chunks.
RIVAL_SHAPE = (64, 64, 64)  # The rivals go block by block: a sixteenth of the region is enough.
REPEATS = 5
WRITE_BUDGET, READ_BUDGET = 20.0, 25.0  # Million cells a second.


def run() -> list[Row]:
    """Measure writing and reading, the best of a few runs after one to compile the kernels."""
    region, part = furnished_region(SHAPE), furnished_region(RIVAL_SHAPE)
    with tempfile.TemporaryDirectory() as folder:
        return list(_rows(region, part, Path(folder)))


def _rows(region: BlockVolume, part: BlockVolume, folder: Path) -> Iterator[Row]:
    cells, part_cells = region.states.size / 1e6, part.states.size / 1e6
    x, y, z = region.corner
    box = (x, y, z, x + SHAPE[0], y + SHAPE[1], z + SHAPE[2])

    rate = cells / best(lambda: write(region, folder / "world"))
    rival = part_cells / once(lambda: rival_write(part, folder / "rival.mca"))
    yield _row("Anvil write", rate, WRITE_BUDGET, "anvil-parser2", rival)

    rate = cells / best(lambda: read_world(folder / "world", box=box))
    write(part, folder / "part")
    rival = part_cells / once(lambda: rival_read(folder / "part" / "region" / "r.0.0.mca"))
    yield _row("Anvil read", rate, READ_BUDGET, "anvil-parser2", rival)

    rate = part_cells / best(lambda: write_schem(part, folder / "a.schem"))
    rival = part_cells / once(lambda: rival_schem(part, folder))
    yield _row("schematic write", rate, None, "mcschematic", rival)

    rate = part_cells / best(lambda: read_schem(folder / "a.schem"))
    rival = part_cells / once(lambda: mcschematic.MCSchematic(str(folder / "a.schem")))
    yield _row("schematic read", rate, None, "mcschematic", rival)

    rate = cells / best(lambda: write_datapack(region, folder / "pack.zip"))
    yield _row("data pack write", rate, None, None, None)


def _row(
    what: str, rate: float, budget: float | None, rival: str | None, rival_rate: float | None
) -> Row:
    ratio = rate / rival_rate if rival_rate else None
    return Row(what, round(rate, 2), "Mcell/s", budget, rival, ratio)


def furnished_region(shape: tuple[int, int, int]) -> BlockVolume:
    """Boxes of one state each and 1 % noise: 36 % of it is not air, in 20 states."""
    rng = np.random.default_rng(0)
    states = np.zeros(shape, np.uint16)
    for _ in range(200 * states.size // (256 * 64 * 256)):
        low = rng.integers(0, shape)
        high = low + rng.integers(4, 40, 3)
        states[tuple(map(slice, low, high))] = rng.integers(1, 20)
    noise = rng.random(shape) < 0.01
    states[noise] = rng.integers(1, 20, noise.sum())
    empty = np.zeros(shape, np.uint8)
    return BlockVolume(
        states=states,
        palette=(AIR, *map(str, states_of("oak_stairs")[:19])),
        semantic=empty,
        instance=empty.astype(np.uint16),
        corner=(0, 0, 0),
        block_to_room=block_to_room(np.zeros(2), 4.0),
    )


def write(volume: BlockVolume, folder: Path) -> None:
    write_world(volume, folder, name="bench", spawn=(0.5, 64.0, 0.5), spawn_yaw_deg=0.0)


def rival_write(volume: BlockVolume, path: Path) -> None:
    region = anvil.EmptyRegion(0, 0)
    blocks = [_rival_block(state) for state in volume.palette]
    for cell in np.argwhere(volume.states).tolist():
        region.set_block(blocks[volume.states[tuple(cell)]], *cell)
    region.save(str(path))


def _rival_block(state: str) -> anvil.Block:
    parsed = parse_state(state)
    return anvil.Block(*parsed.name.split(":"), properties=dict(parsed.properties))


def rival_read(path: Path) -> None:
    region = anvil.Region.from_file(str(path))
    for x in range(RIVAL_SHAPE[0] // 16):
        for z in range(RIVAL_SHAPE[2] // 16):
            chunk = region.get_chunk(x, z)
            for section in range(RIVAL_SHAPE[1] // 16):
                for _ in chunk.stream_blocks(section=section):
                    pass


def rival_schem(volume: BlockVolume, folder: Path) -> None:
    schematic = mcschematic.MCSchematic()
    for cell in np.argwhere(volume.states).tolist():
        schematic.setBlock(tuple(cell), volume.palette[volume.states[tuple(cell)]])
    schematic.save(str(folder), "rival", mcschematic.Version.JE_1_20_1)


def best(work: Callable[[], object]) -> float:
    """Seconds of the fastest of a few runs."""
    work()
    return min(once(work) for _ in range(REPEATS))


def once(work: Callable[[], object]) -> float:
    """Seconds of one run."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start
