"""The rules of a tour, and the views that a plan consists of."""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.coordinates import focal_px_of_fov
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera, Layout
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.shading_parameters import DAY
from world2minecraft.rendering.views.cameras import GamePose

PAPER_SIZE, PAPER_FOV_DEG = (1920, 1129), 70.0  # Of MinecraftOcc's pictures; the FOV is vertical.
KINDS = ("axis", "diagonal", "free")


def nyu_camera() -> Camera:
    """Return the camera of NYUv2 as its loaders have it, 640x480, a vertical FOV of 49.6 degrees.

    Its principal point is (320.5, 240.5), since they count pixel centres as whole numbers.
    """
    return NYU_CAMERA


def paper_camera() -> Camera:
    """Return the pictures of the paper, 1920x1129 at the game's usual vertical FOV of 70."""
    focal_px = float(focal_px_of_fov(PAPER_SIZE[1], PAPER_FOV_DEG))
    return Camera(*PAPER_SIZE, focal_px, focal_px, PAPER_SIZE[0] / 2, PAPER_SIZE[1] / 2)


@dataclass(frozen=True)
class TourRule:
    """How rooms are toured. The numbers are choices, made by looking at sheets of such views.

    ``yaw_shares`` are those of views along the axes, along the diagonals, and of free ones. Half of
    the walks see from the player's own 1.62 m, the others from ``eye_m``. Views that are nearer
    to another than ``apart_m`` and look nearly the same way, within ``apart_deg``, are left out.
    ``start`` is a place in world blocks, such as the spawn; with ``reachable_only`` no room is
    toured that no way leads to from there. ``layouts`` say the rooms, where they are known.
    """

    camera: Camera = field(default_factory=nyu_camera)
    yaw_shares: tuple[float, float, float] = (0.4, 0.2, 0.4)
    eye_m: tuple[float, float] = (1.2, 1.7)
    player_share: float = 0.5
    pitch_deg: tuple[float, float] = (-8.0, 32.0)
    spacing_m: float = 0.25
    apart_m: float = 0.15
    apart_deg: float = 12.0
    light: LightSettings = DAY
    start: tuple[float, float, float] | None = None
    reachable_only: bool = False
    layouts: tuple[Layout, ...] = ()

    def __post_init__(self):
        if len(self.yaw_shares) != 3 or min(self.yaw_shares) < 0 or sum(self.yaw_shares) <= 0:
            raise UsageError(f"yaw_shares are three numbers from 0 up, not {self.yaw_shares}")
        low, high = self.eye_m
        if not 0.3 <= low <= high <= 1.75:
            raise UsageError(f"eye_m is two heights from 0.3 to 1.75, not {self.eye_m}")
        if not -60 <= self.pitch_deg[0] <= self.pitch_deg[1] <= 60:
            raise UsageError(f"pitch_deg is two angles from -60 to 60, not {self.pitch_deg}")
        if not 0.05 <= self.spacing_m <= 0.6:
            raise UsageError(f"spacing_m is from 0.05 to 0.6, not {self.spacing_m:g}")


@dataclass(frozen=True, eq=False)
class PlannedView:
    """One picture to take: the ``frame``-th of a tour. The pose is that of the eye."""

    tour_id: str
    frame: int
    camera: Camera
    camera_to_room: np.ndarray  # float64 [4, 4]
    pose: GamePose
    t_s: float = 0.0
    room: int = 0

    @property
    def kind(self) -> str:
        """Whether it looks along an ``axis`` of the blocks, a ``diagonal``, or is ``free``."""
        return kind_of_yaw(self.pose.yaw_deg)


def kind_of_yaw(yaw_deg: float) -> str:
    """Return the kind of a yaw: exact multiples of 90 and 45 degrees, and all others.

    Example:
        >>> [kind_of_yaw(yaw) for yaw in (-90, 135, 44.9)]
        ['axis', 'diagonal', 'free']
    """
    if yaw_deg % 45:
        return "free"
    return "diagonal" if yaw_deg % 90 else "axis"
