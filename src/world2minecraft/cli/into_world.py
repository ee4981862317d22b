"""What ``w2m build --into`` does: put blocks into a world of the user, and say how to undo it."""

from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.types import BlockVolume


def into_world(
    volume: "BlockVolume",
    world: Path,
    at: tuple[int, int, int],
    turns: int,
    air: str,
    new_chunks: bool,
) -> None:
    """Build a volume into a world.

    Raises:
        UsageError: this is not possible yet.
    """
    raise UsageError(f"{world}: building into a world is not there yet; use --out")
