"""Any capture as an aligned scan, whatever it lacks."""

from dataclasses import replace
from pathlib import Path

from world2minecraft.capture import open_scan
from world2minecraft.core.progress import Progress, silent
from world2minecraft.core.types import Scan
from world2minecraft.reconstruction.opening.preparing import prepared
from world2minecraft.reconstruction.parameters import Parameters

# Names of folders that say nothing of their scene.
NAMELESS = ("capture", "frames", "scan", "data", "input")


def open_prepared(
    capture: Path,
    out: Path,
    chosen: Parameters,
    labels: Path | None = None,
    progress: Progress = silent,
) -> Scan:
    """Open a capture; poses and depth that it lacks are computed and kept in ``out`` first.

    Raises what ``prepared`` and ``open_scan`` raise.
    """
    complete = prepared(capture, out, chosen, progress)
    options = chosen.capture if complete == capture else {}  # Else they were heeded already.
    scan = open_scan(
        complete, voxel_m=chosen.voxel_m, labels=labels, progress=progress, options=options
    )
    return replace(scan, name=scene_name(capture))


def scene_name(capture: Path) -> str:
    """Return what a capture's scene is called: its folder's name, where that says anything."""
    capture = capture.resolve()
    name = (capture.name if capture.is_dir() else capture.stem).replace("_", " ")
    return name if name.isprintable() and name not in NAMELESS else ""
