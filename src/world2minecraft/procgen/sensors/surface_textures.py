"""Procedural surface textures that depend on position: grain, fabric, prints, stone and posters.

All textures are computed from a hash of the position at a resolution of about 2 mm. Photos from
different positions therefore show the same details, which image matching requires. Details finer
than a pixel fade out, as in a lens. Strength 1 has the contrast of real rooms.
"""

from world2minecraft.core.jit import inlined, njit
from world2minecraft.procgen.rooms.materials import Material

WALL = int(Material.WALL)
WOOD_X, WOOD_Y, WOOD_Z = int(Material.WOOD_X), int(Material.WOOD_Y), int(Material.WOOD_Z)
CLOTH, PRINT, RUG = int(Material.CLOTH), int(Material.PRINT), int(Material.RUG)
TILE, PICTURE, LEAF = int(Material.TILE), int(Material.PICTURE), int(Material.LEAF)
TEXT, STONE, VIEW = int(Material.TEXT), int(Material.STONE), int(Material.VIEW)
POSTER_STEP_M = 1.5  # One poster at most on each stretch of wall of this length.
POSTER_SHARE = 0.5
FLOOR_SEED = 40  # Of surfaces without an object; the seeds of objects follow.


@njit
def hash_to_unit(a, b, c, d):
    """Hash four integers to a number from 0 to 1."""
    h = (a * 73856093) ^ (b * 19349663) ^ (c * 83492791) ^ (d * 49979687)
    h = ((h ^ (h >> 15)) * 1274126177) & 0x7FFFFFFF
    h = ((h ^ (h >> 13)) * 1103515245) & 0x7FFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFFF) / 1048575.0


@njit
def noise(x, y, z, wave, foot, seed):
    """Return smooth noise from -1 to 1 at a position.

    Args:
        x: The x coordinate of the position in metres.
        y: The y coordinate of the position in metres.
        z: The z coordinate of the position in metres.
        wave: Wavelength of the noise in metres.
        foot: Side length of the pixel footprint in metres. Details below two footprints fade out.
        seed: An integer seed.
    """
    fade = min(max(wave / (2.0 * foot) - 0.4, 0.0), 1.0)
    if fade <= 0.0:
        return 0.0
    x, y, z = x / wave, y / wave, z / wave
    i, j, k = int(x), int(y), int(z)
    a, b, c = x - i, y - j, z - k
    a, b, c = a * a * (3 - 2 * a), b * b * (3 - 2 * b), c * c * (3 - 2 * c)
    total = 0.0
    for di in range(2):
        for dj in range(2):
            share = (a if di else 1 - a) * (b if dj else 1 - b)
            if share > 0:
                low = hash_to_unit(i + di, j + dj, k, seed)
                total += share * (low + c * (hash_to_unit(i + di, j + dj, k + 1, seed) - low))
    return fade * (2.0 * total - 1.0)


@njit
def tone(material, seed, x, y, z, face, foot):
    """Return the brightness factor of the texture at a position, about 1.

    Args:
        material: The ``Material`` number.
        seed: The number of the object.
        x: The x coordinate of the position in metres.
        y: The y coordinate of the position in metres.
        z: The z coordinate of the position in metres.
        face: The direction of the surface, 0 to 5.
        foot: Side length of the pixel footprint in metres.
    """
    if material == WALL:  # Plaster, rolled and not quite even.
        fine = noise(x, y, z, 0.012, foot, 1) + noise(x, y, z, 0.04, foot, 2)
        return 1 + 0.006 * fine + 0.014 * noise(x, y, z, 0.45, foot, 3)
    if material in (WOOD_X, WOOD_Y, WOOD_Z):
        return _wood(material, seed, x, y, z, face, foot)
    if material in (CLOTH, PRINT):
        return _cloth(material, seed, x, y, z, face, foot)
    if material == RUG:
        return _rug(x, y, z, foot)
    if material == TILE:  # Veins of marble.
        bent = noise(x, y, z, 0.2, foot, 5)
        vein = abs(noise(x + 0.1 * bent, y, z, 0.11, foot, 6))
        return 1 - 0.22 * max(0.0, 0.25 - vein) / 0.25 + 0.05 * noise(x, y, z, 0.02, foot, 7)
    if material == STONE:
        grit = noise(x, y, z, 0.008, foot, 8) + noise(x, y, z, 0.02, foot, 9)
        return 1 + 0.16 * grit
    if material == LEAF:
        return 1 + 0.35 * noise(x, y, z, 0.035, foot, 10) + 0.2 * noise(x, y, z, 0.012, foot, 11)
    if material == PICTURE:
        broad = noise(x, y, z, 0.09, foot, seed) + noise(x, y, z, 0.035, foot, seed + 1)
        return 1 + 0.3 * broad + 0.18 * noise(x, y, z, 0.014, foot, seed + 2)
    if material == TEXT:
        return _text(seed, x, y, z, face, foot)
    if material == VIEW:
        return 1 + 0.06 * noise(x, y, z, 0.14, foot, 12) + 0.05 * noise(x, y, z, 0.04, foot, 13)
    return 1 + 0.008 * noise(x, y, z, 0.03, foot, 14) + 0.016 * noise(x, y, z, 0.25, foot, 15)


@njit
def _wood(material, seed, x, y, z, face, foot):
    """Return the tone of wood with streaks along the grain and rings at knots."""
    if seed == FLOOR_SEED:  # Each row of boards was sawn from another tree.
        seed += 3 * int(y / 0.14)
    axis = material - WOOD_X
    if axis == face // 2:  # The grain does not run out of a face: it runs along another side.
        axis = 2 if axis < 2 else 0
    long_x, long_y, long_z = 9.0 if axis == 0 else 1.0, 9.0 if axis == 1 else 1.0, 1.0
    long_z = 9.0 if axis == 2 else 1.0
    a, b, c = x / long_x, y / long_y, z / long_z
    streaks = 0.09 * noise(a, b, c, 0.006, foot, seed + 1) + 0.1 * noise(a, b, c, 0.018, foot, seed)
    # The numbers of rings per unit of noise: a knot every half metre or so.
    ring = 6.0 * noise(x / 3, y / 3, z / 3, 0.12, foot, seed + 2) + 2.0 * noise(
        a, b, c, 0.05, foot, 4
    )
    ring = abs(ring - int(ring))
    return 1 + streaks - 0.14 * max(0.0, ring - 0.7) / 0.3 + 0.05 * noise(x, y, z, 0.3, foot, 16)


@njit
def _cloth(material, seed, x, y, z, face, foot):
    """Return the tone of fabric with a weave, and with a pattern for prints."""
    weave = noise(x, y, z, 0.004, foot, 17) + noise(x, y, z, 0.01, foot, 18)
    worn = noise(x, y, z, 0.05, foot, 19) + noise(x, y, z, 0.18, foot, 20)
    plain = 1 + 0.07 * weave + 0.035 * worn
    if material == CLOTH:
        return plain
    axis = face // 2
    u, v = (y if axis == 0 else x), (y if axis == 2 else z)
    step = 0.05 + 0.06 * hash_to_unit(seed, 1, 0, 0)
    if foot > step / 2:
        return plain
    kind = int(3 * hash_to_unit(seed, 2, 0, 0))
    i, j = int(u / step), int(v / step)
    a, b = u / step - i - 0.5, v / step - j - 0.5
    if kind == 0:
        marked = a * a + b * b < 0.06 + 0.1 * hash_to_unit(i, j, seed, 3)
    elif kind == 1:
        marked = abs(a) < 0.1 + 0.2 * hash_to_unit(i, seed, 4, 0)
    else:
        marked = abs(a) < 0.12 or abs(b) < 0.08 + 0.1 * hash_to_unit(j, seed, 5, 0)
    return plain * (0.78 if marked else 1.04)


@njit
def _rug(x, y, z, foot):
    """Return the tone of a rug with a pattern of irregular diamonds."""
    step = 0.22
    i, j = int(x / step), int(y / step)
    a, b = abs(x / step - i - 0.5), abs(y / step - j - 0.5)
    ring = a + b
    kind = hash_to_unit(i, j, 6, 0)
    value = 1.0
    if ring < 0.46:
        value = 0.76 if kind < 0.5 else 1.2
    if ring < 0.3:
        value = 1.16 if kind < 0.7 else 0.7
    if ring < 0.05 + 0.1 * kind:
        value = 0.68
    if a > 0.46 or b > 0.46:
        value = 0.86
    pile = noise(x, y, z, 0.006, foot, 21) + noise(x, y, z, 0.016, foot, 22)
    return value * (1 + 0.1 * pile + 0.05 * noise(x, y, z, 0.07, foot, 23))


@njit
def _text(seed, x, y, z, face, foot):
    """Return the tone of rows of dark dashes, as on book spines, labels and screens."""
    axis = face // 2
    u, v = (y if axis == 0 else x), (y if axis == 2 else z)
    block = hash_to_unit(int(u / 0.06), int(v / 0.08), seed, 7)
    value = 0.84 + 0.3 * block
    if block > 0.35 and foot < 0.012:
        row = v / 0.014
        inked = hash_to_unit(int(u / 0.009), int(row), seed, 8) > 0.4
        if inked and row - int(row) < 0.55:
            value *= 0.62 if block < 0.8 else 1.3
    return value * (1 + 0.04 * noise(x, y, z, 0.02, foot, 24))


@njit
def poster(u, v, plane, foot, found):
    """Compute the colour of a poster at a wall position and return whether there is a poster.

    Args:
        u: Position along the wall in metres.
        v: Height above the floor in metres.
        plane: The number of the wall.
        foot: Side length of the pixel footprint in metres.
        found: Output colour, float64 [3], written only if there is a poster.
    """
    cell = int(u / POSTER_STEP_M)
    if hash_to_unit(cell, plane, 9, 0) > POSTER_SHARE:
        return False
    wide, high = (
        0.35 + 0.4 * hash_to_unit(cell, plane, 10, 0),
        0.4 + 0.4 * hash_to_unit(cell, plane, 11, 0),
    )
    a = (
        u
        - cell * POSTER_STEP_M
        - (POSTER_STEP_M - wide) * (0.1 + 0.8 * hash_to_unit(cell, plane, 12, 0))
    )
    b = v - 1.15 - 0.25 * hash_to_unit(cell, plane, 13, 0)
    if not (0 <= a < wide and 0 <= b < high):
        return False
    rim = min(a, wide - a, b, high - b)
    seed = int(1048575 * hash_to_unit(cell, plane, 14, 0))
    if rim < 0.012:
        _paint(found, 0.18 + 0.7 * (hash_to_unit(seed, 14, 0, 0) > 0.6), seed, 0.05)
    elif rim < 0.04:
        _paint(found, 0.92, seed, 0.02)
    elif b < 0.16 and a < 0.7 * wide and foot < 0.012:
        row = b / 0.02
        inked = hash_to_unit(int(a / 0.008), int(row), seed, 15) > 0.35 and row - int(row) < 0.5
        _paint(found, 0.2 if inked else 0.9, seed, 0.03)
    else:
        broad = noise(a + 3, b + 3, 0.5, 0.16, foot, seed)
        field = broad + 0.6 * noise(a + 3, b + 3, 0.5, 0.05, foot, seed + 1)
        step = int((field + 2.0) * 2.2)
        grain = 0.06 * noise(a + 3, b + 3, 0.5, 0.012, foot, 25)
        _paint(found, 0.25 + 0.6 * hash_to_unit(step, seed, 16, 0) + grain, seed * 7 + step, 0.5)
    return True


@inlined
def _paint(found, light, seed, colourful):
    """Write a colour with a lightness from 0 to 1 and a hue that depends on the seed."""
    for n in range(3):
        hue = (hash_to_unit(seed, 17 + n, 0, 0) - 0.5) * colourful
        found[n] = 255.0 * min(max(light + hue, 0.02), 0.98)
