"""Light of the sky, of lamps and of the hour, and tone mapping to the screen.

A scene keeps a ``LightField`` (``light_field(states, palette, reach)``), whose ``lattice`` the
kernel reads, and ``edit_light`` keeps it true where cells change. A ``LightSettings`` says how a
picture is lit, ``scene_exposure(field, look, eyes)`` how far that is opened up; the look gives the
kernel

- ``parameters(exposure) -> LightCoefficients``, floats alone,
- ``background(exposure) -> Background``, the sky,
- ``tone -> Tone``, the tables ``decode`` (texel to light) and ``encode`` (light to screen).

For kernels, a pixel at a time (the picture kernel has a table of all entries of the
lattice, ``shading.corner_lights``, in place of the first and third):

- ``sky, block, occluders = lattice_light(light, side, i, j, k, layer_step, p, q)``
- ``shade = direction_shade(nx, ny, nz, cosine, params)``
- ``r, g, b = light_multipliers(sky, block, occluders, shade, sun, params)``, the multipliers of
  the linear texel; ``emission_light(emission, params)`` is the least of them for what shines by
  itself
- ``r, g, b = background_light(dx, dy, dz, background)`` where a ray meets nothing
- ``tone_map_pixel(r, g, b, tone)``, three uint8
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
