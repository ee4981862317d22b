"""Reading of the files of a finished run for reports and figures."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import (
    BlockVolume,
    FusedEvidence,
    Layout,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.formats.run_arrays import read_evidence, read_room
from world2minecraft.formats.scan_record import read_room_size
from world2minecraft.formats.world_labels import read_scene
from world2minecraft.minecraft.schematics.sponge import read_schem


@dataclass(frozen=True, eq=False)
class FinishedScene:
    """The results of a reconstruction, as read from its folder."""

    folder: Path
    grid: OccupancyGrid
    evidence: FusedEvidence
    instances: tuple[ObjectInstance, ...]
    placements: tuple[Placement, ...]
    volume: BlockVolume
    room_size_m: np.ndarray
    rooms: tuple[Layout, ...] = ()


def read_finished(folder: Path) -> FinishedScene:
    """Read the files of a finished run, all of one state of the folder.

    Raises:
        InputError: If a file is missing or damaged.
        ConflictError: If another process is changing the run.
    """
    return read_whole(folder, lambda: _read_finished(folder))


def _read_finished(folder: Path) -> FinishedScene:
    grid, _ = read_room(folder / "room.npz")
    return FinishedScene(
        rooms=read_rooms(folder, grid),
        folder=folder,
        grid=grid,
        evidence=read_evidence(folder / "evidence.npz"),
        instances=read_objects(folder / "objects.json", grid),
        placements=read_placements(folder / "placements.json"),
        volume=read_built(folder / "build"),
        room_size_m=read_room_size(folder / "scan.json"),
    )


def read_built(folder: Path) -> BlockVolume:
    """Read a build from its schematic and its scene files.

    Raises:
        InputError: If a file is missing or damaged.
    """
    scene = read_scene(folder)
    volume = read_schem(folder / "room.schem")
    if volume.states.shape != scene.semantic.shape:
        raise DamagedFileError(
            folder / "scene.npz",
            "does not belong to the room.schem in the same folder; run w2m reconstruct again",
        )
    return replace(
        volume,
        semantic=scene.semantic,
        instance=scene.instance,
        corner=scene.corner,
        block_to_room=scene.block_to_room,
    )
