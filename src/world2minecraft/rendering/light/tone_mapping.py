"""Tone mapping from linear light to the screen: the tables, and their use in the kernels.

Light up to ``SHOULDER`` is unchanged. Brighter light is compressed below white by its brightest
channel, which preserves hues, and slightly desaturated, as film does. A slight contrast curve is
then applied.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined

SCREEN_POWER = 2.2  # Products of colours then equal products of screen values.
ENCODE_STEPS = 4096  # The first step of sRGB near black spans 0.8 of a screen value.
SHOULDER = 0.60  # Linear; 0.79 on the screen.
PALING = 0.18  # Rate at which light brighter than white loses its colour.
CONTRAST = 1.12  # Exponent for linear light; increases the low contrast of even room light.
NEVER = 1e30


class Tone(NamedTuple):
    """Tables for conversion between screen values and linear light."""

    decode: np.ndarray  # float32 [256]: linear light of a texel's channel
    encode: np.ndarray  # uint8 [ENCODE_STEPS]: screen value of linear light 0 to 1
    shoulder: float  # linear light from which colours are compressed; NEVER to clip at 1 instead


def filmic_tone() -> Tone:
    """Return the filmic tone curve: sRGB with a soft shoulder."""
    return Tone(
        srgb_to_linear(np.arange(256) / 255).astype(np.float32),
        _screen_values(linear_to_srgb(np.linspace(0, 1, ENCODE_STEPS) ** CONTRAST)),
        SHOULDER,
    )


def screen_tone() -> Tone:
    """Return the tone curve for light that scales screen values, as in Minecraft.

    Values above white are clipped.
    """
    return Tone(
        ((np.arange(256) / 255) ** SCREEN_POWER).astype(np.float32),
        _screen_values(np.linspace(0, 1, ENCODE_STEPS) ** (1 / SCREEN_POWER)),
        NEVER,
    )


def srgb_to_linear(screen: np.ndarray) -> np.ndarray:
    """Convert sRGB values 0 to 1 to linear light 0 to 1."""
    screen = np.asarray(screen, np.float64)
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4)


def linear_to_srgb(light: np.ndarray) -> np.ndarray:
    """Convert linear light to sRGB values 0 to 1. Light outside 0 to 1 is clipped."""
    light = np.clip(np.asarray(light, np.float64), 0, 1)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


@inlined
def tone_map_pixel(r, g, b, tone):
    """Return the screen colour ``(red, green, blue)`` of a pixel's linear light, uint8."""
    peak = max(r, g, b)
    if peak > tone.shoulder:
        room = 1.0 - tone.shoulder
        pressed = 1.0 - room * room / (peak - tone.shoulder + room)
        keep = 1.0 / (1.0 + PALING * (peak - pressed))
        white = pressed * (1.0 - keep)
        keep *= pressed / peak
        r, g, b = r * keep + white, g * keep + white, b * keep + white
    last = ENCODE_STEPS - 1
    return (
        tone.encode[np.uint64(min(max(r, 0.0), 1.0) * last + 0.5)],
        tone.encode[np.uint64(min(max(g, 0.0), 1.0) * last + 0.5)],
        tone.encode[np.uint64(min(max(b, 0.0), 1.0) * last + 0.5)],
    )


def _screen_values(values: np.ndarray) -> np.ndarray:
    return np.floor(values * 255 + 0.5).astype(np.uint8)
