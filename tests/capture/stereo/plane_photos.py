"""Photos of one textured plane, exact: each pixel's ray meets it where the texture is known."""

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo, SparseScene

CAMERA = Camera(160, 120, 150.0, 150.0, 80.0, 60.0)


def look(name: str, x_m: float, slope: float, depth_m: float = 2.0, camera: Camera = CAMERA):
    """A photo from (x, 0, 0) along +z of the plane z = depth + slope x, and its exact depth."""
    pose = np.eye(4)
    pose[0, 3] = x_m
    u, v = np.meshgrid(np.arange(camera.width_px) + 0.5, np.arange(camera.height_px) + 0.5)
    a, b = (u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px
    z = (depth_m + slope * x_m) / (1 - slope * a)
    return Photo(name, _texture((x_m + a * z) / depth_m, b * z / depth_m), camera, False, pose), z


def _texture(x, y):
    """uint8 [H, W, 3]: waves of many directions, smooth enough to be read between pixels."""
    rng = np.random.default_rng(3)
    total = np.zeros_like(x)
    for _ in range(60):
        kx, ky, phase = rng.normal(0, 28), rng.normal(0, 28), rng.uniform(0, 6.28)
        total += np.cos(kx * x + ky * y + phase)
    grey = np.clip(128 + 14 * total, 0, 255)
    return np.stack([grey, 0.8 * grey, 0.6 * grey], axis=-1).astype(np.uint8)


def scene_of(photos, slope: float, depth_m: float = 2.0) -> SparseScene:
    """The photos' places, and 40 exact points of the plane that all photos see."""
    rng = np.random.default_rng(4)
    x, y = rng.uniform(-0.25, 0.35, 40) * depth_m, rng.uniform(-0.25, 0.25, 40) * depth_m
    points = np.stack([x, y, depth_m + slope * x], axis=1).astype(np.float32)
    frames = len(photos)
    return SparseScene(
        names=tuple(photo.name for photo in photos),
        cameras=tuple(photo.camera for photo in photos),
        camera_to_scan=np.array([photo.camera_to_scan for photo in photos]),
        points_m=points,
        colour=np.zeros((40, 3), np.uint8),
        track_frame=np.repeat(np.arange(frames), 40).astype(np.int32),
        track_point=np.tile(np.arange(40), frames).astype(np.int32),
        track_px=np.zeros((40 * frames, 2), np.float32),
        error_px=0.1,
    )


def row_of_photos(slope: float, count: int = 5, depth_m: float = 2.0):
    """Photos side by side, 7 % of the distance apart, and the depth that each should find."""
    places = (np.arange(count) - count // 2) * 0.07 * depth_m
    found = [look(f"p{n}", float(x), slope, depth_m) for n, x in enumerate(places)]
    return [photo for photo, _ in found], [z for _, z in found]
