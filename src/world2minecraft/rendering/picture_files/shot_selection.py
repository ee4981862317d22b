"""The shots of a view: given poses, an orbit, a tour or a turntable."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.picture_files.source import Source
from world2minecraft.rendering.presentation.opened_room import OpenedBuild, has_ceiling
from world2minecraft.rendering.presentation.turntable import OPEN_ELEVATION_DEG
from world2minecraft.rendering.views import (
    GamePose,
    Shot,
    camera_of,
    orbit_shots,
    plan_tour,
    read_tour,
    with_open_doors,
)
from world2minecraft.rendering.views.cameras import GAME_FOV_DEG

Kind = Literal["pose", "poses", "orbit", "tour", "turntable", "spawn"]
Medium = Literal["picture", "folder", "moving"]
ORBIT_FOV_DEG = 40.0  # For views from outside; less distortion than the game's.
TURN_S = 5.0  # Duration of an animated orbit or turntable, in seconds.
FOLDER_TURN, FOLDER_TOUR = 36, 24  # Pictures in a folder.
MAX_FRAMES = 1_000_000
MAX_STEP_M = 0.25  # Between the frames of an animation: more looks like jumps.


@dataclass(frozen=True)
class CameraChoice:
    """The image size, and the field of view if given."""

    width_px: int
    height_px: int
    vertical_fov_deg: float | None = None
    horizontal_fov_deg: float | None = None

    def __post_init__(self):
        if self.vertical_fov_deg is not None and self.horizontal_fov_deg is not None:
            raise UsageError(
                "the vertical and the horizontal field of view (--vfov, --hfov) cannot be "
                "combined; give only one of them"
            )
        self.camera(GAME_FOV_DEG)  # Raises where a value is out of range.

    @property
    def fov_given(self) -> bool:
        """Whether a field of view was given."""
        return self.vertical_fov_deg is not None or self.horizontal_fov_deg is not None

    def camera(self, usual_fov_deg: float) -> Camera:
        """Return the camera, with the default vertical field of view if none was given."""
        vertical = self.vertical_fov_deg if self.fov_given else usual_fov_deg
        return camera_of(
            self.width_px,
            self.height_px,
            vertical_fov_deg=vertical,
            horizontal_fov_deg=self.horizontal_fov_deg,
        )


@dataclass(frozen=True)
class View:
    """The viewpoints from which a build is rendered.

    Raises:
        UsageError: If ``frames`` or ``rate_hz`` is out of range, or if the kind of view does not
            support ``frames``.
    """

    kind: Kind
    poses: tuple[GamePose, ...] = ()
    poses_file: Path | None = None
    frames: int | None = None
    rate_hz: float = 24.0
    opened: bool | None = None

    def __post_init__(self):
        if self.frames is not None and not 1 <= self.frames <= MAX_FRAMES:
            raise UsageError(f"frames must be 1 to {MAX_FRAMES:,}, got {self.frames}")
        if not 1 <= self.rate_hz <= 240:
            raise UsageError(f"fps must be 1 to 240, got {self.rate_hz:g}")
        if self.frames is not None and self.kind in ("pose", "poses"):
            raise UsageError(
                "frames requires the view orbit, tour or turntable (--orbit, --tour or "
                f"--turntable) and cannot be used with {self.kind}"
            )


@dataclass(eq=False)
class Plan:
    """The shots, and the volume that is visible in each of them."""

    shots: list[Shot]
    volume_of: Callable[[Shot], BlockVolume]
    notes: list[str] = field(default_factory=list)


def plan_shots(view: View, source: Source, choice: CameraChoice, medium: Medium) -> Plan:
    """Return the shots of a view.

    Raises:
        UsageError: If a tour has no place to stand.
        InputError: If the pose file cannot be read.
    """
    if view.kind == "tour":
        return _tour(view, source, choice, medium)
    if view.kind == "orbit":
        return _orbit(view, source, choice, medium)
    if view.kind == "turntable":
        return Plan([], lambda shot: source.volume)
    if view.kind == "poses" and view.poses_file is not None:
        return _file(view.poses_file, source, choice)
    note = ["rendered from the player's start position; --tour and --orbit show more"]
    poses = view.poses if view.kind == "pose" else tuple(filter(None, [source.spawn]))
    camera = choice.camera(GAME_FOV_DEG)
    return Plan(
        [_shot(pose, camera, source.volume, 0.0) for pose in poses],
        lambda shot: source.volume,
        note if view.kind == "spawn" else [],
    )


def resolve_view(view: View, source: Source) -> View:
    """Return the view, or an outside view for a build without a player start."""
    if view.kind != "spawn" or source.spawn is not None:
        return view
    source.notes.append(
        "the build has no player start, so it is rendered from outside; --tour walks through it"
    )
    return replace(view, kind="orbit")


def turntable_count(view: View, medium: Medium) -> int:
    """Return the number of images per turn of a turntable."""
    usual = {"picture": 1, "folder": FOLDER_TURN, "moving": round(TURN_S * view.rate_hz)}
    return view.frames or usual[medium]


def _shot(pose: GamePose, camera: Camera, volume: BlockVolume, t_s: float) -> Shot:
    eye_blocks = eye_height_blocks(volume.blocks_per_metre)
    return Shot(camera, pose.camera_to_room(volume.block_to_room, eye_blocks), t_s)


def _file(path: Path, source: Source, choice: CameraChoice) -> Plan:
    camera = choice.camera(GAME_FOV_DEG)
    shots = [
        _shot(one.pose, one.camera or camera, source.volume, one.t_s) for one in read_tour(path)
    ]
    return Plan(shots, lambda shot: source.volume)


def _orbit(view: View, source: Source, choice: CameraChoice, medium: Medium) -> Plan:
    camera = choice.camera(ORBIT_FOV_DEG)
    count = turntable_count(view, medium)
    opened = has_ceiling(source.volume) if view.opened is None else view.opened
    if not opened:
        shots = orbit_shots(source.volume, camera, count, rate_hz=view.rate_hz)
        return Plan(shots, lambda shot: source.volume)
    build = OpenedBuild(source.volume)
    start_deg = build.best_start_deg(OPEN_ELEVATION_DEG)
    shots = orbit_shots(
        build.whole, camera, count, elevation_deg=OPEN_ELEVATION_DEG, start_deg=start_deg,
        rate_hz=view.rate_hz,
    )  # fmt: skip
    note = "ceilings and near walls are removed; use --closed to show them"
    return Plan(shots, lambda shot: build.seen_by(shot.camera_to_room), [note])


def _tour(view: View, source: Source, choice: CameraChoice, medium: Medium) -> Plan:
    frames = view.frames or {"picture": 1, "folder": FOLDER_TOUR, "moving": None}[medium]
    camera = choice.camera(GAME_FOV_DEG)
    spawn = source.spawn
    start = (spawn.x, spawn.y, spawn.z) if spawn is not None and medium == "moving" else None
    tour = plan_tour(source.volume, camera, frames, rate_hz=view.rate_hz, start=start)
    volume, doors = with_open_doors(source.volume, tour.way)
    notes = [f"a walk of {tour.length_m:.0f} m through the rooms"]
    step_m = tour.length_m / max(len(tour.shots), 1)
    if view.frames and medium == "moving" and step_m > MAX_STEP_M:
        notes.append(
            f"the camera jumps {step_m:.1f} m from frame to frame; omit --frames, or use "
            f"{round(tour.length_m / MAX_STEP_M):,} or more"
        )
    if doors:
        notes.append(f"{doors} {'door' if doors == 1 else 'doors'} along the way are shown open")
    return Plan(tour.shots, lambda shot: volume, notes)
