"""What ``w2m scan`` found, on one page: plan, photos, directions of look and doubts."""

from world2minecraft.scan.poster.page import is_poster, poster, poster_png

__all__ = ["is_poster", "poster", "poster_png"]
