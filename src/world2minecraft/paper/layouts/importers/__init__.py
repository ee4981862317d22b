"""Layouts of others as ``ComparedScene``: one file a format, found by what is in it.

A format is a module with ``is_mine(path, data)`` (``data`` is the JSON of a file, None for a
folder) and ``read(path, data, how)``. Packages outside add theirs through the entry point group
``world2minecraft.layout_format``.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.registry import Registry
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import READ_ERRORS, why

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
    """What files do not say.

    ``px_m``: metres of a pixel, of layouts in pixels. ``task``: LayoutVLM's scene file, None for
    the one beside the layout. ``assets``: the folder of its assets. ``truth``: the capture with
    the truth of a run.
    """

    px_m: float = PX_M
    task: Path | None = None
    assets: Path | None = None
    truth: Path | None = None


def read_layouts_of(path: Path, how: How | None = None, name: str = "") -> list[ComparedScene]:
    """Read the scenes of a file or a folder.

    Args:
        path: where they are.
        how: what they do not say.
        name: of the format; found out where it is empty.

    Raises:
        InputError: it is not there, or of no known format. DamagedFileError, LimitError: it is not
            what its format says. UnknownNameError: no format is so named.
    """
    if not path.exists():
        raise InputError(path, "is not there")
    data = None if path.is_dir() else read_json(path, MAX_BYTES)
    for one in [name] if name else FORMATS.names():
        found = FORMATS.load(one)
        if name or found.is_mine(path, data):
            return _read(found, path, data, how or How())
    known = ", ".join(FORMATS.names())
    raise InputError(path, f"holds no layout that is known ({known}); --format says which it is")


def _read(found: Any, path: Path, data: Any, how: How) -> list[ComparedScene]:
    try:
        scenes = found.read(path, data, how)
    except READ_ERRORS as error:
        raise DamagedFileError(path, f"is not what its format says ({why(error)})") from error
    if not scenes:
        raise DamagedFileError(path, "holds no scene")
    return scenes
