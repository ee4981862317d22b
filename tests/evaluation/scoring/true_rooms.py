"""A small true room with a table and a chair, a capture of it, and runs that are perfect."""

from pathlib import Path

import numpy as np

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.core.coordinates import apply, invert_rigid, look_at, rotation_about_z
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.core.types import OBSERVED, UNSEEN, Camera, OccupancyGrid, Scan, View
from world2minecraft.evaluation.scoring import read_truth
from world2minecraft.evaluation.scoring.oracle_stages import put_true_objects
from world2minecraft.evaluation.scoring.score import see_truth
from world2minecraft.evaluation.scoring.used_frames import used_frames
from world2minecraft.formats.objects_and_placements import write_objects
from world2minecraft.formats.run_arrays import read_room, write_room
from world2minecraft.formats.scan_record import write_scan
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.rendering.voxel_camera import cast_voxels, prepare_voxels

FINE_M, VOXEL_M = 0.02, 0.08
SIZE_M = (3.2, 2.4, 2.08)
SHELL = 6
CAMERA = Camera(160, 120, 110.0, 110.0, 80.0, 60.0)
OBJECTS = (
    # Class, name, low corner, high corner, yaw.
    ("table", "desk", (0.8, 0.64, 0.0), (1.68, 1.2, 0.72), 90.0),
    ("chair", "chair", (2.24, 1.28, 0.0), (2.64, 1.68, 0.8), 180.0),
)
CLASS_ID = {"table": 8, "chair": 5}
WINDOW = {
    "kind": "window",
    "start_m": [1.2, 2.4],
    "end_m": [2.0, 2.4],
    "sill_m": 0.8,
    "head_m": 1.6,
}


def room_to_scan() -> np.ndarray:
    """A turned and shifted world frame."""
    turned = rotation_about_z(37.0)
    turned[:3, 3] = [0.4, -1.1, 0.7]
    return turned


def fine_room() -> tuple[np.ndarray, np.ndarray]:
    """The labels and the instances in cells of 2 cm."""
    inner = [round(side / FINE_M) for side in SIZE_M]
    labels = np.full([side + 2 * SHELL for side in inner], 3, np.uint8)
    labels[:, :, :SHELL], labels[:, :, -SHELL:] = 2, 1
    labels[SHELL:-SHELL, SHELL:-SHELL, SHELL:-SHELL] = 0
    instance = np.zeros(labels.shape, np.uint16)
    for number, (name, _, low, high, _) in enumerate(OBJECTS, start=1):
        box = tuple(
            slice(round(a / FINE_M) + SHELL, round(b / FINE_M) + SHELL)
            for a, b in zip(low, high, strict=True)
        )
        labels[box], instance[box] = CLASS_ID[name], number
    return labels, instance


def cameras() -> list[np.ndarray]:
    """Poses along two walls, each looking across the room."""
    eyes = [(0.3, 0.3, 1.5), (2.9, 0.3, 1.4), (2.9, 2.1, 1.6), (0.3, 2.1, 1.5), (1.6, 0.3, 1.2)]
    aims = [(2.0, 1.8, 0.3), (0.9, 1.6, 0.5), (0.8, 0.5, 0.9), (2.4, 0.8, 0.2), (1.6, 2.2, 1.1)]
    return [look_at(np.array(eye), np.array(aim)) for eye, aim in zip(eyes, aims, strict=True)]


def write_capture(folder: Path, pose_off_m: float = 0.0) -> Path:
    """Write the capture with its truth; stated poses are off by some metres along x."""
    labels, instance = fine_room()
    origin_m = np.full(3, -SHELL * FINE_M)
    scene = prepare_voxels(labels, FINE_M, origin_m)
    views, shift = [], np.eye(4)
    shift[0, 3] = pose_off_m
    for number, pose in enumerate(cameras()):
        hits = cast_voxels(scene, CAMERA, pose)
        seen = labels.reshape(-1)[np.maximum(hits.voxel_index, 0)]
        colour = np.repeat((seen * 20)[..., None], 3, axis=2).astype(np.uint8)
        to_scan = room_to_scan() @ shift @ pose
        views.append(View(f"f{number}", to_scan, colour, CAMERA, hits.depth_m, CAMERA, labels=seen))
    write_plain(folder, views, depth_unit="m")
    write_npz(
        folder / "truth.npz",
        {
            "labels": labels,
            "instance": instance,
            "voxel_m": np.array(FINE_M),
            "origin_m": origin_m,
            "truth_room_to_scan": room_to_scan(),
            "frame_names": np.array([view.name for view in views]),
            "camera_to_truth": np.array(cameras()),
            "depth_scale": np.ones(len(views)),
        },
    )
    write_json(folder / "truth.json", stated_truth())
    return folder


def stated_truth() -> dict:
    """What ``truth.json`` says."""
    x, y, z = SIZE_M
    return {
        "objects": [
            {
                "id": number,
                "class": name,
                "name": model,
                "center_m": [(a + b) / 2 for a, b in zip(low, high, strict=True)],
                "size_m": own_size(low, high, yaw),
                "yaw_deg": yaw,
            }
            for number, (name, model, low, high, yaw) in enumerate(OBJECTS, start=1)
        ],
        "layouts": [
            {
                "name": "study",
                "floor_z_m": 0.0,
                "wall_height_m": z,
                "floor_polygon_m": [[0, 0], [x, 0], [x, y], [0, y]],
                "openings": [WINDOW],
            }
        ],
    }


def own_size(low, high, yaw) -> list[float]:
    x, y, z = (b - a for a, b in zip(low, high, strict=True))
    return [y, x, z] if yaw % 180 else [x, y, z]


def write_perfect(out: Path, capture: Path, shift_m=(0.0, 0.0, 0.0)) -> Path:
    """Write the run that knows the truth of all that rays came to; its frame may be off."""
    out.mkdir(parents=True, exist_ok=True)
    truth = read_truth(capture)
    scan_to_room = invert_rigid(truth.truth_to_scan)
    scan = Scan((), scan_to_room, np.array(SIZE_M), tuple(truth.camera_to_truth or ()))  # type: ignore[arg-type]
    write_scan(out / "scan.json", scan)
    write_json(out / "manifest.json", {"parameters": Parameters().as_json()})
    room = see_truth(truth, used_frames(out, truth), scan_to_room, VOXEL_M)
    known = room.reached.scored & (room.labels != 255)
    grid = OccupancyGrid(
        labels=np.where(known, room.labels, 255).astype(np.uint8),
        confidence=known.astype(np.float16),
        colour=np.zeros((*known.shape, 3), np.uint8),
        source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
        instance=np.zeros(known.shape, np.uint16),
        voxel_m=VOXEL_M,
        origin_m=room.reached.low * VOXEL_M,
    )
    write_room(out / "room.npz", grid, scan_to_room)
    write_objects(out / "objects.json", ())
    put_true_objects(out, room)
    if any(shift_m):
        moved = scan_to_room.copy()
        moved[:3, 3] += shift_m
        write_room(out / "room.npz", read_room(out / "room.npz")[0], moved)
    return out


def slow_reach(labels, origin_m, pose, truth_to_room, camera, step_m=0.0005):
    """Walk each ray in steps: the cells it crosses before its last millimetre, and its voxels."""
    crossed, met = set(), set()
    for v in range(camera.height_px):
        for u in range(camera.width_px):
            ray = np.array(
                [
                    (u + 0.5 - camera.cx_px) / camera.fx_px,
                    (v + 0.5 - camera.cy_px) / camera.fy_px,
                    1.0,
                ]
            )
            ray = pose[:3, :3] @ (ray / np.linalg.norm(ray))
            ways = np.arange(0, 6, step_m)[:, None] * ray + pose[:3, 3]
            fine = np.floor((ways - origin_m) / FINE_M).astype(int)
            inside = ((fine >= 0) & (fine < labels.shape)).all(axis=1)
            solid = inside.copy()
            solid[inside] = labels[tuple(fine[inside].T)] > 0
            if not solid.any():
                continue
            end = int(solid.argmax())
            cells = np.floor(apply(truth_to_room, ways[: max(end - 2, 0)]) / VOXEL_M).astype(int)
            crossed |= {tuple(cell) for cell in cells.tolist()}
            middle = origin_m + (fine[end] + 0.5) * FINE_M
            axis = int((fine[end] != fine[end - 1]).argmax())
            inward = int(fine[end, axis] - fine[end - 1, axis])
            surface = ways[end].copy()
            surface[axis] = middle[axis] - inward * (FINE_M / 2 - 0.001)
            for point in (middle, surface):
                cell = np.floor(apply(truth_to_room, point) / VOXEL_M).astype(int)
                met.add(tuple(cell.tolist()))
    return crossed, met
