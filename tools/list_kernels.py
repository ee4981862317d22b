"""Record which kernels the commands call: ``python tools/list_kernels.py [WORK ...]``.

Runs commands of each kind of work with small inputs and writes their kernels, with the types of
the arguments, to ``core/data/kernels.json`` for ``core/precompile.py``. Run it again when kernels
were added or their arguments changed. With kinds of work, only those are recorded again.
"""

import atexit
import importlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

from numba.core.dispatcher import Dispatcher

from world2minecraft.cli import main as run_command
from world2minecraft.core import precompile
from world2minecraft.core.jit import KERNEL_CACHE
from world2minecraft.core.kernel_cache import called_kernels, kernel_digest
from world2minecraft.core.precompile import LIST, WORK, read_kernel_calls, type_text

# Commands of ``w2m`` by kind of work. Those in parentheses prepare files and are not recorded.
COMMANDS = {
    "room": (
        "demo --out demo --frames 12",
        "rooms scan --kind kitchen --seed 3 --out scan --frames 8",
        "reconstruct scan --out run",
        "build run --out fine --blocks-per-metre 2 --style display",
    ),
    "pictures": (
        "(demo --out run --frames 12)",
        "evaluate reconstruction run run/capture",
        "render run --out picture.png",
        "render run --out photo.png --photo --size 64x48",
        "render run --out orbit --orbit --frames 2 --outputs all",
        "convert run room.glb",
        "convert run room.litematic",
        "share run --out room.html",
        "share run --out room.gif",
        "rooms generate --house --rooms 4 --out house",
    ),
    "photos": (
        "rooms scan --seed 7 --sensor photos --frames 24 --out photos",
        "reconstruct photos --out run",
    ),
    "dataset": ("dataset build data --houses 1 --images 4 --jobs 1",),
    "navigation": (
        "demo --out demo --frames 12",
        "vln build demo --out walks --trajectories 2 --workers 1",
        "vln run demo 'Go to the table' --out walk --max-steps 5",
    ),
}
RECORD = "W2M_KERNEL_RECORD"  # Names the file for the kernels of a process.


def main() -> None:
    """Run the commands and write the list."""
    chosen = sys.argv[1:] or list(WORK)
    found = {
        (call.kernel, json.dumps(call.types)): Found(set(call.work) - set(chosen), call.size)
        for call in (read_kernel_calls() if LIST.exists() else ())
    }
    for work in chosen:
        for kernel, types, size in record(COMMANDS[work]):
            entry = found.setdefault((kernel, json.dumps(types)), Found(set(), size))
            entry.work.add(work)
    write_list({call: entry for call, entry in found.items() if entry.work})


class Found(NamedTuple):
    """The kinds of work that make a call, and the size of its compiled code in kB."""

    work: set[str]
    size: int


def record(commands: tuple[str, ...]) -> list[tuple[str, list[Any], int]]:
    """Run commands one after the other and return the calls of their processes.

    They begin with an empty cache: of a kernel that is loaded, those it calls are not seen.
    """
    with tempfile.TemporaryDirectory() as folder:
        for number, command in enumerate(commands):
            sys.stderr.write(f"w2m {command}\n")
            kind = "prepared" if command.startswith("(") else "calls"
            environment = {
                **os.environ,
                RECORD: str(Path(folder) / f"{number}.{kind}"),
                "NUMBA_CACHE_DIR": str(Path(folder) / f"{kind}-cache"),
            }
            words = f"{sys.executable} {__file__} -- {command.strip('()')}"
            subprocess.run(words, shell=True, cwd=folder, env=environment, check=True)
        files = sorted(Path(folder).glob("*.calls"))
        return [tuple(row) for file in files for row in json.loads(file.read_text())]


def run_recorded() -> None:
    """Run a command of ``w2m`` and write the kernels that it called."""
    file = Path(os.environ[RECORD])
    precompile.needs_compiling = lambda work: False
    atexit.register(lambda: file.write_text(json.dumps(loaded_calls())))
    del sys.argv[1]
    run_command()


def loaded_calls() -> list[tuple[str, list[Any], int]]:
    """Return the compiled calls of all kernels of this process, with the size of their code."""
    result = []
    for name, kernel in loaded_kernels().items():
        for signature in kernel.overloads:
            try:
                types = [type_text(kind) for kind in signature]
            except ValueError:  # Compiled with what calls it.
                continue
            result.append((name, types, compiled_size(kernel)))
    return result


def loaded_kernels() -> dict[str, Dispatcher]:
    """Return all kernels of the imported modules by module and name."""
    return {
        f"{name.removeprefix('world2minecraft.')}:{attribute}": value
        for name, module in list(sys.modules.items())
        for attribute, value in vars(module).items()
        if name.startswith("world2minecraft.")
        if isinstance(value, Dispatcher) and value.__module__ == name
    }


def write_list(found: dict[tuple[str, str], Found]) -> None:
    """Write the calls with what they call, the work that needs them and their size."""
    for name, _ in found:
        importlib.import_module(f"world2minecraft.{name.partition(':')[0]}")
    kernels = loaded_kernels()
    names = {kernel.py_func: name for name, kernel in kernels.items()}
    called = {
        name: {names[one] for one in called_kernels(kernel.py_func) if one in names} - {name}
        for name, kernel in kernels.items()
    }
    rows: list[dict[str, Any]] = [
        {
            "kernel": name,
            "types": json.loads(types),
            "calls": sorted(called[name]),
            "work": [work for work in WORK if work in entry.work],
            "size": entry.size,
        }
        for (name, types), entry in sorted(found.items())
    ]
    listed = ",\n".join(json.dumps(row) for row in rows)
    LIST.write_text(f"[\n{listed}\n]\n")
    sys.stderr.write(f"{LIST}: {len(rows)} calls of {len({name for name, _ in found})} kernels\n")


def compiled_size(kernel: Dispatcher) -> int:
    """Return the mean size in kB of the compiled calls of a kernel."""
    digest = kernel_digest(kernel.py_func)
    sizes = [file.stat().st_size for file in KERNEL_CACHE.glob(f"*-{digest}.*.nbc")]
    return round(sum(sizes) / max(len(sizes), 1) / 1000) + 1


if __name__ == "__main__":
    if sys.argv[1:2] == ["--"]:
        run_recorded()
    else:
        main()
