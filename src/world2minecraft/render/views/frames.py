"""Pictures of many shots, one after another: what every command and data set reads from.

This is the one door to the renderer: whoever overlaps work with writing, or spreads it over
processes, does so behind it.
"""

from collections.abc import Collection, Iterable, Iterator
from itertools import repeat

import numpy as np

from world2minecraft.render.picture import Picture, render_volume
from world2minecraft.render.scene import RayScene
from world2minecraft.render.views.poses import Shot
from world2minecraft.types import Camera


def frames(
    scene: RayScene,
    cameras: Camera | Iterable[Camera],
    poses: Iterable[np.ndarray],
    *,
    outputs: Collection[str] = ("colour",),
    threads: int = 1,
) -> Iterator[Picture]:
    """Take the pictures of poses, in their order, one at a time.

    Args:
        scene: ``prepare_scene`` of a volume.
        cameras: one for all poses, or one for each.
        poses: ``camera_to_room``, float64 [4, 4] each.
        outputs: what to make, see ``render_volume``.
        threads: bands of a picture that are drawn at a time.

    Raises:
        ValueError: what ``render_volume`` raises.
    """
    each = repeat(cameras) if isinstance(cameras, Camera) else cameras
    for camera, camera_to_room in zip(each, poses, strict=False):
        yield render_volume(scene, camera, camera_to_room, outputs=outputs, threads=threads)


def frames_of(
    scene: RayScene, shots: Collection[Shot], *, outputs: Collection[str], threads: int = 1
) -> Iterator[Picture]:
    """Take the pictures of shots; see ``frames``."""
    cameras, poses = [shot.camera for shot in shots], [shot.camera_to_room for shot in shots]
    return frames(scene, cameras, poses, outputs=outputs, threads=threads)
