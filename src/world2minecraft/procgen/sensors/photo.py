"""A photo of a generated room: what its colours look like in soft room light.

One pass over the pixels gives colour, z-depth, voxel and the cosine between ray and surface. The
light is a lamp under the ceiling of each room (``lamps``) plus what the walls throw back, dimmed
where matter is near (a blurred grid of solid cells), and a fine grain, so that no surface is one
flat tone. It belongs to the spot, not to the camera: a surface has one colour from everywhere.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.lamps import hang_lamps, nearest_lamps
from world2minecraft.rendering import VoxelScene, prepare_voxels
from world2minecraft.rendering.grid_traversal import TILE, bundle_start, trace
from world2minecraft.rendering.scene_tables import NO_FACE

COARSE = 4  # Voxels of 2 cm a cell of the blurred grid: shadows are soft over 16 cm.
BLUR_CELLS = 1.6
NEAR_VOXELS = 7.0  # How far off the surface the blurred grid is read.


class Photo(NamedTuple):
    """What one look at a room gives."""

    colour: np.ndarray  # uint8 [H, W, 3]
    depth_m: np.ndarray  # float32 [H, W]
    voxel_index: np.ndarray  # int32 [H, W]
    cosine: np.ndarray  # float32 [H, W], 1 where the ray meets the surface squarely


@dataclass(frozen=True, eq=False)
class PhotoScene:
    """A room made ready for photos."""

    scene: VoxelScene
    colour: np.ndarray  # uint8 [X, Y, Z, 3]
    solid: np.ndarray  # float32, the blurred share of solid voxels
    lamps: np.ndarray  # float64 [L, 3], in voxels, one a layout
    lamp_of: np.ndarray  # uint8 [X, Y, Z] of coarse cells, the lamp that lights each


def prepare_photos(room: Room) -> PhotoScene:
    """Return the scene of a room."""
    filled = room.labels != 0
    padding = [(0, -side % COARSE) for side in filled.shape]
    padded = np.pad(filled, padding, constant_values=True)
    shape = [value for side in padded.shape for value in (side // COARSE, COARSE)]
    coarse = padded.reshape(shape).mean(axis=(1, 3, 5), dtype=np.float32)
    return PhotoScene(
        scene=prepare_voxels(room.labels, room.voxel_m, room.origin_m),
        colour=room.colour,
        solid=ndimage.gaussian_filter(coarse, BLUR_CELLS, mode="nearest"),
        lamps=(hang_lamps(room) - room.origin_m) / room.voxel_m,
        lamp_of=nearest_lamps(room, coarse.shape, COARSE * room.voxel_m),
    )


def take_photo(scene: PhotoScene, camera: Camera, camera_to_room: np.ndarray) -> Photo:
    """Take a photo through a camera of the room; lens distortion is left out."""
    size = (camera.height_px, camera.width_px)
    photo = Photo(
        np.zeros((*size, 3), np.uint8),
        np.zeros(size, np.float32),
        np.empty(size, np.int32),
        np.zeros(size, np.float32),
    )
    pose = np.ascontiguousarray((scene.scene.room_to_grid @ camera_to_room)[:3])
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    _expose(
        scene.scene.cells, scene.colour, scene.solid, scene.lamps, scene.lamp_of, pose, rays, *photo
    )
    return photo


@njit
def _expose(
    cells, colours, solid, lamps, lamp_of, pose, rays, image, depth, index, cosine
):  # fmt: skip
    height, width = depth.shape
    ny, nz = cells.shape[1], cells.shape[2]
    scale = np.sqrt(pose[0, 2] ** 2 + pose[1, 2] ** 2 + pose[2, 2] ** 2)
    for v_tile in range(0, height, TILE):
        for u_tile in range(0, width, TILE):
            start = bundle_start(cells, pose, rays, 1.0, u_tile, v_tile)
            for v in range(v_tile, min(v_tile + TILE, height)):
                for u in range(u_tile, min(u_tile + TILE, width)):
                    x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
                    dx = pose[0, 0] * x + pose[0, 1] * y + pose[0, 2]
                    dy = pose[1, 0] * x + pose[1, 1] * y + pose[1, 2]
                    dz = pose[2, 0] * x + pose[2, 1] * y + pose[2, 2]
                    t, i, j, k, face = trace(
                        cells, pose[0, 3], pose[1, 3], pose[2, 3], dx, dy, dz, start
                    )
                    if face == NO_FACE:
                        index[v, u] = -1
                        continue
                    depth[v, u] = t
                    index[v, u] = (i * ny + j) * nz + k
                    along = dx if face < 2 else (dy if face < 4 else dz)
                    cosine[v, u] = abs(along) / (scale * np.sqrt(x * x + y * y + 1))
                    px, py, pz = pose[0, 3] + t * dx, pose[1, 3] + t * dy, pose[2, 3] + t * dz
                    light = surface_light(solid, lamps, lamp_of, px, py, pz, face) * _grain(
                        px, py, pz
                    )
                    light *= 1.0 - 0.10 * ((u / width - 0.5) ** 2 + (v / height - 0.5) ** 2)
                    for n in range(3):
                        image[v, u, n] = np.uint8(min(255.0, colours[i, j, k, n] * light))


@njit
def surface_light(solid, lamps, lamp_of, px, py, pz, face):
    """Return the light on a face at a point, about 1 in the open."""
    sign = 1.0 if face % 2 == 1 else -1.0
    axis = face // 2
    off = sign * NEAR_VOXELS
    ox = px + (off if axis == 0 else 0.0)
    oy = py + (off if axis == 1 else 0.0)
    oz = pz + (off if axis == 2 else 0.0)
    i = min(max(int(ox / COARSE), 0), lamp_of.shape[0] - 1)
    j = min(max(int(oy / COARSE), 0), lamp_of.shape[1] - 1)
    k = min(max(int(oz / COARSE), 0), lamp_of.shape[2] - 1)
    lamp = lamps[lamp_of[i, j, k]]
    lx, ly, lz = lamp[0] - px, lamp[1] - py, lamp[2] - pz
    toward = (lx if axis == 0 else (ly if axis == 1 else lz)) * sign
    far = np.sqrt(lx * lx + ly * ly + lz * lz) + 20.0
    direct = max(0.0, toward / far) / (1.0 + (far / 160.0) ** 2)
    base = 0.74 if axis == 0 else (0.80 if axis == 1 else (0.84 if sign > 0 else 0.72))
    return (base + 0.42 * direct) * (1.08 - 0.62 * _blurred(solid, ox, oy, oz))


@njit
def _blurred(solid, px, py, pz):
    """Read the blurred grid between its cells."""
    fx, fy, fz = px / COARSE - 0.5, py / COARSE - 0.5, pz / COARSE - 0.5
    nx, ny, nz = solid.shape
    i = min(max(int(np.floor(fx)), 0), nx - 2)
    j = min(max(int(np.floor(fy)), 0), ny - 2)
    k = min(max(int(np.floor(fz)), 0), nz - 2)
    a = min(max(fx - i, 0.0), 1.0)
    b = min(max(fy - j, 0.0), 1.0)
    c = min(max(fz - k, 0.0), 1.0)
    total = 0.0
    for di in range(2):
        for dj in range(2):
            share = (a if di else 1 - a) * (b if dj else 1 - b)
            low, high = solid[i + di, j + dj, k], solid[i + di, j + dj, k + 1]
            total += share * (low * (1 - c) + high * c)
    return total


@njit
def _grain(px, py, pz):
    """Return a tone near 1 that belongs to a spot of half a centimetre."""
    fine = _hash(int(px * 4), int(py * 4), int(pz * 4))
    broad = _hash(int(px / 3), int(py / 3), int(pz / 3))
    return 1.0 + 0.03 * (fine - 0.5) + 0.02 * (broad - 0.5)


@njit
def _hash(i, j, k):
    mixed = (i * 73856093) ^ (j * 19349663) ^ (k * 83492791)
    mixed = ((mixed ^ (mixed >> 13)) * 1274126177) & 0x7FFFFFFF
    return ((mixed ^ (mixed >> 16)) & 0xFFFF) / 65535.0
