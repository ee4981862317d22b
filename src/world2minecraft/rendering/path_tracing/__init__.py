"""Photos: path tracing of block scenes with sun, sky and lamps, and a filter for its grain.

``render_photo`` takes one; ``emitters_of`` lists a scene's lamps once for many.
"""

from world2minecraft.rendering.path_tracing.emitters import Emitters, emitters_of
from world2minecraft.rendering.path_tracing.photo import Photo, render_photo

__all__ = ["Emitters", "Photo", "emitters_of", "render_photo"]
