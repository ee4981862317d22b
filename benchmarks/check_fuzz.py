"""Corrupted block files, read in a separate process: each gives a result or a typed error.

``python -m benchmarks.check_fuzz FILE... --count 200``

Each FILE (.schem, .litematic, .nbt, .schematic, .mcstructure, or the folder of a world) is
corrupted ``count`` times: bytes are flipped, cut, inserted, doubled or set to the largest number,
in the packed file or inside it. Bombs that request far more memory than their size are added. No
file may take more than 10 seconds of CPU time, and the process no more than 512 MB.
"""

import argparse
import gzip
import json
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.mutations import broken
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.minecraft.formats import read_blocks
from world2minecraft.minecraft.nbt import Byte, Short, pack_gzip, unpack, write_nbt
from world2minecraft.minecraft.worlds.anvil import pack_region, read_region

MAX_SECONDS = 10.0
MAX_MEGABYTES = 512
SUFFIXES = (".schem", ".litematic", ".nbt", ".schematic", ".mcstructure")
STONE = {"Name": "minecraft:stone"}


def main() -> None:
    parser = argparse.ArgumentParser(description="Read broken block files.")
    parser.add_argument("files", type=Path, nargs="*")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--worker", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.worker:
        work(arguments.worker)
        return
    with tempfile.TemporaryDirectory() as folder:
        broken_files(arguments.files, Path(folder), arguments.count)
        total = bombs(Path(folder))
        report = read_apart(Path(folder))
    for outcome, count in sorted(Counter(row["outcome"] for row in report["rows"]).items()):
        print(f"{count:7,} {outcome}")
    slowest = max(report["rows"], key=lambda row: row["seconds"])
    largest = max(report["rows"], key=lambda row: row["peak_mb"])
    print(
        f"{total:7,} files, the slowest {slowest['seconds']:.2f} s ({slowest['name']}), the "
        f"largest {largest['peak_mb']:.0f} MB ({largest['name']})"
    )
    if largest["peak_mb"] > MAX_MEGABYTES:
        raise SystemExit(f"more than {MAX_MEGABYTES} MB")


def read_apart(folder: Path, timeout: float = 3600.0) -> dict:
    """Read all files of a folder in a process of its own; what it says of each, and its peak."""
    command = [sys.executable, "-m", "benchmarks.check_fuzz", "--worker", str(folder)]
    root = Path(__file__).resolve().parents[1]
    done = subprocess.run(
        command, check=False, capture_output=True, text=True, timeout=timeout, cwd=root
    )
    if done.returncode:
        raise SystemExit(f"the reading process ended with {done.returncode}\n{done.stderr[-2000:]}")
    return json.loads(done.stdout)


def work(folder: Path) -> None:
    """Read every file or world of a folder and print what became of it, as JSON."""
    rows = []
    peak_megabytes()
    for path in sorted(folder.iterdir()):
        start = time.process_time()
        outcome = outcome_of(path)
        seconds = time.process_time() - start
        if seconds > MAX_SECONDS:
            raise SystemExit(f"{path.name} took {seconds:.1f} s")
        row = {"name": path.name, "outcome": outcome, "seconds": round(seconds, 3)}
        rows.append({**row, "peak_mb": peak_megabytes()})
    print(json.dumps({"rows": rows, "peak_mb": max((r["peak_mb"] for r in rows), default=0)}))


def peak_megabytes() -> float:
    """The most memory that this process held since it was last asked; Linux counts it."""
    status = Path("/proc/self/status")
    if not status.exists():
        return 0.0
    lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
    Path("/proc/self/clear_refs").write_text("5")
    return int(lines["VmHWM"].split()[0]) / 1024


def outcome_of(path: Path) -> str:
    """``read``, or the name of the error; any other exception is a fault and goes up."""
    try:
        volume = read_blocks(path)
    except World2MinecraftError as error:
        text = str(error)
        if "\n" in text or len(text) > 1000:
            raise SystemExit(f"{path.name}: an error of more than a line: {text[:300]}") from error
        return type(error).__name__
    except BaseException as error:
        raise SystemExit(f"{path.name}: {type(error).__name__}: {error}") from error
    return "read" if volume.states.size else "read, empty"


# Broken files.


def broken_files(sources: list[Path], folder: Path, count: int) -> None:
    """Write ``count`` broken copies of each file or world."""
    for source in sources:
        rng = np.random.default_rng(len(source.name))
        for number in range(count):
            target = folder / f"{source.stem}_{number}{source.suffix}"
            if source.is_dir():
                break_world(source, target, rng)
            else:
                target.write_bytes(break_file(source.read_bytes(), rng))


def break_file(data: bytes, rng: np.random.Generator) -> bytes:
    """Break a file: a quarter of the time as it lies, else what is packed in it."""
    plain = unpack(data, "source")
    if rng.random() < 0.25 or plain is data:
        return broken(data, rng)
    return gzip.compress(broken(plain, rng), 1, mtime=0)


def break_world(source: Path, target: Path, rng: np.random.Generator) -> None:
    """Break one region file of a world: its bytes, or those of one chunk."""
    regions = sorted((source / "region").glob("r.*.mca"))
    victim = regions[rng.integers(len(regions))]
    (target / "region").mkdir(parents=True)
    (target / "level.dat").write_bytes((source / "level.dat").read_bytes())
    if rng.random() < 0.3:
        data = broken(victim.read_bytes(), rng)
    else:
        chunks = dict(read_region(victim))
        place = list(chunks)[rng.integers(len(chunks))]
        chunks[place] = broken(chunks[place], rng)
        way = ("zlib", "gzip", "none", "lz4")[rng.integers(4)]
        data = pack_region(chunks, compression=way)[0]
    (target / "region" / victim.name).write_bytes(data)


# Files that ask for more than they take.


def bombs(folder: Path, *, cheap: bool = False) -> int:
    """Write files that unpack to much, nest deep, or say sizes that they do not hold.

    Args:
        folder: where they go.
        cheap: leave out those that take long to make.

    Returns:
        How many files and worlds the folder holds then.
    """
    for name, data in _cheap_bombs() if cheap else [*_cheap_bombs(), *_dear_bombs()]:
        for suffix in SUFFIXES:
            (folder / f"{name}{suffix}").write_bytes(data)
    if cheap:
        return len(list(folder.iterdir()))
    for name, data in _largest():
        (folder / name).write_bytes(data)
    for name, chunk in _chunk_bombs():
        world = folder / name
        (world / "region").mkdir(parents=True)
        (world / "level.dat").write_bytes(pack_gzip(write_nbt({"Data": {}})))
        chunks = {(x, z): chunk(x, z) for x in range(8) for z in range(8)}
        (world / "region" / "r.0.0.mca").write_bytes(pack_region(chunks)[0])
    return len(list(folder.iterdir()))


def _cheap_bombs() -> Iterator[tuple[str, bytes]]:
    yield "zeros", gzip.compress(bytes(1 << 20), 9, mtime=0) * 400
    yield "nested", pack_gzip(b"\x0a\0\0" + b"\x0a\0\1a" * 10_000)
    yield "lists", pack_gzip(b"\x0a\0\0\x09\0\1a" + b"\x09\0\0\0\1" * 100_000)
    huge = b"\x0a\0\0\x09\0\6blocks\x0a\x7f\xff\xff\xff"
    yield "counts", pack_gzip(huge)
    yield "empties", pack_gzip(huge[:-4] + (30 << 20).to_bytes(4, "big") + bytes(30 << 20), 1)


def _dear_bombs() -> Iterator[tuple[str, bytes]]:
    yield "unpacked", pack_gzip(bytes(400 << 20), 1)
    yield "stored", gzip.compress(bytes(95 << 20), 0, mtime=0)
    yield "plain", bytes(95 << 20)
    yield "wide", pack_gzip(write_nbt({"a": {str(n): {} for n in range(499_000)}}), 1)
    text = "x" * 60_000 + "\U0001f600"
    yield "texts", pack_gzip(write_nbt({"a": [text] * 2000}), 1)
    yield "ints", pack_gzip(write_nbt({"a": np.zeros(33 << 20, np.int32)}), 1)


def _largest() -> Iterator[tuple[str, bytes]]:
    """Files of the largest cube that is read, and of a little more."""
    side = 406
    cells = side**3
    yield (
        "largest.schem",
        pack_gzip(
            write_nbt(
                {
                    **{"Version": 2, "DataVersion": 3465, "Width": Short(side)},
                    **{"Height": Short(side), "Length": Short(side)},
                    **{"Palette": {"minecraft:air": 0, "minecraft:stone": 1}},
                    "BlockData": np.ones(cells, np.int8),
                }
            ),
            1,
        ),
    )
    region = {
        **{"Position": dict.fromkeys("xyz", 0), "Size": dict.fromkeys("xyz", side)},
        "BlockStatePalette": [STONE],
        "BlockStates": np.zeros(cells // 32 + 1, np.int64),
    }
    yield "largest.litematic", pack_gzip(write_nbt({"Version": 6, "Regions": {"a": region}}), 1)
    two = {"a": region, "b": {**region, "Size": dict.fromkeys("xyz", -side + 1)}}
    yield "twice.litematic", pack_gzip(write_nbt({"Version": 6, "Regions": two}), 1)
    yield (
        "largest.nbt",
        pack_gzip(write_nbt({"size": [side] * 3, "palette": [STONE], "blocks": []}), 1),
    )
    old = {"Width": Short(side), "Height": Short(side), "Length": Short(side)}
    old |= {"Blocks": np.full(cells, 85, np.int8), "Data": np.zeros(cells, np.int8)}
    yield "largest.schematic", pack_gzip(write_nbt(old), 1)


def _chunk_bombs() -> Iterator[tuple[str, object]]:
    def chunk(**held: object) -> object:
        return lambda x, z: write_nbt({"DataVersion": 3465, "xPos": x, "zPos": z, **held})

    data = np.arange(1024).astype(np.int64)
    palette = [{"Name": f"mod:block_{number}"} for number in range(4096)]
    blocks = {"palette": palette, "data": data[:820]}
    yield "sections", chunk(sections=[{"Y": Byte(y), "block_states": blocks} for y in range(9)])
    yield "bytes", chunk(a=np.zeros(15 << 20, np.int8))
    yield "entities", chunk(block_entities=[{"id": "a", "x": 0, "y": 0, "z": 0}] * 90_000)

    def states(x: int, z: int) -> bytes:
        names = [{"Name": f"mod:{x}_{z}_{number}_{'n' * 200}"} for number in range(4096)]
        held = {"palette": names, "data": data[:820]}
        return chunk(sections=[{"Y": Byte(0), "block_states": held}])(x, z)  # type: ignore[operator]

    yield "states", states


if __name__ == "__main__":
    main()
