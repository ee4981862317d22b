"""A generated room as a mesh and as a point cloud, in its own frame: metres, z up."""

from pathlib import Path

import numpy as np
import trimesh

from world2minecraft.rooms import Room

NOISE_M = 0.005
POINTS = 1_500_000


def faces_of(room: Room) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the faces between matter and air: corner [N, 4, 3] in metres, normal, colour."""
    filled = np.pad(room.labels != 0, 1, constant_values=True)  # No outer side: nobody saw it.
    corners, normals, colours = [], [], []
    for axis in range(3):
        for step in (-1, 1):
            open_ = ~np.roll(filled, -step, axis)
            face = (filled & open_)[1:-1, 1:-1, 1:-1]
            cells = np.argwhere(face)
            sides = [a for a in range(3) if a != axis]
            corner = np.repeat(cells[:, None, :], 4, axis=1).astype(np.float64)
            corner[:, :, axis] += step > 0
            for n, (a, b) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
                corner[:, n, sides[0]] += a
                corner[:, n, sides[1]] += b
            corners.append(corner * room.voxel_m + room.origin_m)
            normal = np.zeros((len(cells), 3))
            normal[:, axis] = step
            normals.append(normal)
            colours.append(room.colour[tuple(cells.T)])
    return np.concatenate(corners), np.concatenate(normals), np.concatenate(colours)


def write_mesh(room: Room, path: Path) -> None:
    """Write the room's faces as a GLB with vertex colours."""
    if path.is_file():
        return
    corners, _, colours = faces_of(room)
    index = np.arange(4 * len(corners)).reshape(-1, 4)
    triangles = np.concatenate([index[:, [0, 1, 2]], index[:, [0, 2, 3]]])
    mesh = trimesh.Trimesh(
        corners.reshape(-1, 3), triangles, vertex_colors=colours.repeat(4, axis=0), process=False
    )
    mesh.export(path)


def write_cloud(room: Room, path: Path, seed: int) -> None:
    """Write points on the room's faces, 5 mm off, as a binary PLY with colours."""
    if path.is_file():
        return
    corners, normals, colours = faces_of(room)
    rng = np.random.default_rng([seed, 7])
    chosen = rng.integers(0, len(corners), POINTS)
    a, b = rng.random((2, POINTS, 1))
    one = corners[chosen]
    points = one[:, 0] + a * (one[:, 1] - one[:, 0]) + b * (one[:, 3] - one[:, 0])
    points += normals[chosen] * rng.normal(0, NOISE_M, (POINTS, 1))
    trimesh.PointCloud(points, colors=colours[chosen]).export(path)
