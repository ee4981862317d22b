"""How images are called that an ``ImageSource`` takes from a file or from a place within one."""

from world2minecraft.core.archives import AnyPath


class NamedByFile:
    """An image that is called as its file ``path``."""

    path: AnyPath

    def __str__(self) -> str:
        """The file's path, for messages."""
        return str(self.path)

    @property
    def stem(self) -> str:
        """The file's name without suffix."""
        return self.path.stem

    @property
    def name(self) -> str:
        """The file's name."""
        return self.path.name


class NamedByFrame:
    """An image within the larger file ``path`` that is called as its ``frame``."""

    path: AnyPath
    frame: str

    def __str__(self) -> str:
        """The file and the frame in it."""
        return f"{self.path}/{self.frame}"

    @property
    def stem(self) -> str:
        """The name by which label images are found."""
        return self.frame.partition(" ")[0]

    @property
    def name(self) -> str:
        """A short name for messages."""
        return self.frame
