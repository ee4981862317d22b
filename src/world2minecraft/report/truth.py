"""A reconstruction against the truth of a generated room.

Scored are the cells that a noise-free ray of a used frame reached or crossed, because nobody can
know the others. Truth becomes occupancy by SSCNet's rule in the estimated frame; the frame's own
error is told apart.
"""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.classes import class_id
from world2minecraft.coordinates import apply, invert_rigid
from world2minecraft.errors import DamagedFileError
from world2minecraft.files import read_json, read_npz
from world2minecraft.fuse import EvidenceMap, FuseParameters
from world2minecraft.geometry.lifting import lift_depth
from world2minecraft.metrics.objects import count_objects
from world2minecraft.metrics.occupancy import count_occupancy
from world2minecraft.metrics.surface import count_surface, free_space_recall
from world2minecraft.metrics.truth import carry_truth
from world2minecraft.render.voxels import cast_voxels, prepare_voxels
from world2minecraft.report.scene import FinishedScene
from world2minecraft.types import (
    OBSERVED,
    Camera,
    FusedEvidence,
    LayoutObject,
    PointEvidence,
    Scan,
    View,
)

RAYS_WIDE = 160  # A cell of 8 cm at 5 m spans two of them.
HOW = (
    "Scored on the cells that a noise-free ray of a used frame reached or crossed; truth occupied "
    "by SSCNet's rule (4 of 64 sub-cells). Objects match within 0.3 m."
)


@dataclass(frozen=True, eq=False)
class Truth:
    """What lies beside a virtual scan."""

    labels: np.ndarray  # uint8 [A, B, C]
    voxel_m: float
    origin_m: np.ndarray
    truth_to_scan: np.ndarray
    objects: tuple[LayoutObject, ...]


def read_truth(folder: Path) -> Truth:
    """Read ``truth.npz`` and ``truth.json`` of a capture.

    Raises:
        InputError: a file is missing. DamagedFileError: it is no truth.
    """
    names = ("labels", "voxel_m", "origin_m", "truth_room_to_scan")
    arrays = read_npz(folder / "truth.npz", names)
    try:
        objects = tuple(
            LayoutObject(
                class_id(row["class"]), row["center_m"], row["size_m"], row["yaw_deg"], row["name"]
            )
            for row in read_json(folder / "truth.json")["objects"]
        )
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(folder / "truth.json", f"is no truth ({error})") from error
    return Truth(
        arrays["labels"],
        float(arrays["voxel_m"]),
        arrays["origin_m"],
        arrays["truth_room_to_scan"],
        objects,
    )


def truth_facts(scene: FinishedScene, folder: Path, scan: Scan) -> dict[str, Any]:
    """Return the scores of a finished scene, and the few of them that the page shows first."""
    truth = read_truth(folder)
    truth_to_room = scan.scan_to_room @ truth.truth_to_scan
    grid = scene.grid
    reached = _reached(truth, scan, grid.voxel_m)
    low, shape = _common_box(scene, reached)
    truth_labels = carry_truth(
        truth.labels,
        truth.voxel_m,
        truth.origin_m,
        truth_to_room,
        shape,
        low * grid.voxel_m,
        grid.voxel_m,
    )
    labels = _placed(grid.labels, grid.origin_m, grid.voxel_m, low, shape, 255)
    source = _placed(grid.source, grid.origin_m, grid.voxel_m, low, shape, 0)
    seen = _placed(reached.log_odds, reached.origin_m, grid.voxel_m, low, shape, 0)
    found, true = (labels > 0) & (labels != 255), (truth_labels > 0) & (truth_labels != 255)
    surface = count_surface(found, true, found_mask=source == OBSERVED, true_mask=true & (seen > 0))
    occupancy = count_occupancy(labels, truth_labels, seen != 0)
    objects = count_objects(scene.instances, _in_room(truth.objects, truth_to_room))
    frame = frame_error(truth_to_room)
    return {
        "how": HOW,
        "headline": {
            "precision within one voxel": f"{surface.precision:.3f}",
            "recall within one voxel": f"{surface.recall:.3f}",
            "IoU": f"{occupancy.iou:.2f}",
            "mIoU of the classes present": f"{occupancy.miou_present:.2f}",
            "object F1": f"{objects.f1:.2f}",
            "orientation right": f"{objects.orientation_right:.2f}",
        },
        "surface_within_one_voxel": {"precision": surface.precision, "recall": surface.recall},
        "free_recall": free_space_recall(labels == 0, truth_labels == 0, seen < 0),
        "occupancy": occupancy.figures(),
        "objects": {
            "f1": objects.f1,
            "precision": objects.precision,
            "recall": objects.recall,
            "orientation_right": objects.orientation_right,
            "orientation_asked": objects.turns_asked,
        },
        "frame_error": frame,
    }


def frame_error(truth_to_room: np.ndarray) -> dict[str, float]:
    """Return how far an estimated frame is off, whatever quarter turn and corner it chose.

    ``tilt_deg`` is the angle between the two ups, ``yaw_deg`` that to the nearest quarter turn,
    ``floor_m`` the height that it gives the true floor's origin.
    """
    rotation = truth_to_room[:3, :3]
    tilt = math.degrees(math.acos(min(1.0, float(rotation[2, 2]))))
    yaw = math.degrees(math.atan2(rotation[1, 0], rotation[0, 0]))
    return {
        "tilt_deg": tilt,
        "yaw_deg": abs((yaw + 45) % 90 - 45),
        "floor_m": float(truth_to_room[2, 3]),
    }


def _reached(truth: Truth, scan: Scan, voxel_m: float) -> FusedEvidence:
    """Fuse what noise-free rays of the used frames meet: above 0 met, below 0 crossed."""
    map_ = EvidenceMap(
        scan.scan_to_room, FuseParameters(voxel_m=voxel_m, min_share=0.0, min_points=1)
    )
    fine = prepare_voxels(truth.labels, truth.voxel_m, truth.origin_m)
    scan_to_truth = invert_rigid(truth.truth_to_scan)
    for view in scan.views:
        camera = _coarse(view)
        pose = view.depth_camera_to_scan
        depth_m = cast_voxels(fine, camera, scan_to_truth @ pose).depth_m
        points_m, pixels = lift_depth(depth_m, camera, pose)
        weight = np.full(len(pixels), 1.0, np.float32)
        map_.add(PointEvidence(view.name, pose[:3, 3], points_m, weight))
    return map_.fused()


def _coarse(view: View) -> Camera:
    camera = view.depth_camera or view.colour_camera
    if camera is None:
        raise ValueError(f"view {view.name} has neither depth nor colour")
    return camera.resized(RAYS_WIDE, round(RAYS_WIDE * camera.height_px / camera.width_px))


def _common_box(scene: FinishedScene, reached: FusedEvidence):
    """Return the lowest room cell and the shape of the box that holds both grids."""
    voxel_m = scene.grid.voxel_m
    lows = [np.round(g.origin_m / voxel_m).astype(int) for g in (scene.grid, reached)]
    highs = [lows[0] + scene.grid.shape, lows[1] + reached.log_odds.shape]
    low = np.minimum(*lows)
    x, y, z = (int(side) for side in np.maximum(*highs) - low)
    return low, (x, y, z)


def _placed(values, origin_m, voxel_m, low, shape, fill) -> np.ndarray:
    """Return ``values`` in their place within a larger box, ``fill`` around them."""
    result = np.full(shape, fill, values.dtype)
    start = np.round(origin_m / voxel_m).astype(int) - low
    result[tuple(slice(a, a + b) for a, b in zip(start, values.shape, strict=True))] = values
    return result


def _in_room(objects: tuple[LayoutObject, ...], truth_to_room: np.ndarray) -> list[LayoutObject]:
    turn = math.degrees(math.atan2(truth_to_room[1, 0], truth_to_room[0, 0]))
    return [
        LayoutObject(
            item.class_id,
            apply(truth_to_room, item.center_m),
            item.size_m,
            item.yaw_deg + turn,
            item.name,
        )
        for item in objects
    ]
