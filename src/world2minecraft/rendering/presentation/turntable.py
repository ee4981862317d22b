"""A build on a neutral ground that turns once around: the picture that shows a build as a thing."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

import numpy as np

from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.block_elements import LookSource
from world2minecraft.rendering.light_parameters import NEUTRAL
from world2minecraft.rendering.presentation.opened_room import OpenedBuild, has_ceiling
from world2minecraft.rendering.presentation.shot_frames import DrawOptions, exposed, frames
from world2minecraft.rendering.presentation.studio import Studio, studio_of
from world2minecraft.rendering.scene import prepare_scene
from world2minecraft.rendering.views.orbit import TURN_DEG, orbit_shots
from world2minecraft.rendering.views.poses import Shot

FOV_DEG = 24.0  # Narrow: nearly parallel edges read as a model.
OPEN_ELEVATION_DEG = 44.0  # Into a room, over its furniture.
CLOSED_ELEVATION_DEG = 26.0  # A house, its roof and its walls.


def turntable(
    volume: BlockVolume,
    camera: Camera,
    count: int,
    *,
    options: DrawOptions | None = None,
    looks: LookSource | None = None,
    texture_px: int = 16,
    rate_hz: float = 24.0,
    opened: bool | None = None,
) -> Iterator[tuple[Shot, np.ndarray]]:
    """Draw a build from all around, and yield each shot with its picture, uint8 [H, W, 3].

    Args:
        volume: the blocks.
        camera: through which; ``FOV_DEG`` suits it.
        count: pictures in one turn.
        options: how it looks; a calm light and four rays a pixel where None.
        looks: as in ``prepare_scene``.
        texture_px: the same.
        rate_hz: frames a second, for the shots' times.
        opened: whether ceilings and near walls are left out; where there is a ceiling, if None.
    """
    inside = OpenedBuild(volume) if (has_ceiling(volume) if opened is None else opened) else None
    shown = volume if inside is None else inside.whole
    how = options or DrawOptions(light=NEUTRAL, samples=2)
    samples, how = how.samples, replace(how, outputs=("colour",), samples=1)
    fine = camera.resized(camera.width_px * samples, camera.height_px * samples)
    elevation = CLOSED_ELEVATION_DEG if inside is None else OPEN_ELEVATION_DEG
    studio = studio_of(shown)
    exposure: float | None = None
    start = TURN_DEG if inside is None else inside.best_start_deg(elevation)
    shots = orbit_shots(
        shown, camera, count, elevation_deg=elevation, start_deg=start, rate_hz=rate_hz
    )
    volumes = [volume if inside is None else inside.seen_by(one.camera_to_room) for one in shots]
    for _, run in groupby(range(count), key=lambda n: id(volumes[n])):
        some = [shots[n] for n in run]
        scene = prepare_scene(volumes[shots.index(some[0])], looks, texture_px=texture_px)
        if exposure is None:  # One for the whole turn.
            exposure = exposed(scene, how.light, some).exposure
        pictures = frames(
            replace(scene, exposure=exposure), fine, [one.camera_to_room for one in some], how
        )
        for shot, picture in zip(some, pictures, strict=True):
            if picture.colour is None:
                raise ValueError("the picture has no colour")
            yield shot, _on_ground(picture.colour, picture.depth_m > 0, studio, shot, samples)


def _on_ground(
    colour: np.ndarray, is_build: np.ndarray, studio: Studio, shot: Shot, samples: int
) -> np.ndarray:
    """Return the mean of every square of samples, with the ground where the build is not."""
    height, width = colour.shape[0] // samples, colour.shape[1] // samples
    squares = (height, samples, width, samples)
    shown = is_build.reshape(squares).sum(axis=(1, 3), dtype=np.uint16)
    kept = np.where(is_build[..., None], colour, 0).reshape(*squares, 3)
    total = kept.sum(axis=(1, 3), dtype=np.uint32).astype(np.float32)
    bare = shown < samples * samples
    left = (samples * samples - shown[bare])[:, None]
    total[bare] += left * studio.seen_by(shot.camera, shot.camera_to_room, bare)
    return np.minimum(total / (samples * samples) + 0.5, 255).astype(np.uint8)
