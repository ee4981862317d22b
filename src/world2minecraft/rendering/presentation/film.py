"""Frames of films of a room: its cells and its blocks from outside, captions, and fades."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.classes import CLASS_COLOURS, SemanticClass
from world2minecraft.core.types import Camera, OccupancyGrid
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.presentation.opened_room import OpenedBuild
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.rendering.views.orbit import orbit_shots
from world2minecraft.rendering.voxel_camera import cast_voxels

ELEVATION_DEG, FOV_DEG = 38.0, 36.0
PAPER, INK = (242, 242, 238), (28, 30, 34)
SHADES = np.array([0.80, 0.80, 0.90, 0.90, 1.0, 0.6])  # Of faces along x, y and z.
SUPERSAMPLE = 2
WALL_CELLS = 4  # A near wall is so thick at most.
FADE = 4  # Frames between two parts.


@dataclass(eq=False)
class RoomStage:
    """A room seen from outside, opened towards the camera.

    Attributes:
        build: The blocks.
        grid: The cells of the same room.
        size_px: Width and height of a frame.
    """

    build: OpenedBuild
    grid: OccupancyGrid
    size_px: tuple[int, int]
    _scenes: dict[int, BlockScene] = field(default_factory=dict)

    @property
    def camera(self) -> Camera:
        """The camera of all frames."""
        return camera_of(*self.size_px, vertical_fov_deg=FOV_DEG)

    def turning_poses(self, count: int, turn_deg: float) -> list[np.ndarray]:
        """Return poses of a slow orbit about the side from which most furniture is visible.

        Args:
            count: Number of poses.
            turn_deg: The angle from the first pose to the last.
        """
        start_deg = self.build.best_start_deg(ELEVATION_DEG) - turn_deg / 2
        every = max(round(count * 360 / turn_deg), count)
        shots = orbit_shots(
            self.build.whole, self.camera, every, elevation_deg=ELEVATION_DEG, start_deg=start_deg
        )
        return [shot.camera_to_room for shot in shots[:count]]

    def opened_labels(self, pose: np.ndarray) -> np.ndarray:
        """Return the labels uint8 [X, Y, Z] without ceiling and the walls on the camera's side."""
        forward = pose[:3, 2]
        labels = np.where(self.grid.labels == 255, 0, self.grid.labels).astype(np.uint8)
        labels[labels == SemanticClass.CEILING] = 0
        occupied = np.argwhere(labels > 0)
        if not len(occupied):
            return labels
        low, high = occupied.min(axis=0), occupied.max(axis=0)
        wall = np.isin(labels, (SemanticClass.WALL, SemanticClass.WINDOW))
        for axis in (0, 1):
            layer = np.arange(labels.shape[axis])
            is_low = forward[axis] > 0
            near = layer < low[axis] + WALL_CELLS if is_low else layer > high[axis] - WALL_CELLS
            shape = [-1 if n == axis else 1 for n in range(3)]
            labels[wall & near.reshape(shape)] = 0
        return labels

    def cells(
        self, pose: np.ndarray, labels: np.ndarray, colours: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return a frame of cells, uint8 [H, W, 3], and their depth in metres, 0 for none.

        Args:
            pose: Camera-to-room transform.
            labels: Labels of the cells that are drawn, uint8 [X, Y, Z].
            colours: Colour of each cell, uint8 [X, Y, Z, 3]. Defaults to that of its class.
        """
        hits = cast_voxels(
            labels, self.camera, pose, voxel_m=self.grid.voxel_m, origin_m=self.grid.origin_m
        )
        hit = hits.voxel_index >= 0
        index = np.where(hit, hits.voxel_index, 0)
        if colours is None:
            painted = np.array(CLASS_COLOURS, np.float64)[labels.reshape(-1)[index]]
        else:
            painted = colours.reshape(-1, 3)[index].astype(np.float64)
        shaded = painted * SHADES[np.where(hit, hits.face, 0)][..., None]
        return np.where(hit[..., None], shaded, np.array(PAPER)).astype(np.uint8), hits.depth_m

    def blocks(self, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return a frame of the blocks, uint8 [H, W, 3], and their depth in metres, 0 for none."""
        seen = self.build.seen_by(pose)
        if id(seen) not in self._scenes:  # The build keeps the few volumes that it returns.
            self._scenes[id(seen)] = prepare_scene(seen)
        scene = self._scenes[id(seen)]
        picture = render_volume(
            scene, self.camera, pose, outputs=("colour", "depth"), samples=SUPERSAMPLE
        )
        depth_m = np.asarray(picture.depth_m)
        sky = (depth_m == 0)[..., None]
        return np.where(sky, np.array(PAPER, np.uint8), np.asarray(picture.colour)), depth_m


def with_caption(frame: np.ndarray, text: str) -> np.ndarray:
    """Return a frame with a text in its lower left corner."""
    if not text:
        return frame
    image = Image.fromarray(frame)
    unit = image.height / 540
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(round(26 * unit))
    left, top, bottom = round(18 * unit), image.height - round(62 * unit), round(18 * unit)
    width = font.getlength(text)
    box = (left, top, left + round(28 * unit) + width, image.height - bottom)
    draw.rounded_rectangle(box, round(8 * unit), INK)
    draw.text((round(32 * unit), image.height - round(55 * unit)), text, PAPER, font)
    return np.asarray(image)


def joined(parts: Sequence[tuple[str, Sequence[np.ndarray]]]) -> list[np.ndarray]:
    """Return the frames of all parts, with captions.

    Each part fades in over the last frame of the one before.
    """
    result: list[np.ndarray] = []
    before: np.ndarray | None = None
    for text, frames in parts:
        for number, frame in enumerate(frames):
            share = min((number + 1) / (FADE + 1), 1.0)
            mixed = frame if before is None else before * (1 - share) + frame * share
            result.append(with_caption(np.asarray(mixed, np.uint8), text))
        before = frames[-1].astype(np.float32)
    return result
