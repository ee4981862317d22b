"""What photos of generated houses cost, and how far their light is from that of many samples.

``python -m benchmarks.check_photo_look [--truth 512] [--pictures FOLDER]``

Six views by day, evening and night. Printed are, for each and for all, the CPU seconds of 640 x 480
pixels with 16 samples, filter included, and the root mean square on the screen, 0 to 255, of what
16 filtered samples differ by from many without a filter at 320 x 240: of pixels, and of means over
11 x 11 pixels, which is what stains are. ``--truth 0`` leaves out the errors, ``--pictures`` writes
the six photos.
"""

import argparse
import time
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import uniform_filter

from world2minecraft.core.types import Camera
from world2minecraft.procgen.worlds import generate_world
from world2minecraft.rendering import LightSettings, prepare_scene
from world2minecraft.rendering.path_tracing import emitters_of, render_photo
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.views.walk_through import plan_tour

# House, stop of twelve of a tour, hour.
VIEWS = ((3, 1, 10.0), (3, 10, 18.3), (3, 6, 22.0), (11, 8, 22.5), (29, 4, 13.0), (29, 9, 17.8))
ROOMS, STOPS, TEXTURE_PX, SAMPLES = 5, 12, 32, 16
STAIN_PX = 11


def camera(width: int) -> Camera:
    """Return a camera with a horizontal field of view of 78 degrees."""
    focal = 0.62 * width
    return Camera(width, width * 3 // 4, focal, focal, width / 2, width * 3 / 8)


def places() -> dict[int, tuple[BlockScene, list[np.ndarray]]]:
    """Return the scene of each house, and poses in it."""
    found = {}
    for seed in sorted({seed for seed, _, _ in VIEWS}):
        volume = generate_world(seed, rooms=ROOMS).volume
        shots = plan_tour(volume, camera(640), STOPS).shots
        scene = prepare_scene(volume, texture_px=TEXTURE_PX, reach=2)
        found[seed] = scene, [shot.camera_to_room for shot in shots]
    return found


def errors(scene: BlockScene, pose: np.ndarray, hour: float, truth: int) -> tuple[float, float]:
    """Return the errors of pixels and of means over some."""
    small = camera(320)
    whole = render_photo(
        scene, small, pose, light=LightSettings(hour=hour), samples=truth, seed=1, denoise=False
    )
    light = LightSettings(hour=hour, exposure=whole.exposure)
    photo = render_photo(scene, small, pose, light=light, samples=SAMPLES)
    off = np.asarray(photo.colour, float) - np.asarray(whole.colour, float)
    means = uniform_filter(off, STAIN_PX, axes=(0, 1))
    return float(np.sqrt((off**2).mean())), float(np.sqrt((means**2).mean()))


def main() -> None:
    """Take the photos and print a row for each."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--truth", type=int, default=512)
    parser.add_argument("--pictures", type=Path)
    chosen = parser.parse_args()
    rows, found = [], places()
    for seed, stop, hour in VIEWS:
        scene, poses = found[seed]
        light, emitters = LightSettings(hour=hour), emitters_of(scene)
        render_photo(scene, camera(32), poses[stop], light=light, samples=1)  # Compiles.
        begun = time.process_time()
        photo = render_photo(scene, camera(640), poses[stop], light=light, emitters=emitters)
        row = [time.process_time() - begun]
        if chosen.truth:
            row += errors(scene, poses[stop], hour, chosen.truth)
        rows.append(row)
        print(f"house {seed}, {hour:4.1f} h", np.round(row, 2), flush=True)
        if chosen.pictures:
            chosen.pictures.mkdir(parents=True, exist_ok=True)
            Image.fromarray(np.asarray(photo.colour)).save(
                chosen.pictures / f"photo_{seed}_{hour}.png"
            )
    print("mean", np.round(np.mean(rows, axis=0), 2), "CPU s, error, error of means")


if __name__ == "__main__":
    main()
