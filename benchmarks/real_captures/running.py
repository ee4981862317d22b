"""Running and scoring one scene, in a folder that keeps its capture, its run and its scores."""

import resource
import shutil
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.check_photos import best_similarity, poses_of
from benchmarks.real_captures.scenes import CROP_M, Scene, kitchen_poses, read_nyu_classes
from benchmarks.real_captures.scoring import (
    accuracy_by_class,
    agreement,
    class_accuracy,
    confusion,
    fit_floor,
    floor_error_m,
    found_classes,
    labelled_cells,
    share_not_found,
    surface_of,
    tilt_deg,
    wall_share,
)
from benchmarks.real_captures.sheets import write_sheet
from benchmarks.real_captures.stability import measure_stability
from benchmarks.real_captures.walls import border_wall_points
from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import OccupancyGrid, Scan
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.scan_record import read_room_size
from world2minecraft.geometry.oriented_points import collect_oriented_points
from world2minecraft.geometry.unprojection import unproject_depth
from world2minecraft.reconstruction.floorplans import build_plan
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters, with_settings
from world2minecraft.reconstruction.pipeline import read_registered, reconstruct

Row = dict[str, Any]
RESULT = "result.json"


@dataclass(frozen=True)
class Options:
    """What determines the scores of a scene, besides the scene and the program.

    Attributes:
        data: Folder of shared inputs.
        out: Folder of the benchmark, with one folder per scene.
        settings: ``KEY=VALUE`` settings of the reconstruction.
        stability: Whether to measure stability.
        start: Stage from which existing runs are repeated; empty to run scenes without a result.
    """

    data: Path
    out: Path
    settings: tuple[str, ...] = ()
    stability: bool = False
    start: str = ""

    def folder(self, scene: Scene) -> Path:
        """Return the folder of a scene."""
        return self.out / scene.name

    def parameters(self, scene: Scene) -> Parameters:
        """Return the parameters of a scene's reconstruction."""
        return with_settings(Parameters(), [*scene.settings, *self.settings])


def stored_result(scene: Scene, options: Options) -> Row | None:
    """Return the scores of a scene if they were computed with the same settings."""
    path = options.folder(scene) / RESULT
    if not path.is_file():
        return None
    stored = read_json(path)
    has_stability = options.stability <= ("stability" in stored["row"])
    same = stored["settings"] == options.parameters(scene).as_json() and has_stability
    return stored["row"] if same else None


def run_scene(scene: Scene, options: Options) -> Row:
    """Reconstruct and score a scene, and store the result.

    Nothing is raised: a capture that the program refuses is a result too, and a crash, which is not
    stored, does not end the benchmark.
    """
    folder, chosen = options.folder(scene), options.parameters(scene)
    row: Row = {"scene": scene.name, "group": scene.group}
    whole_cpu_s = _cpu_of_whole_run(folder) if options.start else None
    begun = cpu_seconds()
    try:
        capture = _prepared(scene, options)
        scan = _reconstructed(capture, folder / "run", chosen, options.start)
        row |= {"ran": True, "cpu_s": whole_cpu_s or round(cpu_seconds() - begun, 2)}
        row |= score_scene(scene, options, scan)
        if options.stability:
            found = None if scan is None else measure_stability(capture, folder, chosen)
            row["stability"] = None if found is None else found.near
            row["stability_exact"] = None if found is None else found.exact
        image = options.data / scene.label_image if scene.label_image else None
        write_sheet(folder / "sheet.png", folder / "run", scan, image)
    except World2MinecraftError as error:
        row |= {"ran": False, "reason": _reason(error), "cpu_s": round(cpu_seconds() - begun, 2)}
        row["stability"] = None
    except Exception as error:
        traceback.print_exc()
        return row | {"ran": False, "reason": f"crashed: {type(error).__name__}: {error}"}
    write_json(folder / RESULT, {"settings": chosen.as_json(), "row": row})
    return row


def _cpu_of_whole_run(folder: Path) -> float | None:
    """Return the CPU time of the stored result, which repeating later stages does not change."""
    path = folder / RESULT
    return read_json(path)["row"].get("cpu_s") if path.is_file() else None


def _reason(error: World2MinecraftError) -> str:
    return " ".join(str(getattr(error, "reason", "") or error).split())


def cpu_seconds() -> float:
    """Return the CPU time of this process and its children in seconds."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def _prepared(scene: Scene, options: Options) -> Path:
    """Return the path of a scene's capture, made once."""
    folder = options.folder(scene) / "capture"
    marker = options.folder(scene) / "capture.txt"
    if not marker.is_file():
        shutil.rmtree(folder, ignore_errors=True)
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.write_text(f"{scene.prepare(options.data, folder)}\n", "utf-8")
    return Path(marker.read_text("utf-8").strip())


def _reconstructed(capture: Path, run: Path, chosen: Parameters, start: str) -> Scan | None:
    """Return the registered scan of a finished run, or None for a floor plan."""
    plan = find_lone_roomplan(capture)
    if plan is not None:
        build_plan(plan, run, chosen)
        return None
    repeat = start if start and (run / "room.npz").is_file() else None
    if repeat is None:
        shutil.rmtree(run, ignore_errors=True)  # With poses and depth of photos.
    reconstruct(capture, run, chosen, start=repeat)
    return read_registered(prepare_and_open(capture, run, chosen), run)


def score_scene(scene: Scene, options: Options, scan: Scan | None) -> Row:
    """Return the scores of a finished run."""
    run = options.folder(scene) / "run"
    grid, scan_to_room = read_room(run / "room.npz")
    row: Row = {"objects": len(read_json(run / "objects.json"))}
    row |= _frame_scores(scene, options, run, scan_to_room)
    if scan is None:
        return row
    if scene.label_image:
        classes = read_nyu_classes(options.data / scene.label_image)
        return row | score_labelled_frame(classes, grid, scan)
    better = options.out / scene.reference.classes_of / "run" / "room.npz"
    if scene.reference.classes_of and better.is_file():
        whole, scan_to_whole = read_room(better)
        truth = surface_of(whole, scan_to_room @ np.linalg.inv(scan_to_whole))
        # A cell below the crop, which may have cut the cells at its height.
        row |= class_scores(agreement(truth, grid, CROP_M - grid.voxel_m))
    return row | {"wall_share": _plane_wall_share(grid, scan), "wall_reference": "planes"}


def _frame_scores(scene: Scene, options: Options, run: Path, scan_to_room: np.ndarray) -> Row:
    known = scene.reference
    if known.up is None:
        return {}
    row: Row = {}
    size = read_room_size(run / "scan.json")
    if known.finds_poses:
        found = poses_of(run / "capture" / "capture.json")
        similarity = best_similarity(found, kitchen_poses(options.data))
        scale = float(np.linalg.det(similarity[:3, :3]) ** (1 / 3))
        # In metres of the reference, so that the transform is rigid again.
        resized = np.diag([scale, scale, scale, 1])
        scan_to_room = resized @ scan_to_room @ np.linalg.inv(similarity)
        row, size = {"scale": scale}, size * scale
    up = np.array(known.up, np.float64)
    row["tilt_deg"] = tilt_deg(scan_to_room, up)
    if known.floor_m is not None:
        row["floor_m"] = floor_error_m(scan_to_room, size, up, known.floor_m)
    return row


def score_labelled_frame(classes: np.ndarray, grid: OccupancyGrid, scan: Scan) -> Row:
    """Return the scores of a grid against the label image of a scan's only view.

    Args:
        classes: Class of each depth pixel, uint8 [H, W], 255 if unknown.
        grid: Result of the reconstruction.
        scan: Registered scan whose view has depth.
    """
    view = next(iter(scan.views))
    if view.depth_m is None or view.depth_camera is None:
        raise ValueError(f"view {view.name} has no depth")
    camera = view.depth_camera
    pose = scan.scan_to_room @ view.depth_camera_to_scan
    points_m, pixels = unproject_depth(view.depth_m, camera, pose)
    seen = classes.reshape(-1)[pixels]
    area_m2 = view.depth_m.reshape(-1)[pixels].astype(np.float64) ** 2
    area_m2 /= camera.fx_px * camera.fy_px
    truth = labelled_cells(points_m, seen, area_m2, grid.origin_m, grid.voxel_m)
    counts = confusion(truth.classes, found_classes(grid.labels, truth.cells))
    known = (seen > 0) & (seen < CLASS_COUNT)
    cells = np.floor((points_m[known] - grid.origin_m) / grid.voxel_m).astype(np.int64)
    by_pixel = confusion(seen[known], found_classes(grid.labels, cells))
    row = class_scores(counts) | {
        "pixel_accuracy": class_accuracy(by_pixel),
        "wall_share": wall_share(counts),
        "wall_reference": "labels",
    }
    floor = fit_floor(points_m[seen == SemanticClass.FLOOR], pose[:3, 3])
    if floor is not None:  # The points are in the room frame, whose up is z and whose floor is 0.
        row |= {"tilt_deg": tilt_deg(np.eye(4), floor[0]), "floor_m": -float(floor[1][2])}
    return row


def class_scores(counts: np.ndarray) -> Row:
    """Return the figures of a confusion."""
    return {
        "class_accuracy": class_accuracy(counts),
        "not_found": share_not_found(counts),
        "by_class": accuracy_by_class(counts),
        "confusion": counts.tolist(),
    }


def _plane_wall_share(grid: OccupancyGrid, scan: Scan) -> float | None:
    """Return the share of large vertical border planes that is labelled wall or window."""
    seen = collect_oriented_points(scan.views).transformed(scan.scan_to_room)
    points_m = border_wall_points(seen.points_m, seen.normals)
    if not len(points_m):
        return None
    cells = np.floor((points_m - grid.origin_m) / grid.voxel_m).astype(np.int64)
    found = found_classes(grid.labels, cells)
    return float(np.isin(found, (SemanticClass.WALL, SemanticClass.WINDOW)).mean())
