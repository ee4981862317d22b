"""The room that SceneForge shows first: ``w2m demo``, as it was reconstructed.

Its files lie in ``demo_room``; ``python tools/make_demo_room.py`` makes them anew. It has the
floaters, holes and doubtful objects of a real run, so that there is something to mend.
"""

from pathlib import Path

from world2minecraft.sceneforge.scene_sources import OpenedScene, read_source


def demo_room(folder: Path | None = None) -> OpenedScene:
    """Return a living room with its objects; ``folder`` is where it would be saved."""
    return read_source(None, folder)
