"""The metadata file ``document.json``: the source of a document and where it is saved.

``{"format": "world2minecraft/forge", "version": 1, "name", "source", "target", "inputs": {path:
SHA-256}, "is_demo"}``. Paths are relative to the folder that contains the document.
"""

import os
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from world2minecraft.core.errors import MALFORMED, ConflictError, DamagedFileError, OutputError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.sceneforge.document import saving
from world2minecraft.sceneforge.document.recovery import BASE_FILE, recover
from world2minecraft.sceneforge.document.snapshots import State, write_state
from world2minecraft.sceneforge.scene_sources import (
    DEMO_FOLDER,
    OpenedScene,
    read_source_rooms,
    resolve_source,
)

FORMAT, VERSION = "world2minecraft/forge", 1
SUFFIX = ".forge"
DOCUMENT_FILE = "document.json"
_MAX_BYTES = 1 << 20


@dataclass(frozen=True)
class Identity:
    """The contents of ``document.json``, with absolute paths."""

    name: str
    source: Path
    target: Path
    inputs: Mapping[Path, str]
    is_demo: bool = False

    def opened(self, base: State) -> OpenedScene:
        """Return the scene as it was first opened, with the current side files of its source."""
        source = DEMO_FOLDER if self.is_demo else self.source
        fields = (self.name, self.target, tuple(self.inputs), base.grid, base.scan_to_room)
        rooms = read_source_rooms(source, base.grid)
        return OpenedScene(*fields, base.objects, rooms, source, is_demo=self.is_demo)


def document_folder(source: Path | None, out: Path | None = None) -> Path:
    """Return the document folder of a source, which is beside the source or beside ``out``."""
    if source is not None and is_document(source):
        return source
    place = (out or resolve_source(source)).absolute()
    place = Path(os.path.normpath(place))
    return place.with_name(place.name + SUFFIX)


def is_document(path: Path) -> bool:
    """Return whether a path is a document folder."""
    return (path / DOCUMENT_FILE).is_file()


def holds_saved_edits(run: Path) -> bool:
    """Return whether the files of a run contain edits that were saved in SceneForge."""
    folder = document_folder(None, run)
    if not is_document(folder) or saving.saved_rev(folder) == 0:
        return False
    written = saving.saved_hashes(folder)
    return all(saving.sha256(run / name) in written for name in saving.SAVED_FILES)


def write_identity(folder: Path, opened: OpenedScene, generation: str) -> None:
    """Create a document for a scene that was read.

    Raises:
        OutputError: If the files cannot be written.
    """
    outputs = [opened.folder / name for name in saving.SAVED_FILES] if opened.is_run else []
    held = {path: saving.sha256(path) for path in (*opened.inputs, *outputs)}
    state = State(opened.grid, opened.objects, opened.scan_to_room, generation=generation)
    write_state(folder / BASE_FILE, state)
    write_json(
        folder / DOCUMENT_FILE,
        {
            "format": FORMAT,
            "version": VERSION,
            "name": opened.name,
            "source": _relative(opened.source, folder),
            "target": _relative(opened.folder, folder),
            "inputs": {_relative(path, folder): value for path, value in held.items() if value},
            "is_demo": opened.is_demo,
        },
    )


def read_identity(folder: Path) -> Identity:
    """Read the ``document.json`` of a document.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid ``document.json``.
    """
    path = folder / DOCUMENT_FILE
    data = read_json(path, _MAX_BYTES)
    try:
        if (data["format"], data["version"]) != (FORMAT, VERSION):
            raise ValueError(f"expected {FORMAT} {VERSION}, got {data['format']} {data['version']}")
        return Identity(
            str(data["name"]),
            _place(data["source"], folder),
            _place(data["target"], folder),
            {_place(name, folder): str(value) for name, value in data["inputs"].items()},
            bool(data["is_demo"]),
        )
    except MALFORMED as error:
        raise DamagedFileError(path, f"is not a SceneForge document ({error})") from error


def retire_outdated(folder: Path) -> str:
    """Rename a document whose source was replaced by another program.

    Returns:
        A message for the user, or an empty string if the source has not changed.

    Raises:
        ConflictError: If the document has unsaved edits. Nothing is changed.
    """
    changed = changed_inputs(folder)
    if not changed:
        return ""
    unsaved = recover(folder).rev - saving.saved_rev(folder)
    if unsaved > 0:
        raise ConflictError(
            changed[0],
            f"the file has changed since it was edited, and {folder.name} has {unsaved} unsaved "
            f"edits; open {folder} to continue with them, or move it away to start over",
        )
    aside = _retire(folder)
    return f"{changed[0].name} was replaced; its previous edits are in {aside.name}."


def changed_inputs(folder: Path) -> list[Path]:
    """Return the input files of a document whose contents have changed since it was opened."""
    saved = saving.saved_hashes(folder)
    identity = read_identity(folder)
    return [
        path
        for path, value in identity.inputs.items()
        if saving.sha256(path) not in ("", value, *saved)
    ]


def _retire(folder: Path) -> Path:
    """Move all files of a document except its lock into a subfolder."""
    names = (folder / f"old-{number}" for number in count(1))
    aside = next(path for path in names if not path.exists())
    try:
        aside.mkdir()
        held = [path for path in sorted(folder.iterdir()) if not path.name.startswith("old-")]
        # The name of the document goes first: without it the rest is no document.
        for path in sorted(held, key=lambda path: path.name != DOCUMENT_FILE):
            if path.name != "lock":
                shutil.move(path, aside / path.name)
    except OSError as error:
        raise OutputError(folder, f"cannot be written: {error.strerror or error}") from error
    return aside


def _relative(path: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(path.absolute(), folder.absolute().parent)).as_posix()
    except ValueError:  # Another drive of Windows.
        return path.absolute().as_posix()


def _place(data: str, folder: Path) -> Path:
    return Path(os.path.normpath(folder.absolute().parent / str(data)))
