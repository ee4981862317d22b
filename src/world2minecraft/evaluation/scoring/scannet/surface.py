"""A labelled surface as fine voxels, each with the class and the object of most of it.

A triangle is cut into pieces smaller than a voxel. The middle of each, half a voxel deep in the
matter, says which voxel it fills: so a wall whose face lies between two voxels fills the one
behind it, as a solid wall does. Which way the matter lies, the order of a triangle's corners tells;
the floor, whose matter lies below, tells whether a file counts them the other way round.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.errors import LimitError
from world2minecraft.evaluation.scoring.scannet.labelled_mesh import LabelledMesh
from world2minecraft.evaluation.scoring.visibility import MAX_CELLS

PIECE = 0.75  # Of a voxel: the longest side of a piece.
MARGIN = 2  # Free voxels around it all.
CHUNK_M2 = 4.0  # Of surface at a time, some 200,000 pieces.
MOST_VALUES = 1 << 16


@dataclass(frozen=True, eq=False)
class SurfaceVoxels:
    """Voxels of a surface: its classes (255 none), which they are, and their objects."""

    labels: np.ndarray  # uint8 [A, B, C], 255 where there is no surface or no class
    surface: np.ndarray  # bool [A, B, C]
    instance: np.ndarray  # uint16 [A, B, C]
    origin_m: np.ndarray  # float64 [3], a whole multiple of the voxel


def surface_voxels(mesh: LabelledMesh, voxel_m: float) -> SurfaceVoxels:
    """Return the voxels that a mesh fills.

    Args:
        mesh: upright, in metres.
        voxel_m: the side of a voxel.

    Raises:
        LimitError: it spans more voxels than are kept.
    """
    low = np.floor(mesh.vertices_m.min(axis=0) / voxel_m).astype(np.int64) - MARGIN
    high = np.ceil(mesh.vertices_m.max(axis=0) / voxel_m).astype(np.int64) + MARGIN
    shape = high - low
    if np.prod(shape, dtype=np.float64) > MAX_CELLS:
        sides = " x ".join(f"{side * voxel_m:.0f}" for side in shape)
        raise LimitError(mesh.name, f"spans {sides} m; that is no room")
    first, second, third = mesh.triangles.T
    chosen = np.where(mesh.classes[second] == mesh.classes[third], second, first)
    classes, instance = mesh.classes[chosen], mesh.instance[chosen]
    inward = -_normals(mesh, classes)
    votes_of = {"class": _Votes(), "instance": _Votes()}
    for middles, owner in _pieces(mesh.vertices_m[mesh.triangles], PIECE * voxel_m):
        inside = middles + inward[owner] * (voxel_m / 2)
        cells = np.floor(inside / voxel_m).astype(np.int64) - low
        at = np.asarray(np.ravel_multi_index(tuple(cells.T), tuple(shape)))
        votes_of["class"].add(at, classes[owner])
        votes_of["instance"].add(at, instance[owner])
    labels = np.full(shape, UNKNOWN, np.uint8)
    surface, owners = np.zeros(shape, bool), np.zeros(shape, np.uint16)
    at, most = votes_of["class"].winners()
    labels.reshape(-1)[at], surface.reshape(-1)[at] = most, True
    at, most = votes_of["instance"].winners()
    owners.reshape(-1)[at] = most
    return SurfaceVoxels(labels, surface, owners, low * voxel_m)


class _Votes:
    """Counts of values by voxel, summed up chunk by chunk."""

    def __init__(self) -> None:
        self.keys: list[np.ndarray] = []
        self.counts: list[np.ndarray] = []

    def add(self, at: np.ndarray, values: np.ndarray) -> None:
        """Count values [N], under ``MOST_VALUES``, of the voxels with flat indices [N]."""
        keys, counts = np.unique(at * MOST_VALUES + values, return_counts=True)
        self.keys.append(keys)
        self.counts.append(counts)

    def winners(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the flat indices of the voxels, and the value of each with most votes.

        The lowest of a tie wins.
        """
        keys, group = np.unique(np.concatenate(self.keys), return_inverse=True)
        counts = np.bincount(group, np.concatenate(self.counts)).astype(np.int64)
        at, values = keys // MOST_VALUES, keys % MOST_VALUES
        order = np.lexsort((-values, counts, at))
        last = np.flatnonzero(np.append(np.diff(at[order]) > 0, True))
        return at[order][last], values[order][last]


def _normals(mesh: LabelledMesh, classes: np.ndarray) -> np.ndarray:
    """Return unit normals float64 [T, 3] that look away from the matter; 0 of empty triangles."""
    corners = mesh.vertices_m[mesh.triangles]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if cross[classes == SemanticClass.FLOOR, 2].sum() < 0:
        cross = -cross
    return cross / np.maximum(np.linalg.norm(cross, axis=1), 1e-300)[:, None]


def _pieces(corners: np.ndarray, longest_m: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the middles float64 [P, 3] of small pieces and the triangles int64 [P] they are of."""
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    chunk = (np.linalg.norm(cross, axis=1) / 2).cumsum() // CHUNK_M2
    starts = np.append(np.flatnonzero(np.diff(chunk, prepend=-1)), len(corners))
    for start, stop in pairwise(starts):
        yield _cut(corners[start:stop], np.arange(start, stop), longest_m)


def _cut(corners: np.ndarray, owner: np.ndarray, longest_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Halve triangles [T, 3, 3] at their longest sides until all are short."""
    middles, owners = [], []
    while len(corners):
        sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        is_long = sides.max(axis=1) > longest_m
        middles.append(corners[~is_long].mean(axis=1))
        owners.append(owner[~is_long])
        corners, owner = corners[is_long], owner[is_long]
        turned = (sides[is_long].argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(corners, turned[..., None], axis=1).transpose(1, 0, 2)
        middle = (a + b) / 2
        halves = (np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1))
        corners, owner = np.concatenate(halves), np.concatenate([owner, owner])
    return np.concatenate(middles), np.concatenate(owners)
