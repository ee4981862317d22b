"""The views that labels are checked and measured on: people who stand in generated houses."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import minimum_filter

from world2minecraft.classes import SemanticClass
from world2minecraft.coordinates import look_at
from world2minecraft.dataset.tours import nyu_camera
from world2minecraft.dataset.values import SceneVoxels
from world2minecraft.dataset.voxels import scene_voxels
from world2minecraft.render import BlockScene, prepare_scene
from world2minecraft.rooms.worlds import generate_world
from world2minecraft.types import BlockVolume, Camera

EYE_M, TALL_M, ASIDE_M = 1.62, 1.8, 0.3  # The last: as near as one stands to a wall.
NYU = nyu_camera()
GAME = Camera(1920, 1129, 806.19, 806.19, 960.0, 564.5)  # The paper's window at FOV 70.


@dataclass(frozen=True, eq=False)
class House:
    """A house that is ready to be looked at."""

    seed: int
    volume: BlockVolume
    scene: BlockScene
    voxels: SceneVoxels
    blocks: SceneVoxels  # one cell a block


def houses(seeds: range) -> Iterator[House]:
    """Give the house of each seed; they have four to eight rooms, each sixth two storeys."""
    for seed in seeds:
        made = generate_world(seed, rooms=4 + seed % 5, storeys=1 + (seed % 6 == 1))
        scene = prepare_scene(made.volume)
        designs = (made.design, made.designs)
        fine, coarse = (
            scene_voxels(made.volume, designs, voxel_m=size, scene=scene) for size in (0.08, None)
        )
        yield House(seed, made.volume, scene, fine, coarse)


def standing_views(voxels: SceneVoxels, count: int, seed: int) -> list[np.ndarray]:
    """Return cameras at the eyes of people who stand on a floor with nothing in their way.

    They look any way, from 25 degrees down to 10 up.
    """
    rng = np.random.default_rng(seed)
    tall = int(np.ceil(TALL_M / voxels.voxel_m))
    empty = voxels.labels == 0
    below = np.cumsum(empty, axis=2, dtype=np.int32)
    on_floor = voxels.labels[:, :, :-tall] == SemanticClass.FLOOR
    free = below[:, :, tall:] - below[:, :, :-tall] == tall
    top = empty.shape[2] - 1 - np.argmax(~empty[:, :, ::-1], axis=2)
    indoors = top[..., None] > np.arange(on_floor.shape[2]) + tall
    side = 2 * int(np.ceil(ASIDE_M / voxels.voxel_m)) + 1
    roomy = minimum_filter(free.astype(np.uint8), (side, side, 1), mode="constant") > 0
    places = np.argwhere(on_floor & roomy & indoors)
    views = []
    for cell in places[rng.integers(len(places), size=count)]:
        within = np.array([*rng.random(2), 1.0])
        eye = voxels.origin_m + (cell + within) * voxels.voxel_m
        eye[2] += EYE_M
        yaw, pitch = rng.uniform(0, 2 * np.pi), np.radians(rng.uniform(-25, 10))
        ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
        views.append(look_at(eye, eye + np.array(ahead)))
    return views
