"""Views that show a whole room at once: an oblique dollhouse view and a floor plan."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply, look_at
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.cutaway import (
    arrange_side_by_side,
    split_storeys,
    without_ceiling,
    without_near_walls,
    without_partitions,
)
from world2minecraft.rendering.picture import (
    MAX_PIXELS,
    picture_colour,
    render_parallel,
    render_volume,
    visible_furniture,
)
from world2minecraft.rendering.plain_models import PlainModels
from world2minecraft.rendering.scene import prepare_scene
from world2minecraft.rendering.shading_parameters import BACKDROP, NEUTRAL

ELEVATION_DEG = 48.0  # Steep enough to see over the furniture, flat enough to see its fronts.
TURN_DEG = 34.0  # Not the diagonal, so that the two far walls look different.
FOV_DEG = 26.0  # Narrow: nearly parallel edges read as a model of the room.
MARGIN = 1.06
SCOUT_PX = 96
# A corner that keeps this much less of the walls than the best one is not chosen. Cutting the only
# scanned wall loses 0.68 to 0.78 (lounge, kitchen, NYU living room), one of two 0.36 (SUN RGB-D);
# the corners of closed rectangular rooms differ by less than 0.1.
MAX_WALL_LOSS = 0.2
SUPERSAMPLE = 2
CORNERS = ((-1, 1), (1, 1), (1, -1), (-1, -1))


class PreviewView(NamedTuple):
    """What a preview shows, and from where.

    Attributes:
        cut: The volume without its ceiling and near walls, with storeys side by side.
        near: The sides without walls: signs of room x and of room y.
        storeys: The number of storeys.
        camera: The camera.
        camera_to_room: Its pose, float64 [4, 4].
    """

    cut: BlockVolume
    near: tuple[int, int]
    storeys: int
    camera: Camera
    camera_to_room: np.ndarray


def preview(volume: BlockVolume, width_px: int = 1280, height_px: int = 960) -> np.ndarray:
    """Return an oblique cutaway image of a room from above, uint8 [height, width, 3].

    The ceiling and the two near walls are removed. The camera looks from the corner from which most
    furniture is visible, among those at which few scanned walls must be removed. The storeys of a
    house are shown side by side.

    Args:
        volume: A built room.
        width_px: Image width in pixels.
        height_px: Image height in pixels.

    Raises:
        ValueError: If the image would be too large.
    """
    return render_preview(preview_view(volume, width_px, height_px))


def preview_view(volume: BlockVolume, width_px: int = 1280, height_px: int = 960) -> PreviewView:
    """Return what ``preview`` shows, and from where; the arguments and errors are the same."""
    _check_size(width_px, height_px)
    opened = [without_partitions(without_ceiling(one)) for one in split_storeys(volume)]
    side = _best_corner(opened)
    cut = arrange_side_by_side([without_near_walls(one, *side) for one in opened])
    camera, pose = dollhouse_camera(cut, *side, width_px, height_px)
    return PreviewView(cut, (side[0], -side[1]), len(opened), camera, pose)  # Block z is room -y.


def render_preview(view: PreviewView) -> np.ndarray:
    """Render a preview as uint8 [height, width, 3]."""
    picture = render_volume(
        view.cut,
        view.camera,
        view.camera_to_room,
        outputs=("colour",),
        light=NEUTRAL,
        samples=SUPERSAMPLE,
        threads=usable_cores(),
    )
    return picture_colour(picture)


def _best_corner(opened: Sequence[BlockVolume]) -> tuple[int, int]:
    """Return the near sides (x, z) that leave the walls and show most of the furniture."""
    walls = {
        side: sum(_count_walls(without_near_walls(one, *side)) for one in opened)
        for side in CORNERS
    }
    least = max(walls.values()) - MAX_WALL_LOSS * sum(map(_count_walls, opened))
    open_sides = [side for side in CORNERS if walls[side] >= least]
    return max(open_sides, key=lambda side: sum(_visible_furniture(one, *side) for one in opened))


def _count_walls(volume: BlockVolume) -> int:
    """Return the number of blocks that are wall or window."""
    return int(np.isin(volume.semantic, (SemanticClass.WALL, SemanticClass.WINDOW)).sum())


def _visible_furniture(opened: BlockVolume, near_x: int, near_z: int) -> float:
    """Return the sum over all objects of the square root of their visible pixels."""
    cut = without_near_walls(opened, near_x, near_z)
    camera, pose = dollhouse_camera(cut, near_x, near_z, SCOUT_PX, SCOUT_PX * 3 // 4)
    scene = prepare_scene(cut, PlainModels())
    picture = render_volume(scene, camera, pose, outputs=("semantic", "instance"))
    return visible_furniture(picture)


def dollhouse_camera(
    volume: BlockVolume, near_x: int, near_z: int, width_px: int, height_px: int
) -> tuple[Camera, np.ndarray]:
    """Return a camera and its ``camera_to_room`` that see all blocks from an upper corner."""
    points_m = _outline_points_m(volume)
    low, high = points_m.min(axis=0), points_m.max(axis=0)
    along, across = np.cos(np.radians(TURN_DEG)), np.sin(np.radians(TURN_DEG))
    if high[0] - low[0] > high[1] - low[1]:  # The long side lies across the picture.
        along, across = across, along
    flat = np.array([near_x * along, -near_z * across])  # Block z is room -y.
    up = np.radians(ELEVATION_DEG)
    toward_eye = np.array([*(flat * np.cos(up)), np.sin(up)])
    focal = min(width_px, height_px * 4 / 3) / (2 * np.tan(np.radians(FOV_DEG) / 2))
    middle = (low + high) / 2
    distance = _distance_that_fits(points_m - middle, toward_eye, focal, width_px, height_px)
    pose = look_at(middle + toward_eye * distance, middle)
    seen = apply(np.linalg.inv(pose), points_m)
    u, v = focal * seen[:, 0] / seen[:, 2], focal * seen[:, 1] / seen[:, 2]
    centre_x = width_px / 2 - (u.min() + u.max()) / 2
    centre_y = height_px / 2 - (v.min() + v.max()) / 2
    return Camera(width_px, height_px, focal, focal, centre_x, centre_y), pose


def _distance_that_fits(points, toward_eye, focal, width_px, height_px) -> float:
    """Return the least distance from which all points lie within the picture, by bisection."""
    near, far = 0.5, 500.0
    for _ in range(40):
        distance = (near + far) / 2
        seen = apply(np.linalg.inv(look_at(toward_eye * distance, np.zeros(3))), points)
        if (seen[:, 2] <= 0.1).any():
            near = distance
            continue
        spans = focal * np.ptp(seen[:, :2] / seen[:, 2:], axis=0) * MARGIN
        if spans[0] > width_px or spans[1] > height_px:
            near = distance
        else:
            far = distance
    return far


def _outline_points_m(volume: BlockVolume) -> np.ndarray:
    """Return points, float64 [N, 3] in room metres, whose convex hull holds all blocks."""
    filled = volume.states != 0
    if not filled.any():
        filled = np.ones_like(filled)
    columns = np.argwhere(filled.any(axis=1))
    own = filled[columns[:, 0], :, columns[:, 1]]
    low, high = own.argmax(axis=1), own.shape[1] - own[:, ::-1].argmax(axis=1)
    points = [
        np.stack([columns[:, 0] + dx, level, columns[:, 1] + dz], axis=1)
        for level in (low, high)
        for dx in (0, 1)
        for dz in (0, 1)
    ]
    corners = np.unique(np.concatenate(points), axis=0) + np.array(volume.corner)
    return apply(volume.block_to_room, corners.astype(np.float64))


def plan_view(volume: BlockVolume, px_per_block: int = 8) -> np.ndarray:
    """Return a plan of the room, seen from below its ceiling, as uint8 [H, W, 3].

    Room +x points right and room +y points up. The storeys of a house are shown side by side.

    Args:
        volume: A built room.
        px_per_block: Pixels per block.

    Raises:
        ValueError: If ``px_per_block`` is less than 1, or if the plan would be too large.
    """
    if px_per_block < 1:
        raise ValueError(f"px_per_block must be at least 1, got {px_per_block}")
    opened = arrange_side_by_side([without_ceiling(one) for one in split_storeys(volume)])
    x_blocks, _, z_blocks = opened.states.shape
    size = (z_blocks * px_per_block, x_blocks * px_per_block)
    _check_size(size[1], size[0])
    middle = np.array(opened.corner) + np.array(opened.states.shape) / 2
    middle[1] = opened.corner[1] + opened.states.shape[1] + 1
    down = np.diag([1.0, -1.0, -1.0, 1.0])
    down[:3, 3] = apply(volume.block_to_room, middle)
    picture = render_parallel(
        prepare_scene(opened),
        px_per_block * volume.blocks_per_metre,
        size,
        down,
        outputs=("colour",),
        samples=SUPERSAMPLE,
        threads=usable_cores(),
        light=NEUTRAL,
        background=(BACKDROP[0], BACKDROP[0]),
    )
    return picture_colour(picture)


def _check_size(width_px: int, height_px: int) -> None:
    samples = width_px * height_px * SUPERSAMPLE**2
    if width_px < 1 or height_px < 1 or samples > MAX_PIXELS:
        raise ValueError(f"the image size {width_px}x{height_px} pixels is out of range")
