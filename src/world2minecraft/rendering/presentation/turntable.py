"""Turntable renderings: a build on a neutral ground with a soft shadow, seen from all sides."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np
from scipy.ndimage import gaussian_filter

from world2minecraft.core.coordinates import invert
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.block_elements import ModelSource
from world2minecraft.rendering.picture import picture_colour
from world2minecraft.rendering.presentation.opened_room import OpenedBuild, has_ceiling
from world2minecraft.rendering.presentation.shot_rendering import (
    DrawOptions,
    draw_frames,
    with_common_exposure,
)
from world2minecraft.rendering.scene import prepare_scene
from world2minecraft.rendering.shading_parameters import NEUTRAL
from world2minecraft.rendering.views.cameras import Shot
from world2minecraft.rendering.views.orbit import TURN_DEG, orbit_shots

GROUND = (233.0, 231.0, 227.0)  # A warm light grey, darker towards the picture's corners.
CORNER_SHADE = 0.10
# Shadows by their softness in shares of the build's size, and how dark they are.
SHADOWS = ((0.014, 0.46), (0.07, 0.36))
LOW_SHARE = 0.35  # Parts above this share of the height cast a fainter shadow.
EDGE_SHARE = 0.25  # Margin of the shadow around the build, as a share of its size.
FOV_DEG = 24.0  # Narrow: nearly parallel edges read as a model.
OPEN_ELEVATION_DEG = 44.0  # Into a room, over its furniture.
CLOSED_ELEVATION_DEG = 26.0  # A house, its roof and its walls.


@dataclass(frozen=True, eq=False)
class Studio:
    """The ground below a build, with its ambient shadow at each place, in blocks."""

    level: float  # The ground's height, world blocks.
    corner: np.ndarray  # float64 [2], x and z of the map's first sample
    darkness: np.ndarray  # float32 [A, B], 0 lit, four samples a block at most
    per_block: float
    block_to_room: np.ndarray

    def seen_by(self, camera: Camera, camera_to_room: np.ndarray, where: np.ndarray) -> np.ndarray:
        """Return the colours of the ground at selected pixels, as float32 [N, 3] sRGB.

        Args:
            camera: Camera intrinsics.
            camera_to_room: Camera pose above the ground, 4x4.
            where: Mask of the N pixels, bool [H, W].
        """
        rows, columns = np.argwhere(where).T
        across = (columns + 0.5 - camera.cx_px) / camera.fx_px
        down = (rows + 0.5 - camera.cy_px) / camera.fy_px
        camera_to_block = invert(self.block_to_room) @ camera_to_room
        ahead = np.column_stack([across, down, np.ones(len(rows))]) @ camera_to_block[:3, :3].T
        eye = camera_to_block[:3, 3]
        drop = np.minimum(ahead[:, 1], -1e-9)
        place = eye + ahead * ((self.level - eye[1]) / drop)[:, None]
        off = np.hypot(2 * columns / camera.width_px - 1, 2 * rows / camera.height_px - 1)
        light = (1 - self._dark(place[:, [0, 2]])) * (1 - CORNER_SHADE * np.minimum(off, 1.5) ** 2)
        return (light[:, None] * np.array(GROUND)).astype(np.float32)

    def _dark(self, places: np.ndarray) -> np.ndarray:
        """Return the darkness at places, float64 [N, 2] of x and z, bilinear."""
        at = (places - self.corner) * self.per_block - 0.5
        shape = np.array(self.darkness.shape)
        inside = np.asarray(((at >= 0) & (at < shape - 1.001)).all(axis=1))
        at = np.where(inside[:, None], at, 0.0)
        i, j = np.floor(at).astype(np.int64).T
        p, q = (at - np.floor(at)).T
        dark = self.darkness
        low = (1 - q) * dark[i, j] + q * dark[i, j + 1]
        high = (1 - q) * dark[i + 1, j] + q * dark[i + 1, j + 1]
        return np.where(inside, (1 - p) * low + p * high, 0.0)


def studio_of(volume: BlockVolume) -> Studio:
    """Return the ground on which the blocks of a volume stand."""
    filled = volume.states != 0
    layers = np.flatnonzero(filled.any(axis=(0, 2)))
    first = int(layers[0]) if len(layers) else 0
    height = max(1, round(LOW_SHARE * volume.states.shape[1]))
    weight = np.exp(-np.arange(volume.states.shape[1] - first) / height)
    plan = (filled[:, first:] * weight[None, :, None]).max(axis=1).astype(np.float32)
    size = float(max(plan.shape))
    edge = int(np.ceil(EDGE_SHARE * size)) + 2
    per_block = max(1, int(min(4, 1024 // (size + 2 * edge) or 1)))
    fine = np.pad(plan, edge).repeat(per_block, axis=0).repeat(per_block, axis=1)
    lit = np.ones_like(fine)
    for softness, depth in SHADOWS:
        soft = gaussian_filter(fine, max(softness * size, 0.3) * per_block, mode="constant")
        lit *= 1 - depth * soft
    x, y, z = volume.corner
    return Studio(
        level=float(y + first),
        corner=np.array([x - edge, z - edge], np.float64),
        darkness=1 - lit,
        per_block=float(per_block),
        block_to_room=volume.block_to_room,
    )


def turntable(
    volume: BlockVolume,
    camera: Camera,
    count: int,
    *,
    options: DrawOptions | None = None,
    looks: ModelSource | None = None,
    texture_px: int = 16,
    rate_hz: float = 24.0,
    opened: bool | None = None,
) -> Iterator[tuple[Shot, np.ndarray]]:
    """Render a build from all sides, and yield each shot with its image, uint8 [H, W, 3].

    Args:
        volume: The blocks.
        camera: Camera intrinsics. A field of view of ``FOV_DEG`` is recommended.
        count: Number of images per turn.
        options: Rendering options. None uses neutral light and four rays per pixel.
        looks: Models and textures, as for ``prepare_scene``.
        texture_px: Texture size, as for ``prepare_scene``.
        rate_hz: Frames per second, for the time stamps of the shots.
        opened: Whether to remove ceilings and near walls. None removes them if there is a ceiling.
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
            exposure = with_common_exposure(scene, how.light, some).exposure
        pictures = draw_frames(
            replace(scene, exposure=exposure), fine, [one.camera_to_room for one in some], how
        )
        for shot, picture in zip(some, pictures, strict=True):
            colour = picture_colour(picture)
            yield shot, _on_ground(colour, picture.depth_m > 0, studio, shot, samples)


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
