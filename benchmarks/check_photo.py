"""What does a photo cost, and how far is it from the picture that it stands for?

``python -m benchmarks.check_photo [--picture photo.png] [--truth 256]``

A furnished block of flats (``render_scenes.small()``), from a place in one of its rooms, by day and
at night by its lamps. ``trace`` and ``filter`` are CPU seconds at 640x480 and 16 samples, the less
of two. ``grain`` and ``error`` are the root mean square, on the screen (0 to 255), of what
16 samples differ by from many (``--truth``) at 160x120, before and after the filter.
"""

import argparse
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.render_scenes import camera_of, poses, scene_looks, small
from world2minecraft.files import write_bytes
from world2minecraft.render import LookLight, prepare_scene
from world2minecraft.render.photo import Photo, lamps_of, render_photo
from world2minecraft.render.scene import BlockScene
from world2minecraft.report.pictures import as_png

HOURS = (("day", 10.0), ("night", 22.0))
SEED = 12  # Of the place.


class Row(NamedTuple):
    """What one hour gives."""

    hour: str
    trace_s: float
    filter_s: float
    grain: float
    error: float


class Place(NamedTuple):
    """What is photographed from where."""

    scene: BlockScene
    camera_to_room: np.ndarray


def take(place: Place, hour: float, width: int, samples: int, **more: Any) -> Photo:
    """Return a photo of a place."""
    light = more.pop("light", LookLight(hour=hour))
    camera = camera_of(width, width * 3 // 4)
    return render_photo(
        place.scene, camera, place.camera_to_room, light=light, samples=samples, **more
    )


def cost(place: Place, hour: float) -> tuple[float, float]:
    """Return CPU seconds of the paths, and of the filter."""
    lamps = lamps_of(place.scene)

    def least(denoise: bool) -> float:
        seconds = []
        for _ in range(2):
            start = time.process_time()
            take(place, hour, 640, 16, lamps=lamps, denoise=denoise)
            seconds.append(time.process_time() - start)
        return min(seconds)

    plain = least(False)
    return plain, least(True) - plain


def faults(place: Place, hour: float, truth: int) -> tuple[float, float]:
    """Return how far 16 samples are from many, before and after the filter."""
    whole = take(place, hour, 160, truth, denoise=False)
    light = LookLight(hour=hour, exposure=whole.exposure)
    expected = np.asarray(whole.colour, float)
    off = []
    for denoise in (False, True):
        photo = take(place, hour, 160, 16, light=light, seed=1, denoise=denoise)
        differ = np.asarray(photo.colour, float) - expected
        off.append(float(np.sqrt((differ**2).mean())))
    return off[0], off[1]


def main() -> None:
    """Print the table, and write the picture of the last hour where one was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--truth", type=int, default=256)
    options = parser.parse_args()
    volume = small()
    place = Place(prepare_scene(volume, scene_looks()), poses(volume, 1, SEED)[0])
    take(place, 12.0, 32, 1)  # Compiles the kernels.
    table = Table("hour", "trace", "filter", "grain", "error")
    for name, hour in HOURS:
        row = Row(name, *cost(place, hour), *faults(place, hour, options.truth))
        table.add_row(
            row.hour, f"{row.trace_s:.2f} s", f"{row.filter_s:.2f} s",
            f"{row.grain:.1f}", f"{row.error:.1f}",
        )  # fmt: skip
    Console().print(table)
    if options.picture is not None:
        photos = [np.asarray(take(place, hour, 640, 16).colour) for _, hour in HOURS]
        write_bytes(options.picture, as_png(np.concatenate(photos, axis=1)))


if __name__ == "__main__":
    main()
