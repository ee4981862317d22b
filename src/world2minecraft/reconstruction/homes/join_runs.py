"""Read finished runs, join them, and write the result as one run with its world."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from world2minecraft import __version__
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.files import write_json
from world2minecraft.core.output_folders import check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Scan
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.reconstruction.file_stages import run_stage
from world2minecraft.reconstruction.homes.merged_run import Home, merge_runs
from world2minecraft.reconstruction.homes.moved_run import Run
from world2minecraft.reconstruction.homes.room_placement import (
    Placed,
    parse_place,
    place_runs,
    stated,
)
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.room_files import write_room_files
from world2minecraft.reconstruction.run_folder import check_finished

MAX_RUNS = 50


def read_runs(folders: Sequence[Path]) -> tuple[Run, ...]:
    """Read finished runs, named after their folders with a number appended to repeated names.

    Raises:
        InputError: If a folder does not contain a finished run.
        UsageError: If the runs have different cell sizes.
    """
    if not 2 <= len(folders) <= MAX_RUNS:
        raise UsageError(f"expected 2 to {MAX_RUNS} finished runs to join, got {len(folders)}")
    runs: list[Run] = []
    for folder in folders:
        name = _name(folder, [run.name for run in runs])
        runs.append(read_whole(folder, partial(_read_run, folder, name)))
    sizes = sorted({run.grid.voxel_m for run in runs})
    if len(sizes) > 1:
        raise UsageError(
            f"the runs have different cell sizes ({sizes[0]:g} m and {sizes[-1]:g} m); reconstruct "
            "them with the same cell size (--voxel)"
        )
    return tuple(runs)


def _read_run(folder: Path, name: str) -> Run:
    check_finished(folder)
    grid, _ = read_room(folder / "room.npz")
    layouts = read_rooms(folder, grid)
    if not layouts:
        raise InputError(folder, "layout.json is missing or empty; reconstruct the room again")
    objects = read_objects(folder / "objects.json", grid)
    placed = read_placements(folder / "placements.json")
    return Run(name, grid, objects, placed, layouts)


def _name(folder: Path, taken: Sequence[str]) -> str:
    plain = (
        "".join(c if c.isalnum() or c in "_-." else "_" for c in folder.resolve().name) or "room"
    )
    name, number = plain, 2
    while name in taken:
        name, number = f"{plain}-{number}", number + 1
    return name


def join(
    folders: Sequence[Path],
    out: Path,
    parameters: Parameters | None = None,
    places: Sequence[str] = (),
    progress: Progress = no_progress,
) -> Scan:
    """Join finished runs into the folder of one run with its world.

    Args:
        folders: Folders of the runs; the first keeps its position.
        out: Output folder.
        parameters: Parameters of the build.
        places: Positions of runs as ``NAME=X,Y,TURNS``; other runs are placed by their doors.
        progress: Callback for progress.

    Returns:
        A scan of the joined rooms without views.

    Raises:
        InputError: If a run cannot be read.
        UsageError: If a run fits nowhere, or in several positions.
        OutputError: If ``out`` cannot be written.
    """
    chosen = parameters or Parameters()
    if any(out.exists() and folder.exists() and out.samefile(folder) for folder in folders):
        raise UsageError(f"{out} is one of the joined runs; choose another output folder")
    progress("join", 0, 1)
    runs = read_runs(folders)
    voxel_m = runs[0].grid.voxel_m
    names = [run.name for run in runs]
    by_hand = dict(parse_place(text, names, voxel_m) for text in places)
    placed = place_runs(runs, by_hand)
    home = merge_runs(placed, out.resolve().name)
    check_writable(out)
    scan = _scan_of(home, placed)
    run = home.run
    write_room_files(out, scan, run.grid, run.layouts, run.instances, run.placements)
    write_json(out / "manifest.json", _manifest(placed, voxel_m, chosen))
    progress("join", 1, 1)
    run_stage("build", out, chosen, progress)
    return scan


def _scan_of(home: Home, placed: Placed) -> Scan:
    return Scan(
        views=(),  # type: ignore[arg-type]
        scan_to_room=np.eye(4),
        room_size_m=home.size_m,
        frames_used=(),
        source="joined",
        notes=(*placed.lines, *home.lines),
        name=home.run.name.replace("_", " "),
    )


def _manifest(placed: Placed, voxel_m: float, chosen: Parameters) -> dict:
    pairs = zip(placed.runs, placed.moves, strict=True)
    return {
        "program": __version__,
        "joined": [stated(run.name, move, voxel_m) for run, move in pairs],
        "parameters": chosen.as_json(),
    }
