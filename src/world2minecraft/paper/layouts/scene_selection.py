"""Selection of the scenes of a file, and names for their folders."""

from collections.abc import Sequence

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.file_names import is_reserved
from world2minecraft.paper.layouts.compared_scene import ComparedScene

MAX_NAME = 60


def select_scenes(
    found: Sequence[ComparedScene], names: Sequence[str] = (), count: int | None = None
) -> list[ComparedScene]:
    """Select scenes by name. Without names, the first scenes are selected.

    Args:
        found: The scenes of a file.
        names: Substrings of scene names.
        count: The maximum number of scenes, for each name if there are names. None selects one.

    Raises:
        UnknownNameError: If no scene matches a name.
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
    """Return a unique and portable folder name for each scene.

    Scene names come from external files, so only ASCII letters, digits, hyphens and underscores are
    kept. Names that differ only in case are one name on other systems.
    """
    names: list[str] = []
    for number, one in enumerate(scenes):
        safe = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in one.name)
        name = safe[-MAX_NAME:].strip("_") or f"scene_{number}"
        taken = {other.casefold() for other in names}
        free = name if not is_reserved(name) else f"{name}_{number}"
        while free.casefold() in taken:
            free = f"{free}_{number}"
        names.append(free)
    return names
