"""From where ``w2m render`` looks: the shots of poses, an orbit, a tour or a turntable."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from world2minecraft.cli.render.options import CameraChoice
from world2minecraft.cli.render.source import Source
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.rendering.views import GamePose, Shot

Kind = Literal["pose", "poses", "orbit", "tour", "turntable", "spawn"]
Medium = Literal["picture", "folder", "moving"]
ORBIT_FOV_DEG = 40.0  # From outside, less bent than the game's.
TURN_S = 5.0  # Of a moving orbit or turntable.
FOLDER_TURN, FOLDER_TOUR = 36, 24  # Pictures in a folder.


@dataclass(frozen=True)
class View:
    """What the command's words ask for; one kind of view at a time."""

    kind: Kind
    poses: tuple["GamePose", ...] = ()
    poses_file: Path | None = None
    frames: int | None = None
    rate_hz: float = 24.0
    opened: bool | None = None


@dataclass(eq=False)
class Plan:
    """The shots, and the volume that each one sees."""

    shots: list["Shot"]
    volume_of: Callable[["Shot"], "BlockVolume"]
    notes: list[str] = field(default_factory=list)


def view_of(
    poses: tuple["GamePose", ...],
    poses_file: Path | None,
    flags: dict[Kind, bool],
    frames: int | None,
    rate_hz: float,
    opened: bool | None,
) -> View:
    """Return the view that the words ask for; the spawn's where they ask for none.

    Raises:
        UsageError: they ask for several kinds.
    """
    kinds: list[Kind] = [kind for kind, wanted in flags.items() if wanted]
    if poses:
        kinds.append("pose")
    if poses_file is not None:
        kinds.append("poses")
    if len(kinds) > 1:
        told = " and ".join(f"--{kind}" for kind in sorted(kinds))
        raise UsageError(f"{told} are several views; give one of them a command")
    kind = kinds[0] if kinds else "spawn"
    if frames is not None and kind in ("pose", "poses"):
        raise UsageError(f"--frames is for an orbit, a tour or a turntable, not for --{kind}")
    return View(kind, poses, poses_file, frames, rate_hz, opened)


def plan_of(view: View, source: Source, choice: CameraChoice, medium: Medium) -> Plan:
    """Return the shots of a view.

    Raises:
        UsageError: a tour finds nowhere to stand. InputError: the file of poses cannot be read.
    """
    if view.kind == "tour":
        return _tour(view, source, choice, medium)
    if view.kind == "orbit":
        return _orbit(view, source, choice, medium)
    if view.kind == "turntable":
        return Plan([], lambda shot: source.volume)
    if view.kind == "poses" and view.poses_file is not None:
        return _file(view.poses_file, source, choice)
    note = ["seen from where the player starts; --tour and --orbit show more"]
    poses = view.poses if view.kind == "pose" else tuple(filter(None, [source.spawn]))
    camera = choice.camera(_game_fov_deg())
    return Plan(
        [_shot(pose, camera, source.volume, 0.0) for pose in poses],
        lambda shot: source.volume,
        note if view.kind == "spawn" else [],
    )


def resolve_view(view: View, source: Source) -> View:
    """Return the view, with one from outside for a build that says no spawn."""
    if view.kind != "spawn" or source.spawn is not None:
        return view
    source.notes.append("this build says no spawn, so it is seen from outside; --tour walks in")
    return replace(view, kind="orbit")


def turntable_count(view: View, medium: Medium) -> int:
    """Return how many pictures a turn has."""
    usual = {"picture": 1, "folder": FOLDER_TURN, "moving": round(TURN_S * view.rate_hz)}
    return view.frames or usual[medium]


def _game_fov_deg() -> float:
    from world2minecraft.rendering.views.cameras import GAME_FOV_DEG

    return GAME_FOV_DEG


def _shot(pose: "GamePose", camera, volume: "BlockVolume", t_s: float) -> "Shot":
    from world2minecraft.core.coordinates import eye_height_blocks
    from world2minecraft.rendering.views import Shot

    eye_blocks = eye_height_blocks(volume.blocks_per_metre)
    return Shot(camera, pose.camera_to_room(volume.block_to_room, eye_blocks), t_s)


def _file(path: Path, source: Source, choice: CameraChoice) -> Plan:
    from world2minecraft.rendering.views import read_tour

    camera = choice.camera(_game_fov_deg())
    shots = [
        _shot(one.pose, one.camera or camera, source.volume, one.t_s) for one in read_tour(path)
    ]
    return Plan(shots, lambda shot: source.volume)


def _orbit(view: View, source: Source, choice: CameraChoice, medium: Medium) -> Plan:
    from world2minecraft.rendering.presentation.opened_room import OpenedBuild, has_ceiling
    from world2minecraft.rendering.presentation.turntable import OPEN_ELEVATION_DEG
    from world2minecraft.rendering.views import orbit_shots

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
    note = "ceilings and near walls are left out, to show the rooms; --closed keeps them"
    return Plan(shots, lambda shot: build.seen_by(shot.camera_to_room), [note])


def _tour(view: View, source: Source, choice: CameraChoice, medium: Medium) -> Plan:
    from world2minecraft.rendering.views import plan_tour, with_open_doors

    frames = view.frames or {"picture": 1, "folder": FOLDER_TOUR, "moving": None}[medium]
    camera = choice.camera(_game_fov_deg())
    spawn = source.spawn
    start = (spawn.x, spawn.y, spawn.z) if spawn is not None and medium == "moving" else None
    tour = plan_tour(source.volume, camera, frames, rate_hz=view.rate_hz, start=start)
    volume, doors = with_open_doors(source.volume, tour.way)
    notes = [f"a walk of {tour.length_m:.0f} m past the rooms"]
    if doors:
        notes.append(f"{doors} {'door' if doors == 1 else 'doors'} on the way stand open")
    return Plan(tour.shots, lambda shot: volume, notes)
