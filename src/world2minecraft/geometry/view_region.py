"""The box of cells that an image is labelled with, by the paper's rule or for any yaw.

The paper has two cases, selected by the yaw. If the view is along an axis, the player is in the
middle of the back face of the box. If it is along a diagonal, the player is at the minimum corner
of the box, whose two sides run 45 degrees to the left and to the right of the viewing direction.
Other yaws use the nearest of these eight directions. The fallback offset moves the box back, so
that it also contains the space beside the player.

The axes of the region are x right, y forward and z up for an axis view; in a diagonal view, the
viewing direction is +x +y. The cells are those of the scene, rotated by quarter turns, so labels
are copied without resampling. The bottom layer is the layer of the floor on which the player
stands, as in NYUv2, whose boxes begin just below the floor.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import checks

DEFAULT_SHAPE = (60, 60, 36)  # x right, y forward, z up: 60x36x60 as the papers write it
DEFAULT_VOXEL_M = 0.08
REGION_KINDS = ("paper", "free")
AXIS_OFFSET_CELLS = 0  # Both by the sweep of docs/reference/occupancy-labels.md.
DIAGONAL_OFFSET_CELLS = 4
FLOOR_LAYERS = 1  # Of the box, below the floor's top face.
_STEP = 1e-6  # Tolerance in cells at a border.


@dataclass(frozen=True, eq=False)
class LabelRegion:
    """The box of cells that an image is labelled with, in axes x right, y forward, z up.

    The centre of cell (i, j, k) is ``region_to_room`` times ``(i + 0.5) * voxel_m, ...`` in metres.
    """

    shape: tuple[int, int, int]
    voxel_m: float
    region_to_room: np.ndarray  # float64 [4, 4], a turn about z and a shift
    kind: str = "axis"  # axis, diagonal (the paper's two cases) or free (turned with the view)

    def __post_init__(self):
        put = object.__setattr__
        put(self, "shape", tuple(int(side) for side in self.shape))
        if len(self.shape) != 3 or min(self.shape) < 1:
            raise ValueError(f"shape must be three positive cell counts, got {self.shape}")
        put(self, "voxel_m", checks.voxel_size(self.voxel_m))
        checks.extent(self.shape, self.voxel_m)
        put(self, "region_to_room", checks.transform("region_to_room", self.region_to_room))
        if abs(self.region_to_room[2, 2] - 1) > 1e-9:
            raise ValueError("region_to_room must keep the z axis pointing up")

    def centers_m(self) -> np.ndarray:
        """Return the centres of all cells in the room, float64 [X, Y, Z, 3]."""
        places = np.moveaxis(np.indices(self.shape), 0, -1) + 0.5
        return apply(self.region_to_room, places * self.voxel_m)


@dataclass(frozen=True)
class RegionRule:
    """How the region of an image is chosen.

    Offsets are the numbers of cells by which the region is moved back, against the viewing
    direction or along both sides of a diagonal region. They are the fallback offset of the paper
    and apply only to regions of the paper's kind.
    """

    kind: str = "paper"  # or free: turned with the view, whose cells are sampled from the scene's
    shape: tuple[int, int, int] = DEFAULT_SHAPE
    voxel_m: float = DEFAULT_VOXEL_M
    axis_offset_cells: int = AXIS_OFFSET_CELLS
    diagonal_offset_cells: int = DIAGONAL_OFFSET_CELLS

    def __post_init__(self):
        if self.kind not in REGION_KINDS:
            raise UnknownNameError("region kind", self.kind, REGION_KINDS)
        if len(self.shape) != 3 or min(self.shape) < 1:
            raise UsageError(f"the region shape must be three positive integers, got {self.shape}")
        if not self.voxel_m > 0:
            raise UsageError(f"the cell size of a region must be above 0 m, got {self.voxel_m}")


def label_region(
    camera_to_room: np.ndarray,
    rule: RegionRule | None = None,
    *,
    floor_m: float = 0.0,
    grid_origin_m: np.ndarray | None = None,
) -> LabelRegion:
    """Return the region of cells that an image is labelled with.

    Args:
        camera_to_room: 4x4 camera pose in the room (OpenCV axes, metres).
        rule: How the region is chosen; the default is the paper's rule and size.
        floor_m: Height of the floor's top face in metres; 0 is the floor of the room.
        grid_origin_m: Any corner of the scene's cells, with which the region's cells are aligned.
            The default is the origin of the room.

    Example:
        >>> from world2minecraft.core.coordinates import look_at
        >>> pose = look_at(np.array([1.0, 2.0, 1.6]), np.array([5.0, 2.1, 1.2]))
        >>> label_region(pose).kind
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


def view_yaw_deg(camera_to_room: np.ndarray) -> float:
    """Return the yaw of a camera in degrees: 0 along room +x, counter-clockwise from above.

    For a camera that looks straight up or down, the yaw is that of the upper edge of its image.
    """
    right, down, forward = camera_to_room[:3, :3].T
    ahead = forward[:2]
    if np.linalg.norm(ahead) < 1e-6:
        ahead = -down[:2] if forward[2] < 0 else down[:2]
    if np.linalg.norm(ahead) < 1e-6:
        ahead = np.array([-right[1], right[0]])
    return float(np.degrees(np.arctan2(ahead[1], ahead[0])))
