"""Path tracing of block scenes with sun, sky and lamps, and denoising.

``render_photo`` renders an image. ``emitters_of`` lists the lamps of a scene once for many images.
"""

from world2minecraft.rendering.path_tracing.emitters import Emitters, emitters_of
from world2minecraft.rendering.path_tracing.photo import Photo, render_photo

__all__ = ["Emitters", "Photo", "emitters_of", "render_photo"]
