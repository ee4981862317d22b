"""Light settings of an image, and the coefficients that the kernels read."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.rendering.light.pixel_light import MAX_SCREEN, LightCoefficients
from world2minecraft.rendering.light.sky import Background, Sky, sky_at
from world2minecraft.rendering.light.tone_mapping import (
    SCREEN_POWER,
    Tone,
    filmic_tone,
    screen_tone,
    srgb_to_linear,
)

PRESETS = ("shader", "game", "neutral")
DEFAULT_HOUR = 11.0  # Late morning: a high sun with shadows that still have a direction.
WARM = (1.0, 0.86, 0.62)  # The game's torchlight.
# Full block light as eyes see it, linear: paler beside the sun, golden in the dark.
LAMP_BY_DAY, LAMP_BY_NIGHT = (0.58, 0.52, 0.42), (0.98, 0.72, 0.42)
GLOW = 1.9  # Brightness of a lamp's face: above the shoulder, so that it looks lit.
AMBIENT = 0.05
NIGHT_CURVE = 4.0  # What it adds to the curve of block light: what leaves a room is faint outside.
DIM_BY_NIGHT = (0.45, 0.48, 0.60)  # Factors of the ambient light at night.
CORNER = 0.28  # Linear equivalent of the game's value of 0.2 on the screen.
# Shades of faces: x (east, west), up, down, z (north, south).
GAME_CORNER = 0.2
GAME_SHADE = (0.6, 1.0, 0.5, 0.8)
SOFT_SHADE = (0.74, 1.0, 0.70, 0.87)
NEUTRAL_SHADE = (0.85, 1.0, 0.70, 0.94)
NEUTRAL_SKY = (238, 238, 236), (226, 226, 224), (214, 214, 212)  # sRGB: a quiet, warm light grey.
NEUTRAL_EXPOSURE = 1.10
NEUTRAL_HEADLIGHT, NEUTRAL_CORNER, NEUTRAL_GLOW = 0.14, 0.15, 1.12


@dataclass(frozen=True)
class LightSettings:
    """The lighting of an image.

    Presets: ``shader`` computes in linear light with a filmic tone curve. ``game`` imitates
    Minecraft, in which light scales screen values. ``neutral`` is a light at the camera without a
    time of day: the colour on screen is the block's own colour times a mild shade, so that worlds
    can be compared with photos.
    """

    preset: str = "shader"
    hour: float = DEFAULT_HOUR
    exposure: float | None = None  # None: from the scene's own light, see exposure.scene_exposure
    brightness: float = 0.5  # the game's option, 0 (moody) to 1 (bright): lifts the dark
    sun_shadow: bool = False  # ask for a ray towards the sun at each pixel
    soft_shade: bool = True  # of ``shader``: faces differ less than in the game, as rooms want

    def __post_init__(self):
        if self.preset not in PRESETS:
            raise ValueError(f"preset must be one of {', '.join(PRESETS)}, got {self.preset!r}")
        if self.exposure is not None and not 0.01 <= self.exposure <= 100:
            raise ValueError(f"exposure must be 0.01 to 100, got {self.exposure}")
        if not 0 <= self.brightness <= 1:
            raise ValueError(f"brightness must be 0 to 1, got {self.brightness}")
        sky_at(self.hour)

    @property
    def sky(self) -> Sky:
        """The sky at the hour of the settings."""
        return sky_at(self.hour)

    @property
    def tone(self) -> Tone:
        """The tables for conversion between screen values and light."""
        return filmic_tone() if self.preset == "shader" else screen_tone()

    def parameters(self, exposure: float = 1.0) -> LightCoefficients:
        """Return the coefficients for the kernel, with ``exposure`` if the settings have none."""
        exposure = exposure if self.exposure is None else self.exposure
        if self.preset == "neutral":
            return _neutral(self.exposure or 1.0)
        sky = self.sky
        light = np.array(sky.shade if self.sun_shadow else sky.light)
        daylight = min(sky.light[1], 1.0)
        lamp = mix(LAMP_BY_NIGHT, LAMP_BY_DAY, daylight)
        ambient = AMBIENT * (0.4 + 1.2 * self.brightness) * mix(DIM_BY_NIGHT, (1, 1, 1), daylight)
        curve = 3.0 - 2.0 * self.brightness
        block_curve = curve + NIGHT_CURVE * (1 - daylight)
        rest = [curve, block_curve, CORNER, *self._shades(), 0.0, GLOW, 0.0]
        if self.preset == "game":
            light, lamp = light ** (1 / SCREEN_POWER), np.array(WARM)
            # The game mixes b with 1 - (1 - b) ** 4 for b = l / (4 - 3 l); these come close.
            curve = 3.0 - 6.6 * self.brightness + 3.3 * self.brightness**2
            rest = [curve, curve, GAME_CORNER, *GAME_SHADE, 0.0, 1.0, min(exposure, MAX_SCREEN)]
        sun = np.array(sky.sun) * self.sun_shadow
        colours = np.concatenate([light, lamp, ambient, sun]) * exposure
        return LightCoefficients._make([*colours.tolist(), *sky.sun_direction, *rest])

    def _shades(self) -> tuple[float, ...]:
        """Return the shades of faces in linear light: x, up, down, z."""
        return SOFT_SHADE if self.soft_shade else tuple(v**SCREEN_POWER for v in GAME_SHADE)

    def background(self, exposure: float = 1.0) -> Background:
        """Return the background for the kernel, with ``exposure`` if the settings have none."""
        if self.preset == "neutral":
            greys = srgb_to_linear(np.array(NEUTRAL_SKY) / 255).reshape(-1)
            return Background._make([*greys.tolist(), 0.0, 0.0, 0.0, 0.0, 1.0, 0.0])
        return self.sky.background(exposure if self.exposure is None else self.exposure)


def mix(first: Sequence[float], second: Sequence[float], share: float) -> np.ndarray:
    """Return the interpolation of two colours, with ``share`` of the second."""
    return np.array(first) * (1 - share) + np.array(second) * share


def _neutral(exposure: float) -> LightCoefficients:
    """Return a grey light at the camera, with the shades of the preview."""
    light = NEUTRAL_EXPOSURE * exposure
    colours = [*[0.0] * 6, light, light, light, *[0.0] * 3]
    rest = [3.0, 3.0, NEUTRAL_CORNER, *NEUTRAL_SHADE, NEUTRAL_HEADLIGHT, NEUTRAL_GLOW, MAX_SCREEN]
    return LightCoefficients._make([*colours, 0.0, 1.0, 0.0, *rest])
