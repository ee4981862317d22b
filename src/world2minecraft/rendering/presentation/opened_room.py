"""Rooms without their ceiling and the walls near the camera, for views from outside."""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import carry_camera, invert
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.cutaway import (
    arrange_side_by_side,
    split_storeys,
    without_ceiling,
    without_near_walls,
    without_partitions,
)
from world2minecraft.rendering.picture import visible_furniture
from world2minecraft.rendering.plain_models import PlainModels
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, draw_shots
from world2minecraft.rendering.scene import prepare_scene
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.rendering.views.orbit import TURN_DEG, orbit_shots

SCOUT_PX, SCOUT_FOV_DEG = (96, 72), 24.0


def has_ceiling(volume: BlockVolume) -> bool:
    """Return whether any block is labelled as ceiling, which hides the rooms from above."""
    return bool((volume.semantic == SemanticClass.CEILING).any())


@dataclass(eq=False)
class OpenedBuild:
    """A volume opened for views from above, with the storeys of a house side by side."""

    volume: BlockVolume
    _parts: list[BlockVolume] = field(init=False)
    _cuts: dict[tuple[int, int], BlockVolume] = field(init=False, default_factory=dict)

    def __post_init__(self):
        storeys = split_storeys(self.volume)
        self._parts = [without_partitions(without_ceiling(one)) for one in storeys]

    @property
    def whole(self) -> BlockVolume:
        """All blocks that are visible from any side."""
        return arrange_side_by_side(self._parts)

    def best_start_deg(self, elevation_deg: float) -> float:
        """Return the start angle of an orbit: the corner from which most furniture is visible."""
        camera = camera_of(*SCOUT_PX, vertical_fov_deg=SCOUT_FOV_DEG)
        starts = [TURN_DEG + 90.0 * n for n in range(4)]
        return max(starts, key=lambda start: self._shown(camera, start, elevation_deg))

    def _shown(self, camera: Camera, start_deg: float, elevation_deg: float) -> float:
        """Return how many pixels show objects, counted by the root of each object's own number."""
        shot = orbit_shots(self.whole, camera, 1, start_deg=start_deg, elevation_deg=elevation_deg)[
            0
        ]
        scene = prepare_scene(self.seen_by(shot.camera_to_room), PlainModels())
        options = DrawOptions(outputs=("semantic", "instance"))
        return visible_furniture(next(draw_shots(scene, [shot], options)))

    def seen_by(self, camera_to_room: np.ndarray) -> BlockVolume:
        """Return the volume for a camera outside, with the walls on its side cut down to a rim.

        All cameras on the same two sides get the same object.
        """
        forward = carry_camera(camera_to_room, invert(self.volume.block_to_room))[:3, 2]
        near = (1 if forward[0] < 0 else -1, 1 if forward[2] < 0 else -1)
        if near not in self._cuts:
            cut = [without_near_walls(one, *near) for one in self._parts]
            self._cuts[near] = arrange_side_by_side(cut)
        return self._cuts[near]
