"""Compares what the program writes with what it wrote at an older commit.

    python tools/compare_outputs.py BASE            every command: long
    python tools/compare_outputs.py BASE --fast     those that take minutes, for every commit
    python tools/compare_outputs.py BASE --only render walk
    python tools/compare_outputs.py --list

Each command is run with the code of both sides. Grids, worlds and the game's files must be equal
byte for byte; pictures and scenes as data; documents by structure and numbers. What was renamed
since is declared in ``compare_outputs/declared.py``. The base's files are kept by its commit, in
W2M_COMPARE_CACHE or the system's folder for passing files. Exit code 1 where anything differs.
"""

import argparse
import contextlib
import fcntl
import hashlib
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from compare_outputs import declared
from compare_outputs.contents import File, differences
from compare_outputs.running import Done, Side, copied, missing_for, run_steps, unpacked
from compare_outputs.table import STEPS, Step

REPOSITORY = Path(__file__).resolve().parents[1]


def main() -> int:
    """Compare as the words say, and return the exit code."""
    words = _words()
    if words.undeclared:
        declared.forget()
    chosen = _chosen(words.only, words.fast)
    if words.list:
        for step in STEPS:
            tell(f"{step.name:20}{'fast' if step.is_fast else '':6}{len(step.commands)} commands")
        return 0
    commit = _commit(words.base)
    cache = Path(
        os.environ.get("W2M_COMPARE_CACHE", Path(tempfile.gettempdir()) / "w2m-compare-outputs")
    ).resolve()
    shared = Path(os.environ.get("W2M_SHARED_DATA", REPOSITORY.parent / "shared" / "data"))
    tree = Path(words.tree)
    key = _commit(words.tree) if not tree.is_dir() else _sum(tree.resolve())
    base_work, tree_work = cache / f"base-{commit[:12]}", cache / f"tree-{key[:12]}"
    base = Side(cache / f"base-code-{commit[:12]}", base_work, True, shared, base_work)
    ours = Side(cache / f"tree-code-{key[:12]}", tree_work, False, shared, base_work)
    chosen = [step for step in chosen if not step.is_given]
    skipped = {step.name: why for step in chosen if (why := missing_for(step, ours))}
    chosen = [step for step in chosen if step.name not in skipped]
    began = time.monotonic()
    with locked(base_work):
        unpacked(REPOSITORY, commit, base.code)
        before = run_steps(base, _with_those_before(chosen), words.jobs, _teller("base"))
        middle = time.monotonic()
        for step in chosen:
            if step.skipped_by and any(
                step.skipped_by in _said(base, step, number) for number in range(len(step.commands))
            ):
                skipped[step.name] = step.skipped_by
        chosen = [step for step in chosen if step.name not in skipped]
        with locked(tree_work):
            if tree.is_dir():
                copied(tree, ours.code)
            else:
                unpacked(REPOSITORY, key, ours.code)
            after = run_steps(ours, chosen, words.jobs, _teller("tree"))
            end = time.monotonic()
            tell("")
            bad = sum(judged(step, base, ours, before, after, words.show) for step in chosen)
    for name, why in skipped.items():
        tell(f"skipped  {name}: {why}")
    tell(
        f"\n{len(chosen) - bad} of {len(chosen)} steps equal, {bad} not, {len(skipped)} skipped; "
        f"base {middle - began:.0f} s, tree {end - middle:.0f} s with {words.jobs} jobs, of "
        f"processors {sum(before[one.name].cpu_s for one in chosen):.0f} s and "
        f"{sum(after[one.name].cpu_s for one in chosen):.0f} s"
    )
    return int(bad > 0)


def tell(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def judged(
    step: Step,
    base: Side,
    tree: Side,
    before: dict[str, Done],
    after: dict[str, Done],
    show: int,
) -> bool:
    """Tell how a step came out; return whether it differs."""
    found = list(_found(step, base, tree, before[step.name], after[step.name]))
    seconds = f"{before[step.name].cpu_s:.0f} s, {after[step.name].cpu_s:.0f} s of processors"
    files = sum(len(one) for one in _files(base, step).values())
    tell(f"{'DIFFERS' if found else 'ok':9}{step.name} ({files} files; {seconds})")
    for line in found[:show]:
        tell(f"           {line}")
    if len(found) > show:
        tell(f"           ... and {len(found) - show} more")
    return bool(found)


def _found(step: Step, base: Side, tree: Side, before: Done, after: Done) -> Iterator[str]:
    for number, (one, other) in enumerate(zip(before.codes, after.codes, strict=True)):
        if one != step.codes.get(number, 0):
            yield f"command {number}: the base itself ended with {one}: {_said(base, step, number)}"
        elif one != other:
            yield f"command {number}: ended with {one}, now {other}: {_said(tree, step, number)}"
    ours, theirs = _files(base, step), _files(tree, step)
    for kind in ours:
        for name in sorted(ours[kind].keys() | theirs[kind].keys()):
            if name not in theirs[kind]:
                yield f"{kind}{name}: is not written"
            elif name not in ours[kind]:
                yield f"{kind}{name}: was not written"
            else:
                pair = [
                    File(name, side_files[kind][name].read_bytes(), side.places, side.is_base)
                    for side_files, side in ((ours, base), (theirs, tree))
                ]
                for line in differences(*pair, prints=bool(kind)):
                    yield f"{kind}{name}: {line}"


def _said(side: Side, step: Step, number: int) -> str:
    lines = (side.logs(step) / f"{number:02d}.stderr").read_text(errors="replace").split("\n")
    return next((line for line in reversed(lines) if line.strip()), "")[:200]


def _files(side: Side, step: Step) -> dict[str, dict[str, Path]]:
    """Return a step's files by their names as the tree calls them, and what it printed."""
    written, folder = {}, side.folder(step)
    for path in sorted(folder.rglob("*")):
        if path.is_dir() and any(path.iterdir()):
            continue
        parts = path.relative_to(folder).parts
        if side.is_base:
            parts = tuple(declared.FILES.get(one, one) for one in parts)
        name = "/".join(parts)
        for pattern, stand_in in declared.VARYING_NAMES:
            name = pattern.sub(stand_in, name)
        if path.is_file():
            written[name] = path
    printed = {one.name: one for one in sorted(side.logs(step).glob("*.stdout"))}
    return {"": written, "printed by ": printed}


def _teller(side: str) -> Callable[[Step, Done | None], None]:
    def told(step: Step, done: Done | None) -> None:
        took = f"{done.seconds:.0f} s, {done.cpu_s:.0f} s of processors" if done else "kept"
        tell(f"{side}: {step.name} {took}")

    return told


def _words() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("base", nargs="?", default="1f340e9", help="a commit (%(default)s)")
    parser.add_argument("--fast", action="store_true", help="only what takes minutes")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these steps")
    parser.add_argument("--list", action="store_true", help="list the steps")
    parser.add_argument("--jobs", type=int, default=min(os.cpu_count() or 1, 2))
    parser.add_argument("--show", type=int, default=6, help="differences of a step to print")
    parser.add_argument(
        "--undeclared", action="store_true", help="without what is declared: the base with itself"
    )
    parser.add_argument(
        "--tree",
        default=str(REPOSITORY),
        metavar="FOLDER_OR_COMMIT",
        help="what is compared; this work tree, as it stands when the base is done",
    )
    return parser.parse_args()


def _chosen(only: list[str] | None, fast: bool) -> list[Step]:
    known = [step.name for step in STEPS]
    unknown = set(only or ()) - set(known)
    if unknown:
        raise SystemExit(f"no step is named {', '.join(sorted(unknown))}: {', '.join(known)}")
    return [step for step in STEPS if (step.name in only if only else step.is_fast or not fast)]


def _with_those_before(chosen: list[Step]) -> list[Step]:
    wanted, left = set(), [step.name for step in chosen]
    by_name = {step.name: step for step in STEPS}
    while left:
        name = left.pop()
        wanted.add(name)
        left += by_name[name].before
    return [step for step in STEPS if step.name in wanted]


def _sum(folder: Path) -> str:
    return hashlib.sha256(str(folder).encode()).hexdigest()


def _commit(name: str) -> str:
    found = subprocess.run(
        ["git", "-C", str(REPOSITORY), "rev-parse", "--verify", f"{name}^{{commit}}"],
        capture_output=True,
        text=True,
        check=False,
    )
    if not re.fullmatch(r"[0-9a-f]{40}\n", found.stdout):
        raise SystemExit(f"no commit is named {name}")
    return found.stdout.strip()


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Work in a folder alone: another run of the guard waits."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with folder.with_name(folder.name + ".lock").open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            tell(f"another run works in {folder}; waiting for it")
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


if __name__ == "__main__":
    sys.exit(main())
