"""Rooms as triangles and as points, made without the code under test."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.types import Camera

CAMERA = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)  # That of box_room.
SMALL = Camera(40, 30, 20.0, 20.0, 20.0, 15.0)
SIZE_M = (4.2, 3.1, 2.6)
BOXES = (
    ((1.4, 1.2, 0.68, 2.6, 2.0, 0.72), (150, 100, 60)),  # A table's top and two of its legs,
    ((1.4, 1.2, 0.0, 1.46, 1.26, 0.68), (150, 100, 60)),
    ((2.54, 1.94, 0.0, 2.6, 2.0, 0.68), (150, 100, 60)),
    ((0.0, 0.6, 0.0, 0.6, 2.2, 0.9), (40, 60, 160)),  # a counter,
    ((3.7, 0.0, 0.0, 4.2, 1.0, 2.0), (200, 40, 40)),  # and a wardrobe.
)
SIDES = ((230, 225, 210), (220, 215, 200), (120, 90, 60), (245, 245, 245))  # x, y, floor, ceiling.


@dataclass(frozen=True)
class Quads:
    """``corners`` float64 [Q, 4, 3], ``colour`` uint8 [Q, 3], ``labels`` uint8 [Q]."""

    corners: np.ndarray
    colour: np.ndarray
    labels: np.ndarray

    def triangles(self):
        """Vertices [4 Q, 3], faces [2 Q, 3], colours [4 Q, 3] and labels [2 Q]."""
        first = 4 * np.arange(len(self.corners))[:, None]
        faces = np.concatenate([first + np.array(corners) for corners in ((0, 1, 2), (0, 2, 3))])
        colour = np.repeat(self.colour, 4, axis=0)
        return self.corners.reshape(-1, 3), faces, colour, np.tile(self.labels, 2)

    def points(self, apart_m=0.02, noise_m=0.0, seed=0):
        """Points at random on all quads, with their colours and labels."""
        rng = np.random.default_rng(seed)
        across = self.corners[:, 1] - self.corners[:, 0]
        along = self.corners[:, 3] - self.corners[:, 0]
        area = np.linalg.norm(across, axis=1) * np.linalg.norm(along, axis=1)
        count = int(area.sum() / apart_m**2)
        own = rng.choice(len(area), count, p=area / area.sum())
        share = rng.random((count, 2))
        points = self.corners[own, 0] + share[:, :1] * across[own] + share[:, 1:] * along[own]
        points += noise_m * rng.standard_normal(points.shape)
        return points, self.colour[own], self.labels[own]


def box_quads(low, high, inward=False):
    """The six sides of a box, [6, 4, 3], counter-clockwise as seen from outside (or inside)."""
    corners = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            quad = np.tile(np.asarray(low, float), (4, 1))
            quad[:, axis] = (low, high)[side][axis]
            quad[1:3, u] = high[u]
            quad[2:4, v] = high[v]
            corners.append(quad if (side == 1) != inward else quad[::-1])
    return np.array(corners)


def room_quads(size_m=SIZE_M, boxes=BOXES, without=()):
    """A room's shell, seen from inside, and its boxes; ``without`` names sides 0 to 5 to leave."""
    kept = [side for side in range(6) if side not in without]
    shell = box_quads((0, 0, 0), size_m, inward=True)[kept]
    colours = [SIDES[0], SIDES[0], SIDES[1], SIDES[1], SIDES[2], SIDES[3]]
    labels = [3, 3, 3, 3, 2, 1]
    corners, colour = [shell], [np.array(colours, np.uint8)[kept]]
    label = [np.array(labels, np.uint8)[kept]]
    for box, own in boxes:
        corners.append(box_quads(box[:3], box[3:]))
        colour.append(np.tile(np.array(own, np.uint8), (6, 1)))
        label.append(np.full(6, 8 if own[0] == 150 else 10, np.uint8))
    return Quads(np.concatenate(corners), np.concatenate(colour), np.concatenate(label))


def rays_of(camera):
    v, u = np.mgrid[: camera.height_px, : camera.width_px] + 0.5
    x, y = (u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px
    return np.stack([x, y, np.ones_like(x)], axis=-1)
