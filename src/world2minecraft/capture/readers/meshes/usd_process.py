"""Reading of USD files in a process of its own, because Pixar's library crashes on damaged ones.

The process sends the arrays of the mesh in an npz file and everything else as JSON: a file that
takes it over can send nothing else.
"""

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.readers.meshes.las_and_e57 import file_on_disk
from world2minecraft.capture.readers.meshes.mesh_and_cloud import LoadedGeometry, Mesh
from world2minecraft.capture.readers.meshes.optional_libraries import import_optional
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    reason_of,
)
from world2minecraft.core.files import npz_array_names, read_npz

MAX_BYTES = 2 << 30
CALL = "from world2minecraft.capture.readers.meshes.usd_process import serve; serve()"
STATED = ("kind", "unit_m", "usual_up", "up_stated")


def load_usd(place: AnyPath) -> LoadedGeometry:
    """Load all meshes of a USD stage.

    Raises:
        DamagedFileError: If the file cannot be read or refers to files outside its folder.
        LimitError: If the file is too large.
        MissingExtraError: If the USD library is not installed.
    """
    import_optional("pxr", "reading USD files", "usd")
    if (size := place.stat().st_size) > MAX_BYTES:
        raise LimitError(
            place, f"has {size:,} bytes, the limit is {MAX_BYTES:,}; export a smaller file"
        )
    with (
        file_on_disk(place) as path,
        tempfile.TemporaryDirectory(prefix="world2minecraft-") as folder,
    ):
        arrays = Path(folder) / "mesh.npz"
        done = subprocess.run(
            [sys.executable, "-P", "-c", CALL, str(path), str(arrays)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(one for one in sys.path if one)},
            check=False,
        )
        try:
            return _received(place, json.loads(done.stdout), arrays)
        except MALFORMED as error:
            raise DamagedFileError(
                place,
                f"cannot be read as USD (the library crashed, exit code {done.returncode}); "
                "export the file again",
            ) from error


def _received(place: AnyPath, message: dict[str, Any], path: Path) -> LoadedGeometry:
    """Return the geometry that the process has sent, or raise its error."""
    if "error" in message:
        kind = LimitError if message["error"] == LimitError.__name__ else DamagedFileError
        raise kind(place, str(message["reason"]))
    if "missing" in message:
        raise MissingExtraError("reading USD files", "usd")
    try:
        arrays = read_npz(path, npz_array_names(path))
    except InputError as error:
        raise type(error)(place, error.reason) from error
    offset = arrays.pop("offset")
    return LoadedGeometry(Mesh(**arrays), offset=offset, **{name: message[name] for name in STATED})


def serve() -> None:
    """Read the file of the first argument, write its arrays to the second, and print the rest."""
    from world2minecraft.capture.readers.meshes.usd import read_stage  # noqa: PLC0415

    path, arrays = Path(sys.argv[1]), Path(sys.argv[2])
    try:
        found = read_stage(path)
    except MissingExtraError:
        message: dict[str, Any] = {"missing": "usd"}
    except InputError as error:
        message = {"error": type(error).__name__, "reason": error.reason}
    except Exception as error:  # What the library's C++ raises has no root.
        reason = f"cannot be read as USD ({reason_of(error)}); export the file again"
        message = {"error": DamagedFileError.__name__, "reason": reason}
    else:
        mesh = {one.name: getattr(found.geometry, one.name) for one in fields(found.geometry)}
        held = {name: values for name, values in mesh.items() if values is not None}
        np.savez(arrays, offset=np.asarray(found.offset), **held)
        message = {name: getattr(found, name) for name in STATED}
    sys.stdout.write(json.dumps(message))
