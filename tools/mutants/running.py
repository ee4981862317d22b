"""Run the tests of one group against each of its faults, all in one process and its children.

Nothing is imported twice: the tests are collected once, and each fault is grafted into a child of
that process. The first child runs the tests as they are and notes which lines of the modules each
of them reaches; so a fault meets only the tests that reach its line, the quickest first, until one
fails. One that outlasts ten times their time is noticed too: a loop that never ends is a failure.
"""

import importlib
import json
import os
import random
import resource
import signal
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import Phase, settings
from tools.mutants.faults import Fault, faults_of
from tools.mutants.grafting import LoadError, graft

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "world2minecraft"
MORE_MEMORY = 4 << 30
PASSED, FAILED, UNTRIED = range(3)


@dataclass(frozen=True)
class Choice:
    """Which faults are tried, and against which tests."""

    share: float = 1.0  # The part of all faults, by chance.
    seed: int = 0  # Of that chance.
    only: frozenset[tuple[str, str]] | None = None  # Module and change, in place of a share.
    slow_s: float = 6.0  # A test that takes longer, with its kernels as plain Python, is left out.

    def takes(self, module: str, number: int, change: str) -> bool:
        """Return whether a fault is tried."""
        if self.only is not None:
            return (module, change) in self.only
        return random.Random(f"{self.seed} {module} {number}").random() < self.share


class Group:
    """A pytest plugin that takes the place of the loop over the tests."""

    def __init__(self, modules: Iterable[str], choice: Choice, log: Any):
        self.modules = tuple(modules)
        self.choice = choice
        self.log = log
        self.failed = False

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection(self) -> None:
        """Let hypothesis tell a failure at once, without looking for the smallest."""
        quick = settings(settings.get_profile("project"), phases=[Phase.explicit, Phase.generate])
        settings.register_profile("mutants", quick)
        settings.load_profile("mutants")

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a failure of the test that runs."""
        self.failed |= report.failed

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Run all faults in place of all tests."""
        if session.testsfailed:
            raise pytest.UsageError("the tests could not be collected")
        reach = self._reach(session.items)
        for name in self.modules:
            source = (SOURCE / name).read_text()
            faults = faults_of(source)
            for number, fault in enumerate(faults):
                if not self.choice.takes(name, number, fault.change):
                    continue
                outcome = self._try(fault, name, session.items, reach)
                row = {"module": name, "line": fault.line, "change": fault.change}
                self.log.write(json.dumps({**row, "of": len(faults), "outcome": outcome}) + "\n")
                self.log.flush()
        return True

    def _reach(self, items: list[pytest.Item]) -> dict[int, tuple[float, set[tuple[str, int]]]]:
        """Return of each sound test its seconds and the lines that it reaches."""
        rows = [self._measured(at, item) for at, item in enumerate(items)]
        for row in rows:
            if row["failed"]:
                slow = row["seconds"] > 0.9 * self.choice.slow_s
                why = f"takes over {self.choice.slow_s:g} s" if slow else "fails as it is"
                self.log.write(json.dumps({"left_out": items[row["at"]].nodeid, "why": why}) + "\n")
        sound = (row for row in rows if not row["failed"])
        return {
            row["at"]: (row["seconds"], {(name, line) for name, line in row["lines"]})
            for row in sound
        }

    def _measured(self, at: int, item: pytest.Item) -> dict[str, Any]:
        """Run a test in a child of its own, so that no cache that another filled hides a line."""
        read, write = os.pipe()
        child = _forked(lambda: self._measure(at, item, write))
        os.close(write)
        with os.fdopen(read) as told:
            row = told.read()
        os.waitpid(child, 0)
        broken = {"at": at, "seconds": 0.0, "failed": True, "lines": []}
        return json.loads(row) if row else broken

    def _measure(self, at: int, item: pytest.Item, write: int) -> int:
        """Run a test and tell which lines it reaches; break off where it is slow."""
        names = {str(SOURCE / name): name for name in self.modules}
        lines: set[tuple[str, int]] = set()
        signal.signal(signal.SIGPROF, _break_off)
        signal.setitimer(signal.ITIMER_PROF, self.choice.slow_s)
        start = time.process_time()
        with _Tracing(names, lines):
            self._run(item)
        signal.setitimer(signal.ITIMER_PROF, 0)
        seconds = time.process_time() - start
        row = {"at": at, "seconds": seconds, "failed": self.failed, "lines": sorted(lines)}
        with os.fdopen(write, "w") as told:
            told.write(json.dumps(row))
        return PASSED

    def _try(self, fault: Fault, name: str, items: list, reach: dict) -> str:
        chosen = [at for at, (_, lines) in reach.items() if _meets(fault, name, lines)]
        chosen.sort(key=lambda at: reach[at][0])
        if not chosen:
            return "not reached"
        limit_s = 10 * sum(reach[at][0] for at in chosen) + 3

        def child() -> int:
            _limit(limit_s)
            module = importlib.import_module(_dotted(name))
            try:
                graft(module, fault.source, fault.in_function)
            except LoadError:
                return FAILED
            except Exception:
                return UNTRIED
            for at in chosen:
                self._run(items[at])
                if self.failed:
                    return FAILED
            return PASSED

        _, status = os.waitpid(_forked(child), 0)
        if os.WIFSIGNALED(status):
            return "killed by time"
        return ("survived", "killed", "untried")[os.WEXITSTATUS(status)]

    def _run(self, item: pytest.Item) -> None:
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=None)


class TooSlow(BaseException):
    """A test that takes too long; no error that code or hypothesis would catch."""


def _break_off(*_: object) -> None:
    raise TooSlow


class _Tracing:
    """Notes the lines of some files that run."""

    def __init__(self, names: dict[str, str], lines: set[tuple[str, int]]):
        self.names, self.lines = names, lines
        self.before: Any = None  # A debugger, or coverage, which goes on afterwards.

    def __enter__(self) -> None:
        self.before = sys.gettrace()
        sys.settrace(self._call)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self.before)

    def _call(self, frame: Any, event: str, _: Any) -> Any:
        name = self.names.get(frame.f_code.co_filename)
        if name is None:
            return None
        lines = self.lines
        lines.add((name, frame.f_lineno))

        def line(frame: Any, event: str, _: Any) -> Any:
            lines.add((name, frame.f_lineno))
            return line

        return line


def _meets(fault: Fault, name: str, lines: set[tuple[str, int]]) -> bool:
    """Return whether a test reaches a fault: its line, or the module where it is no function's.

    Of a statement over several lines, Python tells only some; so lines near it count too.
    """
    if not fault.in_function:
        return any(module == name for module, _ in lines)
    return any((name, line) in lines for line in range(fault.line - 3, fault.line + 4))


def _dotted(name: str) -> str:
    return "world2minecraft." + name.removesuffix(".py").replace("/", ".")


def _limit(seconds: float) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + MORE_MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _forked(work: Callable[[], int]) -> int:
    """Run ``work`` in a child that leaves with what it returns; return the child's number."""
    child = os.fork()
    if child:
        return child
    try:
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 1)
            os.dup2(nowhere.fileno(), 2)
        code = work()
    except BaseException:
        code = FAILED
    os._exit(code)


def run_group(modules: list[str], tests: list[str], choice: Choice, log: Path) -> int:
    """Run one group and append a line of JSON a fault to ``log``; return pytest's exit code."""
    examples = [str(SOURCE / name) for name in modules]  # Those in docstrings are tests too.
    words = [*tests, *examples, "-p", "no:xdist", "-p", "no:randomly", "--capture=no"]
    words += ["--assert=plain", "--tb=no", "--import-mode=prepend"]
    with log.open("a") as lines:
        return int(pytest.main(words, plugins=[Group(modules, choice, lines)]))
