"""The boxes that many templates share. All lengths are metres in the template's frame."""

import numpy as np

from world2minecraft.furniture.template import Part


def part(role: str, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Part:
    """Return the box between two positions along each axis."""
    return Part(np.array((x[0], y[0], z[0], x[1], y[1], z[1])), role)


def slab(role: str, depth: float, width: float, bottom: float, top: float) -> Part:
    """Return a box over the whole footprint."""
    return part(role, (-depth / 2, depth / 2), (-width / 2, width / 2), (bottom, top))


def legs(depth: float, width: float, height: float, thickness: float) -> list[Part]:
    """Return four legs under the corners of the footprint."""
    x, y = depth / 2, width / 2
    thin = min(thickness, x, y)
    return [
        part("leg", along, across, (0.0, height))
        for along in ((-x, thin - x), (x - thin, x))
        for across in ((-y, thin - y), (y - thin, y))
    ]


def backrest(depth: float, width: float, bottom: float, top: float, thickness: float) -> Part:
    """Return an upright panel at the back of the footprint (x is smallest)."""
    x = -depth / 2
    return part("back", (x, x + min(thickness, depth)), (-width / 2, width / 2), (bottom, top))


def arms(depth: float, width: float, bottom: float, top: float, thickness: float) -> list[Part]:
    """Return an armrest at each side."""
    y, thin = width / 2, min(thickness, width / 3)
    along = (-depth / 2, depth / 2)
    return [
        part("arm", along, (-y, thin - y), (bottom, top)),
        part("arm", along, (y - thin, y), (bottom, top)),
    ]


def column(role: str, side: float, bottom: float, top: float) -> Part:
    """Return a square post in the middle of the footprint."""
    return slab(role, side, side, bottom, top)
