"""Labelling of images: the contents of the cells in a region, and their visibility.

The input is the cells of a scene, a region, a camera and the depth of its image; the output is an
``OccLabels``. Its labels are those of the scene. Its masks are computed from the labels, the camera
and the rendered depth:

- in the frustum: the centre of the cell is in front of the camera and inside the image, as in the
  paper.
- hits: the number of pixels whose surface point is in the cell. The ray of each pixel is followed
  from ``AROUND_M`` before its point to ``AROUND_M`` behind it. The pixel is counted for the first
  solid cell that the ray enters, else for the cell in which it started. If none of these cells is
  solid, the nearest solid cell within ``REACH_M`` of the point is used.
- free: the cell is empty, and the ray of at least one pixel is inside it for more than a millimetre
  before it reaches a surface.

The first surface always counts, even if it is glass, so cells behind a window are occluded.

If a region is not aligned with the cells of the scene, for example because it rotates with the
view, labels and hits are sampled at the centres of its cells. Pixels of scene cells that are not
sampled are counted for the nearest occupied cell of the region.
"""

import numpy as np

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.labels.free_space_kernels import TILE, mark_free, max_depth_tiles
from world2minecraft.minecraftocc.labels.label_kernels import (
    DepthImage,
    count_hits,
    gather_labels,
    mark_in_frustum,
    source_cells,
)
from world2minecraft.minecraftocc.types import LabelRegion, OccLabels, SceneVoxels
from world2minecraft.rendering import BlockScene, render_volume

AROUND_M = 5e-6  # More than the rounding error of a depth below 40 m.
REACH_M = 0.006  # Maximum distance to a solid cell that is caused by rounding at an edge.
LABEL_WIDTH_PX = 640  # Width of images that are rendered only for labels.


def label_image(
    voxels: SceneVoxels,
    region: LabelRegion,
    camera: Camera,
    camera_to_room: np.ndarray,
    depth_m: np.ndarray,
) -> OccLabels:
    """Label the cells of an image's region.

    Args:
        voxels: Cells of the scene.
        region: Region to label; see ``minecraftocc.labels.camera_region``.
        camera: Camera of the image. Its lens distortion is ignored.
        camera_to_room: Camera pose in the room [4, 4], with OpenCV axes, in metres.
        depth_m: Depth of the first surface along the camera's z axis in metres, float32 [H, W]; 0
            if there is no surface.
    """
    view = _ImageView(voxels, region, camera, camera_to_room, depth_m)
    labels, fine, instance = view.contents
    in_frustum, free = np.empty(region.shape, bool), np.empty(region.shape, bool)
    depth_m = view.image.depth
    height, width = depth_m.shape
    mark_in_frustum(view.cells_to_camera, view.image.intrinsics, width, height, in_frustum)
    tiles = np.empty((-(-height // TILE), -(-width // TILE)), np.float32)
    max_depth_tiles(depth_m, tiles)
    mark_free(labels, view.cells_to_camera, view.image, tiles, np.empty((9, 3)), free)
    hits, _ = view.hits(False)
    return OccLabels(region, labels, fine, instance, in_frustum, hits, free)


def cells_of_pixels(
    voxels: SceneVoxels,
    region: LabelRegion,
    camera: Camera,
    camera_to_room: np.ndarray,
    depth_m: np.ndarray,
) -> np.ndarray:
    """Return the region cell that each pixel sees, as a flat index in C order, or -1 for none.

    The arguments are the same as for ``label_image``.

    Returns:
        Array of int32 [H, W]. The ``hits`` of a cell are the number of pixels with its index.
    """
    return _ImageView(voxels, region, camera, camera_to_room, depth_m).hits(True)[1]


def cast_depth(
    scene: BlockScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    width_px: int | None = LABEL_WIDTH_PX,
) -> tuple[Camera, np.ndarray]:
    """Compute the depth of a view without rendering a colour image.

    Args:
        scene: Scene prepared with ``prepare_scene``.
        camera: Camera of the view.
        camera_to_room: Camera pose in the room [4, 4].
        width_px: Image width to use. None uses the width of the camera.

    Returns:
        The camera at this width, and the depth along its z axis in metres, float32 [H, W], with 0
        where there is no surface.
    """
    if width_px is not None:
        camera = resize_camera(camera, width_px)
    return camera, render_volume(scene, camera, camera_to_room, outputs=()).depth_m


def resize_camera(camera: Camera, width_px: int) -> Camera:
    """Return a camera with the same field of view and another image width."""
    if width_px == camera.width_px:
        return camera
    height_px = max(round(camera.height_px * (width_px / camera.width_px)), 1)
    return camera.scaled_to(width_px, height_px)


def occluded_cells(occ: OccLabels) -> np.ndarray:
    """Return the occupied cells in the frustum that no pixel sees, bool [X, Y, Z]."""
    return occ.in_frustum & (occ.fine > 0) & (occ.hits == 0)


def unknown_cells(occ: OccLabels) -> np.ndarray:
    """Return the empty cells in the frustum that the image does not observe, bool [X, Y, Z]."""
    return occ.in_frustum & (occ.fine == 0) & (occ.hits == 0) & ~occ.free


class _ImageView:
    """The camera and the region of an image, in the form that the kernels use."""

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
            raise ValueError(
                f"depth_m must have the shape of the camera, {size}, got {depth_m.shape}"
            )
        self.voxels, self.region, self.camera_to_room = voxels, region, camera_to_room
        intrinsics = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
        camera_to_cells = _camera_to_cells(region, camera_to_room)
        self.image = DepthImage(
            camera_to_cells, intrinsics, np.ascontiguousarray(depth_m, np.float32)
        )
        self.contents = gather_region(voxels, region)
        cells_to_camera = invert(np.vstack([camera_to_cells, [0, 0, 0, 1]]))[:3]
        self.cells_to_camera = np.ascontiguousarray(cells_to_camera)

    def hits(self, cells_wanted: bool) -> tuple[np.ndarray, np.ndarray]:
        """Return the hits of each cell and, if requested, the cell of each pixel."""
        box = (
            self.region if is_on_cells(self.region, self.voxels) else _box(self.region, self.voxels)
        )
        hits = np.zeros(box.shape, np.uint32)
        cells = np.empty(self.image.depth.shape if cells_wanted else (0, 0), np.int32)
        image = self.image._replace(camera_to_cells=_camera_to_cells(box, self.camera_to_room))
        solid = gather_region(self.voxels, box, 1)[1]
        count_hits(solid, image, AROUND_M, REACH_M / box.voxel_m, np.empty(12), hits, cells)
        if box is self.region:
            return hits, cells
        return _resample_hits(self.region, self.contents[1], box, hits, cells)


def gather_region(
    voxels: SceneVoxels, region: LabelRegion, more: int = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the labels, fine classes and object numbers for the cells of a region, each [X, Y, Z].

    Args:
        voxels: Cells of the scene.
        region: Region whose cell centres are looked up in the scene. Cells outside the scene get
            255, 0 and 0.
        more: Number of additional cells on each side.
    """
    shape = tuple(side + 2 * more for side in region.shape)
    gathered = (np.empty(shape, np.uint8), np.empty(shape, np.uint16), np.empty(shape, np.uint16))
    to_scene = _to_cells_of(voxels.origin_m, voxels.voxel_m, region)
    gather_labels(
        voxels.labels, voxels.fine, voxels.instance, to_scene, np.full(3, -more), *gathered
    )
    return gathered


def is_on_cells(region: LabelRegion, voxels: SceneVoxels) -> bool:
    """Return whether a region is aligned with the cells of a scene, up to quarter turns."""
    to_scene = _to_cells_of(voxels.origin_m, voxels.voxel_m, region)
    return bool(np.abs(to_scene - np.round(to_scene)).max() < 1e-4)


def _to_cells_of(origin_m: np.ndarray, voxel_m: float, region: LabelRegion) -> np.ndarray:
    """Return the matrix from region cells to the cells of an upright room grid, float64 [3, 4]."""
    to_cells = region.region_to_room[:3].copy()
    to_cells[:, :3] *= region.voxel_m
    to_cells[:, 3] -= origin_m
    return np.ascontiguousarray(to_cells / voxel_m)


def _camera_to_cells(region: LabelRegion, camera_to_room: np.ndarray) -> np.ndarray:
    """Return the matrix from camera coordinates to region cells, float64 [3, 4]."""
    cells_to_room = region.region_to_room.copy()
    cells_to_room[:3, :3] *= region.voxel_m
    return np.ascontiguousarray((invert(cells_to_room) @ camera_to_room)[:3])


def _box(region: LabelRegion, voxels: SceneVoxels) -> LabelRegion:
    """Return the box of scene cells that encloses a region which is not aligned with them."""
    ends = np.stack(np.meshgrid(*([0, side] for side in region.shape)), -1).reshape(-1, 3)
    ends = apply(region.region_to_room, ends * region.voxel_m)
    low = np.floor((ends.min(axis=0) - voxels.origin_m) / voxels.voxel_m)
    high = np.ceil((ends.max(axis=0) - voxels.origin_m) / voxels.voxel_m)
    to_room = np.eye(4)
    to_room[:3, 3] = voxels.origin_m + low * voxels.voxel_m
    size = (high - low).astype(int)
    return LabelRegion((size[0], size[1], size[2]), voxels.voxel_m, to_room)


def _resample_hits(
    region: LabelRegion, fine: np.ndarray, box: LabelRegion, hits: np.ndarray, cells: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Convert the hits and pixel cells of a box to a region that samples the box."""
    source = np.empty(region.shape, np.int32)
    to_box = _to_cells_of(box.region_to_room[:3, 3], box.voxel_m, region)
    source_cells(to_box, np.array(box.shape), source)
    source = source.reshape(-1)
    own = np.where(source >= 0, hits.reshape(-1)[source], 0).astype(np.uint32)
    back = np.full(hits.size + 1, -1, np.int32)  # The last element is for pixels without a cell.
    back[source[source >= 0]] = np.flatnonzero(source >= 0)
    lost = np.flatnonzero((hits.reshape(-1) > 0) & (back[:-1] < 0))
    middles = np.stack(np.unravel_index(lost, box.shape), axis=-1) + 0.5
    back[lost] = _nearest_occupied(fine, apply(invert(np.vstack([to_box, [0, 0, 0, 1]])), middles))
    lost = lost[back[lost] >= 0]
    np.add.at(own, back[lost], hits.reshape(-1)[lost])
    return own.reshape(region.shape), back[cells]


def _nearest_occupied(fine: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the flat index of the nearest occupied cell of each position, or -1 for none.

    Args:
        fine: Non-zero for occupied cells, uint16 [X, Y, Z].
        places: Positions in cells, float64 [N, 3]. The cell of each position and its neighbours are
            searched.
    """
    best, gathered = np.full(len(places), np.inf), np.full(len(places), -1, np.int64)
    for step in np.ndindex(3, 3, 3):
        cell = np.floor(places).astype(np.int64) + step - 1
        inside = np.flatnonzero(((cell >= 0) & (cell < fine.shape)).all(axis=1))
        here = inside[fine[tuple(cell[inside].T)] > 0]
        away = np.linalg.norm(cell[here] + 0.5 - places[here], axis=1)
        nearer = away < best[here]
        here, away = here[nearer], away[nearer]
        best[here] = away
        gathered[here] = np.ravel_multi_index(tuple(cell[here].T), fine.shape)
    return gathered
