"""Tone mapping from linear light to the screen: tables for the kernels, and numpy versions.

Light up to ``SHOULDER`` comes through as it is; what is brighter is pressed together below white by
its brightest channel, so that hues stay, and pales a little, as film does. A little contrast then
goes on top.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined

SCREEN_POWER = 2.2  # Products of colours then equal products of screen values.
ENCODE_STEPS = 4096  # The darkest step of sRGB is 0.8 of a screen value.
SHOULDER = 0.60  # Linear; 0.79 on the screen.
PALING = 0.18  # How fast light over white loses colour.
CONTRAST = 1.12  # A power of linear light: what fog the even light of rooms leaves is lifted.
NEVER = 1e30


class Tone(NamedTuple):
    """Tables that carry screen values to linear light and back."""

    decode: np.ndarray  # float32 [256]: linear light of a texel's channel
    encode: np.ndarray  # uint8 [ENCODE_STEPS]: screen value of linear light 0 to 1
    shoulder: float  # linear light from which the tone map presses; NEVER for a plain cut at 1


def filmic_tone() -> Tone:
    """Return the tone of pictures with light: sRGB, and a soft shoulder."""
    return Tone(
        srgb_to_linear(np.arange(256) / 255).astype(np.float32),
        _screen_values(linear_to_srgb(np.linspace(0, 1, ENCODE_STEPS) ** CONTRAST)),
        SHOULDER,
    )


def screen_tone() -> Tone:
    """Return the tone in which light acts on screen values, as in the game; white is a cut."""
    return Tone(
        ((np.arange(256) / 255) ** SCREEN_POWER).astype(np.float32),
        _screen_values(np.linspace(0, 1, ENCODE_STEPS) ** (1 / SCREEN_POWER)),
        NEVER,
    )


def srgb_to_linear(screen: np.ndarray) -> np.ndarray:
    """Return linear light, 0 to 1, of sRGB values of 0 to 1."""
    screen = np.asarray(screen, np.float64)
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4)


def linear_to_srgb(light: np.ndarray) -> np.ndarray:
    """Return sRGB values of 0 to 1 of linear light; light outside 0 to 1 is cut."""
    light = np.clip(np.asarray(light, np.float64), 0, 1)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def tone_map(light: np.ndarray, shoulder: float = SHOULDER) -> np.ndarray:
    """Return linear colours [..., 3] pressed below 1, float64."""
    light = np.maximum(np.asarray(light, np.float64), 0)
    peak = light.max(axis=-1, keepdims=True)
    room = 1 - shoulder
    over = np.maximum(peak - shoulder, 0)
    pressed = np.where(over > 0, 1 - room * room / (room + over), peak)
    scaled = light * np.where(over > 0, pressed / np.maximum(peak, 1e-12), 1)
    pale = 1 - 1 / (1 + PALING * (peak - pressed))
    return scaled + (pressed - scaled) * pale


def tone_map_picture(light: np.ndarray, tone: Tone) -> np.ndarray:
    """Return screen colours, uint8 [..., 3], of linear light, as ``tone_map_pixel`` does."""
    pressed = tone_map(light, tone.shoulder) if tone.shoulder < 1 else np.maximum(light, 0)
    return tone.encode[(np.minimum(pressed, 1) * (ENCODE_STEPS - 1) + 0.5).astype(np.int64)]


@inlined
def tone_map_pixel(r, g, b, tone):
    """Return the screen's ``(red, green, blue)``, uint8, of a pixel's linear light."""
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
