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

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import checks

DEFAULT_SHAPE = (60, 60, 36)  # x right, y forward, z up: 60x36x60 as the papers write it
DEFAULT_VOXEL_M = 0.08
REGION_KINDS = ("paper", "free")
AXIS_OFFSET_CELLS = 0  # Both by the sweep of docs/occupancy-labels.md.
DIAGONAL_OFFSET_CELLS = 4
FLOOR_LAYERS = 1  # Of the box, below the floor's top face.
_STEP = 1e-6  # Cells: a place so near a border is on it.


@dataclass(frozen=True, eq=False)
class LabelRegion:
    """The box of cells that an image is labelled with: x right, y forward, z up as it is seen.

    The centre of cell (i, j, k) lies at ``region_to_room`` times ``(i + 0.5) * voxel_m, ...``.
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
        put(self, "voxel_m", checks.positive("voxel_m", self.voxel_m))
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

    Offsets are cells by which the region is moved back, against the view, or along both sides of a
    diagonal one; they are the paper's fallback offset, and hold for the paper's kind alone.
    """

    kind: str = "paper"  # or free: turned with the view, whose cells are sampled from the scene's
    shape: tuple[int, int, int] = DEFAULT_SHAPE
    voxel_m: float = DEFAULT_VOXEL_M
    axis_offset_cells: int = AXIS_OFFSET_CELLS
    diagonal_offset_cells: int = DIAGONAL_OFFSET_CELLS

    def __post_init__(self):
        if self.kind not in REGION_KINDS:
            raise UnknownNameError("kind of region", self.kind, REGION_KINDS)
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
    """Return the region of a view.

    Args:
        camera_to_room: 4x4, OpenCV axes, metres.
        rule: the paper's of usual size where None.
        floor_m: the height of the floor's top face; 0 is the room's.
        grid_origin_m: any corner of the scene's cells, which the region's fall on; the room's
            origin where None.

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
