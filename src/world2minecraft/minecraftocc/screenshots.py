"""Real screenshots from the game, each with its pose: from a sidecar, its name, or its PNG text.

Whether a pose is that of the feet, as F3 shows it, or of the eye must be said: a slip of 1.62
blocks spoils every label. Without other word a sidecar beside the pictures is looked for first,
then the PNG's texts, then the name; each view says where its pose came from.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Literal

import numpy as np

from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.name_patterns import NEEDED, USUAL, NamePattern
from world2minecraft.minecraftocc.png_text import PngFacts, read_png_facts
from world2minecraft.rendering.views.cameras import GamePose, camera_of
from world2minecraft.rendering.views.pose_file import TourPose, read_tour

At = Literal["feet", "eye"]
SIDECARS = ("poses.jsonl", "poses.csv", "tour.jsonl", "screenshots.jsonl", "screenshots.csv")
MOST_PICTURES = 1_000_000
_PAIR = re.compile(
    r"(?<![A-Za-z_])(yaw|pitch|x|y|z)[\"']?\s{0,3}[:=]\s{0,3}([-+]?\d{1,9}(?:\.\d{1,16})?)(?![\d.])",
    re.IGNORECASE,
)


@dataclass(frozen=True, eq=False)
class RecordedView:
    """A screenshot with its pose."""

    image: Path
    camera: Camera
    pose: GamePose  # at the feet or the eye, as it was said
    told_by: str  # "poses.csv", "its PNG text", "its name by {x}_{y}..."
    frame: int = 0
    tour_id: str = ""
    t_s: float = 0.0

    def camera_to_room(self, block_to_room: np.ndarray) -> np.ndarray:
        """Return the camera's pose in the room, float64 [4, 4]: feet are lifted to the eye.

        A player is as large as the world's scale says: 1.62 blocks at one block a metre.
        """
        blocks_per_metre = 1 / float(np.linalg.norm(block_to_room[:3, 0]))
        return self.pose.camera_to_room(block_to_room, eye_height_blocks(blocks_per_metre))


def read_screenshots(
    folder: str | Path,
    *,
    at: At,
    poses: str | Path | None = None,
    pattern: str | None = None,
    vertical_fov_deg: float = 70.0,
) -> list[RecordedView]:
    """Read the screenshots of a folder with their poses, in the order of the sidecar or by name.

    Args:
        folder: PNG files; other files are left alone.
        at: whether x, y, z is where the feet stand (F3, most mods) or the eye; a line of a sidecar
            may say its own.
        poses: a sidecar, JSONL or CSV, with the columns ``image`` (or ``file``), x, y, z, yaw and
            pitch; pictures that it does not name are left out.
        pattern: how names hold poses, see ``NamePattern``.
        vertical_fov_deg: the game's option; a line of a sidecar may say its own.

    Raises:
        UsageError: ``at`` is not said, the pattern is none. InputError: the folder has no picture,
            or no pose for one. DamagedFileError, LimitError: a file is not what it should be.
    """
    if at not in ("feet", "eye"):
        raise UsageError(
            f"at must be feet (what F3 and most mods tell) or eye (1.62 above it), not {at!r}"
        )
    source = Path(folder)
    pictures = _pictures(source)
    sidecar = _sidecar(source, poses, pattern)
    if sidecar is not None:
        return _by_sidecar(source, sidecar, at, vertical_fov_deg)
    read, told = _reader(pictures, pattern)
    views = []
    for frame, path in enumerate(pictures):
        facts = read_png_facts(path)
        numbers = read(path, facts)
        if numbers is None:
            raise InputError(path, f"has no pose: {told} does not tell x, y, z, yaw and pitch")
        camera = camera_of(facts.width_px, facts.height_px, vertical_fov_deg=vertical_fov_deg)
        try:
            pose = GamePose(*(numbers[name] for name in NEEDED), at=at)
        except UsageError as error:
            raise DamagedFileError(path, f"has no pose of the game: {error}") from error
        views.append(RecordedView(path, camera, pose, told, frame))
    return views


def _pictures(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise InputError(folder, "is no folder of screenshots")
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".png")
    if not found:
        raise InputError(folder, "has no screenshot: no .png lies in it")
    if len(found) > MOST_PICTURES:
        raise LimitError(folder, f"has more than {MOST_PICTURES} screenshots")
    return found


def _sidecar(folder: Path, poses: str | Path | None, pattern: str | None) -> Path | None:
    """Return the file of poses that is named, or that lies beside the pictures."""
    if poses is not None and pattern is not None:
        raise UsageError("poses and pattern are two ways to tell the poses; give one of them")
    if poses is not None:
        named = Path(poses)
        return named if named.is_file() else folder / named
    if pattern is not None:
        return None
    return next((folder / name for name in SIDECARS if (folder / name).is_file()), None)


def _by_sidecar(folder: Path, sidecar: Path, at: At, fov_deg: float) -> list[RecordedView]:
    views, counts, known = [], {}, set()
    for one in read_tour(sidecar, at=at):
        path = _named(folder, one.image, sidecar)
        if path in known:
            raise DamagedFileError(sidecar, f"names {one.image} twice")
        known.add(path)
        number = counts.get(one.tour_id, 0)
        counts[one.tour_id] = number + 1
        frame = number if one.frame is None else one.frame
        camera = _camera(path, one, sidecar, fov_deg)
        views.append(
            RecordedView(path, camera, one.pose, sidecar.name, frame, one.tour_id, one.t_s)
        )
    return views


def _named(folder: Path, name: str, sidecar: Path) -> Path:
    """Return the picture that a line names: one in the folder or below it, and nowhere else."""
    if not name:
        raise DamagedFileError(sidecar, "has a line without image (or file), the picture's name")
    parts = PurePosixPath(name.replace("\\", "/"))
    if parts.is_absolute() or ".." in parts.parts or ":" in name or "\0" in name:
        raise DamagedFileError(sidecar, f"names {name!r}, which is not below its folder")
    path = folder.joinpath(*parts.parts)
    if not path.is_file():
        raise InputError(sidecar, f"names {name}, which is not there")
    return path


def _camera(path: Path, one: TourPose, sidecar: Path, fov_deg: float) -> Camera:
    facts = read_png_facts(path)
    size = (facts.width_px, facts.height_px)
    if one.camera is None:
        return camera_of(*size, vertical_fov_deg=one.vertical_fov_deg or fov_deg)
    if (one.camera.width_px, one.camera.height_px) != size:
        told = f"{one.camera.width_px}x{one.camera.height_px}"
        raise DamagedFileError(
            sidecar, f"says {told} of {one.image}, which has {size[0]}x{size[1]}"
        )
    return one.camera


Reader = Callable[[Path, PngFacts], dict[str, float] | None]


def _reader(pictures: list[Path], pattern: str | None) -> tuple[Reader, str]:
    """Return what reads the poses of pictures, and how it is called; the first picture decides."""
    if pattern is not None:
        return _by_name(pattern), f"its name by {pattern}"
    first = pictures[0]
    facts = read_png_facts(first)
    if _by_text(first, facts) is not None:
        return _by_text, "its PNG text"
    for usual in USUAL:
        if _by_name(usual)(first, facts) is not None:
            return _by_name(usual), f"its name by {usual}"
    raise InputError(
        first,
        f"has no pose: no sidecar ({', '.join(SIDECARS)}) lies beside it, its PNG texts tell none, "
        f"and its name is not like {USUAL[0]}; name a sidecar or a pattern",
    )


def _by_name(pattern: str) -> Reader:
    compiled = NamePattern(pattern)
    return lambda path, facts: compiled.read(path.stem)


def _by_text(path: Path, facts: PngFacts) -> dict[str, float] | None:
    """Return the pose that the texts of a PNG tell: five keywords, or pairs such as ``x=1.5``."""
    found: dict[str, float] = {}
    for keyword, text in facts.texts:
        own = f"{keyword}={text.strip()}" if keyword.lower() in NEEDED else text
        for name, number in _PAIR.findall(own):
            value = float(number)
            if found.setdefault(name.lower(), value) != value:
                raise DamagedFileError(path, f"tells {name.lower()} twice in its PNG texts")
    return found if len(found) == len(NEEDED) else None
