"""The light of one pixel, computed by functions that are inlined into the kernels.

All colours are linear multipliers of a surface's linear colour.
"""

from typing import NamedTuple

from world2minecraft.core.jit import inlined

MAX_SCREEN = 2.0  # Beyond, where all is white anyway, the polynomial of ``to_linear`` turns.


class LightCoefficients(NamedTuple):
    """The coefficients of a ``LightSettings`` for the kernel, as plain floats."""

    sky_r: float  # full sky light
    sky_g: float
    sky_b: float
    block_r: float  # full block light
    block_g: float
    block_b: float
    ambient_r: float  # light that is everywhere
    ambient_g: float
    ambient_b: float
    sun_r: float  # the sun, where a ray towards it is free
    sun_g: float
    sun_b: float
    sun_x: float  # unit vector towards the sun, or the moon, in block axes
    sun_y: float
    sun_z: float
    curve: float  # light l of 0 to 1 shines l / (1 + curve * (1 - l)); the game has 3
    block_curve: float  # the same of block light
    corner: float  # what each solid neighbour of a corner takes, 0 to 1
    shade_x: float  # shade of faces to the east and west
    shade_up: float
    shade_down: float
    shade_z: float  # shade of faces to the north and south
    headlight: float  # what a face loses that the camera sees edge-on
    glow: float  # how bright a surface is that shines by itself at level 15
    screen: float  # 0: multipliers act on light; else on screen values, and go up to this one


@inlined
def lattice_light(light, side, i, j, k, layer_step, p, q):
    """Return ``(sky, block, occluders)`` at a point of a face by bilinear interpolation.

    Light is in levels, occluders are 0 to 3.

    Args:
        light: Light lattice, uint16 [3, X + 2, Y + 2, Z + 2]; see ``rendering.light.light_field``.
        side: Side of the face's normal, 0 to 5: -x +x -y +y -z +z.
        i: Cell index along x, within the volume.
        j: Cell index along y.
        k: Cell index along z.
        layer_step: -1 or 1 for a face at the cell's boundary on that side, 0 for a face inside.
        p: Position along the first axis other than the normal's, 0 to 1.
        q: Position along the second axis other than the normal's, 0 to 1.
    """
    # A flat view and one return: with more, numba counts references at every pixel.
    step_y = light.shape[3]
    step_x = light.shape[2] * step_y
    axis = side >> 1
    step_p = step_y if axis == 0 else step_x
    step_q = step_y if axis == 2 else 1
    step = step_x if axis == 0 else (step_y if axis == 1 else 1)
    at = (axis * light.shape[1] + i) * step_x + j * step_y + k + (layer_step + 1) * step
    flat = light.flat
    a, b, c, d = flat[at], flat[at + step_q], flat[at + step_p], flat[at + step_p + step_q]
    wd = p * q
    wc, wb = p - wd, q - wd
    wa = 1.0 - p - wb
    sky = wa * (a & 63) + wb * (b & 63) + wc * (c & 63) + wd * (d & 63)
    block = wa * (a >> 6 & 63) + wb * (b >> 6 & 63) + wc * (c >> 6 & 63) + wd * (d >> 6 & 63)
    occluders = wa * (a >> 12) + wb * (b >> 12) + wc * (c >> 12) + wd * (d >> 12)
    return 0.25 * sky, 0.25 * block, occluders


@inlined
def light_multipliers(sky, block, occluders, shade, sun, params):
    """Return the multipliers ``(r, g, b)`` for the light at a point.

    Args:
        sky: Sky light, 0 to 15.
        block: Block light, 0 to 15.
        occluders: Corner occlusion, 0 to 3; 0 for models without ambient occlusion.
        shade: Shade of the face's direction, see ``direction_shade``.
        sun: Cosine of the sun's angle, or 0 if the sun does not shine or is disabled.
        params: ``LightCoefficients``.
    """
    s, b = sky * (1 / 15), block * (1 / 15)
    s = s / (1.0 + params.curve * (1.0 - s))
    b = b / (1.0 + params.block_curve * (1.0 - b))
    m = shade * (1.0 - params.corner * occluders)
    red = m * (params.ambient_r + params.sky_r * s + params.block_r * b) + params.sun_r * sun
    green = m * (params.ambient_g + params.sky_g * s + params.block_g * b) + params.sun_g * sun
    blue = m * (params.ambient_b + params.sky_b * s + params.block_b * b) + params.sun_b * sun
    if params.screen > 0.0:
        most = params.screen
        red, green, blue = min(red, most), min(green, most), min(blue, most)
        red, green, blue = to_linear(red), to_linear(green), to_linear(blue)
    return red, green, blue


@inlined
def direction_shade(nx, ny, nz, cosine, params):
    """Return the shade of a face by its unit normal in block axes, at any orientation.

    ``cosine`` is the cosine of the angle between the ray and the normal, 0 to 1. The camera's own
    light decreases with it if ``params.headlight`` is positive.
    """
    upright = params.shade_up if ny > 0 else params.shade_down
    shade = params.shade_x * nx * nx + upright * ny * ny + params.shade_z * nz * nz
    return shade * (1.0 - params.headlight * (1.0 - cosine))


@inlined
def emission_light(emission, params):
    """Return the minimum grey multiplier of a luminous surface with emission 0 to 15."""
    light = emission * (1 / 15) * params.glow
    return to_linear(light) if params.screen > 0.0 else light


@inlined
def to_linear(value):
    """Return value ** 2.2 for 0 to 1.5 by a fast approximation (error below 0.6 of 255)."""
    value = min(value, MAX_SCREEN)
    square = value * value
    high = (0.61682 - value * 0.14103) * square
    return square * (0.55340 + value * 1.02762 - square * 1.05753 + high * value)
