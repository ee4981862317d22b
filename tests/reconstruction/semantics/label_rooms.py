"""Small rooms for the tests of the labellers: surfaces as a scan sees them, insides unseen."""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.fusion import extract_grid

VOXEL_M = 0.08
MARGIN = 2  # Cells around the inner box.
WHITE, WOOD, RED, DARK, CLOTH = (
    (225, 225, 220), (170, 120, 70), (170, 30, 30), (25, 26, 30), (70, 90, 140),
)  # fmt: skip


@dataclass
class SmallRoom:
    """A room of ``size_m``, with the visible faces of boxes put into it; truth beside it."""

    size_m: tuple[float, float, float] = (3.2, 4.0, 2.4)
    ceiling: bool = True
    solid: list = field(default_factory=list)  # (box_m, class, colour), later ones on top

    def add(self, box_m, class_id, colour=WOOD):
        self.solid.append((np.array(box_m, float), class_id, colour))
        return self

    def scanned(self, *, noise_m=0.004, seed=0, votes=False):
        """Return (grid, evidence, truth): each surface point falls into its cell, with noise.

        Faces hidden by other boxes or walls are left out; cells inside boxes stay unseen.
        """
        random = np.random.default_rng(seed)
        shape = tuple(int(np.ceil(side / VOXEL_M - 1e-9)) + 2 * MARGIN for side in self.size_m)
        origin = np.full(3, -MARGIN * VOXEL_M)
        points, normals, labels, colours = self._faces()
        points = points + random.normal(0, noise_m, points.shape)
        cells = np.floor((points - 0.02 * normals - origin) / VOXEL_M).astype(int)
        inside = ((cells >= 0) & (cells < shape)).all(axis=1)
        at = tuple(cells[inside].T)
        hits = np.zeros(shape, np.int64)
        np.add.at(hits, at, 1)
        offset, colour_sum = np.zeros((2, *shape, 3), np.float64)
        centers = origin + (cells[inside] + 0.5) * VOXEL_M
        np.add.at(offset, at, points[inside] - centers)
        np.add.at(colour_sum, at, colours[inside])
        voted = np.zeros((*shape, 12), np.float32)
        np.add.at(voted, (*at, labels[inside]), 1)
        occupied = hits >= 4
        log_odds = np.where(occupied, 2.0, np.where(self._air(shape, origin), -2.0, 0.0))
        evidence = FusedEvidence(
            log_odds=log_odds.astype(np.float16),
            votes=(voted if votes else np.zeros_like(voted)).astype(np.float16),
            colour_sum=colour_sum.astype(np.float32),
            offset_sum=offset.astype(np.float32),
            hits=hits.astype(np.uint16),
            voxel_m=VOXEL_M,
            origin_m=origin,
            scan_to_room=np.eye(4),
        )
        truth = np.where(occupied, voted.argmax(axis=3), 0).astype(np.uint8)
        return extract_grid(evidence), evidence, truth

    def _faces(self):
        """Return the points of all seen faces, 2 cm apart, normals outward from matter."""
        x, y, z = self.size_m
        shell = [
            ((0, 0, -0.1, x, y, 0), 2, (120, 125, 135)),
            ((-0.1, 0, 0, 0, y, z), 3, WHITE),
            ((x, 0, 0, x + 0.1, y, z), 3, WHITE),
            ((0, -0.1, 0, x, 0, z), 3, WHITE),
            ((0, y, 0, x, y + 0.1, z), 3, WHITE),
        ]
        if self.ceiling:
            shell.append(((0, 0, z, x, y, z + 0.1), 1, WHITE))
        solids = [(np.array(box, float), c, colour) for box, c, colour in shell] + self.solid
        parts = [self._box_faces(n, solids) for n in range(len(solids))]
        return tuple(np.concatenate(columns) for columns in zip(*parts, strict=True))

    def _box_faces(self, number, solids):
        box, class_id, colour = solids[number]
        points, normals = [], []
        for axis in range(3):
            others = [a for a in range(3) if a != axis]
            grids = [np.arange(box[a] + 0.01, box[a + 3], 0.02) for a in others]
            u, v = (side.reshape(-1) for side in np.meshgrid(*grids, indexing="ij"))
            for side, way in ((box[axis], -1.0), (box[axis + 3], 1.0)):
                face = np.zeros((len(u), 3))
                face[:, others[0]], face[:, others[1]], face[:, axis] = u, v, side
                normal = np.zeros((len(u), 3))
                normal[:, axis] = way
                points.append(face)
                normals.append(normal)
        points, normals = np.concatenate(points), np.concatenate(normals)
        out = points + 0.005 * normals
        seen = ((out > 0) & (out < self.size_m)).all(axis=1)
        if not self.ceiling:
            seen &= out[:, 2] < self.size_m[2] - 0.3
        for other, (hiding, _, _) in enumerate(solids):
            if other != number:
                seen &= ~((out > hiding[:3]) & (out < hiding[3:])).all(axis=1)
        count = int(seen.sum())
        labels = np.full(count, class_id)
        return points[seen], normals[seen], labels, np.tile(np.array(colour, float), (count, 1))

    def _air(self, shape, origin):
        centers = [origin[a] + (np.arange(shape[a]) + 0.5) * VOXEL_M for a in range(3)]
        at = np.stack(np.meshgrid(*centers, indexing="ij"), axis=-1)
        air = ((at > 0) & (at < self.size_m)).all(axis=-1)
        for box, _, _ in self.solid:
            air &= ~((at > box[:3]) & (at < box[3:])).all(axis=-1)
        return air


def table(room, x, y, size=(0.8, 1.4), height=0.74):
    """Put a table with its middle at x, y."""
    w, d = size
    room.add((x - w / 2, y - d / 2, height - 0.04, x + w / 2, y + d / 2, height), 8)
    for sx in (x - w / 2, x + w / 2 - 0.08):
        for sy in (y - d / 2, y + d / 2 - 0.08):
            room.add((sx, sy, 0, sx + 0.08, sy + 0.08, height - 0.04), 8)


def chair(room, x, y, facing=1):
    """Put a chair whose back is on the side away from ``facing`` along x."""
    room.add((x - 0.22, y - 0.22, 0.42, x + 0.22, y + 0.22, 0.46), 5, (110, 70, 40))
    back = x - 0.22 if facing > 0 else x + 0.18
    room.add((back, y - 0.22, 0.46, back + 0.04, y + 0.22, 0.9), 5, (110, 70, 40))
    for sx in (x - 0.22, x + 0.16):
        for sy in (y - 0.22, y + 0.16):
            room.add((sx, sy, 0, sx + 0.06, sy + 0.06, 0.42), 5, (110, 70, 40))


def sofa(room, x, y):
    """Put a sofa with its back towards y = 0, its back left corner at x, y."""
    room.add((x, y, 0, x + 1.8, y + 0.9, 0.44), 7, CLOTH)
    room.add((x, y, 0.44, x + 1.8, y + 0.22, 0.86), 7, CLOTH)


def bed(room, x, y):
    """Put a bed, its head towards x = 0, a corner at x, y."""
    room.add((x, y, 0, x + 2.0, y + 1.4, 0.5), 6, (200, 200, 230))
    room.add((x, y, 0.5, x + 0.06, y + 1.4, 1.0), 6, WOOD)
    room.add((x + 0.06, y + 0.1, 0.5, x + 0.5, y + 0.65, 0.64), 6, WHITE)
    room.add((x + 0.06, y + 0.75, 0.5, x + 0.5, y + 1.3, 0.64), 6, WHITE)


def label_share(result: OccupancyGrid, truth: np.ndarray, class_id: int) -> float:
    """Return the share of a true class's cells that got their class."""
    return float((result.labels[truth == class_id] == class_id).mean())
