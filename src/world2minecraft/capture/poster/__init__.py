"""The page written by ``w2m scan``: plan, photos, view directions and diagnostics."""

from world2minecraft.capture.poster.page import draw_poster, poster_png
from world2minecraft.capture.poster_detection import is_poster

__all__ = ["draw_poster", "is_poster", "poster_png"]
