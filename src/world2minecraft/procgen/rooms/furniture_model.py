"""Furniture models made of coloured boxes in metres.

The origin of a model is the middle of its footprint, at its bottom. Its front faces +x. Sizes are
multiples of 2 cm, so that boxes align with voxels.
"""

from dataclasses import dataclass, replace
from typing import Literal

Colour = tuple[int, int, int]
Grain = Literal["plain", "wood", "fabric", "glow"]
STEP_M = 0.02


@dataclass(frozen=True)
class Part:
    """A coloured box, ball or drum of a model.

    ``box_m`` is x0, y0, z0, x1, y1, z1, and ``grain`` is the kind of colour variation. A ``ball``
    is the ellipsoid inside the box, and a ``drum`` is the cylinder along ``axis`` inside the box.
    """

    box_m: tuple[float, float, float, float, float, float]
    colour: Colour
    grain: Grain = "plain"
    form: Literal["box", "ball", "drum"] = "box"
    axis: int = 2


@dataclass(frozen=True)
class Bar:
    """A round bar between two points, such as a slanted leg or a frame tube."""

    start_m: tuple[float, float, float]
    end_m: tuple[float, float, float]
    radius_m: float
    colour: Colour
    grain: Grain = "plain"

    @property
    def box_m(self) -> tuple[float, float, float, float, float, float]:
        """The bounding box of the bar."""
        low = tuple(min(p) - self.radius_m for p in zip(self.start_m, self.end_m, strict=True))
        high = tuple(max(p) + self.radius_m for p in zip(self.start_m, self.end_m, strict=True))
        return low[0], low[1], low[2], high[0], high[1], high[2]


@dataclass(frozen=True)
class Model:
    """A named furniture model. ``size_m`` is the depth, width and height around all parts."""

    name: str
    class_id: int
    size_m: tuple[float, float, float]
    parts: tuple[Part | Bar, ...]


def translate_part(part: Part | Bar, shift: tuple[float, ...]) -> Part | Bar:
    """Return a part that is moved by ``shift`` (x, y, z in metres) in the frame of its model."""

    def put(point: tuple[float, ...]) -> tuple[float, float, float]:
        x, y, z = (value + off for value, off in zip(point, shift, strict=True))
        return x, y, z

    if isinstance(part, Bar):
        return replace(part, start_m=put(part.start_m), end_m=put(part.end_m))
    return replace(part, box_m=(*put(part.box_m[:3]), *put(part.box_m[3:])))


def round_to_step(length_m: float) -> float:
    """Round a length to a multiple of 2 cm."""
    return round(length_m / STEP_M) * STEP_M


def shade(colour: Colour, factor: float) -> Colour:
    """Multiply the brightness of a colour by a factor."""
    red, green, blue = (max(0, min(255, round(value * factor))) for value in colour)
    return red, green, blue


def legs(depth: float, width: float, height: float, side: float, colour: Colour) -> list[Part]:
    """Return the box parts of four furniture legs at the corners of a footprint."""
    spots = []
    for x in (-depth / 2, depth / 2 - side):
        for y in (-width / 2, width / 2 - side):
            spots.append(Part((x, y, 0, x + side, y + side, height), colour, "wood"))
    return spots
