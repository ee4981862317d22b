"""A whole scene at one revision, as a file: the base of a document and its snapshots.

Arrays of a ``.npz``: those of ``room.npz``; ``objects`` uint8, as ``editing.scene.journal`` packs
them; ``state`` uint8, a JSON object with ``rev``, ``generation`` (of the journal that goes on from
here) and ``line`` (what undo and redo reach).
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.types import OccupancyGrid, SceneObject
from world2minecraft.editing.scene import SceneDraft, Timeline
from world2minecraft.editing.scene.journal import pack_objects, unpack_objects
from world2minecraft.formats.run_arrays import GRID_ARRAYS

NOTHING_DONE = Timeline()


@dataclass(frozen=True, eq=False)
class State:
    """A scene at revision ``rev`` of a journal's generation."""

    grid: OccupancyGrid
    objects: tuple[SceneObject, ...]
    scan_to_room: np.ndarray  # float64 [4, 4]
    rev: int = 0
    generation: str = ""
    line: Timeline = NOTHING_DONE

    def draft(self) -> SceneDraft:
        """Return the scene to be edited."""
        return SceneDraft(self.grid, self.objects)


def write_state(path: Path, state: State) -> None:
    """Write a state, whole or not at all. Raises OutputError."""
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
    """Read a state.

    Raises:
        InputError: the file is missing. DamagedFileError: it is no state, or its bytes are not
        those that were written. LimitError: it is too large.
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
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise DamagedFileError(path, f"is not a valid scene snapshot ({error})") from error


def snapshot_path(folder: Path, rev: int, generation: str) -> Path:
    """Return where the snapshot of a revision lies."""
    return folder / f"snapshot-{rev:09d}-{generation}.npz"


def snapshot_paths(folder: Path) -> Iterator[Path]:
    """Go through the snapshots of a document, newest first."""
    yield from sorted(folder.glob("snapshot-*.npz"), reverse=True)


def _line(data: Any) -> Timeline:
    numbers, kinds = tuple(map(int, data["numbers"])), tuple(map(str, data["kinds"]))
    done = int(data["done"])
    if len(numbers) != len(kinds) or not 0 <= done <= len(numbers):
        raise ValueError("its line of edits is none")
    return Timeline(numbers, kinds, done)
