"""Data set builds on a disk that gets full, and under a clock that jumps.

``python -m benchmarks.check_dataset_disk [--tries 50] [--clocks 50]`` (mounting needs root)

A small data set of generated houses is built once. Then it is built on small disks (tmpfs): each
build must end, or say in one line that the disk is full, with every image that was there before
still whole. The disk gets a little larger and the same command goes on, until the set is complete.
It must equal the first one, file by file. In other builds, ``time.time`` jumps by up to a year,
forth and back, at every call; those sets must be the same too.
"""

import argparse
import os
import random
import subprocess
import tempfile
import time
from pathlib import Path

from benchmarks.check_dataset_kill import (
    differing,
    files_of,
    images_on_disk,
    is_complete,
    the_plan,
)
from world2minecraft.cli.failures import BAD_INPUT, explain_error
from world2minecraft.minecraftocc.building import build_dataset
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.store import verify_store

YEAR_S = 365 * 86_400.0
GROWTH = 1.25
FULL = ("disk is full", "No space left", "cannot be written", "MB free")


def build(folder: Path) -> str:
    """Build in a process of its own; return "" or what it says of its end."""
    words, told = os.pipe()
    number = os.fork()
    if number == 0:
        os.close(words)
        try:
            with open_engine("pool", 1) as engine:
                build_dataset(folder, the_plan(), engine)
            os._exit(0)
        except BaseException as error:
            text, code = explain_error(error)
            os.write(told, text.encode())
            os._exit(code)
    os.close(told)
    with os.fdopen(words, "rb") as stream:
        text = stream.read().decode()
    code = os.waitstatus_to_exitcode(os.waitpid(number, 0)[1])
    return (
        text or ("" if code == 0 else f"exit code {code}")
        if code in (0, BAD_INPUT)
        else (f"exit code {code}: {text}")
    )


def on_small_disk(place: Path, size: int, wanted: dict[str, bytes]) -> tuple[bool, str]:
    """Build on a disk of this size, which grows as often as it is full."""
    place.mkdir()
    mount("-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place))
    try:
        folder, fills, images = place / "set", 0, 0
        while text := build(folder):
            fills += 1
            if not any(one in text for one in FULL) or text.count("\n") or fills > 60:
                return False, f"after {fills} full disks: {text[:300]}"
            found = images_on_disk(folder) if folder.is_dir() else 0
            if found < images:
                return False, f"{found} of {images} images are left"
            images, size = found, int(size * GROWTH)
            mount("-o", f"remount,size={size}", str(place))
        other = differing(files_of(folder), wanted)
        is_right = not other and is_complete(folder) and not verify_store(folder).faults
        return is_right, f"{fills} full disks; {', '.join(other[:5]) or 'the same set'}"
    finally:
        subprocess.run(["umount", str(place)], check=True)


def mount(*words: str) -> None:
    """Call ``mount``.

    Raises:
        SystemExit: If this user may not mount.
    """
    if subprocess.run(["mount", *words], check=False).returncode:
        raise SystemExit("mounting a small disk needs root; try --tries 0")


def under_jumps(folder: Path, seed: int, wanted: dict[str, bytes]) -> tuple[bool, str]:
    """Build while the clock jumps."""
    draw, now = random.Random(seed), time.time
    time.time = lambda: now() + draw.uniform(-YEAR_S, YEAR_S)
    try:
        text = build(folder)
    finally:
        time.time = now
    other = differing(files_of(folder), wanted) if not text else []
    return not text and not other, text or ", ".join(other[:5]) or "the same set"


def main() -> int:
    options = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    options.add_argument("--tries", type=int, default=50)
    options.add_argument("--clocks", type=int, default=50)
    options.add_argument("--seed", type=int, default=0)
    words = options.parse_args()
    rng, wrong = random.Random(words.seed), 0
    with tempfile.TemporaryDirectory() as scratch:
        first = Path(scratch) / "first"
        with open_engine("pool", 1) as engine:
            build_dataset(first, the_plan(), engine)
        wanted = files_of(first)
        size = sum(map(len, wanted.values()))
        print(f"{len(wanted)} files, {size:,} bytes")
        for number in range(words.tries + words.clocks):
            folder = Path(scratch) / f"try{number}"
            if number < words.tries:
                right, line = on_small_disk(folder, rng.randrange(size // 20, size), wanted)
            else:
                right, line = under_jumps(folder, number, wanted)
            wrong += not right
            print(f"{number + 1:3} {'right' if right else 'WRONG'}  {line}", flush=True)
    print(f"{words.tries} small disks, {words.clocks} jumping clocks, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
