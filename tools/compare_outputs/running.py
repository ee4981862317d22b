"""Runs steps with the code of one side, and keeps what they wrote."""

import hashlib
import importlib.util
import json
import os
import shlex
import shutil
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO, NamedTuple

from compare_outputs import declared
from compare_outputs.acting import SPENT, Given, Place
from compare_outputs.table import Step

KEPT_KERNELS = 6  # States of the tree whose compiled kernels are kept.
FAILED = 125  # The exit code of an act that could not be done.
FORM = "1"  # Of what is kept; another one makes everything anew.


class Done(NamedTuple):
    """What became of a step: its exit codes, the seconds that it took, and those of processors."""

    codes: tuple[int, ...]
    seconds: float
    cpu_s: float


@dataclass(frozen=True)
class Side:
    """A tree of code and where its commands work. Both sides' paths are equally long."""

    code: Path
    work: Path
    is_base: bool
    shared: Path
    given_by: Path  # The work folder of the base, which gives each step what it starts from.

    def folder(self, step: Step) -> Path:
        """Where a step's commands are run."""
        return self.work / "out" / step.name

    def logs(self, step: Step) -> Path:
        """Where what they print is kept."""
        return self.work / "logs" / step.name

    @property
    def places(self) -> dict[str, str]:
        """Texts that name this side's folders, and what they are called for comparing."""
        return {str(self.work): "<work>", str(self.code): "<code>"}

    def environment(self, folder: Path) -> dict[str, str]:
        """Return the environment of a step's commands: nothing of the user's own settings."""
        mine = ("W2M_GPU_ADAPTER",)
        kept = {k: one for k, one in os.environ.items() if k[:4] != "W2M_" or k in mine}
        home = self.work / "home" / folder.name
        return kept | {
            "PYTHONPATH": str(self.code / "src"),
            "PYTHONHASHSEED": "0",
            "PYTHONDONTWRITEBYTECODE": "1",
            "W2M_FURNITURE": str(folder / "no-furniture"),
            "W2M_FORGE_HOME": str(folder / "SceneForge"),
            "W2M_CACHE_DIR": str(self.work / "cache"),
            "W2M_RCON_PASSWORD": "secret",
            "HOME": str(home),
            "XDG_DATA_HOME": str(home / "data"),
            "XDG_CONFIG_HOME": str(home / "config"),
            "XDG_CACHE_HOME": str(home / "cache"),
            "HF_HUB_OFFLINE": "1",
            "COLUMNS": "100",
            "NO_COLOR": "1",
            "TZ": "UTC",
            "LC_ALL": "C.UTF-8",
        }

    def start(
        self, words: list[str], stdout: IO[bytes], stderr: IO[bytes], cwd: Path
    ) -> subprocess.Popen[bytes]:
        """Start a command, given in the words of the base."""
        entry = declared.ENTRY if self.is_base else declared.TREE_ENTRY
        words = words if self.is_base else in_new_words(words)
        return self._started(["-m", entry, *words], stdout, stderr, cwd)

    def start_script(
        self, text: str, stdout: IO[bytes], stderr: IO[bytes], cwd: Path
    ) -> subprocess.Popen[bytes]:
        """Start Python with a text that was written for the base."""
        for old, new in declared.MODULES.items() if not self.is_base else ():
            text = text.replace(old, new)
        return self._started(["-c", text], stdout, stderr, cwd)

    def _started(
        self, words: list[str], stdout: IO[bytes], stderr: IO[bytes], cwd: Path
    ) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, *words],
            cwd=cwd,
            env=self.environment(cwd),
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=stderr,
        )


def in_new_words(words: Sequence[str]) -> list[str]:
    """Return a command of the base in the words of the tree."""
    verb = " ".join(words[:2])
    verb = verb if verb in declared.VERBS else words[0]
    length = len(verb.split())
    by_verb = (verb, " ".join(words[:2]))
    rest = [
        next((declared.WORDS[key, one] for key in by_verb if (key, one) in declared.WORDS), one)
        for one in words[length:]
    ]
    return [*declared.VERBS.get(verb, verb).split(), *rest]


def spelled_out(words: list[str], folder: Path) -> list[str]:
    """Return words with the names that a star stands for, as a shell does."""
    return [
        name
        for word in words
        for name in (
            sorted(one.relative_to(folder).as_posix() for one in folder.glob(word))
            if "*" in word
            else [word]
        )
    ]


def missing_for(step: Step, side: Side) -> str:
    """Return why a step cannot be run here; nothing where it can."""
    if step.needs_shared and not side.shared.is_dir():
        return "the shared real inputs are not there"
    missing = [name for name in step.needs if importlib.util.find_spec(name) is None]
    return f"needs {', '.join(missing)}" if missing else ""


def unpacked(repository: Path, commit: str, target: Path) -> None:
    """Lay the code of a commit into a folder, once."""
    if target.exists():
        return
    half = target.with_name(target.name + ".part")
    shutil.rmtree(half, ignore_errors=True)
    half.mkdir(parents=True)
    with (
        subprocess.Popen(
            ["git", "-C", str(repository), "archive", commit, "src"], stdout=subprocess.PIPE
        ) as git,
        tarfile.open(fileobj=git.stdout, mode="r|") as archive,
    ):
        archive.extractall(half, filter="data")
    if git.returncode:
        raise SystemExit(f"{commit} cannot be checked out")
    half.rename(target)


def copied(tree: Path, target: Path) -> None:
    """Lay the code of a work tree into a folder, as it stands now: others may go on in the tree.

    Times stay as they are, so that kernels compiled before are known again.
    """
    shutil.rmtree(target, ignore_errors=True)
    left_out = shutil.ignore_patterns("__pycache__", "node_modules")
    shutil.copytree(tree / "src", target / "src", ignore=left_out)


def sum_of(step: Step, steps: dict[str, Step]) -> str:
    """Return a sum of all that a step's outcome on one commit depends on."""
    known = [
        FORM,
        repr((step.name, step.commands, dict(step.given))),
        *(sum_of(steps[name], steps) for name in step.before),
    ]
    return hashlib.sha256("\n".join(known).encode()).hexdigest()


def prepared(side: Side) -> None:
    """Make a side's folders; of its cache only compiled kernels are kept."""
    for name in ("out", "logs", "home", "cache"):
        (side.work / name).mkdir(parents=True, exist_ok=True)
    for one in (side.work / "cache").iterdir():
        if one.name != "kernels":
            shutil.rmtree(one, ignore_errors=True)
    kernels = side.work / "cache" / "kernels"
    if kernels.is_dir():
        newest = sorted(kernels.iterdir(), key=lambda one: one.stat().st_mtime, reverse=True)
        for one in newest[KEPT_KERNELS:]:
            shutil.rmtree(one, ignore_errors=True)


def run_steps(
    side: Side, wanted: Sequence[Step], jobs: int, tell: Callable[[Step, Done | None], None]
) -> dict[str, Done]:
    """Run steps, those that others take from first, and return what became of each.

    tell: is called with each step that is over; with None where its outcome was kept.
    """
    steps = {step.name: step for step in wanted}
    prepared(side)
    futures: dict[str, Future[Done]] = {}

    def work(step: Step) -> Done:
        for name in step.before if side.is_base else ():
            futures[name].result()
        kept = _kept(side, step, steps) if side.is_base else None
        if kept is not None:
            tell(step, None)
            return kept
        done = _run(side, step)
        if side.is_base:
            told = {"sum": sum_of(step, steps)} | done._asdict()
            (side.logs(step) / "done.json").write_text(json.dumps(told))
        tell(step, done)
        return done

    with ThreadPoolExecutor(jobs) as pool:
        for step in _in_order(steps) if side.is_base else wanted:
            if step.is_given and not side.is_base:
                continue
            futures[step.name] = pool.submit(work, step)
        return {name: future.result() for name, future in futures.items()}


def _in_order(steps: dict[str, Step]) -> list[Step]:
    """Return the steps so that each comes after those that it takes from."""
    order: dict[str, Step] = {}

    def add(step: Step) -> None:
        for name in step.before:
            add(steps[name])
        order.setdefault(step.name, step)

    for step in steps.values():
        add(step)
    return list(order.values())


def _kept(side: Side, step: Step, steps: dict[str, Step]) -> Done | None:
    try:
        told = json.loads((side.logs(step) / "done.json").read_text())
    except (OSError, ValueError):
        return None
    if told["sum"] != sum_of(step, steps):
        return None
    return Done(tuple(told["codes"]), told["seconds"], told.get("cpu_s", 0.0))


def _run(side: Side, step: Step) -> Done:
    folder, logs = side.folder(step), side.logs(step)
    for one in (folder, logs):
        shutil.rmtree(one, ignore_errors=True)
        one.mkdir(parents=True)
    for name, given in step.given.items():
        _put(given, folder / name, side)
    start, start_script = (partial(one, cwd=folder) for one in (side.start, side.start_script))
    codes, began, SPENT.seconds = [], time.monotonic(), 0.0
    for number, command in enumerate(step.commands):
        with (
            (logs / f"{number:02d}.stdout").open("wb") as stdout,
            (logs / f"{number:02d}.stderr").open("wb") as stderr,
        ):
            place = Place(folder, start, start_script, stdout, stderr)
            try:
                if isinstance(command, str):
                    codes.append(place.command(spelled_out(shlex.split(command), folder)))
                else:
                    codes.append(command.act(place))
            except Exception as error:  # Such as an editor that does not begin: the step failed.
                stderr.write(f"{type(error).__name__}: {error}\n".encode())
                codes.append(FAILED)
    return Done(tuple(codes), time.monotonic() - began, SPENT.seconds)


def _put(given: str | Given, target: Path, side: Side) -> None:
    """Lay into a step's folder what it starts from."""
    if not isinstance(given, str):
        given.put(target, side.shared)
        return
    source = side.given_by / "out" / given
    if source.is_dir():
        shutil.copytree(source, target, symlinks=True)
    else:
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)
