"""What the formats of blocks share: the options of their writers, and files known by suffix."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


class FileFormat:
    """A file that is read and written and holds blocks without their labels."""

    suffix: str
    can_read = True
    can_write = True
    keeps_labels = False

    def is_at(self, path: Path) -> bool:
        """Whether the name ends so."""
        return path.is_file() and path.suffix.lower() == self.suffix


@dataclass(frozen=True)
class WriteOptions:
    """What a writer may be told; a format takes what it needs."""

    mc_version: str = "1.20.1"
    name: str = "room"
    spawn: tuple[float, float, float] | None = None
    spawn_yaw_deg: float = 0.0
    schem_version: int = 2
    other: Mapping[str, Any] = field(default_factory=dict)
