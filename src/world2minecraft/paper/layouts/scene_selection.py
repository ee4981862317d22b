"""Which scenes of a file are built, and the names of their folders."""

from collections.abc import Sequence

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.paper.layouts.compared_scene import ComparedScene

MAX_NAME = 60


def select_scenes(
    found: Sequence[ComparedScene], names: Sequence[str] = (), count: int | None = None
) -> list[ComparedScene]:
    """Return the scenes that are asked for, the first one where nothing is.

    Args:
        found: the scenes of a file.
        names: parts of the names of scenes.
        count: how many scenes; of each name where there are names.

    Raises:
        UnknownNameError: no scene has such a name.
    """
    if not names:
        return list(found[: count or 1])
    chosen = []
    for name in names:
        fitting = [one for one in found if name in one.name]
        if not fitting:
            raise UnknownNameError("scene", name, [one.name for one in found])
        chosen += fitting[: count or 1]
    return chosen


def folder_names(scenes: Sequence[ComparedScene]) -> list[str]:
    """Return a folder name for each scene that every system accepts; no two are alike.

    Names come from files of others, so only ASCII letters, digits, hyphens and underscores remain.
    """
    names: list[str] = []
    for number, one in enumerate(scenes):
        safe = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in one.name)
        name = safe[-MAX_NAME:].strip("_") or f"scene_{number}"
        names.append(name if name not in names else f"{name}_{number}")
    return names
