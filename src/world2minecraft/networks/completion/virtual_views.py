"""Virtual scans of rooms: the choice of their views, and the fused evidence.

A ``walk`` is a part of a person's tour, a ``few`` consists of two to six images, and a ``single``
is one image, as in data sets of depth frames. Walks and fews use the room axes, as after alignment;
most singles use the axes of their camera, like the grids of NYUv2.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.types import Camera, FusedEvidence, View
from world2minecraft.geometry.rotations import rotation_from_vector
from world2minecraft.networks.completion.sensor_noise import (
    ScanNoise,
    draw_lost_pixels,
    store_depth,
)
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.depth_camera import (
    bend_depth,
    jitter_pose,
    scale_factor,
    sense_depth,
)
from world2minecraft.procgen.sensors.photo_rendering import PhotoScene, take_photo
from world2minecraft.procgen.sensors.scan_frames import LUMINANCE
from world2minecraft.reconstruction.fusion import EvidenceMap, FusionParameters
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor

ScanKind = Literal["walk", "few", "single"]
FOCAL_SHARE = 0.8107  # NYU's: 518.86 px at 640.
WALK_WIDE_PX, FEW_WIDE_PX = 160, 320
TOUR_VIEWS = 40


@dataclass(frozen=True, eq=False)
class VirtualScan:
    """A scan of a room, with the coordinate system in which it is fused.

    Attributes:
        kind: ``walk``, ``few`` or ``single``.
        poses: Camera poses in the room, float64 [F, 4, 4].
        room_to_grid: Matrix from room coordinates to those of the fused cells, float64 [4, 4].
        in_room_axes: Whether the fused cells are aligned with the room axes.
    """

    kind: ScanKind
    poses: np.ndarray
    room_to_grid: np.ndarray
    in_room_axes: bool


def draw_scan(kind: ScanKind, tour: np.ndarray, rng: np.random.Generator) -> VirtualScan:
    """Choose a random scan from the camera poses of a tour, float64 [F, 4, 4]."""
    if kind == "walk":
        poses = tour[: int(rng.integers(8, len(tour) + 1))]
    elif kind == "few":
        first = int(rng.integers(len(tour) - 6))
        poses = tour[first : first + int(rng.integers(2, 7))]
    else:
        poses = tour[int(rng.integers(len(tour)))][None]
    by_camera = kind == "single" and rng.random() < 0.65
    return VirtualScan(kind, poses, _frame(poses[0], by_camera, rng), not by_camera)


def _frame(pose: np.ndarray, by_camera: bool, rng: np.random.Generator) -> np.ndarray:
    """Return ``room_to_grid``, either rotated so that the camera faces +y, or in room axes.

    The grid starts at the floor and a corner, as after alignment, or with a random offset.
    """
    yaw_deg = 0.0
    if by_camera:
        ahead = pose[:3, 2]
        yaw_deg = 90 - float(np.degrees(np.arctan2(ahead[1], ahead[0])))
    frame = np.eye(4)
    frame[:3, :3] = rotation_about_z(yaw_deg)[:3, :3]
    if by_camera:
        frame[:3, 3] = -frame[:3, :3] @ pose[:3, 3]
        frame[2, 3] = 0
    free = by_camera or rng.random() < 0.5
    frame[:2, 3] += rng.uniform(-0.04, 0.04, 2) if free else rng.standard_normal(2) * 0.008
    frame[2, 3] += rng.uniform(-0.04, 0.04) if rng.random() < 0.4 else rng.standard_normal() * 0.008
    return frame


def lean_scan(scan: VirtualScan, lean_deg: np.ndarray) -> VirtualScan:
    """Return a scan whose frame leans about the floor below its cameras.

    Args:
        scan: The scan.
        lean_deg: Rotation about x and y in degrees, float [2].
    """
    pivot_m = apply(scan.room_to_grid, scan.poses[:, :3, 3]).mean(axis=0) * [1, 1, 0]
    lean = np.eye(4)
    lean[:3, :3] = rotation_from_vector(np.radians([*lean_deg, 0.0]))
    lean[:3, 3] = pivot_m - lean[:3, :3] @ pivot_m
    return replace(scan, room_to_grid=lean @ scan.room_to_grid)


def fuse_scan(
    room: Room, scene: PhotoScene, look: VirtualScan, noise: ScanNoise, rng: np.random.Generator
) -> FusedEvidence:
    """Render the views of a scan with noise and fuse them.

    Raises:
        CaptureError: If no view provides evidence.
    """
    wide = WALK_WIDE_PX if look.kind == "walk" else FEW_WIDE_PX
    focal = FOCAL_SHARE * wide
    camera = Camera(wide, wide * 3 // 4, focal, focal, wide / 2, wide * 3 / 8)
    parameters = FusionParameters()
    evidence, lifting = EvidenceMap(look.room_to_grid, parameters), DepthPredictor()
    for pose in look.poses:
        evidence.add(lifting.lift(_view(room, scene, camera, pose, noise, rng, look.kind)))
    return evidence.fused()


def _view(
    room: Room,
    scene: PhotoScene,
    camera: Camera,
    pose: np.ndarray,
    noise: ScanNoise,
    rng: np.random.Generator,
    kind: ScanKind,
) -> View:
    """Render a view with sensor noise and true labels, in room coordinates."""
    photo = take_photo(scene, camera, pose)
    luminance = photo.colour.astype(np.float32) @ LUMINANCE
    depth_m = sense_depth(noise.sensor, photo.depth_m, photo.cosine, luminance, camera.fx_px, rng)
    labels = room.labels.reshape(-1)[np.maximum(photo.voxel_index, 0)]
    depth_m[draw_lost_pixels(noise, labels, depth_m, rng)] = 0
    depth_m *= np.float32(scale_factor(noise.frame_scale, rng) * noise.scan_scale)
    depth_m = store_depth(noise, bend_depth(depth_m, noise.bend_m, rng))
    # A single image has no tracking error: its pose error is part of the misfit of the scan.
    stated = pose if kind == "single" else jitter_pose(noise.sensor, pose, rng)
    return View(
        name=kind,
        camera_to_scan=stated,
        colour=photo.colour,
        colour_camera=camera,
        depth_m=depth_m,
        depth_camera=camera,
        labels=labels,
    )
