"""Access to pycolmap: imported when needed, without its log, failures as one-line errors."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from world2minecraft.core.errors import CaptureError, MissingExtraError

PHOTOS = "photos"  # What an error names: a stream of photos has no path.


@contextmanager
def pycolmap_session() -> Iterator[Any]:
    """Give the module, without its log lines; what it raises becomes a CaptureError.

    Raises:
        MissingExtraError: pycolmap is not installed.
        CaptureError: it has failed inside the block.
    """
    module = import_pycolmap()
    before = module.logging.minloglevel
    module.logging.minloglevel = 3  # Its errors are raised as well as written.
    try:
        yield module
    except (RuntimeError, ValueError) as error:
        if isinstance(error, ValueError) and not str(error).startswith("["):
            raise  # Ours; those of its own checks begin with its source file.
        first = (str(error).splitlines() or ["no reason given"])[0][:200]
        reason = f"their places could not be found ({first}); leave out odd photos and try again"
        raise CaptureError(PHOTOS, reason) from error
    finally:
        module.logging.minloglevel = before


def import_pycolmap() -> Any:
    """Return pycolmap. Raises MissingExtraError where it is not installed."""
    try:
        return import_module("pycolmap")
    except ImportError as error:
        raise MissingExtraError("finding the places of photos", "capture") from error
