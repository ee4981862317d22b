"""Semantic scene completion of a single depth image, the task of SSCNet.

The grid is defined by a file. Of an SSCNet ``.bin``, only the first 76 bytes are read, which
contain the origin of the grid and the camera pose; the labels are never read. The depth image is
fused into the grid and the completion network classifies each cell. Observed surfaces stay
occupied, and the floor and the walls continue behind furniture. Other hidden cells get the most
likely label if they are in the room, and are empty beyond it: the network was never trained on what
lies behind walls.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.errors import CaptureError, DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.files import npz_array_names, read_npz
from world2minecraft.core.types import (
    Camera,
    FusedEvidence,
    OccupancyGrid,
    PointEvidence,
    View,
    checks,
)
from world2minecraft.formats.predicted_grids import MAX_SKEW
from world2minecraft.formats.sscnet import HEADER_BYTES
from world2minecraft.geometry.rotations import nearest_rigid
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA, decode_depth
from world2minecraft.reconstruction.fusion import (
    CleaningParameters,
    EvidenceMap,
    extract_grid,
    remove_floaters,
)
from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.layout.room_space import RoomSpace, room_space
from world2minecraft.reconstruction.layout.storeys import Storey
from world2minecraft.reconstruction.layout.structure import structure_of
from world2minecraft.reconstruction.layout.surface_cells import surface_of
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor
from world2minecraft.reconstruction.semantics.completion_channels import sight_of
from world2minecraft.reconstruction.semantics.completion_labeller import (
    CompletionModel,
    hint_of,
    likeliest,
)
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller

SHAPE = (60, 60, 36)  # x, y, z; a file's own order is x, z up, y.
FILE_AXES = (0, 2, 1)
VOXEL_M = 0.08
FAR_M = 8.0
PLAUSIBLE_M = (0.4, 10.0)  # Minimum and maximum of the median depth of a room.
CODES = ("auto", "rotated", "mm", "8000")
UP_COSINE = 0.9  # Minimum cosine between the normal of a floor and up.
FLOOR_SHARE = 0.2  # Of the points of the largest level; half of a floor may be hidden.
MIN_FLOOR_POINTS = 200
# The plane z = 0 of the world is the floor if a camera stands on it and almost nothing is below.
CAMERA_HEIGHT_M = (0.3, 2.6)
BELOW_M, BELOW_SHARE = 0.25, 0.02
UNDER_M = 0.02  # Depth below the top of the floor that is inside its cells.
ALONG_AXES_DEG = 5.0  # The geometric labeller finds walls up to this angle to the axes.
LEVEL_COSINE = 0.2  # Maximum cosine between the normal of a wall and up.


@dataclass(frozen=True, eq=False)
class GridPlace:
    """The position of a frame's grid of 60 x 60 x 36 cells of 8 cm, and the pose of its camera.

    Attributes:
        origin_m: Minimum corner of cell (0, 0, 0) in the world in metres, float64 [3], with z up.
        camera_to_world: Camera pose in the world, float64 [4, 4].
    """

    origin_m: np.ndarray
    camera_to_world: np.ndarray


@dataclass(frozen=True, eq=False)
class CompletedFrame:
    """The predictions for a frame's grid, with the axes x, y and z (up).

    Attributes:
        labels: Predicted class of each cell (0 to 11), uint8 [60, 60, 36].
        confidence: Probability of the predicted class, float32 [60, 60, 36].
        observed: Whether the depth image observes each cell, occupied or free, bool [60, 60, 36].
    """

    labels: np.ndarray
    confidence: np.ndarray
    observed: np.ndarray


def read_grid_place(path: Path) -> GridPlace:
    """Read the grid position and the camera pose of a frame.

    Args:
        path: An SSCNet ``.bin`` file, or an npz file with ``origin_m`` (or ``voxel_origin``) and
            ``camera_to_world`` (or ``cam_pose``).

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain a valid origin and camera pose.
    """
    if not path.is_file():
        raise InputError(
            path,
            "not found; expected an SSCNet .bin file, or an npz file with an origin and a pose",
        )
    if path.suffix == ".npz":
        names = npz_array_names(path)
        origin = "origin_m" if "origin_m" in names else "voxel_origin"
        pose = "camera_to_world" if "camera_to_world" in names else "cam_pose"
        arrays = read_npz(path, (origin, pose))
        numbers = np.concatenate([np.ravel(arrays[origin]), np.ravel(arrays[pose])])
    else:
        with path.open("rb") as stream:
            head = stream.read(HEADER_BYTES)
        numbers = np.frombuffer(head[: len(head) // 4 * 4], "<f4")
    if len(numbers) != 19 or not np.isfinite(numbers).all():
        raise DamagedFileError(
            path, "does not contain an origin (3 numbers) and a camera pose (16 numbers)"
        )
    try:
        stored = checks.transform("camera_to_world", numbers[3:].reshape(4, 4), MAX_SKEW)
        origin_m = checks.coordinates("origin_m", numbers[:3], (3,))
    except ValueError as error:
        raise DamagedFileError(path, str(error)) from error
    return GridPlace(origin_m, nearest_rigid(stored))


def depth_of_png(path: Path, raw: np.ndarray, code: str = "auto") -> np.ndarray:
    """Convert the values of a depth PNG to metres, float32 [H, W].

    Args:
        path: File to name in error messages.
        raw: Values of the PNG, uint16 [H, W].
        code: ``rotated`` (as in SSCNet: millimetres, with their bits rotated by three), ``mm``,
            ``8000`` (units of 1/8000 m) or ``auto``. ``auto`` selects ``rotated`` if the three low
            bits are unused, and otherwise the unit for which the depths are plausible for a room.

    Raises:
        UnknownNameError: If the code is unknown.
        CaptureError: If the values are not plausible depths for a room.
    """
    if code not in CODES:
        raise UnknownNameError("depth code", code, CODES)
    if raw.ndim != 2 or raw.dtype != np.uint16 or not raw.any():
        raise CaptureError(path, "not a depth image; expected one channel with 16 bits")
    if code == "auto":
        return depth_of_png(path, raw, _likely(raw))
    depth_m = {
        "rotated": lambda: ((raw >> 3) | (raw << 13)) / np.float32(1000),
        "mm": lambda: decode_depth(raw, "mm"),
        "8000": lambda: raw / np.float32(8000),
    }[code]()
    depth_m = np.where(raw > 0, depth_m, 0).astype(np.float32)
    middle = float(np.median(depth_m[depth_m > 0]))
    if not PLAUSIBLE_M[0] <= middle <= PLAUSIBLE_M[1]:
        raise CaptureError(
            path,
            f"implausible median depth of {middle:.2f} m with depth code {code}; try the depth "
            "code mm or 8000 (--depth-code)",
        )
    return depth_m


def _likely(raw: np.ndarray) -> str:
    seen = raw[raw > 0]
    if np.mean((seen & 7) > 1) < 0.01:
        return "rotated"
    return "mm" if np.percentile(seen, 99) / 1000 <= PLAUSIBLE_M[1] else "8000"


def complete_frame(
    depth_m: np.ndarray,
    place: GridPlace,
    *,
    colour: np.ndarray | None = None,
    camera: Camera = NYU_CAMERA,
    model: CompletionModel | None = None,
) -> CompletedFrame:
    """Predict the class of each cell in a frame's grid.

    Args:
        depth_m: Depth along the camera's z axis in metres, float32 [H, W]; 0 for holes.
        place: Position of the grid and pose of the camera.
        colour: Colour image from the same camera, uint8 [H, W, 3], if available.
        camera: Camera of the image. Defaults to that of NYUv2.
        model: Completion network. Defaults to the shipped network.

    Raises:
        CaptureError: If no cell of the grid is observed.
    """
    world_to_grid = np.eye(4)
    world_to_grid[:3, 3] = -place.origin_m
    view = View(
        name="frame",
        camera_to_scan=place.camera_to_world,
        colour=colour,
        colour_camera=None if colour is None else camera,
        depth_m=depth_m.astype(np.float32),
        depth_camera=camera,
    )
    points = DepthPredictor(FAR_M).lift(view)
    evidence = _in_grid(points, world_to_grid)
    grid = remove_floaters(extract_grid(evidence), CleaningParameters())
    floor_m = floor_of(points, world_to_grid)
    hint, space = _read_structure(points, grid, evidence, floor_m)
    sight = sight_of(grid, evidence, hint, floor_m)
    chance = (model or CompletionModel()).chances(sight)
    labels = _completed(likeliest(chance, sight.log_odds), sight.log_odds == 0, space)
    confidence = np.take_along_axis(chance, labels[None].astype(np.int64), axis=0)[0]
    return CompletedFrame(labels, confidence, grid.source > 0)


def _read_structure(
    points: PointEvidence, grid: OccupancyGrid, evidence: FusedEvidence, floor_m: float
) -> tuple[np.ndarray, RoomSpace]:
    """Return the geometric labels of the surface, uint8 [60, 60, 36], and the space of the room.

    The axes of a frame's grid are often those of its camera. The structure is found in cells along
    the walls, from which the cells of the grid take what lies at their surface point or centre.
    """
    yaw_deg = yaw_of_walls(points, evidence.scan_to_room)
    grid_to_room = rotation_about_z(-yaw_deg if abs(yaw_deg) > ALONG_AXES_DEG else 0.0)
    turned = EvidenceMap(grid_to_room @ evidence.scan_to_room)
    turned.add(points)
    along = turned.fused()
    room = remove_floaters(extract_grid(along), CleaningParameters())
    storey = Storey(floor_m, 0, room.shape[2])
    labelled = hint_of(*GeometricLabeller().traced(room, along, (storey,)))
    surface = storey.surface(surface_of(room, along))
    found = room_space(structure_of(surface, GeometricParameters().structure))
    centers_m = apply(grid_to_room, (np.moveaxis(np.indices(SHAPE), 0, -1) + 0.5) * VOXEL_M)
    cells, wall = (_values_at(room, mask, centers_m) for mask in (found.cells, found.wall))
    floor = np.zeros(SHAPE, bool)
    layer = int(np.floor((floor_m - UNDER_M) / VOXEL_M))
    if 0 <= layer < SHAPE[2]:
        floor[:, :, layer] = cells[:, :, layer] = cells.any(axis=2)
    points_m = apply(grid_to_room, surface_of(grid, evidence).points_m.astype(np.float64))
    hint = np.where(grid.occupied, _values_at(room, labelled, points_m), np.uint8(0))
    return hint, RoomSpace(cells, floor, wall)


def _values_at(room: OccupancyGrid, values: np.ndarray, points_m: np.ndarray) -> np.ndarray:
    """Return the values of the cells that contain points [..., 3]; 0 outside the room's cells."""
    cells = np.floor((points_m - room.origin_m) / room.voxel_m).astype(np.int64)
    inside = np.all((cells >= 0) & (cells < room.shape), axis=-1)
    index = tuple(np.moveaxis(np.where(inside[..., None], cells, 0), -1, 0))
    return np.where(inside, values[index], values.dtype.type(0))


def _completed(labels: np.ndarray, hidden: np.ndarray, space: RoomSpace) -> np.ndarray:
    """Return labels whose hidden cells agree with the space of the room, uint8 [60, 60, 36]."""
    beyond = ~space.cells | ((labels == SemanticClass.FLOOR) & ~space.floor)
    result = np.where(hidden & beyond, np.uint8(SemanticClass.EMPTY), labels)
    result[hidden & space.floor] = SemanticClass.FLOOR
    result[hidden & space.wall] = SemanticClass.WALL
    return result


def yaw_of_walls(points: PointEvidence, world_to_grid: np.ndarray) -> float:
    """Return the angle from the axes of the grid to the walls, -45 to 45 degrees about z."""
    if points.normals is None:
        return 0.0
    normals = points.normals @ world_to_grid[:3, :3].astype(np.float32).T
    upright = (np.abs(normals[:, 2]) < LEVEL_COSINE) & normals.any(axis=1)
    if not upright.any():
        return 0.0
    # Four times the angle is the same for all four directions.
    turned = np.exp(4j * np.arctan2(normals[upright, 1], normals[upright, 0])).mean()
    return float(np.degrees(np.angle(turned)) / 4)


def _in_grid(points: PointEvidence, world_to_grid: np.ndarray) -> FusedEvidence:
    """Resample the evidence of a view to exactly the cells of the grid."""
    evidence = EvidenceMap(world_to_grid)
    evidence.add(points)
    fused = evidence.fused()
    start = np.round(fused.origin_m / VOXEL_M).astype(np.int64)
    first, last = np.maximum(start, 0), np.minimum(start + fused.log_odds.shape, SHAPE)
    if (first >= last).any():
        raise CaptureError(
            "depth image", "shows no part of the grid; check that both are of one frame"
        )
    source = tuple(slice(a, b) for a, b in zip(first - start, last - start, strict=True))
    target = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
    arrays = {}
    for name in ("log_odds", "votes", "colour_sum", "offset_sum", "hits"):
        values = getattr(fused, name)
        arrays[name] = np.zeros((*SHAPE, *values.shape[3:]), values.dtype)
        arrays[name][target] = values[source]
    return FusedEvidence(
        **arrays, voxel_m=VOXEL_M, origin_m=np.zeros(3), scan_to_room=world_to_grid
    )


def floor_of(points: PointEvidence, world_to_grid: np.ndarray) -> float:
    """Estimate the height of the floor above the lowest face of the grid in metres.

    The plane z = 0 of the world is the floor in NYUv2, whether in view or not, and more precise
    than the depth of one image. In a world with surfaces below this plane, or with a camera that
    cannot stand on it, the floor is the lowest horizontal surface with at least ``FLOOR_SHARE`` as
    many upward-facing points as the largest one.
    """
    turn, shift = world_to_grid[:3, :3], world_to_grid[:3, 3]
    world_floor_m = float(shift[2])
    heights = points.points_m @ turn[2].astype(np.float32) + np.float32(shift[2])
    eye_m = float(turn[2] @ points.camera_m + shift[2])
    stands = CAMERA_HEIGHT_M[0] <= eye_m - world_floor_m <= CAMERA_HEIGHT_M[1]
    if stands and np.mean(heights < world_floor_m - BELOW_M) < BELOW_SHARE:
        return world_floor_m
    if points.normals is None:
        return world_floor_m
    level = heights[points.normals @ turn[2].astype(np.float32) >= UP_COSINE]
    level = level[level < eye_m - 0.5]
    if len(level) < MIN_FLOOR_POINTS:
        return world_floor_m
    edges = np.arange(level.min() - 0.02, level.max() + 0.06, 0.04)
    counts = np.histogram(level, edges)[0]
    counts = counts + np.append(counts[1:], 0)
    lowest = int(np.flatnonzero(counts >= FLOOR_SHARE * counts.max())[0])
    within = level[(level >= edges[lowest]) & (level < edges[lowest] + 0.08)]
    return float(np.median(within))
