"""What ``w2m render`` draws: a volume of any form, at its scale, and where its player starts."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.formats.build_reader import PlayerStart
    from world2minecraft.formats.volume_crop import Box
    from world2minecraft.rendering.views import GamePose


@dataclass(eq=False)
class Source:
    """A volume to draw; ``notes`` say what was chosen for the user."""

    volume: "BlockVolume"
    name: str
    path: Path
    spawn: "GamePose | None" = None
    notes: list[str] = field(default_factory=list)


def read_source(path: Path, box: "Box | None") -> Source:
    """Read a file, a world, a run's folder or its build.

    Args:
        path: where it is.
        box: which blocks, the last ones not included; a world of this program says so itself,
            of another world those around the spawn are taken.

    Raises:
        InputError: it cannot be read, or nothing but air is there.
    """
    from world2minecraft.formats.build_reader import read_build as read

    found = read(path, box)
    return Source(found.volume, found.name, path, _pose(found.start), found.notes)


def _pose(start: "PlayerStart | None") -> "GamePose | None":
    from world2minecraft.rendering.views import GamePose

    if start is None:
        return None
    try:
        return GamePose(start.x, start.y, start.z, start.yaw_deg, 0.0)
    except UsageError:
        return None
