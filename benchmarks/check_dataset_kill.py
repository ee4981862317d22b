"""Crash safety of data set builds: SIGKILL at random moments, then resume.

``python -m benchmarks.check_dataset_kill [--kills 50]``

A small data set of generated houses is built once without interruption. Then it is built again:
each build is killed at a random moment, between the first scene and the index, and resumed by the
same command. After each kill every image that existed before or was reported as done must exist,
and at most one more per process. Each finished set must equal the first one, file by file. Some
of the kills (``--pools``) hit builds by a pool of two processes: the parent, a worker, or all of
them.
"""

import argparse
import os
import random
import select
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from world2minecraft.minecraftocc.building import build_dataset
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.plan import DatasetPlan, Recipe, house_scenes, plan_dataset
from world2minecraft.minecraftocc.store import verify_store
from world2minecraft.minecraftocc.store.shard import stored_samples
from world2minecraft.rendering.views import camera_of

HOUSES, IMAGES = 2, 40
USUAL_KILLS, USUAL_POOLS = 50, 8
POOL_JOBS = 2


def the_plan() -> DatasetPlan:
    camera = camera_of(96, 72, vertical_fov_deg=60)
    return plan_dataset(house_scenes(HOUSES), IMAGES, recipe=Recipe(camera=camera))


def work(folder: Path, jobs: int, out: int) -> None:
    """Build the set; tell each image that is done."""

    def told(stage: str, done: int, total: int, note: str = "") -> None:
        os.write(out, f"{stage} {done}\n".encode())

    with open_engine("pool", jobs) as engine:
        build_dataset(folder, the_plan(), engine, told)


def forked(folder: Path) -> tuple[int, int]:
    """Start a build by one process without the seconds that an interpreter takes to begin."""
    words, told = os.pipe()
    number = os.fork()
    if number == 0:
        os.close(words)
        os.setpgid(0, 0)
        try:
            work(folder, 1, told)
            os._exit(0)
        finally:
            os._exit(1)
    os.close(told)
    return number, words


def started(folder: Path) -> tuple[int, int]:
    """Start a build by a pool, in a group of processes of its own."""
    code = (
        "import sys; from benchmarks.check_dataset_kill import POOL_JOBS, Path, work\n"
        "if __name__ == '__main__': work(Path(sys.argv[1]), POOL_JOBS, 1)\n"
    )
    script = folder.parent / "build.py"
    script.write_text(code)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([os.getcwd(), *sys.path])}
    process = subprocess.Popen(
        [sys.executable, str(script), str(folder)],
        stdout=subprocess.PIPE,
        env=environment,
        start_new_session=True,
    )
    return process.pid, os.dup(process.stdout.fileno())


def kill(number: int, how: str) -> None:
    """Kill a build: ``parent``, ``worker`` (one of them), or ``all``."""
    if how == "all":
        os.killpg(number, signal.SIGKILL)
    elif how == "parent":
        os.kill(number, signal.SIGKILL)
    else:
        told = subprocess.run(
            ["pgrep", "-P", str(number)], capture_output=True, text=True, check=False
        )
        children = [int(word) for word in told.stdout.split()]
        if len(children) > 1:  # The first is multiprocessing's own.
            os.kill(children[-1], signal.SIGKILL)


def read_words(words: int, seconds: float) -> tuple[str, bool]:
    """Return what a build tells for so long, and whether it has come to its end."""
    told, until = b"", time.monotonic() + seconds
    while (left := until - time.monotonic()) > 0:
        if select.select([words], [], [], left)[0]:
            part = os.read(words, 1 << 16)
            if not part:
                return told.decode(), True
            told += part
    return told.decode(), False


def images_on_disk(folder: Path) -> int:
    """Return how many whole images lie in shards and parts."""
    count = 0
    for path in sorted(folder.glob("shards/*/*.tar*")):
        with path.open("rb") as stream:
            count += sum(1 for _ in stored_samples(stream, path.stat().st_size, checked=True))
    return count


def one_kill(folder: Path, rng: random.Random, longest_s: float, pool: bool) -> tuple[bool, str]:
    """Build on, kill, and look; return whether all was right, and a line."""
    before = images_on_disk(folder)
    number, words = started(folder) if pool else forked(folder)
    how = rng.choice(["parent", "worker", "all"]) if pool else "parent"
    told, ended = read_words(words, rng.uniform(0, longest_s))
    if not ended:
        kill(number, how)
    if how == "worker" and not ended:
        more, _ = read_words(words, 600)
        told += more
    os.waitpid(number, 0)
    rest, _ = read_words(words, 2.0)
    os.close(words)
    done = [int(line.split()[1]) for line in (told + rest).splitlines() if line[:6] == "images"]
    acknowledged, found = max(done, default=0), images_on_disk(folder)
    least = max(acknowledged, before)  # A run tells what it found as it comes to it.
    most = IMAGES if ended or how == "worker" else least + (POOL_JOBS if pool else 1)
    is_right = least <= found <= most
    return is_right, f"{'pool' if pool else 'one'} {how}: told {acknowledged}, found {found}"


def files_of(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def differing(found: dict[str, bytes], wanted: dict[str, bytes]) -> list[str]:
    """Return the names of files that are in one set alone, or differ."""
    return sorted(name for name in found | wanted if found.get(name) != wanted.get(name))


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--kills", type=int, default=USUAL_KILLS)
    options.add_argument("--pools", type=int, default=USUAL_POOLS)
    options.add_argument("--seed", type=int, default=0)
    words = options.parse_args()
    rng, wrong, whole_sets = random.Random(words.seed), 0, 0
    with tempfile.TemporaryDirectory() as place:
        first = Path(place) / "first"
        began = time.monotonic()
        with open_engine("pool", 1) as engine:
            build_dataset(first, the_plan(), engine)
        longest_s, wanted = time.monotonic() - began, files_of(first)
        print(f"whole in {longest_s:.1f} s: {len(wanted)} files, {IMAGES} images")
        folder = Path(place) / "again"
        for number in range(words.kills):
            pool = number % max(1, words.kills // max(words.pools, 1)) == 0 and words.pools > 0
            right, line = one_kill(folder, rng, longest_s * (3 if pool else 0.7), pool)
            if is_complete(folder) or number == words.kills - 1:
                with open_engine("pool", 1) as engine:
                    build_dataset(folder, the_plan(), engine)
                other = differing(files_of(folder), wanted)
                same = not other and not verify_store(folder).faults
                right, whole_sets = right and same, whole_sets + 1
                line += f"; a whole set, {'the same' if same else 'NOT THE SAME'}"
                line += f": {', '.join(other[:5])}" if other else ""
                folder = Path(place) / f"again{number}"
            wrong += not right
            print(f"{number + 1:3} {'right' if right else 'WRONG'}  {line}", flush=True)
    print(f"{words.kills} kills, {wrong} wrong, {whole_sets} sets came to their end")
    return 1 if wrong else 0


def is_complete(folder: Path) -> bool:
    meta = folder / "dataset.json"
    return meta.is_file() and '"complete": true' in meta.read_text()


if __name__ == "__main__":
    raise SystemExit(main())
