"""Make docs/images/worlds.jpg: a room of a generated house in each of the styles.

    python tools/make_worlds_picture.py            two minutes

Of the views on a walk through a house, the one that shows most things is drawn.
"""

import io
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.files import write_bytes
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.procgen.worlds.styles import styles
from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering.batch import render_batch
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.views import camera_of, plan_tour

PICTURE = Path(__file__).resolve().parents[1] / "docs/images/worlds.jpg"
SIZE, SCOUT, COLUMNS, FOV_DEG = (288, 216), (96, 72), 6, 70
ROOMS, VIEWS, SEED, SAMPLES = 4, 40, 3, 2
MIN_SHARE = 0.004  # Of a picture: less of a thing is not seen.


def room_of(style: str, seed: int) -> np.ndarray:
    """Return the view of a house that shows most things, uint8 [H, W, 3]."""
    volume = generate_world(seed, rooms=ROOMS, style=style).volume
    scene, small = prepare_scene(volume), camera_of(*SCOUT, vertical_fov_deg=FOV_DEG)
    poses = np.array([shot.camera_to_room for shot in plan_tour(volume, small, VIEWS).shots])
    seen = np.asarray(render_batch(scene, small, poses, outputs=("instance",)).instance)
    things = [things_in(picture) for picture in seen]
    best = poses[int(np.argmax(things))]
    camera = camera_of(*SIZE, vertical_fov_deg=FOV_DEG)
    picture = render_volume(scene, camera, best, outputs=("colour",), samples=SAMPLES)
    if picture.colour is None:
        raise RuntimeError("the renderer returned no colour image")
    return picture.colour


def things_in(instance: np.ndarray) -> int:
    """Return the number of things that a picture of instances [H, W] shows."""
    ids, counts = np.unique(instance, return_counts=True)
    return int((counts[ids > 0] >= MIN_SHARE * instance.size).sum())


def main() -> None:
    """Draw a room in each style and write the sheet."""
    names = sorted(styles())
    sheet = Image.new("RGB", (COLUMNS * SIZE[0], -(-len(names) // COLUMNS) * SIZE[1]), "white")
    for n, name in enumerate(names):
        row, column = divmod(n, COLUMNS)
        picture = Image.fromarray(room_of(name, SEED + n))
        sheet.paste(picture, (column * SIZE[0], row * SIZE[1]))
    stream = io.BytesIO()
    sheet.save(stream, "JPEG", quality=82, optimize=True)
    write_bytes(PICTURE, stream.getvalue())


if __name__ == "__main__":
    main()
