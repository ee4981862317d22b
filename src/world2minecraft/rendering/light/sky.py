"""The sky by time of day: the colours of its light, of the sun and of the background.

The values are interpolated from a table of hours. Colours are linear. Their relative strengths are
artistic rather than photometric, because a physically dark night would show nothing.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined

HALO = 0.35  # The sun's share in the sky around it.
DISC_COSINE = 0.9990  # 2.6 degrees: larger than the true sun, as in the game.
DISC = 4.0
SUN_TILT_DEG = 30.0  # Angle of the sun south of the zenith at noon, so that shadows are visible.
MIN_SUN_HEIGHT = 0.10  # The sine of the lowest sun, so that shadows end somewhere.
# hour: light, shade, sun, zenith, horizon
_NIGHT = ((0.050, 0.066, 0.115), (0.040, 0.053, 0.095), (0.030, 0.040, 0.065),
          (0.006, 0.010, 0.026), (0.020, 0.030, 0.062))  # fmt: skip
_DAWN = ((0.520, 0.450, 0.430), (0.280, 0.270, 0.340), (0.880, 0.500, 0.260),
         (0.130, 0.200, 0.420), (0.900, 0.560, 0.380))  # fmt: skip
_DUSK = ((0.540, 0.430, 0.400), (0.280, 0.260, 0.330), (0.950, 0.460, 0.200),
         (0.120, 0.160, 0.380), (0.920, 0.450, 0.250))  # fmt: skip
_DAY = ((1.000, 0.980, 0.950), (0.380, 0.430, 0.530), (1.060, 0.970, 0.820),
        (0.140, 0.330, 0.780), (0.560, 0.740, 0.940))  # fmt: skip
_NO_SUN = (0.0, 0.0, 0.0)  # At 6 and 18 the sun and the moon change places.
_SUNRISE = ((0.330, 0.300, 0.320), (0.200, 0.205, 0.275), _NO_SUN,
            (0.085, 0.135, 0.300), (0.640, 0.400, 0.300))  # fmt: skip
_SUNSET = ((0.330, 0.290, 0.320), (0.200, 0.200, 0.275), _NO_SUN,
           (0.075, 0.110, 0.290), (0.660, 0.320, 0.220))  # fmt: skip
_MOMENTS = (
    (0.0, _NIGHT), (5.0, _NIGHT), (6.0, _SUNRISE), (6.4, _DAWN), (8.5, _DAY), (15.5, _DAY),
    (17.6, _DUSK), (18.0, _SUNSET), (19.2, _NIGHT), (24.0, _NIGHT),
)  # fmt: skip


class Background(NamedTuple):
    """Linear colours of the sky, and the unit vector towards the sun in block axes."""

    zenith_r: float
    zenith_g: float
    zenith_b: float
    horizon_r: float
    horizon_g: float
    horizon_b: float
    ground_r: float  # straight below
    ground_g: float
    ground_b: float
    sun_r: float  # all 0: no sun is drawn
    sun_g: float
    sun_b: float
    sun_x: float
    sun_y: float
    sun_z: float


@inlined
def background_light(dx, dy, dz, background):
    """Return the linear ``(r, g, b)`` of the sky in a direction, a unit vector in block axes."""
    if dy >= 0.0:
        low = 1.0 - dy
        low = low * low * low
        r = background.zenith_r + (background.horizon_r - background.zenith_r) * low
        g = background.zenith_g + (background.horizon_g - background.zenith_g) * low
        b = background.zenith_b + (background.horizon_b - background.zenith_b) * low
    else:
        low = 1.0 + dy
        low = low * low * low
        low = low * low
        r = background.ground_r + (background.horizon_r - background.ground_r) * low
        g = background.ground_g + (background.horizon_g - background.ground_g) * low
        b = background.ground_b + (background.horizon_b - background.ground_b) * low
    cosine = dx * background.sun_x + dy * background.sun_y + dz * background.sun_z
    if cosine > 0.0 and dy > -0.05:
        halo = cosine * cosine
        halo = halo * halo
        halo = halo * halo
        halo = halo * halo * HALO
        if cosine > DISC_COSINE:
            halo = DISC
        r += background.sun_r * halo
        g += background.sun_g * halo
        b += background.sun_b * halo
    return r, g, b


@dataclass(frozen=True)
class Sky:
    """The sky at an hour, with linear colours."""

    light: tuple[float, float, float]  # what full sky light is where nothing casts a shadow
    shade: tuple[float, float, float]  # what is left of it in the sun's shadow
    sun: tuple[float, float, float]  # what the sun, or the moon, adds where it is straight ahead
    zenith: tuple[float, float, float]
    horizon: tuple[float, float, float]
    sun_direction: tuple[float, float, float]  # unit, block axes: x east, y up, z south

    def background(self, exposure: float = 1.0) -> Background:
        """Return the sky for the kernel, which is exposed half as much as the lit surfaces."""
        ground = 0.5 * np.array(self.horizon)
        colours = np.array([self.zenith, self.horizon, ground, self.sun]) * exposure**0.5
        return Background._make([*colours.reshape(-1).tolist(), *self.sun_direction])


def sky_at(hour: float) -> Sky:
    """Return the sky at an hour of the day, 0 to 24. The sun rises in the east at 6.

    Raises:
        ValueError: If the hour is out of range.
    """
    if not 0 <= hour <= 24:
        raise ValueError(f"hour must be 0 to 24, got {hour}")
    hours = [moment for moment, _ in _MOMENTS]
    table = np.array([colours for _, colours in _MOMENTS])
    rows = []
    for row in range(5):
        r, g, b = (float(np.interp(hour, hours, table[:, row, n])) for n in range(3))
        rows.append((r, g, b))
    return Sky(rows[0], rows[1], rows[2], rows[3], rows[4], sun_direction(hour))


def sun_direction(hour: float) -> tuple[float, float, float]:
    """Return the unit vector towards the sun, or at night the moon, in block axes.

    Example:
        >>> tuple(round(value, 2) for value in sun_direction(12))
        (0.0, 0.87, 0.5)
    """
    angle = np.pi * ((hour - 6) % 12) / 12
    tilt = np.deg2rad(SUN_TILT_DEG)
    height = max(float(np.sin(angle) * np.cos(tilt)), MIN_SUN_HEIGHT)
    towards = np.array([np.cos(angle), height, np.sin(angle) * np.sin(tilt)])
    x, y, z = towards / np.linalg.norm(towards)
    return float(x), float(y), float(z)
