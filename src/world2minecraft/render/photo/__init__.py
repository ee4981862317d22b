"""Photos: path tracing of block scenes with sun, sky and lamps, and a filter for its grain.

``render_photo`` takes one; ``lamps_of`` lists a scene's lamps once for many.
"""

from world2minecraft.render.photo.picture import Photo, render_photo
from world2minecraft.render.photo.sources import Lamps, lamps_of

__all__ = ["Lamps", "Photo", "lamps_of", "render_photo"]
