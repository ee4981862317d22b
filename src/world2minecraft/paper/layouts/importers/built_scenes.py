"""Scenes that ``w2m compare build`` has built: their boxes as they were before."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.paper.layouts.compared_scene import SCENE_FILE, ComparedScene, read_scene

if TYPE_CHECKING:
    from world2minecraft.paper.layouts.importers import How


class Format:
    """The format of this module."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Whether a folder was built of a layout."""
        return path.is_dir() and (path / SCENE_FILE).is_file()

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Return its one scene. Raises InputError."""
        return [read_scene(path / SCENE_FILE if path.is_dir() else path)]


FORMAT = Format()
