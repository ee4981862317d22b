"""Data types for tours: the settings of a tour and the planned views."""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.coordinates import focal_px_of_fov
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera, Layout
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.shading_parameters import DAY
from world2minecraft.rendering.views.cameras import GamePose

PAPER_SIZE, PAPER_FOV_DEG = (1920, 1129), 70.0  # Of MinecraftOcc; the field of view is vertical.
KINDS = ("axis", "diagonal", "free")


def nyu_camera() -> Camera:
    """Return the camera of NYUv2: 640x480 pixels, vertical field of view 49.6 degrees.

    Its principal point is (320.5, 240.5), because the loaders of NYUv2 place pixel centres at whole
    numbers.
    """
    return NYU_CAMERA


def paper_camera() -> Camera:
    """Return the camera of the paper: 1920x1129 pixels, vertical field of view 70 degrees."""
    focal_px = float(focal_px_of_fov(PAPER_SIZE[1], PAPER_FOV_DEG))
    return Camera(*PAPER_SIZE, focal_px, focal_px, PAPER_SIZE[0] / 2, PAPER_SIZE[1] / 2)


@dataclass(frozen=True)
class TourRule:
    """The settings of a tour. The defaults were chosen by inspecting contact sheets of views.

    Attributes:
        camera: Camera of the views.
        yaw_shares: Relative numbers of views along the axes, along the diagonals and in free
            directions.
        eye_m: Minimum and maximum eye height in metres for walks that do not use the player's
            height.
        player_share: Fraction of walks at the player's eye height of 1.62 m.
        pitch_deg: Minimum and maximum pitch in degrees; positive values look down.
        spacing_m: Minimum distance between frames of a walk in metres.
        apart_m: Views closer than this in metres are discarded if they also face in similar
            directions.
        apart_deg: Maximum angle between similar directions in degrees.
        max_plane_share: Views of which one wall, door or side of furniture takes up more than this
            share are discarded; the floor may take up 1.4 times as much.
        min_things: Views that show fewer pieces of furniture and objects are discarded.
        light: Light settings for judging the views.
        start: Start position in world blocks, such as the spawn point.
        reachable_only: Whether to skip rooms that cannot be reached from ``start``.
        layouts: Room layouts, if known.
    """

    camera: Camera = field(default_factory=nyu_camera)
    yaw_shares: tuple[float, float, float] = (0.4, 0.2, 0.4)
    eye_m: tuple[float, float] = (1.2, 1.7)
    player_share: float = 0.5
    pitch_deg: tuple[float, float] = (-8.0, 32.0)
    spacing_m: float = 0.25
    apart_m: float = 0.5
    apart_deg: float = 20.0
    max_plane_share: float = 0.35
    min_things: int = 3
    light: LightSettings = DAY
    start: tuple[float, float, float] | None = None
    reachable_only: bool = False
    layouts: tuple[Layout, ...] = ()

    def __post_init__(self):
        if len(self.yaw_shares) != 3 or min(self.yaw_shares) < 0 or sum(self.yaw_shares) <= 0:
            raise UsageError(
                f"yaw_shares must be three numbers of 0 or more, not all 0, got {self.yaw_shares}"
            )
        low, high = self.eye_m
        if not 0.3 <= low <= high <= 1.75:
            raise UsageError(
                f"eye_m must be two heights from 0.3 to 1.75 in ascending order, got {self.eye_m}"
            )
        if not -60 <= self.pitch_deg[0] <= self.pitch_deg[1] <= 60:
            raise UsageError(
                "pitch_deg must be two angles from -60 to 60 in ascending order, got "
                f"{self.pitch_deg}"
            )
        if not 0.05 <= self.spacing_m <= 0.6:
            raise UsageError(f"spacing_m must be from 0.05 to 0.6, got {self.spacing_m:g}")


@dataclass(frozen=True, eq=False)
class PlannedView:
    """A view to render.

    Attributes:
        tour_id: Name of the tour.
        frame: Frame number within the tour.
        camera: Camera of the view.
        camera_to_room: Camera pose in the room, float64 [4, 4].
        pose: Pose of the eye in the game.
        t_s: Time since the start of the tour in seconds.
        room: Number of the room.
    """

    tour_id: str
    frame: int
    camera: Camera
    camera_to_room: np.ndarray
    pose: GamePose
    t_s: float = 0.0
    room: int = 0

    @property
    def kind(self) -> str:
        """Kind of the view's yaw: ``axis``, ``diagonal`` or ``free``."""
        return kind_of_yaw(self.pose.yaw_deg)


def kind_of_yaw(yaw_deg: float) -> str:
    """Return ``axis`` for multiples of 90 degrees, ``diagonal`` for multiples of 45, else ``free``.

    Example:
        >>> [kind_of_yaw(yaw) for yaw in (-90, 135, 44.9)]
        ['axis', 'diagonal', 'free']
    """
    if yaw_deg % 45:
        return "free"
    return "diagonal" if yaw_deg % 90 else "axis"
