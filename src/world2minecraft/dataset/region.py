"""Which box of cells an image is labelled with: the paper's region function, and any yaw.

The paper has two cases, by the yaw. Where the view runs along an axis, the player stands in the
middle of the box's back face. Where it runs along a diagonal, the player is the box's minimum
corner: two sides of the box go off from it, 45 degrees to the left and to the right of the view.
Yaws between go to the nearest of the eight. The fallback offset pushes the box back: against the
view, or against both axes of a diagonal, so that what lies beside the player is held too.

The region's axes are x right, y forward, z up: of an axis view exactly so; of a diagonal view the
view runs along +x +y. Its cells are those of the scene, turned by quarter turns, so that labels are
copied and never resampled. Its bottom layer is the layer of the floor that the player stands on, as
in NYUv2, whose boxes begin just below the floor.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.classes import SemanticClass
from world2minecraft.coordinates import rotation_about_z
from world2minecraft.dataset.values import (
    USUAL_SHAPE,
    USUAL_VOXEL_M,
    LabelRegion,
    SceneVoxels,
)
from world2minecraft.errors import UnknownNameError, UsageError

KINDS = ("paper", "free")
AXIS_OFFSET_CELLS = 0  # Both by the sweep of docs/occupancy-labels.md.
DIAGONAL_OFFSET_CELLS = 4
FLOOR_LAYERS = 1  # Of the box, below the floor's top face.
RUG_M = 0.25  # What lies so much higher than a floor that spreads wider is no floor of its own.
_STEP = 1e-6  # Cells: a place so near a border is on it.


@dataclass(frozen=True)
class RegionRule:
    """How the region of an image is chosen.

    Offsets are cells by which the region is moved back, against the view, or along both sides of a
    diagonal one; they are the paper's fallback offset, and hold for the paper's kind alone.
    """

    kind: str = "paper"  # or free: turned with the view, whose cells are sampled from the scene's
    shape: tuple[int, int, int] = USUAL_SHAPE
    voxel_m: float = USUAL_VOXEL_M
    axis_offset_cells: int = AXIS_OFFSET_CELLS
    diagonal_offset_cells: int = DIAGONAL_OFFSET_CELLS

    def __post_init__(self):
        if self.kind not in KINDS:
            raise UnknownNameError("kind of region", self.kind, KINDS)
        if len(self.shape) != 3 or min(self.shape) < 1:
            raise UsageError(f"a region has three sides of a cell or more, not {self.shape}")
        if not self.voxel_m > 0:
            raise UsageError(f"the cells of a region are larger than 0 m, not {self.voxel_m}")


def region_of(
    camera_to_room: np.ndarray,
    rule: RegionRule | None = None,
    *,
    floor_m: float = 0.0,
    grid_origin_m: np.ndarray | None = None,
) -> LabelRegion:
    """Return the region of a view.

    Args:
        camera_to_room: 4x4, OpenCV axes, metres.
        rule: the paper's of usual size where None.
        floor_m: the height of the floor's top face; 0 is the room's.
        grid_origin_m: any corner of the scene's cells, which the region's fall on; the room's
            origin where None.

    Example:
        >>> from world2minecraft.coordinates import look_at
        >>> pose = look_at(np.array([1.0, 2.0, 1.6]), np.array([5.0, 2.1, 1.2]))
        >>> region_of(pose).kind
        'axis'
    """
    rule = rule or RegionRule()
    grid = np.zeros(3) if grid_origin_m is None else np.asarray(grid_origin_m, np.float64)
    yaw_deg = view_yaw_deg(camera_to_room)
    eighth = round(yaw_deg / 45.0)
    diagonal = rule.kind == "paper" and eighth % 2 == 1
    if rule.kind == "free":
        kind, forward_deg, back = "free", yaw_deg, 0
    elif diagonal:
        kind, forward_deg, back = "diagonal", 45.0 * (eighth + 1), rule.diagonal_offset_cells
    else:
        kind, forward_deg, back = "axis", 45.0 * eighth, rule.axis_offset_cells
    turn = rotation_about_z(forward_deg - 90.0)
    to_back = np.array([back if diagonal else rule.shape[0] / 2, back, FLOOR_LAYERS])
    corner_m = np.array([*camera_to_room[:2, 3], floor_m]) - turn[:3, :3] @ to_back * rule.voxel_m
    on_grid = [2] if rule.kind == "free" else [0, 1, 2]
    cells = (corner_m - grid) / rule.voxel_m
    corner_m[on_grid] = (grid + np.round(cells - _STEP) * rule.voxel_m)[on_grid]
    region_to_room = turn.copy()
    region_to_room[:3, 3] = corner_m
    return LabelRegion(rule.shape, rule.voxel_m, region_to_room, kind)


def region_in(
    voxels: SceneVoxels, camera_to_room: np.ndarray, rule: RegionRule | None = None
) -> LabelRegion:
    """Return the region of a view of a scene: on its cells, from the floor under the camera on."""
    return region_of(
        camera_to_room,
        rule,
        floor_m=floor_under(voxels, camera_to_room),
        grid_origin_m=voxels.origin_m,
    )


def view_yaw_deg(camera_to_room: np.ndarray) -> float:
    """Return where a camera looks, seen from above: 0 along room +x, counter-clockwise.

    A camera that looks straight down or up looks where the upper edge of its image does.
    """
    right, down, forward = camera_to_room[:3, :3].T
    ahead = forward[:2]
    if np.linalg.norm(ahead) < 1e-6:
        ahead = -down[:2] if forward[2] < 0 else down[:2]
    if np.linalg.norm(ahead) < 1e-6:
        ahead = np.array([-right[1], right[0]])
    return float(np.degrees(np.arctan2(ahead[1], ahead[0])))


def floor_under(voxels: SceneVoxels, camera_to_room: np.ndarray, around_m: float = 1.0) -> float:
    """Return the height of the floor that a camera is over, in metres.

    It is the top of the highest cell of class floor below the camera, of the columns nearest to it
    that have one; of the whole scene where none is near, and 0 where there is none at all. Where
    that lies on a floor that spreads wider, as a rug does, it is the wider floor's.

    Args:
        voxels: the scene.
        camera_to_room: 4x4.
        around_m: how far beside the camera a floor still counts as near.
    """
    eye = (camera_to_room[:3, 3] - voxels.origin_m) / voxels.voxel_m
    layers = int(np.clip(np.floor(eye[2]), 0, voxels.labels.shape[2]))
    at, reach = np.floor(eye[:2]).astype(int), int(np.ceil(around_m / voxels.voxel_m))
    near = _floor_counts(voxels, at, reach, layers)
    for away in (0, 1, 3, reach):
        floor = np.flatnonzero(_floor_counts(voxels, at, away, layers))
        if len(floor):
            below = range(max(floor[-1] - int(RUG_M / voxels.voxel_m), 0), floor[-1] + 1)
            wide = [layer for layer in below if 2 * near[layer] >= max(near[below])]
            return float(voxels.origin_m[2] + (wide[-1] + 1) * voxels.voxel_m)
    floor = np.flatnonzero((voxels.labels == SemanticClass.FLOOR).any(axis=(0, 1)))
    below = floor[floor < layers] if (floor < layers).any() else floor[:1]
    return float(voxels.origin_m[2] + (below[-1] + 1) * voxels.voxel_m) if len(below) else 0.0


def _floor_counts(voxels: SceneVoxels, at: np.ndarray, away: int, layers: int) -> np.ndarray:
    """Return how many cells of the lowest ``layers`` are floor, of the columns around a place."""
    low, high = np.maximum(at - away, 0), np.maximum(at + away + 1, 0)
    part = voxels.labels[low[0] : high[0], low[1] : high[1], :layers]
    return np.count_nonzero(part == SemanticClass.FLOOR, axis=(0, 1))
