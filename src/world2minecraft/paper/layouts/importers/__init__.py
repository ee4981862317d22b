"""Importers of layouts from other programs as ``ComparedScene``, with one module per format.

A format is an object with ``is_mine(path, data)``, where ``data`` is the JSON of a file or None for
a folder, and ``read(path, data, how)``. Other packages add formats through the entry point group
``world2minecraft.layout_format``.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.registry import Registry
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import why

MAX_BYTES = 256 << 20  # LayoutGPT's 423 bedrooms have 0.9 MB.
PX_M = 3.5 / 256  # See layoutgpt.py.
HOME = "world2minecraft.paper.layouts.importers"
FORMATS = Registry(
    "layout_format",
    {
        "stored": f"{HOME}.built_scenes:FORMAT",
        "run": f"{HOME}.runs:FORMAT",
        "layoutgpt": f"{HOME}.layoutgpt:FORMAT",
        "idesign": f"{HOME}.idesign:FORMAT",
        "layoutvlm": f"{HOME}.layoutvlm:FORMAT",
    },
)


@dataclass(frozen=True)
class How:
    """Information that layout files do not contain.

    Attributes:
        px_m: The metres per pixel of layouts in pixels.
        task: The LayoutVLM scene file. None uses the one beside the layout.
        assets: The folder of LayoutVLM assets.
        truth: The capture with the ground truth of a run.
    """

    px_m: float = PX_M
    task: Path | None = None
    assets: Path | None = None
    truth: Path | None = None


def read_layouts_of(path: Path, how: How | None = None, name: str = "") -> list[ComparedScene]:
    """Read the scenes of a layout file or folder.

    Args:
        path: The file or folder.
        how: Information that the files do not contain.
        name: The name of the format. Empty detects it.

    Raises:
        InputError: If the path does not exist, or has no known format.
        DamagedFileError: If the content is not valid in its format.
        LimitError: If the file is too large.
        UnknownNameError: If the format is unknown.
    """
    if not path.exists():
        raise InputError(path, "not found")
    data = None if path.is_dir() else read_json(path, MAX_BYTES)
    for one in [name] if name else FORMATS.names():
        found = FORMATS.load(one)
        if name or found.is_mine(path, data):
            return _read(found, path, data, how or How())
    known = ", ".join(FORMATS.names())
    raise InputError(
        path, f"no layout in a known format found ({known}); name the format with --format"
    )


def _read(found: Any, path: Path, data: Any, how: How) -> list[ComparedScene]:
    try:
        scenes = found.read(path, data, how)
    except MALFORMED as error:
        raise DamagedFileError(path, f"not valid in its format ({why(error)})") from error
    if not scenes:
        raise DamagedFileError(path, "the file does not contain any scenes")
    return scenes
