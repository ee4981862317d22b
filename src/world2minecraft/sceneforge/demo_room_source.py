"""The demo room that SceneForge shows first: a reconstruction made by ``w2m demo``.

Its files are in ``demo_room``; ``python tools/make_demo_room.py`` regenerates them. The room has
the floaters, holes and doubtful objects of a real run, so that there is something to edit.
"""

from pathlib import Path

from world2minecraft.sceneforge.scene_sources import OpenedScene, read_source


def demo_room(folder: Path | None = None) -> OpenedScene:
    """Return a living room with its objects. ``folder`` is where it would be saved."""
    return read_source(None, folder)
