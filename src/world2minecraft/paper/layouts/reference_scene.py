"""The reference scene of a comparison: a ground truth, or a scene corrected by a person."""

from pathlib import Path

from world2minecraft.core.errors import InputError
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers import read_layouts_of

TRUTH = "truth"


def is_truth(path: Path) -> bool:
    """Return whether a folder is a capture with ground truth."""
    return path.is_dir() and (path / "truth.json").is_file()


def true_scene(path: Path) -> ComparedScene:
    """Read the reference scene in its own frame.

    Args:
        path: A capture of ``w2m rooms scan``, or anything that ``read_layouts_of`` accepts.

    Raises:
        InputError: If the scene cannot be read, or there are several.
    """
    if is_truth(path):
        known = read_truth(path)
        if not known.layouts:
            raise InputError(
                path, "the scan does not contain a room; scan it again with w2m rooms scan"
            )
        return ComparedScene(path.name, TRUTH, known.layouts, known.objects)
    scenes = read_layouts_of(path)
    if len(scenes) > 1:
        raise InputError(
            path, f"found {len(scenes):,} scenes, expected exactly one ground-truth scene"
        )
    return scenes[0]
