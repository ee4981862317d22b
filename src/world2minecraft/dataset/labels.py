"""The labels of one image: what its region holds, and what of it the image shows.

In: the cells of a scene, a region, a camera and the depth of its image. Out: ``OccLabels``. The
labels are the scene's own. Masks follow from the camera and from the depth alone, so that whoever
has an image's files can make them again:

- in the frustum: the cell's middle is before the camera and falls into the image (the paper's);
- hit: how many pixels' points lie in the cell. A point is moved ``INWARD_M`` along its ray; where
  it is in no solid cell then, the nearest within ``REACH_M`` counts;
- free: empty, and some pixel's ray was in it over more than a millimetre before its surface.

The first surface counts, be it glass: what lies behind a window is occluded.
"""

import numpy as np

from world2minecraft.dataset.free_kernels import TILE, greatest_depths, mark_free
from world2minecraft.dataset.label_kernels import count_hits, gather, mark_in_frustum
from world2minecraft.dataset.region import RegionRule, region_in
from world2minecraft.dataset.values import LabelRegion, OccLabels, SceneVoxels
from world2minecraft.render import BlockScene, render_volume
from world2minecraft.types import Camera

INWARD_M = 5e-5  # Far more than depth is rounded by, far less than shapes are thick.
REACH_M = 0.006  # A point so far from a solid cell is rounding at a shape's edge.
LABEL_WIDTH_PX = 640  # Of an image that is cast for labels alone.


def label_image(
    voxels: SceneVoxels,
    region: LabelRegion,
    camera: Camera,
    camera_to_room: np.ndarray,
    depth_m: np.ndarray,
) -> OccLabels:
    """Return the labels and masks of an image.

    Args:
        voxels: the scene.
        region: which cells; see ``dataset.region``.
        camera: of the image; its distortion is ignored.
        camera_to_room: 4x4, OpenCV axes, metres.
        depth_m: float32 [H, W], z-depth of the first surface, 0 where there is none.
    """
    view = _View(voxels, region, camera, camera_to_room, depth_m)
    labels, fine, instance = (values[1:-1, 1:-1, 1:-1] for values in view.around)
    labels, fine, instance = map(np.ascontiguousarray, (labels, fine, instance))
    in_frustum, free = np.empty(region.shape, bool), np.empty(region.shape, bool)
    height, width = view.depth_m.shape
    mark_in_frustum(view.to_camera, view.lens, width, height, in_frustum)
    tiles = np.empty((-(-height // TILE), -(-width // TILE)), np.float32)
    greatest_depths(view.depth_m, tiles)
    mark_free(
        labels, view.to_camera, view.place, view.lens, view.depth_m, tiles, np.empty((8, 3)), free
    )
    hits, _ = view.hits(False)
    return OccLabels(region, labels, fine, instance, in_frustum, hits, free)


def cells_of_pixels(
    voxels: SceneVoxels,
    region: LabelRegion,
    camera: Camera,
    camera_to_room: np.ndarray,
    depth_m: np.ndarray,
) -> np.ndarray:
    """Return the cell that each pixel sees: its C-order number in the region, -1 for none.

    Args: as ``label_image``.

    Returns:
        int32 [H, W]; ``hits`` counts its values.
    """
    return _View(voxels, region, camera, camera_to_room, depth_m).hits(True)[1]


def cast_depth(
    scene: BlockScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    width_px: int | None = LABEL_WIDTH_PX,
) -> tuple[Camera, np.ndarray]:
    """Return the depth of an image that nobody draws, and the camera that it is of.

    Args:
        scene: ``prepare_scene`` of the world.
        camera: that the labels are for.
        camera_to_room: 4x4.
        width_px: the width to cast at; None for the camera's own.

    Returns:
        The camera, and z-depth float32 [H, W] with 0 where there is nothing.
    """
    if width_px is not None:
        camera = resized(camera, width_px)
    return camera, render_volume(scene, camera, camera_to_room, outputs=()).depth_m


def resized(camera: Camera, width_px: int) -> Camera:
    """Return the camera with another number of pixels for the same view."""
    if width_px == camera.width_px:
        return camera
    across = width_px / camera.width_px
    height_px = max(round(camera.height_px * across), 1)
    down = height_px / camera.height_px
    return Camera(
        width_px,
        height_px,
        camera.fx_px * across,
        camera.fy_px * down,
        camera.cx_px * across,
        camera.cy_px * down,
        camera.distortion,
    )


def label_view(
    voxels: SceneVoxels,
    scene: BlockScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    rule: RegionRule | None = None,
) -> OccLabels:
    """Return the labels of a view of which there is no picture; see ``cast_depth``."""
    region = region_in(voxels, camera_to_room, rule)
    camera, depth_m = cast_depth(scene, camera, camera_to_room)
    return label_image(voxels, region, camera, camera_to_room, depth_m)


def occluded(occ: OccLabels) -> np.ndarray:
    """Bool [X, Y, Z]: cells in the frustum that hold something and that no pixel sees."""
    return occ.in_frustum & (occ.fine > 0) & (occ.hits == 0)


def unknown(occ: OccLabels) -> np.ndarray:
    """Bool [X, Y, Z]: cells in the frustum of which the image says nothing, and that are empty."""
    return occ.in_frustum & (occ.fine == 0) & (occ.hits == 0) & ~occ.free


class _View:
    """An image's camera and its region, in the numbers that the kernels read."""

    def __init__(
        self,
        voxels: SceneVoxels,
        region: LabelRegion,
        camera: Camera,
        camera_to_room: np.ndarray,
        depth_m: np.ndarray,
    ):
        size = (camera.height_px, camera.width_px)
        if depth_m.shape != size:
            raise ValueError(f"depth of {depth_m.shape} is not of a camera with {size} pixels")
        cells_to_room = region.region_to_room.copy()
        cells_to_room[:3, :3] *= region.voxel_m
        place = np.linalg.inv(cells_to_room) @ camera_to_room
        self.region, self.depth_m = region, np.ascontiguousarray(depth_m, np.float32)
        self.place = np.ascontiguousarray(place[:3])
        self.to_camera = np.ascontiguousarray(np.linalg.inv(place)[:3])
        self.lens = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
        self.around = _gathered(voxels, region, cells_to_room)

    def hits(self, cells_wanted: bool) -> tuple[np.ndarray, np.ndarray]:
        """Return the hits of each cell, and the cell of each pixel where that is wanted."""
        hits = np.zeros(self.region.shape, np.uint32)
        cells = np.empty(self.depth_m.shape if cells_wanted else (0, 0), np.int32)
        # Of a turned region the cells are samples: a surface may pass between two solid ones.
        free_kind = self.region.kind == "free"
        reach = 1.0 if free_kind else REACH_M / self.region.voxel_m
        count_hits(
            self.around[1], self.place, self.lens, self.depth_m, INWARD_M, reach, hits, cells
        )
        return hits, cells


def _gathered(
    voxels: SceneVoxels, region: LabelRegion, cells_to_room: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return labels, fine classes and objects of a region and of one cell more on each side."""
    shape = tuple(side + 2 for side in region.shape)
    around = (np.empty(shape, np.uint8), np.empty(shape, np.uint16), np.empty(shape, np.uint16))
    to_scene = cells_to_room[:3].copy()
    to_scene[:, 3] -= voxels.origin_m
    to_scene /= voxels.voxel_m
    gather(voxels.labels, voxels.fine, voxels.instance, to_scene, np.array([-1, -1, -1]), *around)
    return around
