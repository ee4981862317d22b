"""The sun and the sky as light sources at the hour given by a ``LightSettings``.

The visible sky is that of ``rendering.light.sky``. The sky used for lighting has each channel
scaled, so that open ground in the shade gets the light intended for that hour.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined
from world2minecraft.rendering.light.light_settings import LightSettings
from world2minecraft.rendering.light.sky import (
    DISC,
    DISC_COSINE,
    HALO,
    Background,
    background_light,
)

SUN = 3.0  # The sun beside the sky's shade: on a clear day three to five times as much.
SUN_COSINE = 0.99985  # Of its disc's radius, 1 degree: twice the true one, for soft shadows.


class SkyLight(NamedTuple):
    """The sky and sun parameters that the kernel reads."""

    background: Background  # at exposure 1
    scale_r: float  # what lights, beside what is seen
    scale_g: float
    scale_b: float
    sun_r: float  # what a surface gets that faces the sun, over pi
    sun_g: float
    sun_b: float
    disc_cosine: float  # of the disc that light comes from


def sky_light(light: LightSettings) -> SkyLight:
    """Return the sky and the sun at the hour of the light settings.

    Raises:
        ValueError: If the light preset has no sky.
    """
    if light.preset != "shader":
        raise ValueError(f"photos need the light preset 'shader', got {light.preset!r}")
    sky = light.sky
    scale = np.array(sky.shade) / _open_light(sky.zenith, sky.horizon)
    red, green, blue = (SUN * value for value in sky.sun)
    scale_r, scale_g, scale_b = (float(value) for value in scale)
    return SkyLight(sky.background(), scale_r, scale_g, scale_b, red, green, blue, SUN_COSINE)


def _open_light(zenith: tuple[float, ...], horizon: tuple[float, ...]) -> np.ndarray:
    """Return what open ground gets of the sky without its sun, over pi: float64 [3].

    The mean, weighed by the cosine, of the background's (1 - y) ** 3 is 1 / 10.
    """
    return 0.9 * np.array(zenith) + 0.1 * np.array(horizon)


@inlined
def sky_radiance(dx, dy, dz, sky):
    """Return the linear radiance of the sky in a direction, without the sun's disc."""
    r, g, b = background_light(dx, dy, dz, sky.background)
    bg = sky.background
    if dx * bg.sun_x + dy * bg.sun_y + dz * bg.sun_z > DISC_COSINE and dy > -0.05:
        r -= (DISC - HALO) * bg.sun_r
        g -= (DISC - HALO) * bg.sun_g
        b -= (DISC - HALO) * bg.sun_b
    return r * sky.scale_r, g * sky.scale_g, b * sky.scale_b


@inlined
def tangent_frame(x, y, z):
    """Return two unit vectors orthogonal to a unit vector and to each other."""
    sign = 1.0 if z >= 0 else -1.0
    a = -1.0 / (sign + z)
    b = x * y * a
    return 1.0 + sign * x * x * a, sign * b, -sign * x, b, sign + y * y * a, -y


@inlined
def sample_sun(sky, first, second):
    """Return a unit direction into the sun's disc from two random numbers in [0, 1)."""
    bg = sky.background
    ax, ay, az, bx, by, bz = tangent_frame(bg.sun_x, bg.sun_y, bg.sun_z)
    cosine = 1.0 - first * (1.0 - sky.disc_cosine)
    sine = np.sqrt(max(0.0, 1.0 - cosine * cosine))
    p, q = sine * np.cos(2 * np.pi * second), sine * np.sin(2 * np.pi * second)
    return (
        cosine * bg.sun_x + p * ax + q * bx,
        cosine * bg.sun_y + p * ay + q * by,
        cosine * bg.sun_z + p * az + q * bz,
    )
