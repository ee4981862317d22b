"""Pictures of a box room whose walls are noise, made by casting rays: places are known exactly."""

from functools import cache

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates
from scipy.spatial.transform import Rotation

from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo

SIZE_M = np.array([4.0, 3.2, 2.4])
CAMERA = Camera(320, 240, 232.0, 232.0, 160.0, 120.0)
TEXEL_M = 0.01


@cache
def wall(face: int, seed: int) -> np.ndarray:
    """A texture of noise at several scales, float [rows, columns, 3]."""
    rng = np.random.default_rng([seed, face])
    shape = (420, 420)
    image = sum(
        sigma * gaussian_filter(rng.standard_normal((*shape, 3)), (sigma, sigma, 0))
        for sigma in (3.0, 8.0, 20.0)
    )
    return 128 + 60 * image / image.std()


def poses(count: int = 10, turn: float = 1.0) -> np.ndarray:
    """Camera-to-world [count, 4, 4] of a walk along an arc, looking into a corner."""
    made = []
    for t in np.linspace(0, 1, count):
        eye = np.array([0.7 + 1.3 * t, 0.8 + 0.5 * np.sin(3 * t), 1.3 + 0.25 * np.cos(5 * t)])
        target = np.array([3.6 - 0.6 * turn * t, 2.9, 1.0 + 0.3 * np.sin(4 * t)])
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, [0, 0, 1.0])
        right /= np.linalg.norm(right)
        pose = np.eye(4)
        pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
        pose[:3, 3] = eye
        made.append(pose)
    return np.array(made)


def picture(pose: np.ndarray, camera: Camera = CAMERA, seed: int = 1) -> np.ndarray:
    """What a camera at a pose sees, uint8 [H, W, 3], four rays a pixel."""
    fine = 2
    y, x = np.mgrid[0 : camera.height_px * fine, 0 : camera.width_px * fine]
    rays = np.stack(
        [
            ((x + 0.5) / fine - camera.cx_px) / camera.fx_px,
            ((y + 0.5) / fine - camera.cy_px) / camera.fy_px,
            np.ones(x.shape),
        ],
        axis=-1,
    ).reshape(-1, 3)
    way = rays @ pose[:3, :3].T
    eye = pose[:3, 3]
    far = np.where(way > 0, SIZE_M - eye, -eye) / np.where(way == 0, 1e-12, way)
    axis = far.argmin(axis=1)
    hit = eye + way * far.min(axis=1, keepdims=True)
    colour = np.zeros((len(rays), 3))
    for face in range(6):
        mine = (axis == face // 2) & ((way[np.arange(len(way)), face // 2] > 0) == (face % 2 == 1))
        across = np.delete(hit[mine], face // 2, axis=1).T / TEXEL_M
        for channel in range(3):
            colour[mine, channel] = map_coordinates(
                wall(face, seed)[..., channel], across, order=1, mode="reflect"
            )
    shape = (camera.height_px, fine, camera.width_px, fine, 3)
    return np.clip(colour.reshape(shape).mean(axis=(1, 3)), 0, 255).astype(np.uint8)


def photos(
    places: np.ndarray,
    camera: Camera | None = None,
    stated: np.ndarray | None = None,
    seed: int = 1,
) -> list[Photo]:
    """Photos at places, with the camera and the poses that they state, if any."""
    given = [None] * len(places) if stated is None else list(stated)
    return [
        Photo(f"{i:03d}", seen(place, seed), camera, False, pose)
        for i, (place, pose) in enumerate(zip(places, given, strict=True))
    ]


_seen: dict = {}


def seen(pose: np.ndarray, seed: int) -> np.ndarray:
    """The picture at a pose, made once."""
    key = (pose.tobytes(), seed)
    if key not in _seen:
        _seen[key] = picture(pose, seed=seed)
    return _seen[key]


def jittered(places: np.ndarray, deg: float, shift_m: float, seed: int = 0) -> np.ndarray:
    """Poses off by random turns and shifts of about these sizes."""
    rng = np.random.default_rng(seed)
    moved = places.copy()
    turns = Rotation.from_rotvec(np.radians(deg) * unit(rng, len(places)))
    moved[:, :3, :3] = turns.as_matrix() @ moved[:, :3, :3]
    moved[:, :3, 3] += shift_m * unit(rng, len(places))
    return moved


def unit(rng: np.random.Generator, count: int) -> np.ndarray:
    """Random directions [count, 3]."""
    way = rng.standard_normal((count, 3))
    return way / np.linalg.norm(way, axis=1, keepdims=True)
