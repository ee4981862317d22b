"""View planning for scans: the camera looks at surfaces that were seen least or from few sides.

Coarse rays in all directions find the surfaces around a position. Every possible image is a window
of these directions, so choosing among hundreds of views takes a few milliseconds.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.rendering.grid_traversal import trace_ray
from world2minecraft.rendering.scene_tables import NO_FACE
from world2minecraft.rendering.voxel_camera import VoxelScene

RAY_DEG = 4.0
PITCH_DEG = (-74.0, 50.0)  # Of the look around.
# How high the camera is held, and how gladly: level and slightly down, seldom up at a ceiling.
PITCHES_DEG = np.array([14.0, 2.0, -10.0, -22.0, -34.0, -46.0])
PITCH_WORTH = np.array([0.75, 0.95, 1.0, 1.0, 1.0, 0.8])
PATCH_M = 0.16  # Side of the patches of surface that are counted as seen.
SIDES = 4  # Of the compass, from which a patch can be seen.
NEAR_M, GOOD_M, FAR_M = 0.5, 2.6, 4.5  # Nothing nearer counts; all up to good; little at far.
FAR_WORTH = 0.25
SQUARE_COSINE = 0.5  # Surfaces seen more askew than by 60 degrees count less.
NEW_SIDE = np.array([1.0, 0.35, 0.15, 0.08])  # By the sides from which it was seen before.
REPEAT_WORTH = 0.15  # What each look from a side leaves of the worth of the next from there.
TURN_PER_M = np.radians(300.0)  # How far one turns while walking a metre, or staying as long.
TURN_LIMITS = np.radians([6.0, 100.0])
CLASS_WORTH = np.ones(12)
CLASS_WORTH[[int(SemanticClass.CEILING), int(SemanticClass.FLOOR)]] = 0.4, 0.6
CLASS_WORTH[[int(SemanticClass.WALL), int(SemanticClass.WINDOW)]] = 0.8
CLASS_WORTH[5:] = 2.0  # Furniture and objects.


class ViewPlanner:
    """A planner of viewing directions along one tour that remembers the surfaces already seen."""

    def __init__(
        self,
        scene: VoxelScene,
        camera: Camera,
        pace_m: float,
        most: tuple[float, float] | None = None,
    ):
        """Create a planner that has seen no surface.

        Args:
            scene: The result of ``prepare_voxels`` for the room.
            camera: The camera, whose field of view is used.
            pace_m: Distance in metres from one image to the next.
            most: Maximum change of yaw and pitch between images, in radians. The default is
                unlimited.
        """
        self._scene = scene
        self._patch = max(1, round(PATCH_M * scene.cells_per_metre))
        self._shape = tuple(-(-side // self._patch) for side in scene.cells.shape)
        self._seen = np.zeros((int(np.prod(self._shape)), SIDES), np.uint8)
        self._yaws = np.radians(np.arange(0, 360, RAY_DEG))
        self._pitches = np.radians(np.arange(*PITCH_DEG, RAY_DEG))
        across = np.arctan(camera.width_px / 2 / camera.fx_px)
        down = np.arctan(camera.height_px / 2 / camera.fy_px)
        self._half = (round(across / np.radians(RAY_DEG)), round(down / np.radians(RAY_DEG)))
        self._limit = float(np.clip(TURN_PER_M * pace_m, *TURN_LIMITS))
        self._most = most
        self._yaw: float | None = None
        self._pitch = 0.0

    def next_direction(self, eye_m: np.ndarray) -> tuple[float, float]:
        """Choose the yaw and pitch of the next image, in radians, and mark its surfaces as seen."""
        patch, worth, side = self._look_around(eye_m)
        fresh = self._freshness(patch, side)
        gain = self._windows(worth * fresh) * PITCH_WORTH[:, None]
        if self._yaw is not None:
            off = np.abs((self._yaws - self._yaw + np.pi) % (2 * np.pi) - np.pi)
            gain = gain / (1 + (off / self._limit) ** 2)
            if self._most is not None:
                steep = np.abs(np.radians(PITCHES_DEG) - self._pitch)
                near = (off <= self._most[0] + 1e-9) & (steep[:, None] <= self._most[1] + 1e-9)
                gain = np.where(near, gain, -1.0)
        row, column = np.unravel_index(int(gain.argmax()), gain.shape)
        self._remember(patch, worth, side, int(row), int(column))
        self._yaw = float(self._yaws[column])
        self._pitch = float(np.radians(PITCHES_DEG[row]))
        return self._yaw, self._pitch

    def _look_around(self, eye_m: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the patch, the value of seeing it and its side, [P, Y] by pitch and yaw."""
        pitch, yaw = np.meshgrid(self._pitches, self._yaws, indexing="ij")
        cosine = np.cos(pitch)
        ahead = np.stack([np.cos(yaw) * cosine, np.sin(yaw) * cosine, np.sin(pitch)], axis=-1)
        per_m = self._scene.cells_per_metre
        eye = self._scene.room_to_grid[:3, :3] @ eye_m + self._scene.room_to_grid[:3, 3]
        index, far, square = _cast(self._scene.cells, eye, ahead.reshape(-1, 3))
        far_m = (far / per_m).reshape(pitch.shape)
        label = self._scene.semantic.reshape(-1)[np.maximum(index, 0)]
        cells = np.unravel_index(np.maximum(index, 0), self._scene.cells.shape)
        patch = np.ravel_multi_index([axis // self._patch for axis in cells], self._shape)
        worth = CLASS_WORTH[np.minimum(label, 11)] * np.minimum(square / SQUARE_COSINE, 1)
        worth = np.where(index < 0, 0, worth).reshape(pitch.shape)
        # A ray stands for the surface around it, up to the whole of its patch.
        worth *= np.minimum(far_m * np.radians(RAY_DEG), PATCH_M) ** 2 * cosine
        worth *= np.interp(far_m, [NEAR_M, NEAR_M, GOOD_M, FAR_M, FAR_M], [0, 1, 1, FAR_WORTH, 0])
        side = (yaw * SIDES / (2 * np.pi)).astype(np.int64) % SIDES
        return np.reshape(patch, pitch.shape), worth, side

    def _freshness(self, patch: np.ndarray, side: np.ndarray) -> np.ndarray:
        seen = self._seen[patch]
        here = np.take_along_axis(seen, side[..., None], axis=-1)[..., 0]
        others = (seen > 0).sum(axis=-1) - (here > 0)
        return NEW_SIDE[np.minimum(others, SIDES - 1)] * REPEAT_WORTH ** here.astype(np.float64)

    def _windows(self, value: np.ndarray) -> np.ndarray:
        """Return the sum over each image's window, float64 [pitches, yaws]."""
        across = self._half[0]
        wrapped = np.concatenate([value[:, -across:], value, value[:, : across + 1]], axis=1)
        sums = np.zeros((value.shape[0] + 1, wrapped.shape[1] + 1))
        sums[1:, 1:] = wrapped.cumsum(axis=0).cumsum(axis=1)
        columns = sums[:, 2 * across + 1 :][:, : value.shape[1]] - sums[:, : value.shape[1]]
        rows = [self._rows(pitch) for pitch in np.radians(PITCHES_DEG)]
        return np.array([columns[last] - columns[first] for first, last in rows])

    def _rows(self, pitch: float) -> tuple[int, int]:
        middle = round((pitch - self._pitches[0]) / np.radians(RAY_DEG))
        down = self._half[1]
        return max(0, middle - down), min(len(self._pitches), middle + down + 1)

    def _remember(
        self, patch: np.ndarray, worth: np.ndarray, side: np.ndarray, row: int, column: int
    ) -> None:
        across = self._half[0]
        first, last = self._rows(float(np.radians(PITCHES_DEG[row])))
        columns = np.arange(column - across, column + across + 1) % len(self._yaws)
        window = np.ix_(np.arange(first, last), columns)
        useful = worth[window] > 0
        seen = np.unique(patch[window][useful] * SIDES + side[window][useful])
        counts = self._seen.reshape(-1)
        counts[seen] = np.minimum(counts[seen], 250) + 1


@njit
def _cast(cells, eye, ahead):
    """Return the cell, distance in cells and cosine of the surface in each direction."""
    ny, nz = cells.shape[1], cells.shape[2]
    count = ahead.shape[0]
    index = np.full(count, -1, np.int64)
    far, square = np.zeros(count), np.zeros(count)
    for n in range(count):
        dx, dy, dz = ahead[n, 0], ahead[n, 1], ahead[n, 2]
        t, i, j, k, face = trace_ray(cells, eye[0], eye[1], eye[2], dx, dy, dz, 0.0)
        if face == NO_FACE:
            continue
        index[n], far[n] = (i * ny + j) * nz + k, t
        square[n] = abs(dx) if face < 2 else (abs(dy) if face < 4 else abs(dz))
    return index, far, square
