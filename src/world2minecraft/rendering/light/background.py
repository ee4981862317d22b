"""What a ray sees that meets nothing: the sky by its direction, with the sun in it."""

from typing import NamedTuple

from world2minecraft.core.jit import inlined

HALO = 0.35  # The sun's share in the sky around it.
DISC_COSINE = 0.9990  # 2.6 degrees: larger than the true sun, as in the game.
DISC = 4.0


class Background(NamedTuple):
    """Linear colours, and the unit vector towards the sun in block axes."""

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
    """Return the linear ``(r, g, b)`` of the sky in a direction of block axes, a unit vector."""
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
