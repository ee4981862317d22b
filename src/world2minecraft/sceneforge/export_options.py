"""The export formats and destinations for the edited scene.

Data files (``occ.json``, ``room.npz`` ...) are written directly. Formats that need blocks are built
by a worker process from a snapshot (``write_snapshot``), while the scene can still be edited.
"""

import csv
import hashlib
import io
import os
import shutil
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, display_name
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.files import write_text
from world2minecraft.editing.scene import placements_of
from world2minecraft.formats.objects_and_placements import write_objects, write_placements
from world2minecraft.formats.paper_json import write_centers_json, write_occ_json
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.formats.volume_formats import writable_format_names
from world2minecraft.minecraft.worlds.launchers import Game, find_games
from world2minecraft.sceneforge.document.saving import supported_instances, write_run_files
from world2minecraft.sceneforge.editor import Editor

DATA_FILES = {
    "npz": "room.npz",
    "occ": "occ.json",
    "centers": "centers.json",
    "objects": "objects.json",
    "placements": "placements.json",
    "stats": "stats.csv",
}
BUILT_FIRST, MODELS = ("world", "schem"), ("glb", "habitat", "png")
COPIED = ("scan.json", "layout.json")  # The scene's name, and where its inner corner stands.


@dataclass(frozen=True)
class ExportForm:
    """An export format. ``built`` says whether the format consists of blocks at a chosen scale."""

    id: str
    group: str  # game, 3d, data
    built: bool


def export_forms() -> tuple[ExportForm, ...]:
    """Return all export formats."""
    others = [name for name in writable_format_names() if name not in (*BUILT_FIRST, *MODELS)]
    game = [ExportForm(name, "game", True) for name in (*BUILT_FIRST, *others)]
    models = [ExportForm(name, "3d", True) for name in MODELS]
    return (*game, *models, *(ExportForm(name, "data", False) for name in DATA_FILES))


def get_export_form(name: str) -> ExportForm:
    """Return an export format by its id.

    Raises:
        UnknownNameError: If no format has this id.
    """
    known = {one.id: one for one in export_forms()}
    if name not in known:
        raise UnknownNameError("export", name, known)
    return known[name]


def write_snapshot(editor: Editor, folder: Path) -> None:
    """Write the current scene to a folder, with the files that ``Editor.save`` writes.

    Raises:
        OutputError: If the folder cannot be written.
    """
    write_run_files(folder, editor.read(editor.document.state))
    for name in COPIED:
        if (editor.opened.folder / name).is_file():
            shutil.copyfile(editor.opened.folder / name, folder / name)


def write_data(editor: Editor, form: str, folder: Path) -> Path:
    """Write one of the ``DATA_FILES`` for the current scene and return its path.

    Raises:
        OutputError: If the folder cannot be written.
    """
    path = folder / DATA_FILES[form]
    state = editor.read(editor.document.state)
    if form == "npz":
        write_room(path, state.grid, state.scan_to_room)
    elif form == "occ":
        write_occ_json(path, state.grid)
    elif form == "centers":
        write_centers_json(path, supported_instances(state))
    elif form == "objects":
        write_objects(path, supported_instances(state))
    elif form == "placements":
        write_placements(path, placements_of(state.objects))
    else:
        write_text(path, stats_csv(editor))
    return path


def stats_csv(editor: Editor) -> str:
    """Return a CSV table with the cells, objects and volume in cubic metres of each class."""
    counts, objects = editor.read(
        lambda: (editor.draft.counts.copy(), tuple(editor.draft.objects.values()))
    )
    stream = io.StringIO()
    rows = csv.writer(stream, lineterminator="\n")
    rows.writerow(["class_id", "class", "name", "cells", "objects", "cells_m3"])
    owned = np.bincount([one.class_id for one in objects] or [0], minlength=len(CLASS_NAMES))
    owned = owned if objects else owned * 0
    cell_m3 = editor.draft.voxel_m**3
    for number, name in enumerate(CLASS_NAMES):
        cells = int(counts[number])
        volume = f"{cells * cell_m3:.3f}"
        rows.writerow([number, name, display_name(number), cells, int(owned[number]), volume])
    return stream.getvalue()


def games_here() -> dict[str, Game]:
    """Return the Minecraft installations of this machine, by ids that do not reveal their paths."""
    found = find_games(sys.platform, Path.home(), os.environ)
    return {id_of(game.saves): game for game in found}


def worlds_of(games: Iterable[Game]) -> dict[str, tuple[Game, Path]]:
    """Return the worlds in the saves folders of installations: installation and folder by id."""
    found = {}
    for game in games:
        with suppress(OSError):  # Worlds of other users may not be readable.
            for folder in sorted(game.saves.iterdir()):
                if (folder / "level.dat").is_file() and not folder.is_symlink():
                    found[id_of(folder)] = (game, folder)
    return found


def id_of(path: Path) -> str:
    """Return an id of a path that does not reveal it."""
    return hashlib.sha256(str(path).encode("utf-8", "surrogateescape")).hexdigest()[:12]
