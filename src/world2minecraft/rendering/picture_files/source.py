"""The build to draw: its blocks, its scale and where its player starts."""

from dataclasses import dataclass, field
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.build_reader import PlayerStart, read_build
from world2minecraft.formats.volume_crop import Box
from world2minecraft.rendering.views import GamePose


@dataclass(eq=False)
class Source:
    """A build to draw; ``notes`` state what was chosen automatically."""

    volume: BlockVolume
    name: str
    path: Path
    spawn: GamePose | None = None
    notes: list[str] = field(default_factory=list)


def read_source(path: Path, box: Box | None) -> Source:
    """Read a file, a world, a run's folder or its build.

    Args:
        path: the file or folder.
        box: the blocks to draw, x0, y0, z0, x1, y1, z1, the last ones excluded; by default
            those of the scene, or those around the spawn of a world without one.

    Raises:
        InputError: it cannot be read, or holds nothing but air.
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
