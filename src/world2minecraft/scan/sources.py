"""Which layout a folder has.

A new layout is one file with a ``Source``, one line here and one test; other packages add theirs
through the entry point group ``world2minecraft.source``.
"""

from pathlib import Path

from world2minecraft.errors import CaptureError
from world2minecraft.registry import Registry
from world2minecraft.scan.frames import Capture, Source

SOURCES = Registry(
    "source",
    {
        "plain": "world2minecraft.scan.plain:PlainSource",
        "nerfstudio": "world2minecraft.scan.nerfstudio:NerfstudioSource",
        "seven_scenes": "world2minecraft.scan.seven_scenes:SevenScenesSource",
    },
)
INDEX_FILES = ("capture.json", "transforms.json")


def find_capture(path: str | Path) -> Capture:
    """Find out the layout of a folder and list its frames.

    Args:
        path: the folder, or its ``capture.json`` or ``transforms.json``.

    Raises:
        CaptureError: it is missing, empty, of another kind or contradicts itself.
    """
    folder = Path(path)
    if folder.is_file() and folder.name in INDEX_FILES:
        folder = folder.parent
    if not folder.exists():
        raise CaptureError(folder, "is not there")
    if not folder.is_dir():
        raise CaptureError(folder, "is a file; a capture is a folder of frames")
    try:
        empty = next(folder.iterdir(), None) is None
    except OSError as error:
        raise CaptureError(folder, f"cannot be read: {error.strerror or error}") from error
    sources: list[Source] = [SOURCES.load(name)() for name in SOURCES.names()]
    for source in sources:
        if source.recognise(folder):
            return source.read(folder)
    kind = "is empty" if empty else "is a folder of another kind"
    layouts = "; ".join(source.layout for source in sources)
    raise CaptureError(folder, f"{kind}; a capture has one of these layouts: {layouts}")
