"""Saving of a scene to the files of a run: all files or none, without overwriting foreign changes.

The files are first written within the document, then listed in ``saved.json``, then copied to their
destination. A save that is interrupted after that point is completed when the document is next
opened. ``saved.json`` is ``{"rev", "known": [SHA-256, ...], "pending": {"rev", "files"}}``: the
last saved revision, the hashes of files that the document may overwrite, and the save in progress,
if any.
"""

import hashlib
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, ConflictError, InputError
from world2minecraft.core.files import read_json, write_bytes, write_json
from world2minecraft.core.types import ObjectInstance
from world2minecraft.core.whole_reads import changing
from world2minecraft.editing.scene import instances_of, placements_of
from world2minecraft.formats.objects_and_placements import write_objects, write_placements
from world2minecraft.formats.paper_json import write_centers_json, write_occ_json
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.reconstruction.instances.supports import with_supports
from world2minecraft.sceneforge.document.snapshots import State

SAVED_FILE, STAGED = "saved.json", "saving"
EXTRA_FILES = ("scan.json", "layout.json")
SAVED_FILES = ("room.npz", "objects.json", "placements.json", "occ.json", "centers.json")


def write_scene_files(folder: Path, state: State) -> None:
    """Write the five files of a scene into a folder.

    Raises:
        OutputError: If a file cannot be written.
    """
    instances = write_run_files(folder, state)
    write_occ_json(folder / "occ.json", state.grid)
    write_centers_json(folder / "centers.json", instances)


def write_run_files(folder: Path, state: State) -> tuple[ObjectInstance, ...]:
    """Write the three files of a scene that builds read, and return its objects.

    Raises:
        OutputError: If a file cannot be written.
    """
    instances = supported_instances(state)
    write_room(folder / "room.npz", state.grid, state.scan_to_room)
    write_objects(folder / "objects.json", instances)
    write_placements(folder / "placements.json", placements_of(state.objects))
    return instances


def supported_instances(state: State) -> tuple[ObjectInstance, ...]:
    """Return the objects of a scene with what each of them stands on."""
    return with_supports(instances_of(state.objects, state.grid.instance), state.grid)


def sha256(path: Path) -> str:
    """Return the SHA-256 of a file as a hex string, or an empty string if the file does not exist.

    Raises:
        InputError: If the file cannot be read.
    """
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except FileNotFoundError:
        return ""
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error


def save(
    document: Path, source: Path, target: Path, state: State, known: Iterable[str]
) -> dict[str, str]:
    """Save a scene to ``target`` and return the SHA-256 of each file.

    If ``target`` is not the source, the other files of the source that w2m commands read are copied
    too.

    Args:
        document: The ``.forge`` folder of the document.
        source: The run from which the scene was opened.
        target: Folder for the files.
        state: The scene.
        known: SHA-256 of files that may be overwritten, in addition to those of earlier saves.

    Raises:
        ConflictError: If a file in ``target`` was changed by another program. Nothing is written.
        OutputError: If the disk is full or not writable. The missing files are written when the
            scene is next saved or opened.
    """
    staged = document / STAGED
    _remove_staged(staged)
    write_scene_files(staged, state)
    for name in EXTRA_FILES:
        if (source / name).is_file() and not (target / name).exists():
            write_bytes(staged / name, (source / name).read_bytes())
    names = (*SAVED_FILES, *(name for name in EXTRA_FILES if (staged / name).is_file()))
    files = {name: sha256(staged / name) for name in names}
    allowed = {*known, *files.values(), *saved_hashes(document)}
    for name in files:
        if (found := sha256(target / name)) and found not in allowed:
            _remove_staged(staged)
            reason = "was changed by another program; move it away, then save again"
            raise ConflictError(target / name, reason)
    record = _read_record(document)
    hashes = sorted({*saved_hashes(document), *files.values()})
    pending = {"rev": state.rev, "files": files}
    write_json(document / SAVED_FILE, record | {"pending": pending, "known": hashes})
    _finish(document, target, pending)
    return files


def finish_interrupted_save(document: Path, target: Path) -> bool:
    """Complete an interrupted save to ``target``, and return whether there was one.

    A ``target`` that is not beside the document is not touched, because the document may have been
    moved from another place.

    Raises:
        OutputError: If the disk is full or not writable.
    """
    pending = _read_record(document).get("pending", {})
    files = pending.get("files", {})
    whole = bool(files) and all(
        name in (*SAVED_FILES, *EXTRA_FILES) and sha256(document / STAGED / name) == value
        for name, value in files.items()
    )
    if not whole or target.resolve().parent != document.resolve().parent:
        return False
    _finish(document, target, pending)
    return True


def saved_rev(document: Path) -> int:
    """Return the revision that was last saved, or 0 if the scene was never saved."""
    return _read_record(document)["rev"]


def saved_hashes(document: Path) -> set[str]:
    """Return the SHA-256 of all files that saves have written or were about to write."""
    return {str(value) for value in _read_record(document)["known"]}


def _finish(document: Path, target: Path, pending: Mapping[str, Any]) -> None:
    with changing(target, "saved"):
        for name, value in pending["files"].items():
            if sha256(target / name) != value:
                write_bytes(target / name, (document / STAGED / name).read_bytes())
    known = sorted(pending["files"].values())
    write_json(document / SAVED_FILE, {"rev": pending["rev"], "known": known})
    _remove_staged(document / STAGED)


def _remove_staged(staged: Path) -> None:
    shutil.rmtree(staged, ignore_errors=True)


def _read_record(document: Path) -> dict[str, Any]:
    """Return the contents of ``saved.json``, or those of an unsaved scene if it is not readable."""
    try:
        record = read_json(document / SAVED_FILE, 1 << 20)
        pending = record.get("pending", {"rev": 0, "files": {}})
        rev, later = int(record["rev"]), int(pending["rev"])
        files = {str(name): str(value) for name, value in pending["files"].items()}
        found = {"rev": rev, "known": list(record["known"])}
        return found | ({"pending": {"rev": later, "files": files}} if files else {})
    except (*MALFORMED, InputError):
        return {"rev": 0, "known": []}
