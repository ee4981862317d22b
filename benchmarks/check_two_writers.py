"""Two commands write one folder at once, for each kind of folder.

``python -m benchmarks.check_two_writers [--tries 50] [--seeds FOLDER]``

Both commands run in processes that were forked from one with all modules loaded, so that they meet.
Each must succeed, or end with one line that the folder is in use; at least one must succeed. The
folder must then hold what one of them makes by itself, or what both make one after the other.
"""

import argparse
import os
import shlex
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from benchmarks.fuzz_verbs import FINE_CODES, load_modules, make_seeds
from world2minecraft.cli import run

MEETING_S = 0.05


class Kind(NamedTuple):
    """Two commands on one folder, what they read, and the files that tell their results apart."""

    reads: tuple[str, ...]
    commands: tuple[str, str]
    files: tuple[str, ...]


KINDS = {
    "run": Kind(
        ("run",),
        ("build run -o OUT", "build run -o OUT --blocks-per-metre 2"),
        ("room.npz", "placements.json", "build/room.schem"),
    ),
    "world": Kind(
        ("schem.schem", "world"),
        (
            "build schem.schem --into world --at 0 64 0",
            "build schem.schem --into world --at 2 70 2",
        ),
        ("region/*.mca",),
    ),
    "data set": Kind(
        (),
        (
            "dataset build OUT --houses 1 --images 2 --size 64x48 --seed 1 --jobs 1",
            "dataset build OUT --houses 1 --images 2 --size 64x48 --seed 2 --jobs 1",
        ),
        ("dataset.json", "shards/*/*", "worlds/*/*"),
    ),
    "navigation set": Kind(
        ("run",),
        (
            "vln build run -o OUT --trajectories 1 --seed 1",
            "vln build run -o OUT --trajectories 1 --seed 2",
        ),
        ("items.jsonl", "trajectories.jsonl", "episodes.jsonl", "images/*"),
    ),
}  # fmt: skip


def started(words: str, folder: Path, number: int, at: float) -> int:
    """Fork a process that calls a command at a time; return its number."""
    child = os.fork()
    if child:
        return child
    code = 70
    try:
        for stream, name in ((1, "stdout"), (2, "stderr")):
            os.dup2(os.open(folder / f"{name}{number}", os.O_CREAT | os.O_WRONLY), stream)
        os.chdir(folder)
        time.sleep(max(0.0, at - time.monotonic()))
        code = run(shlex.split(words))
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(code)


def result_of(kind: Kind, seeds: Path, folder: Path, groups: Sequence[Sequence[int]]) -> dict:
    """Run groups of the two commands, each group at once; return codes, errors and digests."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in kind.reads:
        copy = shutil.copytree if (seeds / name).is_dir() else shutil.copy
        copy(seeds / name, folder / name)
    codes = dict[int, int]()
    for group in groups:
        at = time.monotonic() + MEETING_S
        children = {n: started(kind.commands[n], folder, n, at) for n in group}
        for n, child in children.items():
            codes[n] = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    target = folder / ("world" if "world" in kind.reads else "OUT")
    files = sorted(path for what in kind.files for path in target.glob(what) if path.is_file())
    digests = {str(path.relative_to(target)): sha256(path.read_bytes()).digest() for path in files}
    errors = {n: (folder / f"stderr{n}").read_text(errors="replace") for n in codes}
    return {"codes": codes, "errors": errors, "files": digests}


def fault_of(found: dict, alone: Sequence[dict]) -> str:
    """Return what is wrong with a try, or ""."""
    if 0 not in found["codes"].values():
        return f"neither worked: {found['errors']}"
    for number, code in found["codes"].items():
        lines = [one for one in found["errors"][number].splitlines() if one.startswith("error:")]
        if code not in FINE_CODES or len(lines) != bool(code):
            return f"exit code {code}: {found['errors'][number][-300:]}"
    if all(found["files"] != one["files"] for one in alone):
        return "the folder is a mixture"
    return ""


def main() -> int:
    parser = argparse.ArgumentParser(description="Let two commands write one folder at once.")
    parser.add_argument("--tries", type=int, default=50)
    parser.add_argument("--seeds", type=Path, help="seed files of benchmarks.fuzz_verbs")
    chosen = parser.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory() as scratch:
        seeds, folder = chosen.seeds or Path(scratch) / "seeds", Path(scratch) / "try"
        if not seeds.exists():
            make_seeds(seeds)
        load_modules()
        for name, kind in KINDS.items():
            orders = ([[0]], [[1]], [[0], [1]], [[1], [0]])
            alone = [result_of(kind, seeds, folder, groups) for groups in orders]
            ends = Counter[str]()
            for _ in range(chosen.tries):
                found = result_of(kind, seeds, folder, [[0, 1]])
                fault = fault_of(found, alone)
                wrong += bool(fault)
                refused = sum(code != 0 for code in found["codes"].values())
                ends[fault or ("one refused" if refused else "one after the other")] += 1
            print(f"{name}: {dict(ends)}", flush=True)
    print(f"{len(KINDS)} kinds of folder, {chosen.tries} tries each, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
