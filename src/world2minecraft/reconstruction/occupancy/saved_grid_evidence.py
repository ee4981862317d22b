"""Convert saved predictions of other networks to evidence, alone or beside depth.

Beside depth, a prediction votes for the classes of surface points, and is evidence of occupancy
where the view's own depth measured nothing: behind the first surface and at missing pixels.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.types import Camera, GridEvidence, PointEvidence, Scan, View
from world2minecraft.formats.predicted_grids import PredictedGrid
from world2minecraft.formats.sscnet import NYU_FOCAL_PX, NYU_SIZE_PX
from world2minecraft.reconstruction.occupancy import Predictor, notes_of
from world2minecraft.reconstruction.occupancy.monocular_occupancy import (
    before_walls,
    cell_colours,
    cell_depths,
    visible_cells,
)
from world2minecraft.reconstruction.occupancy.parameters import PredictionParameters
from world2minecraft.reconstruction.occupancy.saved_grid_checks import check_predictions
from world2minecraft.reconstruction.occupancy.saved_grids import (
    SCENE,
    GridFiles,
    find_grids,
    grid_region,
    place_frame,
    place_scene,
    read_grid,
    stated_place,
    view_camera,
)

INTO_CELLS = (0.25, 1.0)  # So many cells behind its surface, a point looks for its class.
CLEAR_CELLS = 1.0  # Depth decides up to so far behind its surface.
MAX_COLOUR_VIEWS = 24  # That give a scene's cells their colours.
SAME_FOCAL = 0.05  # A lens off by more than this share is another than the network assumes.


class SavedGridPredictor:
    """Yields the evidence of another predictor and that of saved grids.

    Args:
        base: Predictor of the measured evidence, which yields nothing for views without depth.
        parameters: Folder of the grids, and their conventions.
    """

    def __init__(self, base: Predictor, parameters: PredictionParameters):
        self.base = base
        self.parameters = parameters
        self._notes: tuple[str, ...] = ()

    @property
    def notes(self) -> tuple[str, ...]:
        """The notes on the grids, and those of the base predictor."""
        return (*notes_of(self.base), *self._notes)

    def predict(self, scan: Scan) -> Iterator[PointEvidence | GridEvidence]:
        """Yield the measured evidence with votes, and then the grids.

        Raises:
            InputError: If the grids cannot be read, or if they contradict the capture.
        """
        files = find_grids(Path(self.parameters.path), scan.frames_used)
        facts = check_predictions(files, scan, self.parameters)
        self._notes = (*facts, *self._describe(files, scan))
        scene = self._scene(files, scan)
        poses = {view.name: view_camera(view)[1] for view in scan.views if is_shown(view)}
        for item in self.base.predict(scan):
            if isinstance(item, PointEvidence):
                yield self._with_votes(item, files, scan, scene, poses)
            else:
                yield item
        if scene is not None:
            yield scene
        for view in scan.views:
            if view.name in files.of_view and is_shown(view):
                grid = self._read(files.of_view[view.name])
                pose = view_camera(view)[1]
                place = place_frame(grid, pose, scan.scan_to_room, scan.source_to_scan)
                yield frame_evidence(grid, view, place)

    def _read(self, path: Path, *, is_frame: bool = True) -> PredictedGrid:
        return read_grid(path, self.parameters.rules, is_frame=is_frame)

    def _scene(self, files: GridFiles, scan: Scan) -> GridEvidence | None:
        if files.scene is None:
            return None
        grid = self._read(files.scene, is_frame=False)
        return scene_evidence(grid, place_scene(grid, scan.source_to_scan), scan)

    def _with_votes(
        self,
        item: PointEvidence,
        files: GridFiles,
        scan: Scan,
        scene: GridEvidence | None,
        poses: dict[str, np.ndarray],
    ) -> PointEvidence:
        """Return points with the votes of the grid of their view, or of the scene."""
        if scene is not None:
            grid, place, voxel_m = scene.probabilities, scene.grid_to_scan, scene.voxel_m
        elif item.view in files.of_view and item.view in poses:
            read = self._read(files.of_view[item.view])
            pose = poses[item.view]
            place = place_frame(read, pose, scan.scan_to_room, scan.source_to_scan)
            grid, voxel_m = read.probabilities(), read.voxel_m
        else:
            return item
        votes = point_votes(item.points_m, item.camera_m, grid, place, voxel_m)
        others = 0 if item.point_votes is None else item.point_votes.astype(np.float32)
        return replace(item, votes=(votes + others).astype(np.float16), vote_rows=None)

    def _describe(self, files: GridFiles, scan: Scan) -> tuple[str, ...]:
        """Return notes on which grids are used and how they are placed."""
        if files.scene is not None:
            grid = self._read(files.scene, is_frame=False)
            return (f"{files.scene.name} predicts the whole scene ({_told(grid)})",)
        total = len(scan.frames_used)
        first = next(name for name in scan.frames_used if name in files.of_view)
        grid = self._read(files.of_view[first])
        notes = [f"{len(files.of_view)} of {total} views have predictions ({_told(grid)})"]
        if files.unused:
            notes.append(
                f"{len(files.unused)} files of predictions belong to no view and are unused"
            )
        if stated_place(grid, np.eye(4), scan.source_to_scan) is None:
            notes.append(
                "the predictions state no cam_pose and voxel_origin; each is placed in front of "
                "its camera as in the data sets"
            )
        view = next((view for view in scan.views if view.name == first), None)
        if view is not None and is_shown(view) and grid.axes == "xzy":
            notes += lens_note(view_camera(view)[0])
        return tuple(notes)


def is_shown(view: View) -> bool:
    """Return whether a view has an image."""
    return view.colour_camera is not None or view.depth_camera is not None


def _told(grid: PredictedGrid) -> str:
    kind = "class ids" if grid.shares is None else "probabilities"
    axes = ", ".join(grid.axes)
    sides = "x".join(map(str, grid.labels.shape))
    return f"{grid.convention}, axes {axes}, {kind}, {sides} cells of {grid.voxel_m:g} m"


def lens_note(camera: Camera) -> list[str]:
    """Return a note if a camera sees less than the lens that networks of NYUv2 assume."""
    wide = camera.width_px / camera.fx_px
    assumed = NYU_SIZE_PX[0] / NYU_FOCAL_PX
    if wide >= assumed * (1 - SAME_FOCAL):
        return []
    return [
        f"the focal length is {camera.fx_px * NYU_SIZE_PX[0] / camera.width_px:.0f} px at a width "
        f"of {NYU_SIZE_PX[0]} px, but networks of NYUv2 assume {NYU_FOCAL_PX:.0f} px; predictions "
        "for uncropped images are too close to the camera"
    ]


def frame_evidence(grid: PredictedGrid, view: View, grid_to_scan: np.ndarray) -> GridEvidence:
    """Return the evidence of a frame's grid: its cells in the image up to the first wall.

    Cells that the view's own depth decides are left to it.
    """
    camera, pose = view_camera(view)
    camera_to_grid = invert_rigid(grid_to_scan) @ pose
    region = grid_region(grid)
    seen = before_walls(grid.labels, region, camera_to_grid, camera) & (grid.labels != UNKNOWN)
    if grid.axes == "xzy":
        seen &= in_nyu_image(region.centers_m(), camera_to_grid)
    if view.depth_m is not None:
        seen &= ~decided_by_depth(view, grid, grid_to_scan)
    colour = None
    if view.colour is not None:
        occupied = (grid.labels > 0) & (grid.labels != UNKNOWN)
        colour = cell_colours(occupied, region, camera_to_grid, camera, view.colour)
    return GridEvidence(view.name, grid.probabilities(), seen, grid.voxel_m, grid_to_scan, colour)


def in_nyu_image(centers_m: np.ndarray, camera_to_grid: np.ndarray) -> np.ndarray:
    """Return whether points of the grid lie in the image that networks of NYUv2 are given.

    Their loaders crop other images to this lens.
    """
    at = apply(invert_rigid(camera_to_grid), centers_m)
    ahead = np.maximum(at[..., 2], 1e-6)
    across, down = (0.5 * side / NYU_FOCAL_PX for side in NYU_SIZE_PX)
    slack = 1 + SAME_FOCAL  # The principal point is not exactly in the middle.
    inside = np.abs(at[..., 0]) <= across * slack * ahead
    return np.asarray((at[..., 2] > 0) & inside & (np.abs(at[..., 1]) <= down * slack * ahead))


def decided_by_depth(view: View, grid: PredictedGrid, grid_to_scan: np.ndarray) -> np.ndarray:
    """Return the cells in front of a view's measured surface or at it, bool [X, Y, Z]."""
    camera, depth_m = view.depth_camera, view.depth_m
    if camera is None or depth_m is None:
        return np.zeros(grid.labels.shape, bool)
    camera_to_grid = invert_rigid(grid_to_scan) @ view.depth_camera_to_scan
    pixels, inside, at_m = cell_depths(grid_region(grid), camera_to_grid, camera)
    surface_m = depth_m[pixels[..., 1], pixels[..., 0]]
    return inside & (surface_m > 0) & (at_m <= surface_m + CLEAR_CELLS * grid.voxel_m)


def scene_evidence(grid: PredictedGrid, grid_to_scan: np.ndarray, scan: Scan) -> GridEvidence:
    """Return the evidence of the grid of a whole scene, with the colours that the views show."""
    known = grid.labels != UNKNOWN
    occupied = known & (grid.labels > 0)
    total = np.zeros((*grid.labels.shape, 3), np.float32)
    count = np.zeros(grid.labels.shape, np.float32)
    region = grid_region(grid)
    step = max(1, len(scan.views) // MAX_COLOUR_VIEWS)
    for number, view in enumerate(scan.views):
        if number % step or view.colour is None or view.colour_camera is None:
            continue
        camera_to_grid = invert_rigid(grid_to_scan) @ view.camera_to_scan
        shown, pixels = visible_cells(occupied, region, camera_to_grid, view.colour_camera)
        total[shown] += view.colour[pixels[:, 1], pixels[:, 0]]
        count[shown] += 1
    colour = None
    if count.any():
        colour = (total / np.maximum(count, 1)[..., None]).astype(np.uint8)
        colour[occupied & (count == 0)] = np.median(colour[count > 0], axis=0).astype(np.uint8)
    return GridEvidence(SCENE, grid.probabilities(), known, grid.voxel_m, grid_to_scan, colour)


def point_votes(
    points_m: np.ndarray,
    camera_m: np.ndarray,
    probabilities: np.ndarray,
    grid_to_scan: np.ndarray,
    voxel_m: float,
) -> np.ndarray:
    """Return the votes of the cells behind the points of a surface, float32 [N, 12].

    A point votes by the first cell behind it that is more likely occupied than not, or not at all.

    Args:
        points_m: Points of the surface in the scan, float [N, 3].
        camera_m: Position of the camera in the scan, float [3].
        probabilities: Probability of each class, float16 [X, Y, Z, 12].
        grid_to_scan: Transform from the grid's minimum corner to the scan.
        voxel_m: Edge length of the cells.
    """
    votes = np.zeros((len(points_m), CLASS_COUNT), np.float32)
    scan_to_grid = invert_rigid(grid_to_scan)
    at_m = apply(scan_to_grid, points_m.astype(np.float64))
    ray_m = at_m - apply(scan_to_grid, camera_m)
    ray_m /= np.maximum(np.linalg.norm(ray_m, axis=1, keepdims=True), 1e-9)
    without = np.arange(len(points_m))
    for depth in INTO_CELLS:
        cells = np.floor(at_m[without] / voxel_m + depth * ray_m[without]).astype(np.int64)
        held = ((cells >= 0) & (cells < probabilities.shape[:3])).all(axis=1)
        found = np.zeros((len(without), CLASS_COUNT), np.float32)
        found[held] = probabilities[tuple(cells[held].T)]
        found[:, 0] = 0
        solid = found.sum(axis=1) > 0.5
        votes[without[solid]] = found[solid]
        without = without[~solid]
    return votes
