"""Assessment of views with small renderings, to discard blocked, empty, flat or dark views."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.undistort import pinhole_camera
from world2minecraft.minecraftocc.tours.types import TourRule
from world2minecraft.rendering.batch import render_batch
from world2minecraft.rendering.scene import BlockScene

WIDE_PX = 64  # Of the small pictures.
NEAR_M, NEAR_SHARE = 0.5, 0.25  # Blocked: so much of the picture is nearer than this,
CLOSE_M = 0.95  # or half of it is nearer than this.
OUT_SHARE = 0.45  # Looks out: so much of it is window or sky.
MIN_CLASSES, MIN_OBJECTS = 3, 0.05  # Empty: fewer classes, or a smaller share of objects,
# or few blocks: this, and one more for each in a square metre, up to the second.
MIN_CELLS, MIN_CELLS_LIMIT = 20, 60
FLAT_SHARE = 0.55  # Flat: so much of it is one wall,
PLANE_SHARE = 0.85  # or so much of it faces one way, whatever hangs there.
MIN_BRIGHTNESS, MAX_BRIGHTNESS = 0.10, 0.97  # Of 1, the mean of the small picture.


@dataclass(frozen=True, eq=False)
class ViewQuality:
    """Measurements of N views on small images, float64 [N] each.

    Attributes:
        near: Fraction of pixels closer than ``NEAR_M``.
        middle_m: Median depth in metres.
        out: Fraction of pixels that show sky or windows.
        classes: Number of visible classes.
        things: Fraction of pixels that show furniture and objects.
        cells: Number of visible blocks.
        flat: Fraction of pixels that show walls facing in the most frequent direction.
        plane: Fraction of pixels with any surface facing in the most frequent direction.
        bright: Mean brightness from 0 to 1.
    """

    near: np.ndarray  # the share of pixels nearer than NEAR_M
    middle_m: np.ndarray  # the median depth
    out: np.ndarray  # the share of sky and windows
    classes: np.ndarray  # how many are seen
    things: np.ndarray  # the share of pixels of furniture and objects
    cells: np.ndarray  # how many blocks are seen
    flat: np.ndarray  # the share of the largest wall
    plane: np.ndarray  # the share of what faces one way
    bright: np.ndarray  # 0 to 1

    def is_good(self, blocks_per_metre: float, labelled: bool) -> np.ndarray:
        """Return whether each view is good enough to be used, bool [N]."""
        blocked = (self.near > NEAR_SHARE) | (self.middle_m < CLOSE_M)
        cells = min(MIN_CELLS_LIMIT, MIN_CELLS + blocks_per_metre**2)
        empty = (self.out > OUT_SHARE) | (self.classes < MIN_CLASSES) | (self.cells < cells)
        if labelled:
            empty |= self.things < MIN_OBJECTS
        dark = (self.bright < MIN_BRIGHTNESS) | (self.bright > MAX_BRIGHTNESS)
        flat = (self.flat > FLAT_SHARE) | (self.plane > PLANE_SHARE)
        return ~(blocked | empty | dark | flat)


def assess_views(
    scene: BlockScene, states: np.ndarray, poses: np.ndarray, rule: TourRule
) -> ViewQuality:
    """Render small images of views and measure their quality.

    Args:
        scene: Scene prepared with ``prepare_scene``.
        states: Block states of the volume, used instead of classes if the volume has no labels.
        poses: Camera poses in the room, float64 [N, 4, 4].
        rule: Tour settings, which define the camera and the light.
    """
    outputs = ("colour", "depth", "semantic", "block", "face")
    seen = render_batch(
        scene, pinhole_camera(rule.camera, WIDE_PX), poses, outputs=outputs, light=rule.light
    )
    count = len(poses)
    depth, semantic, block, face = (
        np.asarray(part).reshape(count, -1)
        for part in (seen.depth_m, seen.semantic, seen.block_index, seen.face)
    )
    is_sky = depth == 0
    there = np.where(is_sky, np.float32(100.0), depth)
    out = is_sky | (semantic == SemanticClass.WINDOW)
    things = (semantic >= SemanticClass.CHAIR) & (semantic != 255)
    known = semantic.astype(np.int32)
    if not scene.semantic.any():
        known = states.reshape(-1)[np.maximum(block, 0)].astype(np.int32)
    classes = _distinct(np.where(is_sky | (semantic == 255), -1, known))
    wall = np.where(things | is_sky, 255, face)
    return ViewQuality(
        (there < NEAR_M).mean(axis=1),
        np.median(there, axis=1),
        out.mean(axis=1),
        classes,
        things.mean(axis=1),
        _distinct(block),
        _largest(wall),
        _largest(np.where(is_sky, 255, face)),
        np.asarray(seen.colour).mean(axis=(1, 2, 3)) / 255,
    )


def _largest(faces: np.ndarray) -> np.ndarray:
    """Return the fraction of the most frequent of the four vertical face directions in each row."""
    return np.max([(faces == side).mean(axis=1) for side in (0, 1, 4, 5)], axis=0)


def _distinct(values: np.ndarray) -> np.ndarray:
    """Return the number of distinct non-negative values in each row."""
    ordered = np.sort(values, axis=1)
    first = np.ones(ordered.shape, bool)
    first[:, 1:] = ordered[:, 1:] != ordered[:, :-1]
    return (first & (ordered >= 0)).sum(axis=1).astype(float)
