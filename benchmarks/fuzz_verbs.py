"""All verbs of the command line with mutated files: ``make fuzz MINUTES=30``.

``python -m benchmarks.fuzz_verbs [--minutes 30] [--jobs 2] [--only WORD] [--keep FOLDER]``

Small seed files are made first: rooms, a scan, runs, worlds, schematics, a data set, a navigation
set. Then a verb is called again and again, each time with one to three of its files mutated. Each
call runs in a process that was forked from one with all modules loaded. A call must end within
``MAX_SECONDS``, use no more than ``MAX_MEGABYTES``, return an exit code of the command line with at
most one line of error, and leave no output if it fails. A call that does not is a fault: it is
repeated with fewer mutated files, and is kept as a folder with the command, the files and what was
printed. Random numbers depend on ``--seed`` and on the number of the call alone.
"""

import argparse
import importlib
import json
import os
import pkgutil
import resource
import shlex
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import world2minecraft
from benchmarks.mutations import mutate
from world2minecraft.cli import run
from world2minecraft.sceneforge.editor import Editor

MAX_SECONDS = 60.0  # Of CPU time; other processes may use the cores as well.
MAX_WALL_S = 300.0
MAX_MEGABYTES = 4096
GRACE_S = 0.02
FINE_CODES = (0, 2, 3)
MAX_FILES = 3  # Mutated in one call.
RESUMED = ("dataset export", "dataset build", "dataset import", "vln evaluate")  # They keep parts.
# A verb, the seed folders or files that it reads, and what it writes.
VERBS = (
    "scan {scan} -o {out}.png",
    "scan {mesh}",
    "reconstruct {scan} -o {out}",
    "reconstruct {mesh} -o {out}",
    "reconstruct {scan} --from build -o {run}",
    "build {room} -o {out}",
    "build {run} -o {out}",
    "build {schem} --into {world} --at 0 64 0",
    "clean {run}",
    "clean {run} --undo-all",
    "convert {schem} {out}.litematic",
    "convert {litematic} {out}.nbt",
    "convert {nbt} {out}.mcstructure",
    "convert {bedrock} {out}.schem",
    "convert {world} {out}.schem",
    "convert {run} {out}.glb",
    "convert {run} {out}.habitat",
    "convert {schem} {out}",
    "render {schem} -o {out}.png --size 64x48",
    "render {world} -o {out}.png --size 64x48",
    "render {run} -o {out}.gif --turntable --frames 2 --size 64x48",
    "render {run} -o {out} --poses {poses} --size 64x48",
    "share {run} -o {out}.html",
    "share {schem} -o {out}.html",
    "install {run} --saves {saves}",
    "undo {world} --list",
    "join {run} {twin} -o {out}",
    "segment {scan} --out {out}",
    "occupy {scan} --out {out}.npz",
    "forge stats {edited}",
    "evaluate reconstruction {run} {truth}",
    "evaluate occupancy {guesses} {data} --split all",
    "furniture add {schem} --class chair --blocks-per-metre 2 --front north",
    "rooms scan {generated} -o {out} --frames 2",
    "dataset verify {data}",
    "dataset stats {data}",
    "dataset quality {data}",
    "dataset show {data} --out {out}.png",
    "dataset sheet {data} --out {out}.png",
    "dataset export {data} --format nyu --out {out}",
    "dataset export {data} --format npz --out {out}",
    "dataset import {nyu} --out {out}",
    "dataset map --map {map}",
    "dataset tour {world} --count 4 --out {out}.jsonl",
    "vln stats {set}",
    "vln stats {set} --no-baselines",
    "vln export {set} --to llamafactory -o {out}",
    "vln export {set} --to r2r -o {out}",
    "vln run {run} 'go to the table' --agent shortest --no-video --out {out}",
    "vln evaluate {set} --split all --agent majority --out {out}",
    "compare layouts {layout}",
    "compare build {layout} -o {out} --count 1",
    "compare describe {run}",
    "paper vln --results {results}",
)  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """How a call ended."""

    code: int  # Of the process; negative if a signal ended it.
    seconds: float
    megabytes: float
    error: str
    left: tuple[str, ...]  # Output of a failed call.

    @property
    def fault(self) -> str:
        """What is wrong with the end, or ""."""
        lines = [line for line in self.error.splitlines() if line.startswith("error:")]
        if self.seconds >= 0.98 * MAX_SECONDS:
            return f"no end after {MAX_SECONDS:.0f} s"
        if self.code < 0:
            return f"ended by {signal.Signals(-self.code).name}"
        if "Traceback" in self.error or "error: unexpected " in self.error:
            return "unexpected error"
        if self.code not in FINE_CODES:
            return f"exit code {self.code}"
        if self.code and len(lines) != 1:
            return f"{len(lines)} lines of error"
        if self.megabytes > MAX_MEGABYTES:
            return f"{self.megabytes:.0f} MB"
        return f"output of a failed call: {', '.join(self.left)}" if self.left else ""


def main() -> None:
    parser = argparse.ArgumentParser(description="Call all verbs with mutated files.")
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="verbs with this word")
    parser.add_argument("--keep", type=Path, default=Path("FUZZ"), help="folder for faults")
    parser.add_argument("--seeds", type=Path, help="folder of seed files of an earlier call")
    chosen = parser.parse_args()
    verbs = [verb for verb in VERBS if chosen.only in verb]
    with tempfile.TemporaryDirectory() as folder:
        seeds = chosen.seeds or Path(folder) / "seeds"
        if not seeds.exists():
            make_seeds(seeds)
        load_modules()
        check_seeds(verbs, seeds, Path(folder) / "seeds_checked")
        end = time.monotonic() + 60 * chosen.minutes
        workers = list[int]()
        for job in range(chosen.jobs):
            workers.append(os.fork())
            if not workers[-1]:
                _work(verbs, seeds, Path(folder), chosen, job, end)
        codes = [os.waitpid(worker, 0)[1] for worker in workers]
        counts = Counter(Path(folder, "ends.txt").read_text().splitlines())
    for what, count in sorted(counts.items()):
        print(f"{count:7,} {what}")
    print(f"{counts.total():7,} calls of {len(verbs)} verbs")
    faults = sorted(chosen.keep.glob("*/fault.txt")) if chosen.keep.exists() else []
    for fault in faults:
        print(f"{fault.parent}: {fault.read_text()}")
    if faults or any(codes):
        raise SystemExit(1)


def _work(
    verbs: Sequence[str],
    seeds: Path,
    folder: Path,
    chosen: argparse.Namespace,
    job: int,
    end: float,
) -> None:
    """Call verbs until the end of the campaign, in a process of its own that never returns."""
    number = job
    try:
        with open(folder / "ends.txt", "a", buffering=1) as ends:
            while time.monotonic() < end:
                verb = verbs[number % len(verbs)]
                outcome = try_call(verb, seeds, folder / f"job{job}", [chosen.seed, number])
                if outcome.fault:
                    keep_fault(chosen.keep / f"{number:06}", folder / f"job{job}", verb, outcome)
                words = outcome.fault.split(":")[0] or f"exit code {outcome.code}"
                ends.write(f"{words}\n")
                number += chosen.jobs
    except BaseException:
        traceback.print_exc()
        os._exit(1)
    os._exit(0)


def check_seeds(verbs: Sequence[str], seeds: Path, folder: Path) -> None:
    """Call each verb without mutations: what fails then says nothing of mutated files."""
    for verb in verbs:
        outcome = call(verb, seeds, folder, [0], 0, [])
        if outcome.code or outcome.fault:
            raise SystemExit(f"{verb} fails without mutations: {outcome.fault} {outcome.error}")


def try_call(verb: str, seeds: Path, folder: Path, seed: list[int]) -> Outcome:
    """Call a verb with mutated files; drop the mutations that a fault does not need."""
    rng = np.random.default_rng(seed)
    number = int(rng.integers(1, MAX_FILES + 1))
    wanted = list(range(number))
    outcome = call(verb, seeds, folder, seed, number, wanted)
    if not outcome.fault or outcome.seconds >= 0.9 * MAX_SECONDS:
        return outcome
    for one in range(number):
        fewer = [other for other in wanted if other != one]
        if fewer and call(verb, seeds, folder, seed, number, fewer).fault == outcome.fault:
            wanted = fewer
    return call(verb, seeds, folder, seed, number, wanted)


def call(
    verb: str, seeds: Path, folder: Path, seed: list[int], number: int, wanted: Sequence[int]
) -> Outcome:
    """Call a verb once, with the mutations of these numbers of ``number`` drawn ones."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "home").mkdir(parents=True)
    names = {name for name in os.listdir(seeds) if f"{{{name.split('.')[0]}}}" in verb}
    for name in names:
        source = seeds / name
        copy = shutil.copytree if source.is_dir() else shutil.copy
        copy(source, folder / name)
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    rng = np.random.default_rng([*seed, 1])
    for n in range(number if files else 0):
        victim = files[int(rng.integers(len(files)))]
        changed = mutate(victim.name, victim.read_bytes(), rng)
        (folder / f"mutated{n}.txt").write_text(str(victim.relative_to(folder)))
        if n in wanted:
            victim.write_bytes(changed)
    places = {name.split(".")[0]: name for name in names} | {"out": "OUT", "saves": "SAVES"}
    return _forked(shlex.split(verb.format(**places)), folder)


def _forked(arguments: list[str], folder: Path) -> Outcome:
    before = {path.name for path in folder.iterdir()}
    started = time.monotonic()
    child = os.fork()
    if child == 0:
        _be_called(arguments, folder)
    ended = os.wait4(child, os.WNOHANG)
    while not ended[0] and time.monotonic() - started < MAX_WALL_S:
        time.sleep(GRACE_S)
        ended = os.wait4(child, os.WNOHANG)
    hangs = not ended[0]
    if hangs:
        os.killpg(child, signal.SIGKILL)
        ended = os.wait4(child, 0)
    _, status, usage = ended
    code = os.waitstatus_to_exitcode(status)
    left = sorted({path.name for path in folder.iterdir()} - before - {"stdout", "stderr"})
    error = (folder / "stderr").read_text(errors="replace")
    return Outcome(
        code,
        MAX_WALL_S if hangs else usage.ru_utime + usage.ru_stime,
        usage.ru_maxrss / 1024,
        error,
        tuple(left) if code and not " ".join(arguments).startswith(RESUMED) else (),
    )


def _be_called(arguments: list[str], folder: Path) -> None:
    """Run the command line in this process, which ends."""
    code = 70
    try:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (int(MAX_SECONDS), int(MAX_SECONDS)))
        for number, name in ((1, "stdout"), (2, "stderr")):
            os.dup2(os.open(folder / name, os.O_CREAT | os.O_WRONLY), number)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.chdir(folder)
        os.environ |= dict.fromkeys(("XDG_DATA_HOME", "XDG_CONFIG_HOME"), str(folder / "home"))
        code = run(arguments)
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(code)


def keep_fault(target: Path, folder: Path, verb: str, outcome: Outcome) -> None:
    """Keep the files of a fault, its command and what it printed."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(folder, target, symlinks=True)
    (target / "command.txt").write_text(verb)
    (target / "fault.txt").write_text(f"{outcome.fault}: {verb}: {outcome.error[-300:]}")


def make_seeds(folder: Path) -> None:
    """Write small files of each kind."""
    folder.mkdir(parents=True)
    for words in _seed_commands():
        arguments = shlex.split(words)
        child = os.fork()  # Kernels that ran in threads must not be forked later.
        if child == 0:
            os.chdir(folder)
            os._exit(run(arguments))
        if os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]):
            raise SystemExit(f"the seed files could not be made: w2m {words}")
    shutil.copy(folder / "run" / "room.npz", folder / "room.npz")
    for name in ("twin", "edited"):
        shutil.copytree(folder / "run", folder / name)
    with closing(Editor.open(folder / "edited")) as editor:
        editor.do("rename_objects", ids=[1], name="Wilson")
    shutil.copytree(folder / "run" / "build" / "world", folder / "world")
    (folder / "poses.jsonl").write_text('{"x": 2, "y": 65, "z": 2, "yaw": 30, "pitch": 5}\n' * 2)
    (folder / "map.yaml").write_text("name: mine\nextends: nyu\nblocks:\n  minecraft:stone: wall\n")
    (folder / "results.yaml").write_text("vln:\n  base-next-view: {label: ours}\n")
    shutil.copytree(folder / "scan", folder / "truth")
    (folder / "guesses").mkdir()
    for path in (folder / "arrays").rglob("*-*.npz"):
        shutil.copy(path, folder / "guesses")
    bed = ["bed", {"width": 120, "length": 140, "left": 20, "top": 20}]
    prompt = "Room Type: bedroom\nRoom Size: max length 256px, max width 256px"
    answer = {"query_id": "a", "iter": 0, "prompt": prompt, "object_list": [bed], "src_bbox": []}
    (folder / "layout.json").write_text(json.dumps([answer]))


def _seed_commands() -> Iterator[str]:
    yield "rooms generate --seed 3 --kind study -o generated"
    yield "rooms scan generated -o scan --frames 6"
    yield "reconstruct scan -o run"
    yield "convert run/build/room.schem schem.schem"
    yield "convert run/build/room.schem litematic.litematic"
    yield "convert run/build/room.schem nbt.nbt"
    yield "convert run/build/room.schem bedrock.mcstructure"
    yield "convert run mesh.glb"
    yield "dataset build data --houses 1 --images 4 --seed 1 --size 160x120"
    yield "dataset export data --format nyu --out nyu --limit 2"
    yield "dataset export data --format npz --out arrays"
    yield "vln build run -o set --trajectories 2"
    yield "evaluate reconstruction run scan"


def load_modules() -> None:
    """Import what the verbs import, so that each call starts at once."""
    for package in pkgutil.walk_packages(world2minecraft.__path__, "world2minecraft."):
        if not package.name.startswith(("world2minecraft.networks", "world2minecraft.__main__")):
            importlib.import_module(package.name)


if __name__ == "__main__":
    main()
