"""Light of the sky and of lamps by time of day, and tone mapping to the screen.

A scene has a ``LightField`` (``light_field(states, palette, reach)``), whose ``lattice`` the kernel
reads and which ``edit_light`` updates after edits. A ``LightSettings`` describes the lighting of an
image, and ``scene_exposure(field, look, eyes)`` computes its exposure. The settings provide to the
kernel:

- ``parameters(exposure) -> LightCoefficients``, only floats,
- ``background(exposure) -> Background``, the sky,
- ``tone -> Tone``, the tables ``decode`` (texel to light) and ``encode`` (light to screen).

Functions for kernels, called for each pixel (the picture kernel replaces the first and third by a
table of all lattice entries, ``shading.corner_lights``):

- ``sky, block, occluders = lattice_light(light, side, i, j, k, layer_step, p, q)``
- ``shade = direction_shade(nx, ny, nz, cosine, params)``
- ``r, g, b = light_multipliers(sky, block, occluders, shade, sun, params)``, the multipliers of the
  linear texel; ``emission_light(emission, params)`` is their minimum for luminous surfaces
- ``r, g, b = background_light(dx, dy, dz, background)`` for rays without a surface
- ``tone_map_pixel(r, g, b, tone)``, three uint8 values
"""

from world2minecraft.rendering.light.exposure import scene_exposure
from world2minecraft.rendering.light.light_field import LightField, light_field
from world2minecraft.rendering.light.light_settings import LightSettings
from world2minecraft.rendering.light.pixel_light import (
    LightCoefficients,
    direction_shade,
    emission_light,
    lattice_light,
    light_multipliers,
)
from world2minecraft.rendering.light.relight import edit_light
from world2minecraft.rendering.light.sky import Background, background_light
from world2minecraft.rendering.light.tone_mapping import Tone, tone_map_pixel

__all__ = [
    "Background",
    "LightCoefficients",
    "LightField",
    "LightSettings",
    "Tone",
    "background_light",
    "direction_shade",
    "edit_light",
    "emission_light",
    "lattice_light",
    "light_field",
    "light_multipliers",
    "scene_exposure",
    "tone_map_pixel",
]
