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
from collections import defaultdict
from pathlib import Path
from typing import Any

from numba.core.dispatcher import Dispatcher

from world2minecraft.cli import main as run_command
from world2minecraft.core.jit import KERNEL_CACHE
from world2minecraft.core.kernel_cache import called_kernels, kernel_digest
from world2minecraft.core.precompile import LIST, WORK, read_kernel_calls, type_text

COMMANDS = {
    "room": (
        "demo --out demo --frames 12",
        "rooms scan --kind kitchen --seed 3 --out scan --frames 8",
        "reconstruct scan --out run",
        "evaluate reconstruction run scan",
        "render run --out picture.png",
        "render run --out photo.png --photo --size 64x48",
        "render run --out orbit --orbit --frames 2 --outputs all",
        "build run --out fine --blocks-per-metre 2 --style display",
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
    found: dict[str, set[str]] = defaultdict(set)  # Kinds of work of each call, as JSON.
    for call in read_kernel_calls() if LIST.exists() else ():
        found[json.dumps([call.kernel, call.types])].update(set(call.work) - set(chosen))
    for work in chosen:
        for line in record(COMMANDS[work]):
            found[line].add(work)
    write_list({line: work for line, work in found.items() if work})


def record(commands: tuple[str, ...]) -> set[str]:
    """Run commands one after the other and return the calls of their processes, as JSON."""
    with tempfile.TemporaryDirectory() as folder:
        for number, command in enumerate(commands):
            sys.stderr.write(f"w2m {command}\n")
            environment = {**os.environ, RECORD: str(Path(folder) / f"{number}.calls")}
            words = f"{sys.executable} {__file__} -- {command}"
            subprocess.run(words, shell=True, cwd=folder, env=environment, check=True)
        return {
            line for file in Path(folder).glob("*.calls") for line in file.read_text().splitlines()
        }


def run_recorded() -> None:
    """Run a command of ``w2m`` and write the kernels that it called."""
    file = Path(os.environ[RECORD])
    atexit.register(lambda: file.write_text("\n".join(sorted(loaded_calls()))))
    del sys.argv[1]
    run_command()


def loaded_calls() -> set[str]:
    """Return the compiled calls of all kernels of this process, as JSON."""
    result = set()
    for name, kernel in loaded_kernels().items():
        for signature in kernel.overloads:
            try:
                result.add(json.dumps([name, [type_text(kind) for kind in signature]]))
            except ValueError:  # Compiled with what calls it.
                continue
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


def write_list(found: dict[str, set[str]]) -> None:
    """Write the calls with what they call, the work that needs them and their size."""
    for line in found:
        importlib.import_module(f"world2minecraft.{json.loads(line)[0].partition(':')[0]}")
    kernels = loaded_kernels()
    names = {kernel.py_func: name for name, kernel in kernels.items()}
    called = {
        name: {names[one] for one in called_kernels(kernel.py_func) if one in names} - {name}
        for name, kernel in kernels.items()
    }
    work: dict[str, set[str]] = defaultdict(set)
    for line, kinds in found.items():
        name = json.loads(line)[0]
        for one in {name, *called[name]}:
            work[one] |= kinds
    rows: list[dict[str, Any]] = [
        {
            "kernel": name,
            "types": types,
            "calls": sorted(called[name]),
            "work": [kind for kind in WORK if kind in work[name]],
            "size": compiled_size(kernels[name]),
        }
        for name, types in sorted(json.loads(line) for line in found)
    ]
    listed = ",\n".join(json.dumps(row) for row in rows)
    LIST.write_text(f"[\n{listed}\n]\n")
    kernels_listed = len({row["kernel"] for row in rows})
    sys.stderr.write(f"{LIST}: {len(rows)} calls of {kernels_listed} kernels\n")


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
