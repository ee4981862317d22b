"""Reader of meshes and point clouds as posed RGB-D frames rendered from inside the room.

The file is loaded by the reader for its suffix and rotated upright, and the interior is found.
Frames are rendered on first access and cached for the next stage.
"""

import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from world2minecraft.capture.images import ImageHeader
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.meshes.cloud_splatting import Surfels, render_surfels
from world2minecraft.capture.readers.meshes.frustum_culling import (
    Blocks,
    sort_mesh_into_blocks,
    sort_surfels_into_blocks,
)
from world2minecraft.capture.readers.meshes.interior import (
    backface_share,
    find_interior,
    voxelise_surface,
)
from world2minecraft.capture.readers.meshes.mesh_and_cloud import Geometry, LoadedGeometry, Mesh
from world2minecraft.capture.readers.meshes.mesh_rasterizer import GREY, render_mesh
from world2minecraft.capture.readers.meshes.orientation_and_unit import find_orientation, find_unit
from world2minecraft.capture.readers.meshes.surface_sampling import sample_surface
from world2minecraft.capture.readers.meshes.surfels import estimate_surfels
from world2minecraft.capture.readers.meshes.text_clouds import S3DIS_FOLDER, load_s3dis
from world2minecraft.capture.readers.meshes.viewpoints import CAMERA, choose_views
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath, file_stamp
from world2minecraft.core.classes import CLASS_COLOURS
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import Camera

# Where one mesh is exported in several ways side by side, the first is taken.
READERS = {
    ".glb": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".gltf": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".obj": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".usdz": "world2minecraft.capture.readers.meshes.usd_process:load_usd",
    ".usdc": "world2minecraft.capture.readers.meshes.usd_process:load_usd",
    ".usda": "world2minecraft.capture.readers.meshes.usd_process:load_usd",
    ".usd": "world2minecraft.capture.readers.meshes.usd_process:load_usd",
    ".ply": "world2minecraft.capture.readers.meshes.ply:load_ply",
    ".stl": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".off": "world2minecraft.capture.readers.meshes.trimesh_scenes:load_scene",
    ".e57": "world2minecraft.capture.readers.meshes.las_and_e57:load_e57",
    ".laz": "world2minecraft.capture.readers.meshes.las_and_e57:load_las",
    ".las": "world2minecraft.capture.readers.meshes.las_and_e57:load_las",
    ".pts": "world2minecraft.capture.readers.meshes.text_clouds:load_text",
    ".xyz": "world2minecraft.capture.readers.meshes.text_clouds:load_text",
    ".xyzrgb": "world2minecraft.capture.readers.meshes.text_clouds:load_text",
    ".asc": "world2minecraft.capture.readers.meshes.text_clouds:load_text",
    ".txt": "world2minecraft.capture.readers.meshes.text_clouds:load_text",
    ".csv": "world2minecraft.capture.readers.meshes.text_clouds:load_text",
}
AMBIGUOUS_SUFFIXES = (".txt", ".csv", ".asc")  # Read only if the file itself is given.
MESH_READERS = Registry("solid format", READERS)
LABELLED = ".labels"  # ScanNet: a second file of the mesh, coloured by class.
MAX_CACHE_BYTES = 192 << 20  # All 120 views of 480 x 360: 1.4 MB each.
MODES = {"colour": "RGB", "depth": "float32", "labels": "L"}
RenderedView = tuple[np.ndarray, np.ndarray, np.ndarray]
MARGIN_M = 0.3
MIN_SIDES_M = (1.0, 1.0, 0.6)  # The upper part of a room may not have been captured.
MAX_SIDE_M = 200.0
MAX_BACKFACE_SHARE = 0.9  # Maximum share of back faces seen from inside; rooms have far fewer.
UNIT_ADVICE = "if the unit is wrong, set --set capture.unit=m|cm|mm|inch|foot"


def find_mesh_file(path: AnyPath) -> AnyPath | None:
    """Find the mesh or point cloud at a path.

    Returns:
        The file, the folder of an S3DIS room, or None if there is no mesh or point cloud.

    Raises:
        CaptureError: If a folder contains several different meshes or point clouds.
    """
    if path.is_file():
        return path if path.suffix.lower() in READERS else None
    if not path.is_dir():
        return None
    annotations = path / S3DIS_FOLDER
    if annotations.is_dir() and any(annotations.glob("*.txt")):
        return path
    order = [suffix for suffix in READERS if suffix not in AMBIGUOUS_SUFFIXES]
    found = [entry for entry in path.iterdir() if entry.suffix.lower() in order]
    found = [entry for entry in found if entry.is_file() and not entry.name.startswith(".")]
    plain = [entry for entry in found if not entry.stem.endswith(LABELLED)] or found
    stems = {entry.stem for entry in plain}
    if len(stems) > 1:
        raise CaptureError(
            path,
            f"contains {len(stems)} meshes or point clouds "
            f"({', '.join(sorted(stems)[:4])}); give the path of one file",
        )
    return min(plain, key=lambda e: (order.index(e.suffix.lower()), e.name), default=None)


def load_geometry(path: AnyPath) -> LoadedGeometry:
    """Load a file found by ``find_mesh_file`` with the reader for its format.

    Raises:
        InputError: If the file cannot be read.
    """
    if path.is_dir():
        return load_s3dis(path)
    return MESH_READERS.load(path.suffix.lower())(path)


@dataclass(eq=False)
class ViewRenderer:
    """A renderer of the views of a mesh or point cloud, with a cache of recent views.

    Attributes:
        name: Name of the file, for messages.
        geometry: The mesh or surfels to render.
        camera: Intrinsics shared by all views.
        camera_to_world: Camera poses of the views, float64 [F, 4, 4].
        blocks: Blocks of the geometry for frustum culling.
        by_class: Whether to use class colours because the geometry has labels but no colours.
    """

    name: str
    geometry: Mesh | Surfels
    camera: Camera
    camera_to_world: np.ndarray
    blocks: Blocks
    by_class: bool = False  # Colours of the classes, for what has classes but no colours.
    _cache: "OrderedDict[int, RenderedView]" = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def render(self, view: int) -> RenderedView:
        """Render the depth, colour and labels of a view, each with shape [H, W] or [H, W, 3]."""
        with self._lock:
            if view in self._cache:
                self._cache.move_to_end(view)
                return self._cache[view]
            found = self._render(view)
            if self.by_class:
                colours = np.full((256, 3), GREY, np.uint8)
                colours[: len(CLASS_COLOURS)] = CLASS_COLOURS
                found = found[0], colours[found[2]], found[2]
            self._cache[view] = found
            max_views = max(2, MAX_CACHE_BYTES // sum(image.nbytes for image in found))
            while len(self._cache) > max_views:
                self._cache.popitem(last=False)
            return found

    def _render(self, view: int) -> RenderedView:
        world_to_camera = invert_rigid(self.camera_to_world[view])
        runs = self.blocks.runs(self.camera, world_to_camera)
        if isinstance(self.geometry, Mesh):
            return render_mesh(self.geometry, self.camera, world_to_camera, runs)
        return render_surfels(self.geometry, self.camera, world_to_camera, runs)


@dataclass(frozen=True, eq=False)
class RenderedImage:
    """A colour, depth or label image of a rendered view. It implements ``ImageSource``."""

    renderer: ViewRenderer
    view: int
    kind: str

    def __str__(self) -> str:
        """Return the file name, the view and the kind of image, for messages."""
        return f"{self.renderer.name}/view {self.view} ({self.kind})"

    @property
    def stem(self) -> str:
        """The name of the frame."""
        return view_name(self.view)

    @property
    def name(self) -> str:
        """The name of the frame."""
        return view_name(self.view)

    def header(self) -> ImageHeader:
        """Return the size and mode of the image without rendering it."""
        camera = self.renderer.camera
        return ImageHeader(camera.width_px, camera.height_px, MODES[self.kind])

    def check_whole(self) -> None:
        """Do nothing, because the file has already been read completely."""

    def colour(self) -> np.ndarray:
        """Return the colour image as uint8 [H, W, 3]."""
        return self.renderer.render(self.view)[1]

    def raw(self) -> np.ndarray:
        """Return the depth in metres as float32 [H, W], or the class ids as uint8 [H, W]."""
        depth, _, labels = self.renderer.render(self.view)
        return depth if self.kind == "depth" else labels


def view_name(view: int) -> str:
    """Return the frame name of a view.

    Example:
        >>> view_name(7)
        'view-007'
    """
    return f"view-{view:03d}"


class MeshSource:
    """A reader of a single mesh or point cloud of a room, with its textures if there are any."""

    layout = "a mesh or a point cloud (.glb .gltf .obj .ply .stl .usdz .las .laz .e57 .xyz .pts ..)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the path is a mesh or point cloud, or a folder that contains either."""
        return find_mesh_file(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read a mesh or point cloud with default options. See ``read_with`` for the exceptions."""
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Read a mesh or point cloud as a capture of rendered views.

        Args:
            folder: The file, or a folder that contains it.
            options: Unit, up axis and interior point given by the user.

        Raises:
            CaptureError: If the file does not show the inside of a room.
            DamagedFileError: If the file is not valid in its format.
            LimitError: If the file is too large.
            MissingExtraError: If the library for the format is not installed.
        """
        path = find_mesh_file(folder)
        if path is None:
            raise CaptureError(folder, "does not contain a mesh or point cloud")
        return _read_once(path, file_stamp(path), options)


@lru_cache(maxsize=1)
def _read_once(path: AnyPath, stamp: tuple[int, ...], options: ScanOptions) -> Capture:
    """Read a file and cache the result: captures are read for the summary and again to open."""
    loaded = load_geometry(path)
    if not len(loaded.geometry.positions) or (
        isinstance(loaded.geometry, Mesh) and not len(loaded.geometry.faces)
    ):
        raise CaptureError(path, "contains no triangles and no points; export the file again")
    file_to_world, frame_note = estimate_world_frame(path, loaded, options)
    inside_m = None
    if options.inside is not None:
        inside_m = apply(file_to_world, np.array(options.inside) - loaded.offset)
    geometry = loaded.geometry.moved(file_to_world)
    poses, seen_note = _choose_poses(path, geometry, inside_m)
    if isinstance(geometry, Mesh):
        sorted_geometry, blocks = sort_mesh_into_blocks(geometry)
    else:
        sorted_geometry, blocks = sort_surfels_into_blocks(estimate_surfels(geometry))
    by_class = geometry.labels is not None and not geometry.coloured
    renderer = ViewRenderer(path.name, sorted_geometry, CAMERA, poses, blocks, by_class)
    notes = (
        f"{_size_note(loaded)}; {frame_note}",
        seen_note,
        *loaded.notes,
    )
    return Capture(
        path,
        f"solid ({loaded.kind})",
        tuple(_frame(renderer, view, geometry) for view in range(len(poses))),
        depth_unit="m",
        notes=notes,
        depth_kind="exact",
        world_up=np.array([0.0, 0.0, 1.0]),
        source_to_scan=file_to_world @ _translation(-loaded.offset),
    )


def _translation(offset: np.ndarray) -> np.ndarray:
    move = np.eye(4)
    move[:3, 3] = offset
    return move


def estimate_world_frame(
    path: AnyPath, loaded: LoadedGeometry, options: ScanOptions
) -> tuple[np.ndarray, str]:
    """Estimate the transform from the frame of a file to metres with z up.

    Returns:
        The transform as float64 [4, 4], and a note about size, unit and up axis.

    Raises:
        CaptureError: If the geometry has no surface or does not have the size of a room.
    """
    samples = sample_surface(loaded.geometry)
    if not len(samples.points):
        raise CaptureError(path, "contains no surface: all triangles have zero area")
    orientation = find_orientation(samples, loaded.usual_up, loaded.up_stated, options.up)
    upright = samples.points @ orientation.turn.T
    low, high = np.quantile(upright, [0.002, 0.998], axis=0)
    unit_m, unit_note = find_unit(high - low, loaded.unit_m, options.unit)
    size = (high - low) * unit_m
    if (size < MIN_SIDES_M).any() or (size > MAX_SIDE_M).any():
        raise CaptureError(
            path,
            f"is {size[0]:.2f} x {size[1]:.2f} x {size[2]:.2f} m ({unit_note}; "
            f"{orientation.description}), which is not the size of a room; {UNIT_ADVICE}",
        )
    file_to_world = np.eye(4)
    file_to_world[:3, :3] = orientation.turn * unit_m
    middle = (low + high) / 2 * unit_m
    file_to_world[:3, 3] = -np.array([middle[0], middle[1], low[2] * unit_m])
    size_note = f"{size[0]:.1f} x {size[1]:.1f} m and {size[2]:.1f} m high"
    return file_to_world, f"{size_note}; {unit_note}; {orientation.description}"


def _choose_poses(
    path: AnyPath, geometry: Geometry, inside_m: np.ndarray | None
) -> tuple[np.ndarray, str]:
    """Return the camera poses of the views, and a note on what they show."""
    low, high = sample_surface(geometry).box()
    try:
        grid = voxelise_surface(geometry, low - MARGIN_M, high + MARGIN_M)
    except ValueError as error:
        raise CaptureError(path, str(error)) from error
    interior = find_interior(grid, inside_m)
    if interior is None:
        raise CaptureError(path, _no_interior_reason(inside_m))
    poses = choose_views(grid, interior)
    if isinstance(geometry, Mesh) and inside_m is None:
        share = backface_share(geometry, CAMERA, poses)
        if share > MAX_BACKFACE_SHARE:
            raise CaptureError(
                path,
                "has only outward-facing surfaces, like an object or a building seen from "
                "outside; if it is a room, give a point inside it with --set "
                "capture.inside=x,y,z",
            )
    spaces = f"{interior.spaces} {'open' if interior.is_open else 'closed'} space"
    spaces += "s" * (interior.spaces > 1)
    where = ", with low walls or without walls on some sides" * interior.is_open
    return poses, f"rendered {len(poses)} views of {spaces}{where}"


def _no_interior_reason(inside_m: np.ndarray | None) -> str:
    if inside_m is not None:
        return (
            "has no enclosed free space within 1 m of capture.inside; give a point in the "
            "middle of the room, in the units and axes of the file"
        )
    return (
        "does not show the inside of a room: no free space has a floor and walls on "
        "most sides; if it is a room, set a point inside it (--set "
        "capture.inside=x,y,z) or the up axis (--set capture.up=y)"
    )


def _frame(renderer: ViewRenderer, view: int, geometry: Geometry) -> FrameFiles:
    camera, coloured = renderer.camera, geometry.coloured or renderer.by_class
    return FrameFiles(
        view_name(view),
        renderer.camera_to_world[view],
        RenderedImage(renderer, view, "colour") if coloured else None,
        camera if coloured else None,
        RenderedImage(renderer, view, "depth"),
        camera,
        labels_path=RenderedImage(renderer, view, "labels")
        if geometry.labels is not None
        else None,
    )


def _size_note(loaded: LoadedGeometry) -> str:
    if isinstance(loaded.geometry, Mesh):
        return f"{loaded.kind} mesh with {len(loaded.geometry.faces):,} triangles"
    thinned = (
        f", downsampled to {len(loaded.geometry.points):,}"
        if loaded.read > len(loaded.geometry.points)
        else ""
    )
    return (
        f"{loaded.kind} point cloud with "
        f"{max(loaded.read, len(loaded.geometry.points)):,} points{thinned}"
    )
