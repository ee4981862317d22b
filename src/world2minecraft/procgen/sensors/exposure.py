"""A phone's photo of a generated room: marks on the surfaces, soft edges, a chip's noise.

``photo`` sees one ray a pixel and flat colours, which depth sensors need and matching cannot use.
Here each pixel is the mean of four rays, each of them taken at its own moment of the exposure, so
that a camera that moves blurs; then come the exposure that the phone chose, and noise.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.procgen.rooms.materials import Material, heights_m, room_materials, wall_planes
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.photo import PhotoScene, prepare_photos, surface_light
from world2minecraft.procgen.sensors.surface_textures import FLOOR_SEED, poster, tone
from world2minecraft.rendering.grid_traversal import TILE, bundle_start, trace
from world2minecraft.rendering.scene_tables import NO_FACE

WALL = int(Material.WALL)
OFFSETS_PX = ((-0.25, -0.25), (0.25, 0.25), (-0.25, 0.25), (0.25, -0.25))
MIDDLE_GREY = 122.0  # What the mean of a picture is drawn towards,
METERING = 0.35  # and how much of the way: white rooms stay bright.
NOISE_FLOOR, NOISE_PER_LIGHT = 1.1, 0.012  # Standard deviation: 1.1 of 255 in black, 2.1 in white.
DRIFT, TINT_DRIFT = 0.03, 0.012  # How the gain and the white balance of photos err.


@dataclass(frozen=True, eq=False)
class TexturedScene:
    """A room made ready for photos with marks on its surfaces."""

    photos: PhotoScene
    materials: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    planes: np.ndarray  # bool [4, N]
    heights_m: np.ndarray  # float64 [Z]
    voxel_m: float
    seed: int
    strength: float


def prepare_textured(room: Room, strength: float = 1.0) -> TexturedScene:
    """Return the scene of a room; ``strength`` 0 leaves its colours flat, 1 is as in real rooms."""
    return TexturedScene(
        prepare_photos(room),
        room_materials(room),
        np.ascontiguousarray(room.instance),
        wall_planes(room),
        heights_m(room),
        room.voxel_m,
        room.seed,
        strength,
    )


def exposed(scene: TexturedScene, camera: Camera, cameras_to_room: np.ndarray) -> np.ndarray:
    """Return what falls on the chip, float32 [H, W, 3] of 0 to 255, without noise.

    Args:
        scene: the room.
        camera: a pinhole camera; lens distortion is left out.
        cameras_to_room: float64 [N, 4, 4], the poses during the exposure; one stands still.
    """
    total = np.zeros((camera.height_px, camera.width_px, 3), np.float32)
    photos = scene.photos
    for n, (across, down) in enumerate(OFFSETS_PX):
        at = cameras_to_room[min(n * len(cameras_to_room) // 4, len(cameras_to_room) - 1)]
        pose = np.ascontiguousarray((photos.scene.room_to_grid @ at)[:3])
        rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px - across, camera.cy_px - down])
        _expose(
            photos.scene.cells, photos.colour, photos.solid, photos.lamps, photos.lamp_of,
            scene.materials, scene.instance, scene.planes, scene.heights_m, scene.voxel_m,
            scene.seed, scene.strength, pose, rays, total,
        )  # fmt: skip
    return total / np.float32(len(OFFSETS_PX))


def developed(light: np.ndarray, rng: np.random.Generator, drift: float = 1.0) -> np.ndarray:
    """Return the picture that a phone makes of the light, uint8 [H, W, 3].

    Args:
        light: float32 [H, W, 3], changed in place.
        rng: the frame's own source of noise.
        drift: how much gain and white balance wander from picture to picture; 0 in a video.
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
def _expose(
    cells, colours, solid, lamps, lamp_of, materials, instance, planes, heights, voxel_m, seed,
    strength, pose, rays, total,
):  # fmt: skip
    """Add to ``total`` the light of one ray a pixel."""
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
                    t, i, j, k, face = trace(
                        cells, pose[0, 3], pose[1, 3], pose[2, 3], dx, dy, dz, start
                    )
                    if face == NO_FACE:
                        continue
                    along = dx if face < 2 else (dy if face < 4 else dz)
                    cosine = abs(along) / (scale * np.sqrt(x * x + y * y + 1))
                    foot = t / rays[0] / np.sqrt(max(cosine, 0.05))
                    px, py, pz = pose[0, 3] + t * dx, pose[1, 3] + t * dy, pose[2, 3] + t * dz
                    light = surface_light(solid, lamps, lamp_of, px, py, pz, face)
                    light *= 1.0 - 0.22 * ((u / width - 0.5) ** 2 + (v / height - 0.5) ** 2)
                    material = materials[i, j, k]
                    mark = 1.0 + strength * (
                        tone(material, int(instance[i, j, k]) + FLOOR_SEED,
                             px * voxel_m, py * voxel_m, pz * voxel_m, face, foot) - 1.0
                    )  # fmt: skip
                    hung = False
                    if material == WALL and strength > 0 and face < 4:
                        plane = i if face < 2 else j
                        if planes[face, plane]:
                            along_m = (py if face < 2 else px) * voxel_m
                            above_m = heights[k] + (pz - k) * voxel_m
                            number = seed * 1013 + face * 97 + plane
                            hung = poster(along_m, above_m, number, foot, sheet)
                    for n in range(3):
                        base = sheet[n] if hung else colours[i, j, k, n] * mark
                        total[v, u, n] += max(0.0, min(255.0, base * light))
