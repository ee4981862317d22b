"""Detection of the page that ``w2m scan`` writes, so that it is not read as a photo."""

from PIL import Image

from world2minecraft.core.archives import AnyPath

SOFTWARE_TAG = "w2m scan"  # PNG text ``Software`` of the page.
POSTER_SUFFIX = "-scan.png"


def is_poster(path: AnyPath) -> bool:
    """Return whether a file is a page written by ``w2m scan``, which may be overwritten."""
    try:
        with path.open("rb") as stream, Image.open(stream, formats=("PNG",)) as image:
            return getattr(image, "text", {}).get("Software") == SOFTWARE_TAG
    except (OSError, SyntaxError, ValueError):
        return False


def is_saved_poster(path: AnyPath) -> bool:
    """Return whether a file in a capture's folder is such a page, by name and content."""
    return path.name.endswith(POSTER_SUFFIX) and is_poster(path)
