"""Snapshots: files that contain a complete scene at one revision of a document.

The ``.npz`` file contains the arrays of ``room.npz``; ``objects`` uint8, as packed by
``editing.scene.journal``; and ``state`` uint8, a JSON object with ``rev``, ``generation`` (of the
journal that continues from the snapshot) and ``line`` (the operations that can be undone and
redone).
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.types import OccupancyGrid, SceneObject
from world2minecraft.editing.scene import SceneDraft, Timeline
from world2minecraft.editing.scene.journal import pack_objects, unpack_objects
from world2minecraft.formats.run_arrays import GRID_ARRAYS

NOTHING_DONE = Timeline()


@dataclass(frozen=True, eq=False)
class State:
    """A scene at revision ``rev`` of a journal generation."""

    grid: OccupancyGrid
    objects: tuple[SceneObject, ...]
    scan_to_room: np.ndarray  # float64 [4, 4]
    rev: int = 0
    generation: str = ""
    line: Timeline = NOTHING_DONE

    def draft(self) -> SceneDraft:
        """Return the scene as an editable draft."""
        return SceneDraft(self.grid, self.objects)


def write_state(path: Path, state: State) -> None:
    """Write a snapshot atomically.

    Raises:
        OutputError: If the file cannot be written.
    """
    arrays = {name: np.asarray(getattr(state.grid, name)) for name in GRID_ARRAYS}
    data = {
        "rev": state.rev,
        "generation": state.generation,
        "line": {
            "numbers": state.line.numbers,
            "kinds": state.line.kinds,
            "done": state.line.done,
        },
    }
    arrays["scan_to_room"] = np.asarray(state.scan_to_room, np.float64)
    arrays["objects"] = np.frombuffer(pack_objects(state.objects), np.uint8)
    arrays["state"] = np.frombuffer(json.dumps(data, sort_keys=True).encode(), np.uint8)
    write_npz(path, arrays)


def read_state(path: Path) -> State:
    """Read a snapshot.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a valid snapshot, or if its checksum does not match.
        LimitError: If the snapshot is too large.
    """
    arrays = read_npz(path, (*GRID_ARRAYS, "scan_to_room", "objects", "state"))
    objects = unpack_objects(arrays.pop("objects").tobytes(), path)
    try:
        data = json.loads(arrays.pop("state").tobytes())
        scan_to_room = arrays.pop("scan_to_room").reshape(4, 4)
        fields: dict[str, Any] = {**arrays, "voxel_m": float(arrays["voxel_m"])}
        return State(
            OccupancyGrid(**fields),
            objects,
            scan_to_room,
            int(data["rev"]),
            str(data["generation"]),
            _line(data["line"]),
        )
    except (*MALFORMED, RecursionError) as error:
        raise DamagedFileError(path, f"is not a valid scene snapshot ({error})") from error


def snapshot_path(folder: Path, rev: int, generation: str) -> Path:
    """Return the path of the snapshot of a revision."""
    return folder / f"snapshot-{rev:09d}-{generation}.npz"


def snapshot_paths(folder: Path) -> Iterator[Path]:
    """Yield the paths of a document's snapshots, newest first."""
    yield from sorted(folder.glob("snapshot-*.npz"), reverse=True)


def _line(data: Any) -> Timeline:
    numbers, kinds = tuple(map(int, data["numbers"])), tuple(map(str, data["kinds"]))
    done = int(data["done"])
    if len(numbers) != len(kinds) or not 0 <= done <= len(numbers):
        raise ValueError("its list of undoable edits is invalid")
    return Timeline(numbers, kinds, done)
