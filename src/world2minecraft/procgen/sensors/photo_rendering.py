"""Rendering of photos of generated rooms, for depth sensors and for phones.

Each room has a lamp under its ceiling. ``take_photo`` computes colour, z-depth, voxel and the
cosine between ray and surface in one pass over the pixels. The lighting combines the lamp, ambient
light, occlusion by nearby surfaces (from a blurred grid of solid cells) and a fine grain that
avoids flat colours. It depends on the position and not on the camera, so a surface has the same
colour in every view.

``expose`` and ``develop`` simulate a phone's photo for image matching. Surfaces have textures, and
each pixel is the mean of four rays at different moments of the exposure, which gives motion blur.
The exposure gain and noise of the phone are applied last.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera, Layout
from world2minecraft.procgen.rooms.materials import Material, heights_m, room_materials, wall_planes
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.navmesh import is_inside
from world2minecraft.procgen.sensors.surface_textures import FLOOR_SEED, poster, tone
from world2minecraft.rendering import VoxelScene, prepare_voxels
from world2minecraft.rendering.grid_traversal import TILE, bundle_start, trace_ray
from world2minecraft.rendering.scene_tables import NO_FACE

UNDER_CEILING_M = 0.35
GRID_M, MAX_STEPS = 0.1, 300  # The grid on which a place for a lamp is searched.
COARSE = 4  # Voxels of 2 cm a cell of the blurred grid: shadows are soft over 16 cm.
BLUR_CELLS = 1.6
NEAR_VOXELS = 7.0  # How far off the surface the blurred grid is read.
WALL = int(Material.WALL)
OFFSETS_PX = ((-0.25, -0.25), (0.25, 0.25), (-0.25, 0.25), (0.25, -0.25))
MIDDLE_GREY = 122.0  # What the mean of a picture is drawn towards,
METERING = 0.35  # and how much of the way: white rooms stay bright.
NOISE_FLOOR, NOISE_PER_LIGHT = 1.1, 0.012  # Standard deviation: 1.1 of 255 in black, 2.1 in white.
DRIFT, TINT_DRIFT = 0.03, 0.012  # How the gain and the white balance of photos err.


def hang_lamps(room: Room) -> np.ndarray:
    """Return the positions of the lamps in metres, float64 [L, 3], one per layout."""
    return np.array([_lamp_m(room, layout) for layout in room.layouts])


def _lamp_m(room: Room, layout: Layout) -> list[float]:
    x, y = _middle_m(layout.floor_polygon_m)
    cell = np.floor(([x, y, layout.floor_z_m] - room.origin_m) / room.voxel_m + 1e-6).astype(int)
    i, j, k = np.clip(cell, 0, np.array(room.labels.shape) - 1)  # A file may be wrong.
    column = room.labels[i, j, k:] == int(SemanticClass.CEILING)
    height = layout.wall_height_m
    if column.any():  # Under a roof the ceiling may be lower than the walls are high.
        height = min(height, float(column.argmax()) * room.voxel_m)
    return [x, y, layout.floor_z_m + height - UNDER_CEILING_M]


def _middle_m(polygon_m: np.ndarray) -> tuple[float, float]:
    """Return the middle of a rectangular floor, or else the point farthest from the walls."""
    low, high = polygon_m.min(axis=0), polygon_m.max(axis=0)
    if len(polygon_m) == 4:
        x, y = (low + high) / 2
        return float(x), float(y)
    step = max(GRID_M, float((high - low).max()) / MAX_STEPS)
    counts = np.ceil((high - low) / step).astype(int)
    cells = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), axis=-1)
    points = low + (cells.reshape(-1, 2) + 0.5) * step
    inside = np.pad(is_inside(polygon_m, points).reshape(counts), 1)
    distance = np.zeros(inside.shape)
    ndimage.distance_transform_edt(inside, distances=distance)
    x, y = points[distance[1:-1, 1:-1].reshape(-1).argmax()]
    return float(x), float(y)


def nearest_lamps(room: Room, shape: tuple[int, ...], cell_m: float) -> np.ndarray:
    """Return the index of the lamp that lights each cell of a coarse grid, as uint8 of ``shape``.

    A cell is lit by the lamp of its room, or of the nearest room on its storey.
    """
    lamp_of = np.zeros(shape, np.uint8)
    if len(room.layouts) == 1:
        return lamp_of
    axes = [room.origin_m[n] + (np.arange(shape[n]) + 0.5) * cell_m for n in range(3)]
    points = np.stack(np.meshgrid(*axes[:2], indexing="ij"), axis=-1).reshape(-1, 2)
    for floor_z_m in sorted({layout.floor_z_m for layout in room.layouts}):
        owner = np.full(len(points), -1)
        for n, layout in enumerate(room.layouts):
            if layout.floor_z_m == floor_z_m:
                owner[is_inside(layout.floor_polygon_m, points)] = n
        owner = owner.reshape(shape[:2])
        nearest = np.zeros((2, *owner.shape), np.int32)
        ndimage.distance_transform_edt(
            owner < 0, return_distances=False, return_indices=True, indices=nearest
        )
        # Storeys come from below: each takes over from the middle of its floor slab up.
        lamp_of[:, :, axes[2] > floor_z_m - 0.12] = owner[tuple(nearest)][:, :, None]
    return lamp_of


class Photo(NamedTuple):
    """The rendered images of one camera pose."""

    colour: np.ndarray  # uint8 [H, W, 3]
    depth_m: np.ndarray  # float32 [H, W]
    voxel_index: np.ndarray  # int32 [H, W]
    cosine: np.ndarray  # float32 [H, W], 1 if the ray is perpendicular to the surface.


class Lighting(NamedTuple):
    """The lighting of a room. Arrays of coarse cells are [X, Y, Z]."""

    solid: np.ndarray  # float32, blurred share of solid voxels in each coarse cell.
    lamps: np.ndarray  # float64 [L, 3], in voxels, one per layout.
    lamp_of: np.ndarray  # uint8, index of the lamp that lights each coarse cell.


@dataclass(frozen=True, eq=False)
class PhotoScene:
    """A room prepared for rendering photos."""

    scene: VoxelScene
    colour: np.ndarray  # uint8 [X, Y, Z, 3]
    lighting: Lighting


def prepare_photos(room: Room) -> PhotoScene:
    """Prepare a room for rendering photos."""
    filled = room.labels != 0
    padding = [(0, -side % COARSE) for side in filled.shape]
    padded = np.pad(filled, padding, constant_values=True)
    shape = [value for side in padded.shape for value in (side // COARSE, COARSE)]
    coarse = padded.reshape(shape).mean(axis=(1, 3, 5), dtype=np.float32)
    return PhotoScene(
        scene=prepare_voxels(room.labels, room.voxel_m, room.origin_m),
        colour=room.colour,
        lighting=Lighting(
            solid=ndimage.gaussian_filter(coarse, BLUR_CELLS, mode="nearest"),
            lamps=(hang_lamps(room) - room.origin_m) / room.voxel_m,
            lamp_of=nearest_lamps(room, coarse.shape, COARSE * room.voxel_m),
        ),
    )


def take_photo(scene: PhotoScene, camera: Camera, camera_to_room: np.ndarray) -> Photo:
    """Render a photo from a camera pose, ignoring lens distortion."""
    size = (camera.height_px, camera.width_px)
    photo = Photo(
        np.zeros((*size, 3), np.uint8),
        np.zeros(size, np.float32),
        np.empty(size, np.int32),
        np.zeros(size, np.float32),
    )
    pose = np.ascontiguousarray((scene.scene.room_to_grid @ camera_to_room)[:3])
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    _render_photo(scene.scene.cells, scene.colour, scene.lighting, pose, rays, photo)
    return photo


@njit
def _render_photo(cells, colours, lighting, pose, rays, photo):
    """Render a photo with one ray per pixel.

    Args:
        cells: The voxels of a ``VoxelScene``.
        colours: Voxel colours, uint8 [X, Y, Z, 3].
        lighting: The ``Lighting`` of the room.
        pose: Transform from the camera to voxels, float64 [3, 4].
        rays: Focal lengths and principal point in pixels, float64 [4].
        photo: Output ``Photo``, filled with zeros.
    """
    image, depth, index, cosine = photo.colour, photo.depth_m, photo.voxel_index, photo.cosine
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
                    t, i, j, k, face = trace_ray(
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
                    light = surface_light(lighting, px, py, pz, face) * _grain(px, py, pz)
                    light *= 1.0 - 0.10 * ((u / width - 0.5) ** 2 + (v / height - 0.5) ** 2)
                    for n in range(3):
                        image[v, u, n] = np.uint8(min(255.0, colours[i, j, k, n] * light))


@njit
def surface_light(lighting, px, py, pz, face):
    """Return the light on a surface point, given in voxels. The value is about 1 in the open."""
    lamps, lamp_of = lighting.lamps, lighting.lamp_of
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
    return (base + 0.42 * direct) * (1.08 - 0.62 * _interpolate_solid(lighting.solid, ox, oy, oz))


@njit
def _interpolate_solid(solid, px, py, pz):
    """Interpolate the blurred grid between its cells."""
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
    """Return a tone near 1 that depends on the position at half a centimetre."""
    fine = _hash(int(px * 4), int(py * 4), int(pz * 4))
    broad = _hash(int(px / 3), int(py / 3), int(pz / 3))
    return 1.0 + 0.03 * (fine - 0.5) + 0.02 * (broad - 0.5)


@njit
def _hash(i, j, k):
    mixed = (i * 73856093) ^ (j * 19349663) ^ (k * 83492791)
    mixed = ((mixed ^ (mixed >> 13)) * 1274126177) & 0x7FFFFFFF
    return ((mixed ^ (mixed >> 16)) & 0xFFFF) / 65535.0


class SurfaceMarks(NamedTuple):
    """The data that the surface textures of a room depend on."""

    materials: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    planes: np.ndarray  # bool [4, N], wall planes with space for posters.
    heights_m: np.ndarray  # float64 [Z], height above the floor of the storey.
    voxel_m: float
    seed: int
    strength: float  # 0 for flat colours, 1 for the contrast of real rooms.


@dataclass(frozen=True, eq=False)
class TexturedScene:
    """A room prepared for rendering photos with textured surfaces."""

    photos: PhotoScene
    marks: SurfaceMarks


def prepare_textured(room: Room, strength: float = 1.0) -> TexturedScene:
    """Prepare a room for rendering photos with textures.

    Args:
        room: The room or house.
        strength: Contrast of the textures, from 0 for flat colours to 1 for that of real rooms.
    """
    marks = SurfaceMarks(
        room_materials(room),
        np.ascontiguousarray(room.instance),
        wall_planes(room),
        heights_m(room),
        room.voxel_m,
        room.seed,
        strength,
    )
    return TexturedScene(prepare_photos(room), marks)


def expose(scene: TexturedScene, camera: Camera, cameras_to_room: np.ndarray) -> np.ndarray:
    """Render the light on the image sensor as float32 [H, W, 3], 0 to 255, without noise.

    Args:
        scene: The textured scene of a room.
        camera: A pinhole camera. Lens distortion is ignored.
        cameras_to_room: The camera poses during the exposure, float64 [N, 4, 4]. One pose gives no
            motion blur.
    """
    total = np.zeros((camera.height_px, camera.width_px, 3), np.float32)
    photos = scene.photos
    for n, (across, down) in enumerate(OFFSETS_PX):
        at = cameras_to_room[min(n * len(cameras_to_room) // 4, len(cameras_to_room) - 1)]
        pose = np.ascontiguousarray((photos.scene.room_to_grid @ at)[:3])
        rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px - across, camera.cy_px - down])
        _accumulate_light(
            photos.scene.cells, photos.colour, photos.lighting, scene.marks, pose, rays, total
        )
    return total / np.float32(len(OFFSETS_PX))


def develop(light: np.ndarray, rng: np.random.Generator, drift: float = 1.0) -> np.ndarray:
    """Convert the light on the image sensor to a phone's image, uint8 [H, W, 3].

    Args:
        light: The light, float32 [H, W, 3], modified in place.
        rng: Random generator for the noise of this frame.
        drift: Variation of gain and white balance between images. Use 0 for videos.
    """
    gain = (MIDDLE_GREY / max(float(light.mean()), 1.0)) ** METERING
    gain *= float(np.exp(drift * DRIFT * rng.standard_normal()))
    light *= np.float32(gain) * np.exp(
        drift * TINT_DRIFT * rng.standard_normal(3)
    ).astype(np.float32)  # fmt: skip
    sigma = np.sqrt(np.float32(NOISE_FLOOR**2) + np.float32(NOISE_PER_LIGHT) * light)
    light += sigma * rng.standard_normal(light.shape, np.float32)
    return np.clip(light + 0.5, 0, 255).astype(np.uint8)


@njit
def _accumulate_light(cells, colours, lighting, marks, pose, rays, total):
    """Add the light of one ray per pixel to ``total``, float32 [H, W, 3].

    ``marks`` are ``SurfaceMarks``. The other arguments are those of ``_render_photo``.
    """
    planes, voxel_m, strength = marks.planes, marks.voxel_m, marks.strength
    height, width = total.shape[:2]
    scale = np.sqrt(pose[0, 2] ** 2 + pose[1, 2] ** 2 + pose[2, 2] ** 2)
    sheet = np.zeros(3)
    for v_tile in range(0, height, TILE):
        for u_tile in range(0, width, TILE):
            start = bundle_start(cells, pose, rays, 1.0, u_tile, v_tile)
            for v in range(v_tile, min(v_tile + TILE, height)):
                for u in range(u_tile, min(u_tile + TILE, width)):
                    x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
                    dx = pose[0, 0] * x + pose[0, 1] * y + pose[0, 2]
                    dy = pose[1, 0] * x + pose[1, 1] * y + pose[1, 2]
                    dz = pose[2, 0] * x + pose[2, 1] * y + pose[2, 2]
                    t, i, j, k, face = trace_ray(
                        cells, pose[0, 3], pose[1, 3], pose[2, 3], dx, dy, dz, start
                    )
                    if face == NO_FACE:
                        continue
                    along = dx if face < 2 else (dy if face < 4 else dz)
                    cosine = abs(along) / (scale * np.sqrt(x * x + y * y + 1))
                    foot = t / rays[0] / np.sqrt(max(cosine, 0.05))
                    px, py, pz = pose[0, 3] + t * dx, pose[1, 3] + t * dy, pose[2, 3] + t * dz
                    light = surface_light(lighting, px, py, pz, face)
                    light *= 1.0 - 0.22 * ((u / width - 0.5) ** 2 + (v / height - 0.5) ** 2)
                    material = marks.materials[i, j, k]
                    mark = 1.0 + strength * (
                        tone(material, int(marks.instance[i, j, k]) + FLOOR_SEED,
                             px * voxel_m, py * voxel_m, pz * voxel_m, face, foot) - 1.0
                    )  # fmt: skip
                    hung = False
                    if material == WALL and strength > 0 and face < 4:
                        plane = i if face < 2 else j
                        if planes[face, plane]:
                            along_m = (py if face < 2 else px) * voxel_m
                            above_m = marks.heights_m[k] + (pz - k) * voxel_m
                            number = marks.seed * 1013 + face * 97 + plane
                            hung = poster(along_m, above_m, number, foot, sheet)
                    for n in range(3):
                        base = sheet[n] if hung else colours[i, j, k, n] * mark
                        total[v, u, n] += max(0.0, min(255.0, base * light))
