"""Make ``sceneforge/demo_room``: the files of ``w2m demo`` that SceneForge shows first.

``python tools/make_demo_room.py`` runs the demo (about a minute) and copies what is needed, with
a picture.
"""

import shutil
import tempfile
from pathlib import Path

from PIL import Image

from world2minecraft.cli import main
from world2minecraft.sceneforge.scene_sources import DEMO_FOLDER, DEMO_PICTURE

FILES = ("room.npz", "objects.json", "placements.json", "layout.json", "scan.json")

PICTURE_SIZE = (720, 540)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        main(["demo", "--out", scratch])
        DEMO_FOLDER.mkdir(exist_ok=True)
        for name in FILES:
            shutil.copyfile(Path(scratch) / name, DEMO_FOLDER / name)
        with Image.open(Path(scratch) / "preview.png") as picture:
            picture.thumbnail(PICTURE_SIZE)
            picture.save(DEMO_FOLDER / DEMO_PICTURE, quality=80)
