"""Check that this machine can run the program: ``w2m doctor``."""

import json
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Annotated, Literal

import typer

EXAMPLES = """\
w2m doctor                  check this machine
w2m doctor && w2m demo      check it, then build the demo room
w2m doctor --warm           compile all kernels now, on all cores
w2m doctor --json           print the checks as JSON, for a bug report
"""

PYTHON_RANGE = ((3, 11), (3, 14))
MIN_MEMORY_GB = 1.0  # The budget of a capture of 40 frames.
MIN_DISK_GB = 0.5  # Kernels take about 50 MB, a built room less than 20 MB.
CORE_PACKAGES = ("numpy", "numba", "scipy", "pillow")


@dataclass(frozen=True)
class Check:
    """The result of one check.

    Attributes:
        what: Name of the checked item.
        state: ``ok``, ``warn`` (the program runs with limitations) or ``bad`` (it cannot run).
        found: What the check found.
        advice: How to fix a problem. Empty if there is none.
    """

    what: str
    state: Literal["ok", "warn", "bad"]
    found: str
    advice: str = ""


def run(
    warm: Annotated[
        bool, typer.Option("--warm", help="Compile all kernels, so that no first run waits.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a JSON list.")] = False,
) -> int:
    """Check Python, the libraries, the cache folder, memory, disk and the optional extras.

    Exits with code 0 if the program can run, and with code 1 if something must be fixed first.
    Java, the game and a graphics card are not needed.

    Args:
        warm: Compile all kernels after the checks.
        as_json: Print the checks as JSON instead of text.
    """
    checks = list(examine())
    if as_json:
        print(json.dumps([vars(check) for check in checks], indent=2))
        return int(any(check.state == "bad" for check in checks))
    for check in checks:
        advice = f"; {check.advice}" if check.advice else ""
        print(f"{check.state:<5}{check.what:<14}{check.found}{advice}")
    bad = sum(check.state == "bad" for check in checks)
    if warm and not bad:
        compile_all()
    print(f"{bad} problem{'s' * (bad != 1)} to fix" if bad else "ready: try w2m demo")
    return int(bad > 0)


def compile_all() -> None:
    """Compile the kernels of all kinds of work."""
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import WORK, compile_kernels

    with show_progress() as progress:
        compiled = sum(compile_kernels(work, progress) for work in WORK)
    print(f"{'ok':<5}{'kernels':<14}{compiled} compiled, the others were ready")


def examine() -> Iterator[Check]:
    """Run all checks in display order."""
    yield check_python(sys.version_info[:2])
    for name in CORE_PACKAGES:
        yield check_package(name)
    yield check_cache()
    yield check_threads()
    yield check_memory(available_memory_gb())
    yield check_disk(Path.cwd())
    for extra, packages in optional_extras().items():
        yield check_extra(extra, packages)
    yield Check("Java, game", "ok", "not needed to build; Java Edition opens the worlds")


def check_python(version: tuple[int, ...]) -> Check:
    """Check that the libraries support this version of Python."""
    first, last = PYTHON_RANGE
    found = ".".join(map(str, version))
    if first <= version <= last:
        return Check("Python", "ok", found)
    wanted = " to ".join(".".join(map(str, end)) for end in PYTHON_RANGE)
    return Check(
        "Python", "bad", found, f"install Python {wanted} and create a new environment with it"
    )


def check_package(name: str) -> Check:
    """Check that a core package is installed, and return its version."""
    if _is_installed(name):
        return Check(name, "ok", metadata.version(name))
    return Check(name, "bad", "not installed", "run: pip install world2minecraft")


def check_cache() -> Check:
    """Check that compiled kernels can be saved between runs."""
    from world2minecraft.core.jit import user_cache_dir

    folder = user_cache_dir()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return Check("cache", "ok", str(folder))
    except OSError as error:
        advice = "every run compiles again; set W2M_CACHE_DIR to a writable folder"
        return Check("cache", "warn", f"{folder}: {error.strerror}", advice)


def check_threads() -> Check:
    """Report the number of cores that this process can use."""
    from world2minecraft.core.machine import usable_cores

    cores = usable_cores()
    limit = os.environ.get("NUMBA_NUM_THREADS")
    return Check("cores", "ok", f"{cores}" + (f" (NUMBA_NUM_THREADS={limit})" if limit else ""))


def check_memory(free_gb: float | None) -> Check:
    """Check the free memory in GB. None means that the system does not report it."""
    if free_gb is None:
        return Check("memory", "ok", "not reported by this system")
    if free_gb >= MIN_MEMORY_GB:
        return Check("memory", "ok", f"{free_gb:.1f} GB free")
    advice = f"{MIN_MEMORY_GB:.0f} GB is needed; close other programs, or use a larger --voxel"
    return Check("memory", "warn", f"{free_gb:.1f} GB free", advice)


def check_disk(folder: Path) -> Check:
    """Check the free space on the disk that contains ``folder``."""
    free_gb = shutil.disk_usage(folder).free / 1e9
    if free_gb >= MIN_DISK_GB:
        return Check("disk", "ok", f"{free_gb:.1f} GB free here")
    return Check(
        "disk",
        "warn",
        f"{free_gb:.1f} GB free here",
        f"{MIN_DISK_GB} GB is needed; free some space, or use another disk",
    )


def optional_extras() -> dict[str, tuple[str, ...]]:
    """Return the packages of each extra that the distribution declares, except ``dev``."""
    extras: dict[str, tuple[str, ...]] = {}
    for requirement in metadata.requires("world2minecraft") or ():
        name = re.match(r"[\w.-]+", requirement)
        extra = re.search(r"extra == ['\"]([\w-]+)['\"]", requirement)
        if name and extra and extra[1] != "dev":
            extras[extra[1]] = (*extras.get(extra[1], ()), name[0])
    return extras


def check_extra(extra: str, packages: tuple[str, ...]) -> Check:
    """Check whether an optional extra is installed. Reconstruction and building need no extras."""
    missing = [name for name in packages if not _is_installed(name)]
    if not missing:
        return Check(f"[{extra}]", "ok", "installed")
    install = f"to install: pip install 'world2minecraft[{extra}]'"
    return Check(f"[{extra}]", "ok", f"optional, {', '.join(missing)} not installed", install)


def available_memory_gb() -> float | None:
    """Return the memory available to new programs in GB, or None if it is not reported."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        values = {line.split(":")[0]: line.split()[1] for line in lines}
        return int(values["MemAvailable"]) * 1024 / 1e9
    except (OSError, KeyError, IndexError, ValueError):
        return None


def _is_installed(package: str) -> bool:
    try:
        metadata.version(package)
    except metadata.PackageNotFoundError:
        return False
    return True
