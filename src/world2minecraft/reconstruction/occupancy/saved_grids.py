"""Saved predictions of other networks: found by the names of views, and placed in the scan.

A folder contains one file per view, named like the view, or a single file for the whole scene. A
frame's grid is placed by the camera pose in its file, or else by its corner in the world of the
scan. Without either, it is assumed to be the box that the networks' data sets cut in front of each
camera.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.capture.pose_validation import move_like_capture
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Camera, View
from world2minecraft.formats.predicted_grids import (
    SUFFIXES,
    GridRules,
    PredictedGrid,
    grid_to_camera,
    grid_to_world,
    interpret_grid,
    read_stored_grid,
)
from world2minecraft.geometry.view_region import LabelRegion, RegionRule, label_region

SCENE = "scene"  # The name of the scene's grid among the views.
SHOWN_NAMES = 3
COLOUR_SUFFIX = re.compile(r"[._-](color|colour|rgb)$")  # NYU0003_0000_color.jpg, its NYU0003_0000.


@dataclass(frozen=True)
class GridFiles:
    """The files of saved predictions.

    Attributes:
        path: Folder or file given by the user.
        of_view: File of each view that has one, by the name of the view.
        scene: File of the grid of the whole scene, or None.
        unused: Names of files that belong to no view.
    """

    path: Path
    of_view: dict[str, Path]
    scene: Path | None = None
    unused: tuple[str, ...] = ()


def find_grids(path: Path, views: Sequence[str]) -> GridFiles:
    """Find the saved predictions of views by their names.

    A single file that is not named like a view is the grid of the whole scene.

    Args:
        path: Folder with one file per view, or a single file.
        views: Names of the views.

    Raises:
        InputError: If there are no files, or if none of several is named like a view.
    """
    if path.is_dir():
        files = [one for one in sorted(path.iterdir()) if one.suffix in SUFFIXES]
        files = [one for one in files if not one.name.startswith(".")]
    else:
        files = [path] if path.is_file() else []
    if not files:
        found = "contains no" if path.is_dir() else "not found; expected"
        raise InputError(path, f"{found} predictions as .npy, .npz, .pkl or .bin files")
    stems: dict[str, Path] = {}
    for file in files:
        if file.stem in stems:
            raise InputError(file, f"and {stems[file.stem].name} predict the same view; remove one")
        stems[file.stem] = file
    keys = {view: next((key for key in _keys(view) if key in stems), None) for view in views}
    of_view = {view: stems[key] for view, key in keys.items() if key is not None}
    if of_view:
        used = set(of_view.values())
        return GridFiles(path, of_view, None, tuple(one.name for one in files if one not in used))
    if len(files) == 1:
        return GridFiles(path, {}, files[0])
    raise InputError(
        path,
        f"no file is named like a view: the views are {_some(views)}, the files "
        f"{_some([one.name for one in files])}",
    )


def _keys(view: str) -> tuple[str, ...]:
    """Return the file stems that belong to a view."""
    stem = Path(view).stem if Path(view).suffix.lower() in (".jpg", ".jpeg", ".png") else view
    return (view, stem, COLOUR_SUFFIX.sub("", stem))


def _some(names: Iterable[str]) -> str:
    listed = list(names)
    shown = ", ".join(listed[:SHOWN_NAMES])
    return f"{shown} ... ({len(listed)})" if len(listed) > SHOWN_NAMES else shown


def read_grid(path: Path, rules: GridRules, *, is_frame: bool) -> PredictedGrid:
    """Read a saved prediction. Raises the exceptions of ``interpret_grid``."""
    return interpret_grid(read_stored_grid(path), rules, is_frame=is_frame)


def view_camera(view: View) -> tuple[Camera, np.ndarray]:
    """Return the camera of a view's image, or of its depth without one, and its pose in the scan.

    Raises:
        ValueError: If the view has neither.
    """
    if view.colour_camera is not None:
        return view.colour_camera, view.camera_to_scan
    if view.depth_camera is None:
        raise ValueError(f"view {view.name} has no image")
    return view.depth_camera, view.depth_camera_to_scan


def place_scene(grid: PredictedGrid, source_to_scan: np.ndarray) -> np.ndarray:
    """Return the transform from the grid of a scene to the scan, float64 [4, 4].

    The world of the grid's corner is that of the scan, before or after georeferenced poses were
    moved by ``source_to_scan``, unless the file states their relation.
    """
    world_to_scan = np.eye(4) if grid.scan_to_world is None else invert_rigid(grid.scan_to_world)
    return move_like_capture(world_to_scan @ grid_to_world(grid), source_to_scan)


def stated_place(
    grid: PredictedGrid, camera_to_scan: np.ndarray, source_to_scan: np.ndarray
) -> np.ndarray | None:
    """Return the transform from a frame's grid to the scan as its file states it, or None."""
    to_camera = grid_to_camera(grid)
    if to_camera is not None:
        return camera_to_scan @ to_camera
    return None if grid.origin_m is None else place_scene(grid, source_to_scan)


def place_frame(
    grid: PredictedGrid,
    camera_to_scan: np.ndarray,
    scan_to_room: np.ndarray,
    source_to_scan: np.ndarray,
) -> np.ndarray:
    """Return the transform from a frame's grid to the scan, float64 [4, 4].

    A grid whose file states no place is put where data sets cut it: NYUv2 turns the box with the
    camera, OccScanNet and the paper choose one of eight directions.
    """
    stated = stated_place(grid, camera_to_scan, source_to_scan)
    if stated is not None:
        return stated
    rule = RegionRule("free" if grid.axes == "xzy" else "paper")
    placed = label_region(scan_to_room @ camera_to_scan, rule).region_to_room
    return invert_rigid(scan_to_room) @ placed


def grid_region(grid: PredictedGrid) -> LabelRegion:
    """Return the cells of a grid as a region whose room is the grid itself."""
    sides = grid.labels.shape
    return LabelRegion((sides[0], sides[1], sides[2]), grid.voxel_m, np.eye(4), "free")
