"""``scan.json``: how a capture was read and aligned."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Scan

MOST_NAME = 60


def write_scan(path: str | Path, scan: Scan, registration: Mapping[str, Any] | None = None) -> None:
    """Write everything of a scan but its pictures, and what registration found."""
    write_json(
        path,
        {
            "source": scan.source,
            "name": scan.name,
            "scan_to_room": scan.scan_to_room.tolist(),
            "room_size_m": scan.room_size_m.tolist(),
            "frames_used": list(scan.frames_used),
            "frames_skipped": [{"frame": n, "reason": r} for n, r in scan.frames_skipped],
            "scale": scan.scale,
            "scale_sigma": scan.scale_sigma,
            "depth_kind": scan.depth_kind,
            "notes": list(scan.notes),
            "registration": dict(registration or {}),
        },
    )


def read_registration(path: str | Path) -> dict[str, Any]:
    """Return what registration found, of a ``scan.json``; empty where it holds nothing of it.

    Raises:
        InputError: the file is missing. DamagedFileError: it is no ``scan.json``.
    """
    found = read_json(path)
    if not isinstance(found, dict) or not isinstance(found.get("registration", {}), dict):
        raise DamagedFileError(path, "is no scan.json")
    return found.get("registration", {})


def read_scene_name(path: str | Path) -> str:
    """Return the scene's name of a ``scan.json``, printable; empty where it holds none.

    Raises:
        InputError: the file is missing. DamagedFileError: it is no ``scan.json``.
    """
    found = read_json(path)
    if not isinstance(found, dict):
        raise DamagedFileError(path, "is no scan.json")
    name = found.get("name", "")
    return name[:MOST_NAME] if isinstance(name, str) and name.isprintable() else ""


def read_depth_kind(path: str | Path) -> str:
    """Return what made the depth, of a ``scan.json``; ``sensor`` where none says so.

    Raises:
        DamagedFileError: it is no ``scan.json``.
    """
    if not Path(path).is_file():
        return "sensor"
    found = read_json(path)
    if not isinstance(found, dict):
        raise DamagedFileError(path, "is no scan.json")
    return str(found.get("depth_kind", "sensor"))


def placed_as_written(scan: Scan, path: str | Path) -> Scan:
    """Return a scan with the place of the room, and the notes, that a ``scan.json`` holds.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no place of a room.
    """
    try:
        found = read_json(path)
        return replace(
            scan,
            scan_to_room=np.array(found["scan_to_room"], np.float64),
            room_size_m=read_room_size(path),
            notes=tuple(str(note) for note in found["notes"]),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(path, f"holds no place of a room ({error})") from error


def read_room_size(path: str | Path) -> np.ndarray:
    """Return ``room_size_m`` float64 [3] of a ``scan.json``.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no size.
    """
    try:
        size = np.array(read_json(path)["room_size_m"], np.float64).reshape(3)
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(path, f"has no room_size_m ({error})") from error
    if not (np.isfinite(size).all() and (size > 0).all()):
        raise DamagedFileError(path, f"room_size_m must be above 0, not {size.tolist()}")
    return size
