"""The stages after fusion, each from files to files so that it can be repeated separately.

``evidence.npz`` -> label -> ``room.npz`` -> find -> ``objects.json`` -> furnish ->
``placements.json`` -> build -> ``build/``. Each stage gets the folder of the run and the
parameters.
"""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.construction import WORLD_NAME, build_volume, with_hinges, write_build
from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import (
    BlockEdit,
    BlockVolume,
    FusedEvidence,
    ObjectInstance,
    OccupancyGrid,
)
from world2minecraft.core.vocabulary import NYU40_COUNT
from world2minecraft.editing.cleanup.passes import repair_volume
from world2minecraft.editing.journal import write_edits
from world2minecraft.formats.layout import read_rooms, write_layouts
from world2minecraft.formats.object_names import read_run_names
from world2minecraft.formats.objects_and_placements import (
    read_objects,
    read_placements,
    write_objects,
    write_placements,
)
from world2minecraft.formats.occupancy_files import inner_corner_m
from world2minecraft.formats.paper_json import write_centers_json, write_occ_json
from world2minecraft.formats.run_arrays import read_evidence, read_room, write_centers, write_room
from world2minecraft.formats.scan_record import read_depth_kind, read_room_size, read_scene_name
from world2minecraft.formats.volume_formats import (
    format_by_name,
    run_details,
    write_volume_formats,
)
from world2minecraft.minecraft.file_format import WriteOptions
from world2minecraft.reconstruction.fusion import (
    calibrate,
    close_structure,
    confidence_table,
    extract_grid,
    remove_floaters,
)
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.instances.supports import with_supports
from world2minecraft.reconstruction.naming.name_votes import (
    NAME_VOTES,
    NameVotes,
    class_votes,
    read_name_votes,
    votes_of_cells,
    votes_of_objects,
)
from world2minecraft.reconstruction.naming.object_traits import name_instances
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.retrieval import place_templates
from world2minecraft.reconstruction.semantics import (
    complete_walls,
    find_structure,
    labeller,
    remove_wall_guesses,
)
from world2minecraft.reconstruction.semantics.known_surfaces import label_known_surface
from world2minecraft.reconstruction.semantics.labeller_choice import choose_labeller
from world2minecraft.reconstruction.semantics.votes_labeller import is_from_network
from world2minecraft.reconstruction.semantics.wall_things import label_wall_things


def label_stage(folder: Path, chosen: Parameters) -> None:
    """Run the label stage: ``evidence.npz`` -> ``room.npz`` (cleaned labels), ``layout.json``."""
    evidence = read_evidence(folder / "evidence.npz")
    grid = remove_floaters(extract_grid(evidence), chosen.clean)
    rooms = find_structure(grid, evidence)
    if not chosen.find.paper_compat:
        rooms = with_hinges(rooms)
    write_layouts(folder / "layout.json", rooms)
    from_photos = read_depth_kind(folder / "scan.json") == "stereo"
    if from_photos:
        grid = remove_wall_guesses(grid, rooms)
    grid = label_grid(grid, evidence, chosen, from_photos=from_photos)
    votes = _name_votes(folder)
    if votes is not None and not chosen.find.paper_compat:
        grid = label_wall_things(grid, votes)
    if chosen.known is not None:
        grid = label_known_surface(grid, evidence, *chosen.known)
    if from_photos:
        grid = complete_walls(grid, rooms)
    write_room(folder / "room.npz", grid, evidence.scan_to_room)


def label_grid(
    grid: OccupancyGrid, evidence: FusedEvidence, chosen: Parameters, *, from_photos: bool = False
) -> OccupancyGrid:
    """Return the cleaned grid with a class and a calibrated confidence for each cell.

    Args:
        grid: Grid extracted from the evidence.
        evidence: Fused evidence of the same cells.
        chosen: Parameters of the reconstruction.
        from_photos: Whether the depth was computed by stereo instead of being measured.
    """
    name = chosen.labeller
    if name == "auto":
        # Grids of other networks without any measured surface already complete the room.
        predicted = bool(chosen.predictions.path) and not evidence.offset_sum.any()
        name = "votes" if predicted else choose_labeller(evidence, from_photos)
    grid = close_structure(labeller(name).label(grid, evidence), chosen.clean)
    return calibrate(grid, evidence, confidence_table(name))


def find_stage(folder: Path, chosen: Parameters) -> None:
    """Run the find stage: ``room.npz`` -> instances, ``centers.npz`` and ``objects.json``."""
    grid, scan_to_room = read_room(folder / "room.npz")
    votes = _name_votes(folder)
    found = find_objects(
        grid, chosen.find, stated=_stated_cells(folder, grid), votes=_class_votes(votes, grid)
    )
    if not chosen.find.paper_compat:
        named = _named(folder, found.grid, found.instances, votes)
        found = replace(found, instances=with_supports(named, found.grid))
    write_room(folder / "room.npz", found.grid, scan_to_room)
    centers = found.centers
    write_centers(folder / "centers.npz", centers.density, centers.candidates, centers.cluster)
    write_objects(folder / "objects.json", found.instances)
    write_occ_json(folder / "occ.json", found.grid)
    write_centers_json(folder / "centers.json", found.instances)


def _stated_cells(folder: Path, grid: OccupancyGrid) -> np.ndarray | None:
    """Return the cells whose class label images state, bool [X, Y, Z], or None if there are none.

    The segmentation network votes with probabilities, label images with whole numbers.
    """
    if not (folder / "evidence.npz").is_file():
        return None
    votes = read_evidence(folder / "evidence.npz").votes
    if votes.shape[:3] != grid.shape or not votes.any():
        return None
    return votes.any(axis=-1) & ~is_from_network(votes)


def _name_votes(folder: Path) -> NameVotes | None:
    path = folder / NAME_VOTES
    return read_name_votes(path) if path.is_file() else None


def _class_votes(
    votes: NameVotes | None, grid: OccupancyGrid
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the cells with votes and their votes for NYU40 classes, or None without votes."""
    if votes is None:
        return None
    cells, rows = votes_of_cells(votes, grid)
    return cells, class_votes(rows)


def _named(
    folder: Path,
    grid: OccupancyGrid,
    instances: tuple[ObjectInstance, ...],
    votes: NameVotes | None,
) -> tuple[ObjectInstance, ...]:
    """Return the objects with fine names, from votes if there are any."""
    given = np.zeros((len(instances) + 1, NYU40_COUNT), np.float32)
    if votes is not None:
        given = votes_of_objects(votes, grid, len(instances))
    names = name_instances(instances, read_rooms(folder, grid), given[1:])
    return tuple(
        replace(item, name=name, name_confidence=confidence)
        for item, (name, confidence) in zip(instances, names, strict=True)
    )


def furnish_stage(folder: Path, chosen: Parameters) -> None:
    """Run the furnish stage: ``room.npz`` and ``objects.json`` -> ``placements.json``."""
    grid, _ = read_room(folder / "room.npz")
    instances = read_objects(folder / "objects.json", grid)
    placed = place_templates(grid, instances, chosen.furnish, read_rooms(folder, grid))
    named = not chosen.furnish.paper_compat
    write_placements(folder / "placements.json", placed, named=named)


def build_stage(folder: Path, chosen: Parameters) -> None:
    """Run the build stage: ``room.npz`` and ``placements.json`` -> the files in ``build``."""
    volume, edits = _build_and_repair(folder, chosen)
    name = scene_name(folder) or WORLD_NAME
    names = read_run_names(folder)
    write_build(folder / "build", volume, mc_version=chosen.mc_version, name=name, objects=names)
    write_edits(folder / "build", edits)
    write_further_forms(folder, volume, chosen)


def write_further_forms(folder: Path, volume: BlockVolume, chosen: Parameters) -> None:
    """Write the requested additional formats, and their losses to ``forms.json``.

    Files of formats that an earlier build wrote are deleted, since they are outdated.
    """
    _remove_old_forms(folder / "build", chosen.format_names)
    if not chosen.format_names:
        return
    options = WriteOptions(mc_version=chosen.mc_version, other=run_details(folder))
    lost = write_volume_formats(folder / "build", volume, chosen.format_names, options)
    rows = {
        name: {"file": f"room{format_by_name(name).suffix}", "lost": dict(losses)}
        for name, losses in lost.items()
    }
    write_json(folder / "build" / "forms.json", rows)


def _remove_old_forms(build: Path, wanted: tuple[str, ...]) -> None:
    """Remove the additional formats of an earlier build, except ``wanted``, and their list."""
    listed = build / "forms.json"
    if not listed.is_file():
        return
    stated = read_json(listed)
    suffixes = {_suffix_of(str(name)) for name in stated} if isinstance(stated, dict) else set()
    for suffix in sorted(suffixes - {_suffix_of(name) for name in wanted} - {"", ".schem"}):
        place = build / f"room{suffix}"
        if place.is_dir():
            shutil.rmtree(place, ignore_errors=True)
        else:
            place.unlink(missing_ok=True)
    listed.unlink()


def _suffix_of(name: str) -> str:
    """Return the file suffix of a format, or an empty string if the format is unknown."""
    try:
        return format_by_name(name).suffix
    except UsageError:
        return ""


def built_volume(folder: Path, chosen: Parameters) -> BlockVolume:
    """Build the blocks from the files of a run without writing any file."""
    return _build_and_repair(folder, chosen)[0]


def _build_and_repair(
    folder: Path, chosen: Parameters
) -> tuple[BlockVolume, tuple[BlockEdit, ...]]:
    """Return the blocks, and the repairs made after they were built."""
    grid, _ = read_room(folder / "room.npz")
    volume = build_volume(
        grid,
        read_placements(folder / "placements.json"),
        read_objects(folder / "objects.json", grid),
        corner_m=corner_m(folder, grid),
        blocks_per_metre=chosen.blocks_per_metre,
        parameters=chosen.build,
        name=scene_name(folder),
        rooms=() if chosen.build.paper_compat else read_rooms(folder, grid),
    )
    return repair_volume(volume) if chosen.mend else (volume, ())


def scene_name(folder: Path) -> str:
    """Return the scene name of a run, or an empty string if it has no scan."""
    path = folder / "scan.json"
    return read_scene_name(path) if path.is_file() else ""


def corner_m(folder: Path, grid: OccupancyGrid) -> np.ndarray:
    """Return the corner (x_min, y_max) of the room's inner box in metres.

    The corner comes from the alignment of the scan if available, otherwise from the walls.
    """
    if not (folder / "scan.json").is_file():
        return inner_corner_m(grid)
    depth_m = read_room_size(folder / "scan.json")[1]
    return np.array([0.0, np.round(depth_m / grid.voxel_m) * grid.voxel_m])


# The stages that go from file to file, in order.
FILE_STAGES: dict[str, Callable[[Path, Parameters], None]] = {
    "label": label_stage,
    "find": find_stage,
    "furnish": furnish_stage,
    "build": build_stage,
}


def run_stage(
    stage: str, folder: Path, chosen: Parameters, progress: Progress = no_progress
) -> None:
    """Run one of ``FILE_STAGES`` on the folder of a run."""
    progress(stage, 0, 1)
    FILE_STAGES[stage](folder, chosen)
    progress(stage, 1, 1)
