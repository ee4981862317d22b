"""Build blocks from an occupancy grid or a finished run, without its capture.

The stages are those of ``pipeline``: a grid starts at ``find``, a finished run at ``build``.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.output_folders import draft_of, output_folder
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.formats.occupancy_files import read_occupancy, to_room_frame
from world2minecraft.formats.run_arrays import read_room, write_room
from world2minecraft.minecraft.formats import FORMATS, read_blocks
from world2minecraft.reconstruction.file_stages import built_volume, run_stage
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.run_folder import BUILT_FROM, RUN, check_finished

# Runs from a grid alone have no scan, those of the first versions no rooms.
MORE_FILES = ("scan.json", "layout.json")
FROM_GRID = ("find", "furnish", "build")
BUILT = replace(
    RUN, names=("build", *BUILT_FROM, *MORE_FILES, "occ.json", "centers.json", "centers.npz")
)


def rebuild(
    source: Path,
    out: Path,
    parameters: Parameters,
    progress: Progress = no_progress,
    classes: str = "",
    force: bool = False,
) -> None:
    """Build ``out / "build"`` from the folder of a run or from an occupancy file.

    A run is built from its existing objects and placements. For a grid, objects are first found and
    matched, and their files are also written to ``out``. ``classes`` is the class set of a grid
    with other ids than ours, such as ``embodied``. If the build fails, ``out`` is unchanged.

    Raises:
        InputError: If ``source`` cannot be read.
        ConflictError: If another process writes ``out``.
        OutputError: If ``out`` cannot be written.
        UsageError: If ``out`` equals ``source`` or contains other files without ``force``, or if
            ``source`` contains blocks instead of a room.
    """
    if out.exists() and source.exists() and out.samefile(source):
        raise UsageError(f"{out} is the source folder; choose another output folder")
    if is_block_file(source):
        ways = f"use w2m convert {source} {out} to make a world, or --into WORLD --at X Y Z"
        raise UsageError(f"{source} contains blocks, but an output folder requires a room; {ways}")
    if classes and source.is_dir():
        raise UsageError(f"classes requires an occupancy grid, but {source} is a run folder")
    with output_folder(out, BUILT, "built", force=force), draft_of(out, ("build",)) as draft:
        if source.is_dir():
            stages = _copy_run(source, draft)
        else:
            _write_grid(draft, source, classes)
            stages = FROM_GRID
        for stage in stages:
            run_stage(stage, draft, parameters, progress)


def blocks_of(
    source: Path, parameters: Parameters, progress: Progress = no_progress, classes: str = ""
) -> BlockVolume:
    """Return the blocks that ``rebuild`` would write, or the blocks that ``source`` contains.

    Args:
        source: Folder of a run, an occupancy file, or any file or world of blocks. Blocks are
            returned unchanged, whatever the parameters.
        parameters: Parameters of the build.
        progress: Callback for progress.
        classes: Class set of an occupancy grid with other ids than ours.

    Raises:
        InputError: If ``source`` cannot be read.
        UsageError: If classes are given for another source than an occupancy grid.
    """
    if classes and (source.is_dir() or is_block_file(source)):
        raise UsageError(f"classes requires an occupancy grid, which {source} is not")
    if is_block_file(source):
        return read_blocks(source)
    if source.is_dir():
        check_finished(source)
        if is_in_room_frame(source):
            return read_whole(source, lambda: built_volume(source, parameters))
        source = source / "room.npz"
    with tempfile.TemporaryDirectory(prefix="w2m-") as scratch:
        folder = Path(scratch)
        _write_grid(folder, source, classes)
        for stage in FROM_GRID[:-1]:
            run_stage(stage, folder, parameters, progress)
        return built_volume(folder, parameters)


def is_block_file(source: Path) -> bool:
    """Return whether ``source`` is a file or world in one of the known block formats."""
    found = (FORMATS.load(name)() for name in FORMATS.names())
    return any(format_.can_read and format_.is_at(source) for format_ in found)


def is_in_room_frame(run: Path) -> bool:
    """Return whether the cells of a run lie in the room frame, where its other files place them."""
    grid, _ = read_room(run / "room.npz")
    return to_room_frame(grid)[0] is grid


def _write_grid(out: Path, source: Path, classes: str = "") -> None:
    """Write ``room.npz`` of an occupancy file in the room frame.

    Its ``scan_to_room`` transforms the frame of the file to that of the room, so that
    georeferenced coordinates can be restored.
    """
    grid, grid_to_room = to_room_frame(read_occupancy(source, classes))
    scan_to_room = read_room(source)[1] if source.name == "room.npz" else np.eye(4)
    write_room(out / "room.npz", grid, grid_to_room @ scan_to_room)


def _copy_run(source: Path, out: Path) -> tuple[str, ...]:
    """Copy what a run is built from, and return the stages that build it.

    If its cells were georeferenced, the objects are found again: the other files of the run do not
    lie at those coordinates.
    """
    check_finished(source)
    if not is_in_room_frame(source):
        _write_grid(out, source / "room.npz")
        return FROM_GRID
    names = [name for name in (*BUILT_FROM, *MORE_FILES) if (source / name).is_file()]
    files = read_whole(source, lambda: [(source / name).read_bytes() for name in names])
    for name, data in zip(names, files, strict=True):
        write_bytes(out / name, data)
    return ("build",)
