"""Assessment of views with small renderings, to discard blocked, empty, flat or dark views."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import BlockVolume
from world2minecraft.geometry.undistort import pinhole_camera
from world2minecraft.minecraftocc.tours.types import TourRule
from world2minecraft.rendering.batch import render_batch
from world2minecraft.rendering.scene import BlockScene

WIDE_PX = 64  # Width of the small images.
# A blocked view has this share of pixels nearer than NEAR_M, or half of them nearer than CLOSE_M.
NEAR_M, NEAR_SHARE, CLOSE_M = 0.5, 0.25, 0.95
OUT_SHARE = 0.45  # Maximum share of windows and sky.
MIN_CLASSES, MIN_OBJECTS = 3, 0.05  # Number of classes, and share of objects.
# Visible blocks: the first, and one more for each block in a square metre, up to the second.
MIN_CELLS, MIN_CELLS_LIMIT = 20, 60
LEVEL_FACTOR = 1.4  # How much more of an image floor and ceiling may take up than a wall.
THING_SHARE = 0.003  # Minimum share of the image of a visible object.
MIN_BRIGHTNESS, MAX_BRIGHTNESS = 0.10, 0.97  # Of the mean of the small image, 0 to 1.


@dataclass(frozen=True, eq=False)
class ViewQuality:
    """Measurements of N views on small images, float64 [N] each.

    Attributes:
        near: Fraction of pixels closer than ``NEAR_M``.
        middle_m: Median depth in metres.
        out: Fraction of pixels that show sky or windows.
        classes: Number of visible classes.
        things: Fraction of pixels that show furniture and objects.
        count: Number of visible pieces of furniture and objects.
        cells: Number of visible blocks.
        plane: Fraction of pixels that show the largest plane, such as a wall. For the floor and the
            ceiling, it is divided by ``LEVEL_FACTOR``.
        bright: Mean brightness from 0 to 1.
    """

    near: np.ndarray
    middle_m: np.ndarray
    out: np.ndarray
    classes: np.ndarray
    things: np.ndarray
    count: np.ndarray
    cells: np.ndarray
    plane: np.ndarray
    bright: np.ndarray

    def is_good(self, volume: BlockVolume, max_plane_share: float, min_things: int) -> np.ndarray:
        """Return whether each view of a volume is good enough to be used, bool [N].

        Args:
            volume: The volume. In one without labels, things are not counted.
            max_plane_share: Maximum share of the picture that one plane may take up.
            min_things: Minimum number of visible pieces of furniture and objects.
        """
        blocked = (self.near > NEAR_SHARE) | (self.middle_m < CLOSE_M)
        cells = min(MIN_CELLS_LIMIT, MIN_CELLS + volume.blocks_per_metre**2)
        empty = (self.out > OUT_SHARE) | (self.classes < MIN_CLASSES) | (self.cells < cells)
        if volume.semantic.any():
            empty |= self.things < MIN_OBJECTS
        if volume.instance.any():
            empty |= self.count < min_things
        dark = (self.bright < MIN_BRIGHTNESS) | (self.bright > MAX_BRIGHTNESS)
        return ~(blocked | empty | dark | (self.plane > max_plane_share))


def assess_views(
    scene: BlockScene, volume: BlockVolume, poses: np.ndarray, rule: TourRule
) -> ViewQuality:
    """Render small images of views and measure their quality.

    Args:
        scene: Scene prepared with ``prepare_scene``.
        volume: The volume. Without labels, block states are counted instead of classes.
        poses: Camera poses in the room, float64 [N, 4, 4].
        rule: Tour settings, which define the camera and the light.
    """
    outputs = ("colour", "depth", "semantic", "instance", "block", "face")
    seen = render_batch(
        scene, pinhole_camera(rule.camera, WIDE_PX), poses, outputs=outputs, light=rule.light
    )
    count = len(poses)
    depth, semantic, instance, block, face = (
        np.asarray(part).reshape(count, -1)
        for part in (seen.depth_m, seen.semantic, seen.instance, seen.block_index, seen.face)
    )
    is_sky = depth == 0
    there = np.where(is_sky, np.float32(100.0), depth)
    out = is_sky | (semantic == SemanticClass.WINDOW)
    things = (semantic >= SemanticClass.CHAIR) & (semantic != 255)
    known = semantic.astype(np.int32)
    if not scene.semantic.any():
        known = volume.states.reshape(-1)[np.maximum(block, 0)].astype(np.int32)
    classes = _distinct(np.where(is_sky | (semantic == 255), -1, known))
    owner = np.where(things & ~is_sky, instance, 0)
    return ViewQuality(
        (there < NEAR_M).mean(axis=1),
        np.median(there, axis=1),
        out.mean(axis=1),
        classes,
        things.mean(axis=1),
        _frequent(owner, THING_SHARE),
        _distinct(block),
        _largest_plane(np.where(is_sky, -1, block), face, volume.states.shape),
        np.asarray(seen.colour).mean(axis=(1, 2, 3)) / 255,
    )


def _largest_plane(block: np.ndarray, face: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """Return the fraction of the largest plane in each row, less for floors and ceilings.

    Args:
        block: Flat indices of the visible blocks, int [N, P]; negative for none.
        face: Their visible faces, int [N, P]: 0 and 1 along x, 2 and 3 along y, 4 and 5 along z.
        shape: The shape of the volume.
    """
    axis = np.minimum(face, 5).astype(np.int64) // 2
    places = np.stack(np.unravel_index(np.maximum(block, 0), shape))
    layer = np.take_along_axis(places, axis[None], axis=0)[0]
    plane = np.where(block < 0, -1, np.minimum(face, 5) + 6 * layer)
    result = np.zeros(len(plane))
    for row, planes in enumerate(plane):
        known, counts = np.unique(planes[planes >= 0], return_counts=True)
        level = known % 6 // 2 == 1
        shares = counts / len(planes) / np.where(level, LEVEL_FACTOR, 1.0)
        result[row] = shares.max(initial=0.0)
    return result


def _frequent(values: np.ndarray, share: float) -> np.ndarray:
    """Return the number of positive values that fill at least a share of each row."""
    result = np.zeros(len(values))
    for row, own in enumerate(values):
        _, counts = np.unique(own[own > 0], return_counts=True)
        result[row] = (counts >= share * len(own)).sum()
    return result


def _distinct(values: np.ndarray) -> np.ndarray:
    """Return the number of distinct non-negative values in each row."""
    ordered = np.sort(values, axis=1)
    first = np.ones(ordered.shape, bool)
    first[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
    return (first & (ordered >= 0)).sum(axis=1).astype(float)
