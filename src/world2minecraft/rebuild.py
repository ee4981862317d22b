"""From an occupancy grid to a world, without its capture."""

from pathlib import Path

import numpy as np

from world2minecraft.errors import InputError, UsageError
from world2minecraft.exchange.occupancy import read_occupancy
from world2minecraft.exchange.room import write_room
from world2minecraft.files import write_bytes
from world2minecraft.parameters import Parameters
from world2minecraft.progress import Progress, silent
from world2minecraft.run_folder import check_writable
from world2minecraft.steps import LATER_STEPS

RUN_FILES = ("scan.json", "room.npz", "objects.json", "placements.json")
ROOMS = "layout.json"  # Runs of the first versions have none.


def rebuild(source: Path, out: Path, parameters: Parameters, progress: Progress = silent) -> None:
    """Build ``out / "build"`` from a run's folder or from any occupancy file.

    A run's folder is built from its objects and placements as they stand. From a grid alone
    objects are found and matched first; their files are written to ``out`` too.

    Raises:
        InputError: ``source`` cannot be read. OutputError: ``out`` cannot be written.
        UsageError: ``out`` is ``source``.
    """
    if out.exists() and source.exists() and out.samefile(source):
        raise UsageError(f"{out} is the source; give another folder to --out")
    if source.is_dir():
        _copy_run(source, out)
        stages = ("build",)
    else:
        grid = read_occupancy(source)
        check_writable(out)
        write_room(out / "room.npz", grid, np.eye(4))
        stages = ("find", "furnish", "build")
    for stage in stages:
        progress(stage, 0, 1)
        LATER_STEPS[stage](out, parameters)
        progress(stage, 1, 1)


def _copy_run(source: Path, out: Path) -> None:
    missing = [name for name in RUN_FILES if not (source / name).is_file()]
    if missing:
        raise InputError(source, f"is no finished run: {missing[0]} is missing")
    check_writable(out)
    for name in (*RUN_FILES, ROOMS):
        if (source / name).is_file():
            write_bytes(out / name, (source / name).read_bytes())
