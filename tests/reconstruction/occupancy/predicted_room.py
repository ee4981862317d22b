"""An exactly known room, and what perfect networks of each convention predict of its views."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from tests.exact_room import CAMERA, BoxRoom

from world2minecraft.core.coordinates import apply, invert_rigid, rotation_about_z
from world2minecraft.core.types import View
from world2minecraft.formats.safe_pickle import dump_pickle
from world2minecraft.formats.sscnet import encode_bin
from world2minecraft.geometry.view_region import LabelRegion, RegionRule, label_region

ROOM = BoxRoom((4.0, 3.2, 2.56))  # Whole cells, and no two sides alike.
CLASSES = (8, 8, 8, 10, 10)  # Of its boxes: a table with legs, a counter, a wardrobe.
THICK_M = 0.16
VOXEL_M = 0.08
Change = Callable[[np.ndarray], np.ndarray]


def labels_at(points_m: np.ndarray) -> np.ndarray:
    """Return the class of the room at points [..., 3]: 255 beyond its walls."""
    x, y, z = np.moveaxis(points_m, -1, 0)
    wide, deep, high = ROOM.size_m
    labels = np.zeros(points_m.shape[:-1], np.uint8)
    for box, kind in zip(ROOM.boxes, CLASSES, strict=True):
        low, top = np.array(box[:3]) - 0.021, np.array(box[3:]) + 0.021
        labels[((points_m >= low) & (points_m <= top)).all(axis=-1)] = kind
    labels[(x < 0) | (y < 0) | (x > wide) | (y > deep)] = 3
    labels[z > high] = 1
    labels[z < 0] = 2
    beyond = (x < -THICK_M) | (y < -THICK_M) | (x > wide + THICK_M) | (y > deep + THICK_M)
    labels[beyond | (z < -THICK_M) | (z > high + THICK_M)] = 255
    return labels


def scene_labels() -> tuple[np.ndarray, np.ndarray]:
    """Return the labels of the whole room and the corner of their grid."""
    origin_m = np.full(3, -THICK_M)
    sides = np.round((np.array(ROOM.size_m) + 2 * THICK_M) / VOXEL_M).astype(int)
    centers = (np.moveaxis(np.indices(sides), 0, -1) + 0.5) * VOXEL_M + origin_m
    return labels_at(centers), origin_m


def region_of(camera_to_room: np.ndarray, convention: str) -> LabelRegion:
    """Return the box of a view: turned with it in NYUv2, along the room's axes in OccScanNet."""
    if convention in ("monoscene", "sscnet"):
        return label_region(camera_to_room, RegionRule("free"))
    found = label_region(camera_to_room, RegionRule("paper"))
    ends = apply(found.region_to_room, np.array([[0.0, 0, 0], found.shape]) * VOXEL_M)
    along = np.eye(4)
    along[:3, 3] = ends.min(axis=0)
    return LabelRegion(found.shape, VOXEL_M, along)


def write_prediction(
    folder: Path, name: str, camera_to_room: np.ndarray, convention: str
) -> np.ndarray:
    """Save what a perfect network predicts for a view, as its program would.

    Returns:
        The labels with the axes x, y and z.
    """
    region = region_of(camera_to_room, convention)
    labels = labels_at(region.centers_m())
    to_world = rotation_about_z(37.0)  # The world of the file is not that of the scan.
    to_world[:3, 3] = [3.0, -2.0, 0.5]
    if convention in ("monoscene", "sscnet"):  # Its axes are those of the box.
        to_world[:3, :3] = region.region_to_room[:3, :3].T
    else:
        to_world[:3, :3] = np.eye(3)
    pose = to_world @ camera_to_room
    origin_m = apply(to_world, region.region_to_room[:3, 3])
    folder.mkdir(parents=True, exist_ok=True)
    if convention == "sscnet":
        data = encode_bin(labels.transpose(0, 2, 1), origin_m, pose)
        (folder / f"{name}.bin").write_bytes(data)
    elif convention == "monoscene":
        stored = labels.transpose(0, 2, 1).astype(np.uint16)
        data = dump_pickle({"y_pred": stored, "cam_pose": pose, "vox_origin": origin_m})
        (folder / f"{name}.pkl").write_bytes(data)
    elif convention == "iso":
        stored = labels.transpose(1, 0, 2)
        np.savez(folder / f"{name}.npz", y_pred=stored, cam_pose=pose, voxel_origin=origin_m)
    else:
        ids = np.where(labels == 0, 12, np.where(labels == 255, 0, labels))
        scores = np.eye(13, dtype=np.float32)[ids]
        np.savez(folder / f"{name}.npz", pred=scores, cam_pose=pose, voxel_origin=origin_m)
    return labels


def views_of(count: int, room_to_scan: np.ndarray, *, depth: bool) -> list[View]:
    """Return views of the room, with or without depth."""
    views = []
    for number, pose in enumerate(ROOM.poses(count)):
        depth_m, colour = ROOM.render(pose)
        seen = (depth_m, CAMERA) if depth else (None, None)
        views.append(View(f"{number:06d}", room_to_scan @ pose, colour, CAMERA, *seen))
    return views


def write_predictions(
    folder: Path, views: list[View], room_to_scan: np.ndarray, convention: str
) -> None:
    """Save the predictions of all views."""
    for view in views:
        camera_to_room = invert_rigid(room_to_scan) @ view.camera_to_scan
        write_prediction(folder, view.name, camera_to_room, convention)
