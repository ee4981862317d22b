"""Make ``sceneforge/demo_room``: the files of ``w2m demo`` that SceneForge shows first.

``python tools/make_demo_room.py`` runs the demo (about a minute) and copies what is needed.
"""

import shutil
import tempfile
from pathlib import Path

from world2minecraft.cli import main
from world2minecraft.sceneforge.scene_sources import DEMO_FOLDER

FILES = ("room.npz", "objects.json", "placements.json", "layout.json", "scan.json")

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        main(["demo", "--out", scratch])
        DEMO_FOLDER.mkdir(exist_ok=True)
        for name in FILES:
            shutil.copyfile(Path(scratch) / name, DEMO_FOLDER / name)
