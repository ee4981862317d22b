"""Importer of scenes built by ``w2m compare build``, with their boxes before building."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.paper.layouts.compared_scene import SCENE_FILE, ComparedScene, read_scene

if TYPE_CHECKING:
    from world2minecraft.paper.layouts.importers import How


class Format:
    """The format of scenes built by ``w2m compare build``."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Return whether a folder was built from a layout."""
        return path.is_dir() and (path / SCENE_FILE).is_file()

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Read the only scene of a folder.

        Raises:
            InputError: If the file cannot be read.
        """
        return [read_scene(path / SCENE_FILE if path.is_dir() else path)]


FORMAT = Format()
