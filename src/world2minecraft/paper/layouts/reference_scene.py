"""The true scene that others are held to: a scan's truth, or one that a person has mended."""

from pathlib import Path

from world2minecraft.core.errors import InputError
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers import read_layouts_of

TRUTH = "truth"


def is_truth(path: Path) -> bool:
    """Whether a folder is a capture with its truth."""
    return path.is_dir() and (path / "truth.json").is_file()


def true_scene(path: Path) -> ComparedScene:
    """Return the scene that is true, in its own frame.

    Args:
        path: a capture of ``w2m rooms scan``, or anything that ``read_layouts_of`` reads.

    Raises:
        InputError: it cannot be read, or holds several scenes.
    """
    if is_truth(path):
        known = read_truth(path)
        if not known.layouts:
            raise InputError(path, "tells of no room; scan it again with w2m rooms scan")
        return ComparedScene(path.name, TRUTH, known.layouts, known.objects)
    scenes = read_layouts_of(path)
    if len(scenes) > 1:
        raise InputError(path, f"holds {len(scenes):,} scenes; one is true")
    return scenes[0]
