"""The rooms that a scene says itself: ``layout.json`` of a run, beside its build or above it."""

from pathlib import Path

from world2minecraft.core.types import Layout
from world2minecraft.formats.layout import read_layouts

_NAME = "layout.json"


def layouts_beside(path: str | Path) -> tuple[Layout, ...]:
    """Return the rooms of the run that a place belongs to; none where it is of no run.

    Args:
        path: a run's folder, its ``build``, the world in it, or any other place.

    Raises:
        DamagedFileError: its ``layout.json`` is no layout.
    """
    place = Path(path)
    for folder in (place, place.parent, place.parent.parent):
        if (folder / _NAME).is_file() and (folder / "build").is_dir():
            return read_layouts(folder / _NAME)
    return ()
