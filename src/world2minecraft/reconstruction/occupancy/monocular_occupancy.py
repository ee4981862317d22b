"""F_mono of the paper: predict the cells in front of the camera from a single image.

The box of cells of each view follows the rule by which the labels of training images are cut
(``geometry/view_region.py``), aligned with the cells and the floor of the room. The network's
prediction is used for the cells in the image up to the first wall. Hidden cells are guesses, so
fusion gives the prediction a low weight.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.shipped_weights import shipped
from world2minecraft.core.types import Camera, GridEvidence, Scan, View
from world2minecraft.geometry.undistort import pinhole_camera, undistort_image
from world2minecraft.geometry.unprojection import project, unproject_depth
from world2minecraft.geometry.view_region import (
    DEFAULT_VOXEL_M,
    LabelRegion,
    RegionRule,
    label_region,
)
from world2minecraft.reconstruction.occupancy.onnx_network import NetworkFacts, OccupancyNetwork

SHIPPED = shipped("mono.onnx")
NEAREST_M = 0.1  # Cells nearer to the plane of the camera are not in the image.
WALLS = [CLASS_NAMES.index(name) for name in ("wall", "window")]
WALL_CELLS = 3.0  # So far behind its first cell a wall ends; along one seen aslant cells lie apart.
HIDDEN_CELLS = 1.5  # A cell farther behind the first surface of its pixels is hidden by it.


class MonoPredictor:
    """Yields a GridEvidence for each view with a colour image.

    Args:
        network: Path of an ONNX file; the default is the built-in network.

    Raises:
        InputError: If the file cannot be used.
    """

    def __init__(self, network: str | Path = ""):
        self.network = OccupancyNetwork(network or SHIPPED)

    def predict(self, scan: Scan) -> Iterator[GridEvidence]:
        """Yield the network's prediction for each view, in the order of the scan.

        Raises:
            CaptureError: If no view has a colour image.
        """
        none = True
        for view in scan.views:
            if view.colour is not None:
                none = False
                yield self.look(view, scan.scan_to_room)
        if none:
            raise CaptureError(
                "capture",
                "contains no colour images; use the predictor depth instead of mono (--predictor)",
            )

    def look(self, view: View, scan_to_room: np.ndarray) -> GridEvidence:
        """Return the network's prediction for a view with a colour image."""
        facts = self.network.facts
        picture, camera = fitted(view, facts.image_size_px)
        camera_to_room = scan_to_room @ view.camera_to_scan
        region = region_before(camera_to_room, facts)
        camera_to_grid = invert_rigid(region.region_to_room) @ camera_to_room
        found = self.network.probabilities(
            np.moveaxis(picture, 2, 0).astype(np.float32) / np.float32(255),
            camera.matrix,
            camera_to_grid,
            depth_of(view, camera) if facts.wants_depth else None,
        )
        return GridEvidence(
            view.name,
            found.astype(np.float16),
            before_walls(found.argmax(axis=-1), region, camera_to_grid, camera),
            facts.voxel_m,
            invert_rigid(scan_to_room) @ region.region_to_room,
            cell_colours(found[..., 0] < 0.5, region, camera_to_grid, camera, picture),
        )


def region_before(camera_to_room: np.ndarray, facts: NetworkFacts) -> LabelRegion:
    """Return the network's box of cells in front of a camera, as in its training data.

    The rule is defined in cells of the default size; a network with larger cells covers the same
    box.
    """
    usual = tuple(max(1, round(n * facts.voxel_m / DEFAULT_VOXEL_M)) for n in facts.grid_shape)
    rule = RegionRule(facts.region, (usual[0], usual[1], usual[2]))
    place = label_region(camera_to_room, rule).region_to_room
    return LabelRegion(facts.grid_shape, facts.voxel_m, place, facts.region)


def fitted(view: View, size_px: tuple[int, int]) -> tuple[np.ndarray, Camera]:
    """Return a view's image as the network expects it, and the camera of that image.

    The image is undistorted, cropped evenly on both sides to the network's aspect ratio, and
    resized.

    Returns:
        The image as uint8 [H, W, 3], and its camera.
    """
    colour, camera = view.colour, view.colour_camera
    if colour is None or camera is None:
        raise ValueError(f"view {view.name} has no colour image")
    if any(camera.distortion):
        flat = pinhole_camera(camera, camera.width_px)
        colour, camera = undistort_image(colour, camera, flat), flat
    wide, high = size_px
    side = min(camera.width_px / wide, camera.height_px / high)
    left, top = (camera.width_px - side * wide) / 2, (camera.height_px - side * high) / 2
    box = (left, top, left + side * wide, top + side * high)
    picture = Image.fromarray(colour).resize(size_px, Image.Resampling.BILINEAR, box=box)
    fx, fy = camera.fx_px / side, camera.fy_px / side
    cx, cy = (camera.cx_px - left) / side, (camera.cy_px - top) / side
    return np.array(picture), Camera(wide, high, fx, fy, cx, cy)


def depth_of(view: View, camera: Camera) -> np.ndarray | None:
    """Return a view's depth resampled into its colour camera, float32 [H, W], or None.

    Each depth pixel is projected to one pixel, where the nearest depth wins. The result is None if
    the view has no depth.
    """
    if view.depth_m is None or view.depth_camera is None:
        return None
    points, _ = unproject_depth(view.depth_m, view.depth_camera, view.depth_to_colour)
    points = points[points[:, 2] > NEAREST_M].astype(np.float64)
    found = np.full((camera.height_px, camera.width_px), np.inf)
    u, v = np.floor(project(points, camera)).astype(np.int64).T
    here = (u >= 0) & (v >= 0) & (u < camera.width_px) & (v < camera.height_px)
    np.minimum.at(found, (v[here], u[here]), points[here, 2])
    return np.where(np.isfinite(found), found, 0).astype(np.float32)


def before_walls(
    labels: np.ndarray, region: LabelRegion, camera_to_grid: np.ndarray, camera: Camera
) -> np.ndarray:
    """Return the mask of cells in the image that no wall or window hides, bool [X, Y, Z].

    Cells beyond the room have no labels in training, so predictions for them are meaningless.
    """
    pixels, inside, depth_m = cell_depths(region, camera_to_grid, camera)
    walls = inside & np.isin(labels, WALLS)
    if not walls.any():
        return inside
    u, v = pixels[walls].T
    first = _first_depth(u, v, depth_m[walls], region.voxel_m, camera)
    last_m = first[pixels[..., 1], pixels[..., 0]] + WALL_CELLS * region.voxel_m
    return inside & (depth_m <= last_m)


def cell_colours(
    occupied: np.ndarray,
    region: LabelRegion,
    camera_to_grid: np.ndarray,
    camera: Camera,
    picture: np.ndarray,
) -> np.ndarray:
    """Return the image colour of occupied cells, uint8 [X, Y, Z, 3].

    A hidden cell takes the colour of the nearest visible cell.
    """
    pixels, inside, depth_m = cell_depths(region, camera_to_grid, camera)
    requested = occupied & inside
    colour = np.zeros((*region.shape, 3), np.uint8)
    if not requested.any():
        return colour
    shown = _first_cells(pixels, requested, depth_m, region.voxel_m, camera)
    at_px = pixels[shown]
    colour[shown] = picture[at_px[:, 1], at_px[:, 0]]
    nearest = ndimage.distance_transform_edt(~shown, return_distances=False, return_indices=True)
    return np.where(occupied[..., None], colour[tuple(np.asarray(nearest))], np.uint8(0))


def visible_cells(
    occupied: np.ndarray, region: LabelRegion, camera_to_grid: np.ndarray, camera: Camera
) -> tuple[np.ndarray, np.ndarray]:
    """Return the occupied cells that no other occupied cell hides, and their pixels.

    Returns:
        The mask of the cells, bool [X, Y, Z], and the column and row of the pixel of each of the N
        cells in it, int64 [N, 2].
    """
    pixels, inside, depth_m = cell_depths(region, camera_to_grid, camera)
    requested = occupied & inside
    if not requested.any():
        return requested, np.zeros((0, 2), np.int64)
    shown = _first_cells(pixels, requested, depth_m, region.voxel_m, camera)
    return shown, pixels[shown]


def cell_depths(
    region: LabelRegion, camera_to_grid: np.ndarray, camera: Camera
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Project the centres of all cells into an image.

    Returns:
        The pixel of each cell (column, row), int64 [X, Y, Z, 2], the mask of the cells in the
        image, bool [X, Y, Z], and the depth of each centre in metres, float64 [X, Y, Z].
    """
    places = np.moveaxis(np.indices(region.shape), 0, -1) + 0.5
    at = apply(invert_rigid(camera_to_grid), places * region.voxel_m)
    ahead = at[..., 2] > NEAREST_M
    pixels = project(np.where(ahead[..., None], at, [0.0, 0.0, 1.0]), camera)
    size = (camera.width_px, camera.height_px)
    inside = ahead & ((pixels >= 0) & (pixels < size)).all(axis=-1)
    pixels = np.clip(np.floor(pixels), 0, np.array(size) - 1).astype(np.int64)
    return pixels, inside, at[..., 2]


def _first_cells(
    pixels: np.ndarray, requested: np.ndarray, depth_m: np.ndarray, voxel_m: float, camera: Camera
) -> np.ndarray:
    """Return the mask of the requested cells that are first along their pixels."""
    u, v = pixels[requested].T
    first = _first_depth(u, v, depth_m[requested], voxel_m, camera)
    shown = np.zeros_like(requested)
    shown[requested] = depth_m[requested] <= first[v, u] + HIDDEN_CELLS * voxel_m
    return shown


def _first_depth(u, v, depth_m, voxel_m: float, camera: Camera) -> np.ndarray:
    """Return the depth of the first cell that covers each pixel, float64 [H, W] in metres.

    The cells are drawn by their centres; each spreads as wide as a cell of the middle depth looks.
    """
    first = np.full((camera.height_px, camera.width_px), np.inf)
    np.minimum.at(first, (v, u), depth_m)
    side = 1 + 2 * int(camera.fx_px * voxel_m / (2 * float(np.median(depth_m))))
    return ndimage.minimum_filter(first, side, mode="nearest")
