"""The cells of the room that a noise-free ray of a used frame reached or crossed.

The other cells cannot be observed, so they are not scored. A ray reaches at most two cells, usually
the same one: the cell of the surface point on the fine voxel, moved 1 mm inward, and the cell of
the voxel's centre. The centre alone could miss the front of a wall. The surface alone could miss a
wall behind a cell boundary, where the rule of 4 in 64 leaves the first millimetres empty.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import LimitError
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.rendering.scene_tables import FACE_NORMALS
from world2minecraft.rendering.voxel_camera import cast_voxels, prepare_voxels

CROSSED, MET = 1, 2
RAYS_WIDE = 320  # All 640 of a frame come to 0.1 % more cells, in four times the time.
PUSH_M = 0.001  # A surface on the edge of two cells belongs to the one with the matter.
MAX_CELLS = 200_000_000
Believed = Callable[[UsedFrame, np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class Reached:
    """The ray observations in a box of cells of the estimated room.

    Attributes:
        flags: Combinations of CROSSED and MET, or 0, as uint8 [X, Y, Z].
        low: The room cell at index (0, 0, 0), as int64 [3].
        voxel_m: The cell size in metres.
        voxels: The ascending flat indices of the fine voxels that rays met, as int64 [N].
    """

    flags: np.ndarray
    low: np.ndarray
    voxel_m: float
    voxels: np.ndarray

    @property
    def scored(self) -> np.ndarray:
        """The cells that a ray reached or crossed, as bool [X, Y, Z]."""
        return self.flags != 0

    @property
    def met(self) -> np.ndarray:
        """The cells in which a ray met a surface, as bool [X, Y, Z]."""
        return self.flags & MET > 0


def reached_cells(
    truth: Truth,
    frames: Sequence[UsedFrame],
    truth_to_room: np.ndarray,
    voxel_m: float,
    rays_wide: int = RAYS_WIDE,
    believed: Believed | None = None,
) -> Reached:
    """Cast the rays of all frames into the ground truth, and mark the cells of the estimated room.

    Args:
        truth: The ground truth.
        frames: The frames with their true camera poses.
        truth_to_room: The rigid 4x4 transform from the frame of the ground truth to that of the
            room.
        voxel_m: The cell size of the estimated room in metres.
        rays_wide: The number of rays across an image, at most the width of the image in pixels.
        believed: A function that selects the rays that count, as bool [H, W], from the frame and
            the ray depths, float32 [H, W] in metres. None counts all rays.
    """
    truth_to_cells = truth_to_room.copy()
    truth_to_cells[:3] /= voxel_m
    low, flags = _box(truth, frames, truth_to_cells)
    voxel_to_truth = np.eye(4) * truth.voxel_m
    voxel_to_truth[:, 3] = [*truth.origin_m, 1]
    voxel_to_cells = truth_to_cells @ voxel_to_truth
    scene = prepare_voxels(truth.solid, truth.voxel_m, truth.origin_m)
    voxels = []
    for frame in frames:
        camera = pinhole(frame.camera, rays_wide)
        hits = cast_voxels(scene, camera, frame.camera_to_truth)
        if believed is not None:
            index = np.where(believed(frame, hits.depth_m), hits.voxel_index, np.int32(-1))
            hits = hits._replace(voxel_index=index)
        _mark(
            hits.depth_m,
            hits.voxel_index,
            hits.face,
            pixel_rays(camera),
            truth_to_cells @ frame.camera_to_truth,
            voxel_to_cells,
            np.array(truth.labels.shape),
            FACE_NORMALS.astype(np.float64) * (PUSH_M / truth.voxel_m),
            low,
            flags,
        )
        voxels.append(np.unique(hits.voxel_index))
    met = np.unique(np.concatenate(voxels)) if voxels else np.zeros(0, np.int64)
    return Reached(flags, low, voxel_m, met[met >= 0].astype(np.int64))


def pinhole(camera: Camera, rays_wide: int) -> Camera:
    """Return the undistorted pinhole camera for ray casting.

    Distortion is ignored because it moves few rays to another cell.
    """
    wide = min(rays_wide, camera.width_px)
    camera = camera.resized(wide, max(round(wide * camera.height_px / camera.width_px), 1))
    return Camera(
        camera.width_px,
        camera.height_px,
        camera.fx_px,
        camera.fy_px,
        camera.cx_px,
        camera.cy_px,
    )


def _box(
    truth: Truth, frames: Sequence[UsedFrame], truth_to_cells: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest cell and empty flags of a box around the ground truth and the cameras."""
    corners = np.array(list(np.ndindex(2, 2, 2))) * truth.labels.shape * truth.voxel_m
    cameras = [frame.camera_to_truth[:3, 3] for frame in frames]
    points = apply(
        truth_to_cells, np.concatenate([corners + truth.origin_m, *[[c] for c in cameras]])
    )
    low = np.floor(points.min(axis=0)).astype(np.int64) - 1
    shape = np.ceil(points.max(axis=0)).astype(np.int64) + 1 - low
    if np.prod(shape, dtype=np.float64) > MAX_CELLS:
        raise LimitError(
            truth.folder / "truth.npz",
            f"rays span {' x '.join(map(str, shape))} cells, more than the limit",
        )
    return low, np.zeros(shape, np.uint8)


@njit
def _mark(depth_m, index, face, rays, camera_to_cells, voxel_to_cells, fine, normals, low, flags):
    """Mark the cells of one image's rays in place."""
    eye = camera_to_cells[:, 3]
    middle = np.empty(3)
    surface = np.empty(3)
    for v in range(depth_m.shape[0]):
        for u in range(depth_m.shape[1]):
            if index[v, u] < 0:
                continue
            plane = fine[1] * fine[2]
            voxel = (index[v, u] // plane, index[v, u] // fine[2] % fine[1], index[v, u] % fine[2])
            inward = normals[face[v, u]]
            z = float(depth_m[v, u])
            x, y = rays[v, u, 0] * z, rays[v, u, 1] * z
            for axis in range(3):
                a, m = camera_to_cells[axis], voxel_to_cells[axis]
                surface[axis] = a[0] * x + a[1] * y + a[2] * z + a[3]
                middle[axis] = m[3] - low[axis]
                for other in range(3):
                    middle[axis] += m[other] * (voxel[other] + 0.5)
            _cross(eye, surface, low, flags)
            for axis in range(3):
                for other in range(3):
                    surface[axis] -= voxel_to_cells[axis, other] * inward[other]
                surface[axis] -= low[axis]
            _meet(surface, flags)
            _meet(middle, flags)


@njit
def _meet(point, flags):
    """Mark the cell that contains a point, given in cells of the box."""
    i, j, k = int(np.floor(point[0])), int(np.floor(point[1])), int(np.floor(point[2]))
    flags[i, j, k] |= MET


@njit
def _cross(eye, target, low, flags):
    """Mark the cells that a ray from ``eye`` to ``target`` crosses."""
    cell, step = np.empty(3, np.int64), np.empty(3, np.int64)
    at, gap = np.empty(3), np.empty(3)
    length = 0.0
    for axis in range(3):
        way = target[axis] - eye[axis]
        length += way * way
        cell[axis] = int(np.floor(eye[axis])) - low[axis]
        step[axis] = 1 if way > 0 else -1
        gap[axis] = np.inf if way == 0 else abs(1.0 / way)
        edge = np.floor(eye[axis]) + (1 if way > 0 else 0)
        at[axis] = np.inf if way == 0 else (edge - eye[axis]) / way
    # The way counts from 0 to 1; it ends a hundredth of a cell before the surface.
    end = 1.0 - 0.01 / max(np.sqrt(length), 0.02)
    entry = 0.0
    while entry < end:
        flags[cell[0], cell[1], cell[2]] |= CROSSED
        axis = 0 if at[0] <= at[1] and at[0] <= at[2] else (1 if at[1] <= at[2] else 2)
        entry = at[axis]
        cell[axis] += step[axis]
        at[axis] += gap[axis]
