"""The official loaders' arithmetic, written from the description of the formats alone.

It shares no code with the exporters: pickles are opened by Python itself, pictures by Pillow, and
cells meet pixels as MonoScene's vox2pix says: pixel = round(fx X / Z + cx), no half.
"""

import pickle
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

NYU_K = np.array([[518.8579, 0, 320], [0, 518.8579, 240], [0, 0, 1]])
SCENE_SIZE_M, VOXEL_M = (4.8, 4.8, 2.88), 0.08


class Loaded(NamedTuple):
    """What a loader gives a network."""

    target: np.ndarray  # [60, 60, 36] as x, y, z
    pixels: np.ndarray  # int [60, 60, 36, 2], column and row
    in_view: np.ndarray  # bool [60, 60, 36]
    image: np.ndarray
    depth_m: np.ndarray
    stored: dict[str, Any]


def load_nyu(root: Path, split: str, name: str) -> Loaded:
    """As Symphonies and MonoScene: [x, z, y] and depth in 1/8000 m."""
    stored = _opened(root / "base" / f"NYU{split}" / f"{name}.pkl")
    image = np.asarray(Image.open(root / f"NYU{split}" / f"{name}_color.jpg").convert("RGB"))
    depth_m = np.array(Image.open(root / f"NYU{split}" / f"{name}.png")) / 8000.0
    target = stored["target_1_4"].transpose(0, 2, 1)
    pixels, in_view = vox2pix(stored["cam_pose"], NYU_K, stored["voxel_origin"])
    return Loaded(target, pixels, in_view, image, depth_m, stored)


def load_occscannet(root: Path, line: str) -> Loaded:
    """As EmbodiedOcc and GPOcc: [y, x, z], millimetres, the matrix of the file."""
    stored = _opened(root / line)
    name = line.removeprefix("gathered_data/").removesuffix(".pkl")
    image = np.asarray(Image.open(root / "posed_images" / f"{name}.jpg"))
    depth_m = np.array(Image.open(root / "posed_images" / f"{name}.png").convert("I;16")) / 1000.0
    matrix = stored["intrinsic"]
    matrix[0, 0] *= 640 / image.shape[1]
    matrix[0, 2] *= 640 / image.shape[1]
    matrix[1, 1] *= 480 / image.shape[0]
    matrix[1, 2] *= 480 / image.shape[0]
    target = np.transpose(stored["target_1_4"], (1, 0, 2))
    origin = np.round(np.array(stored["voxel_origin"], dtype=np.float32), 4)
    pixels, in_view = vox2pix(stored["cam_pose"], matrix[:3, :3], origin)
    return Loaded(target, pixels, in_view, image, depth_m, stored | {"K": matrix[:3, :3]})


def vox2pix(cam_pose, K, origin) -> tuple[np.ndarray, np.ndarray]:
    """Project the centres of all cells; the grid's size is a division that is rounded up."""
    bounds = np.zeros((3, 2))
    bounds[:, 0], bounds[:, 1] = origin, origin + np.array(SCENE_SIZE_M)
    sides = np.ceil(np.around((bounds[:, 1] - bounds[:, 0]) / VOXEL_M, 3)).astype(int)
    assert sides.tolist() == [60, 60, 36]
    grid = np.stack(np.meshgrid(*(range(side) for side in sides), indexing="ij"), axis=-1)
    world = np.float32(origin) + np.float32(VOXEL_M) * (grid.astype(np.float32) + 0.5)
    world_to_camera = np.linalg.inv(cam_pose)
    camera = world @ world_to_camera[:3, :3].T + world_to_camera[:3, 3]
    x, y, z = np.moveaxis(camera, -1, 0)
    z_safe = np.where(z == 0, 1e-9, z)
    u = np.round(x * K[0, 0] / z_safe + K[0, 2]).astype(np.int64)
    v = np.round(y * K[1, 1] / z_safe + K[1, 2]).astype(np.int64)
    in_view = (u >= 0) & (u < 640) & (v >= 0) & (v < 480) & (z > 0)
    return np.stack([u, v], axis=-1), in_view


def first_seen_labels(loaded: Loaded, K, nudge_m: float = 0.001) -> np.ndarray:
    """Look each pixel's point up in the target; 254 where it lies outside the box."""
    v, u = np.indices(loaded.depth_m.shape)
    z = loaded.depth_m + nudge_m
    points = np.stack([(u - K[0, 2]) / K[0, 0] * z, (v - K[1, 2]) / K[1, 1] * z, z], axis=-1)
    pose = loaded.stored["cam_pose"]
    world = points @ pose[:3, :3].T + pose[:3, 3]
    cells = np.floor((world - loaded.stored["voxel_origin"]) / VOXEL_M).astype(int)
    inside = np.all((cells >= 0) & (cells < (60, 60, 36)), axis=-1) & (loaded.depth_m > 0)
    safe = np.where(inside[..., None], cells, 0)
    return np.where(inside, loaded.target[tuple(np.moveaxis(safe, -1, 0))], 254)


def _opened(path: Path) -> dict[str, Any]:
    with path.open("rb") as stream:
        return pickle.load(stream)
