"""Frames: samples that are converted to a common image size and cell size.

The centre of the image is cropped to the required aspect ratio and resampled, and the intrinsics
are adapted. Fine labels are downsampled with SSCNet's rule, which was also used for the published 8
cm grids. A coarse cell is seen if any of its fine cells is seen. It is free if it is empty, not
seen, and a ray crosses any of its fine cells.
"""

from dataclasses import dataclass

import numpy as np
from PIL import Image

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.metrics.protocols import KnownCells
from world2minecraft.formats.sscnet import downsample_labels
from world2minecraft.minecraftocc.formats.label_grids import cells_in_image
from world2minecraft.minecraftocc.types import OccSample
from world2minecraft.networks.config import Grid

SAME_SURFACE = 0.05  # Maximum relative depth difference of neighbours on the same surface.


@dataclass(frozen=True)
class FrameRule:
    """The common format of all frames in a run.

    Attributes:
        grid: Grid of cells.
        width_px: Image width in pixels.
        height_px: Image height in pixels.
    """

    grid: Grid
    width_px: int
    height_px: int


@dataclass(frozen=True, eq=False)
class Frame:
    """A training frame.

    Attributes:
        key: Key of the sample.
        scene_id: Name of the scene.
        image: Colour image, uint8 [H, W, 3].
        depth_m: Depth in metres, float32 [H, W]; 0 for none.
        intrinsics: Camera matrix with pixel centres at +0.5, float32 [3, 3].
        camera_to_grid: Matrix from camera coordinates to the position relative to the corner of
            cell (0, 0, 0) in metres, float32 [4, 4].
        grid_to_room: Matrix from this position to room coordinates, float64 [4, 4].
        labels: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z].
        in_frustum: Whether each cell centre is inside the image, bool [X, Y, Z].
        seen: Whether each cell is seen by a pixel, bool [X, Y, Z].
        free: Whether each cell is empty and crossed by a ray, bool [X, Y, Z].
        has_depth: Whether ``seen`` and ``free`` are known.
    """

    key: str
    scene_id: str
    image: np.ndarray
    depth_m: np.ndarray
    intrinsics: np.ndarray
    camera_to_grid: np.ndarray
    grid_to_room: np.ndarray
    labels: np.ndarray
    in_frustum: np.ndarray
    seen: np.ndarray
    free: np.ndarray
    has_depth: bool

    @property
    def known(self) -> KnownCells:
        """Ground truth and masks for the evaluation protocols."""
        masks = (self.seen, self.free) if self.has_depth else (None, None)
        return KnownCells(self.labels, self.in_frustum, *masks)


def make_frame(sample: OccSample, rule: FrameRule) -> Frame:
    """Convert a sample to a frame.

    Raises:
        InputError: If the sample has no image, if its camera has lens distortion, or if its cells
            cannot be converted to the grid.
    """
    if sample.colour is None:
        raise InputError(
            sample.key,
            "the sample has no image; build the data set with images (without --labels-only)",
        )
    if any(sample.camera.distortion):
        raise InputError(sample.key, "the camera has lens distortion; undistort the images first")
    crop = _Crop(sample.camera, rule)
    known = cells_with_masks(sample, rule.grid)
    grid_to_room = sample.occ.region.region_to_room
    camera_to_grid = invert_rigid(grid_to_room) @ sample.camera_to_room
    nothing = np.zeros(known.labels.shape, bool)
    inside, seen, free = (
        nothing if mask is None else mask for mask in (known.in_frustum, known.seen, known.free)
    )
    if crop.cuts:
        inside, _, _ = cells_in_image(
            rule.grid.shape, rule.grid.voxel_m, invert_rigid(camera_to_grid), crop.camera
        )
        seen, free = seen & inside, free & inside
    return Frame(
        key=sample.key,
        scene_id=sample.scene_id,
        image=crop.colour(sample.colour),
        depth_m=crop.depth(sample.depth_m),
        intrinsics=crop.camera.matrix.astype(np.float32),
        camera_to_grid=camera_to_grid.astype(np.float32),
        grid_to_room=grid_to_room,
        labels=known.labels,
        in_frustum=inside,
        seen=seen,
        free=free,
        has_depth=known.seen is not None,
    )


def cells_with_masks(sample: OccSample, grid: Grid) -> KnownCells:
    """Return the ground truth of a sample in the cells of a grid. The sample needs no image.

    Raises:
        InputError: If the cells of the sample cannot be converted to the grid.
    """
    factor, occ = _factor(sample, grid), sample.occ
    if factor == 1:
        labels, inside = occ.labels, occ.in_frustum
    else:
        labels = downsample_labels(occ.labels, factor)
        grid_to_camera = invert_rigid(sample.camera_to_room) @ occ.region.region_to_room
        inside = cells_in_image(grid.shape, grid.voxel_m, grid_to_camera, sample.camera)[0]
    seen, free = (_any_of(mask, factor) for mask in (occ.visible, occ.free))
    if not (seen.any() or free.any()):
        return KnownCells(labels, inside)
    return KnownCells(labels, inside, seen, free & (labels == 0) & ~seen)


def _factor(sample: OccSample, grid: Grid) -> int:
    """Return the number of region cells per grid cell along each side."""
    region, (shape, voxel_m) = sample.occ.region, grid
    factor = max(round(voxel_m / region.voxel_m), 1)
    fits = abs(factor * region.voxel_m - voxel_m) < 1e-6
    if not fits or tuple(side * factor for side in shape) != region.shape:
        have, want = ("x".join(str(side) for side in of) for of in (region.shape, shape))
        raise InputError(
            sample.key,
            f"a region of {have} cells of {region.voxel_m:g} m cannot be converted to {want} cells "
            f"of {voxel_m:g} m; build the data set with cells of 0.08 m (--voxel 0.08) or choose "
            "another grid",
        )
    return factor


def _any_of(mask: np.ndarray, factor: int) -> np.ndarray:
    if factor == 1:
        return mask
    blocks = [part for side in mask.shape for part in (side // factor, factor)]
    return np.asarray(mask.reshape(blocks).any(axis=(1, 3, 5)))


class _Crop:
    """The largest central part of an image with the required aspect ratio, at the required size."""

    def __init__(self, camera: Camera, rule: FrameRule):
        scale = max(rule.width_px / camera.width_px, rule.height_px / camera.height_px)
        self.width, self.height = rule.width_px / scale, rule.height_px / scale
        self.left = (camera.width_px - self.width) / 2
        self.top = (camera.height_px - self.height) / 2
        self.cuts = max(self.left, self.top) > 0.5
        self.camera = Camera(
            rule.width_px,
            rule.height_px,
            camera.fx_px * scale,
            camera.fy_px * scale,
            (camera.cx_px - self.left) * scale,
            (camera.cy_px - self.top) * scale,
        )

    def colour(self, pixels: np.ndarray) -> np.ndarray:
        """Crop and resample a colour image to uint8 [H, W, 3]."""
        size = (self.camera.width_px, self.camera.height_px)
        box = (self.left, self.top, self.left + self.width, self.top + self.height)
        image = Image.fromarray(pixels).resize(size, Image.Resampling.BILINEAR, box=box)
        return np.asarray(image)

    def depth(self, depth_m: np.ndarray | None) -> np.ndarray:
        """Crop and resample a depth map to float32 [H, W], without blending different surfaces."""
        rows, columns = self.camera.height_px, self.camera.width_px
        if depth_m is None:
            return np.zeros((rows, columns), np.float32)
        down = self.top + (np.arange(rows) + 0.5) * self.height / rows - 0.5
        across = self.left + (np.arange(columns) + 0.5) * self.width / columns - 0.5
        return _depth_between(depth_m, down, across)


def _depth_between(depth_m: np.ndarray, down: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Interpolate depth at positions relative to the first pixel centre, [rows] and [columns].

    Using only the nearest pixel would shift the depth by half a pixel if an image is halved, which
    corresponds to a whole cell on walls at a steep angle.
    """
    first, high, low_share = [], [], []
    for places, side in ((down, depth_m.shape[0]), (across, depth_m.shape[1])):
        low = np.clip(np.floor(places).astype(int), 0, side - 1)
        first.append(low)
        high.append(np.clip(low + 1, 0, side - 1))
        low_share.append(1 - np.clip(places - low, 0, 1))
    shares = np.ix_(*low_share)
    corners = [
        (depth_m[np.ix_(rows, columns)], weight)
        for rows, down_share in ((first[0], shares[0]), (high[0], 1 - shares[0]))
        for columns, weight in (
            (first[1], down_share * shares[1]),
            (high[1], down_share * (1 - shares[1])),
        )
    ]
    values = np.stack([value for value, _ in corners])
    weights = np.stack([np.broadcast_to(weight, values.shape[1:]) for _, weight in corners])
    nearest = np.take_along_axis(values, weights.argmax(axis=0)[None], axis=0)[0]
    minimum = values.min(axis=0)
    one_surface = (minimum > 0) & (values.max(axis=0) <= minimum * (1 + SAME_SURFACE))
    return np.where(one_surface, (values * weights).sum(axis=0), nearest).astype(np.float32)
