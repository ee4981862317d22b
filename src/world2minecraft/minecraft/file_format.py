"""What most formats share that are files known by their suffix."""

from pathlib import Path


class FileFormat:
    """A file that is read and written and holds blocks without their labels."""

    suffix: str
    can_read = True
    can_write = True
    keeps_labels = False

    def is_at(self, path: Path) -> bool:
        """Whether the name ends so."""
        return path.is_file() and path.suffix.lower() == self.suffix
