"""The build to render: its blocks, its scale and the start position of its player."""

from dataclasses import dataclass, field
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.build_reader import PlayerStart, read_build
from world2minecraft.formats.volume_crop import Box
from world2minecraft.rendering.views import GamePose


@dataclass(eq=False)
class Source:
    """A build to render. ``notes`` describe automatic choices."""

    volume: BlockVolume
    name: str
    path: Path
    spawn: GamePose | None = None
    notes: list[str] = field(default_factory=list)


def read_source(path: Path, box: Box | None) -> Source:
    """Read a build from a file, a world, a run folder or its build folder.

    Args:
        path: The file or folder.
        box: Blocks to render as x0, y0, z0, x1, y1, z1, with an exclusive end. The default is the
            whole scene, or the blocks around the spawn point of a world without a scene.

    Raises:
        InputError: If the build cannot be read or contains only air.
    """
    found = read_build(path, box)
    return Source(found.volume, found.name, path, _pose(found.start), found.notes)


def _pose(start: PlayerStart | None) -> GamePose | None:
    if start is None:
        return None
    try:
        return GamePose(start.x, start.y, start.z, start.yaw_deg, 0.0)
    except UsageError:
        return None
