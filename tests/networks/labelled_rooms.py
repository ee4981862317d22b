"""Small labelled frames of a floor, a wall and a box, for the tests of the segmentation network."""

import numpy as np
from PIL import Image

from world2minecraft.core.types import Camera
from world2minecraft.networks.segmentation.frames import labelled_frame

CAMERA = Camera(64, 48, 52.0, 52.0, 32.0, 24.0)
HEIGHT_M, WALL_M = 1.3, 3.0
WALL, FLOOR, BED = 0, 1, 3


def room_arrays(seed, camera=CAMERA):
    """Colours, labels and depth of a level camera that looks at a wall, with a box on the floor."""
    rng = np.random.default_rng(seed)
    rows, columns = np.mgrid[: camera.height_px, : camera.width_px] + 0.5
    down = (rows - camera.cy_px) / camera.fy_px
    with np.errstate(divide="ignore"):
        floor_m = np.where(down > 0, HEIGHT_M / down, np.inf)
    depth_m = np.minimum(floor_m, WALL_M)
    labels = np.where(floor_m < WALL_M, FLOOR, WALL).astype(np.uint8)
    left = rng.uniform(0, 0.6) * camera.width_px
    box = (columns > left) & (columns < left + 0.3 * camera.width_px) & (down > 0.1)
    front = box & (depth_m > 2)
    depth_m[front], labels[front] = 2.0, BED
    base = np.array([[180, 180, 170], [120, 80, 40], [0, 0, 0], [60, 60, 200]])[labels]
    colour = np.clip(base + rng.normal(0, 8, base.shape), 0, 255).astype(np.uint8)
    return colour, labels, depth_m.astype(np.float32)


def room_frame(seed):
    return labelled_frame(f"{seed:04}", *room_arrays(seed), CAMERA)


def write_nyu_frame(folder, number):
    colour, labels, depth_m = room_arrays(number)
    folder.mkdir(exist_ok=True)
    Image.fromarray(colour).save(folder / f"{number:04}.color.jpg")
    Image.fromarray(np.round(depth_m * 25.5).astype(np.uint8)).save(
        folder / f"{number:04}.depth8.png"
    )
    Image.fromarray(labels).save(folder / f"{number:04}.label40.png")
