"""Access to pycolmap: lazy import, suppressed log output, and one-line errors."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from world2minecraft.core.errors import CaptureError, MissingExtraError

PHOTOS = "photos"  # Name used in errors, as a stream of photos has no path.


@contextmanager
def pycolmap_session() -> Iterator[Any]:
    """Yield pycolmap with its log suppressed; exceptions inside the block become CaptureError.

    Raises:
        MissingExtraError: If pycolmap is not installed.
        CaptureError: If pycolmap fails inside the block.
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
        reason = f"pose estimation failed ({first}); remove unusual photos and try again"
        raise CaptureError(PHOTOS, reason) from error
    finally:
        module.logging.minloglevel = before


def import_pycolmap() -> Any:
    """Import and return pycolmap.

    Raises:
        MissingExtraError: If pycolmap is not installed.
    """
    try:
        return import_module("pycolmap")
    except ImportError as error:
        raise MissingExtraError("pose estimation", "capture") from error
