"""Metric scale of captures without a unit, such as photos.

``collect_unscaled`` collects the surface. ``estimate_scale`` estimates the factor to metres from
typical sizes in rooms or from lengths known to the user. ``parse_known_length`` parses a named
length, and ``KnownDistance`` is a length between two pixels.
"""

from world2minecraft.capture.scale.estimate import ScaleEstimate, estimate_scale
from world2minecraft.capture.scale.known_lengths import (
    KnownDistance,
    KnownLength,
    length_between,
    parse_known_length,
)
from world2minecraft.capture.scale.measurements import collect_unscaled, scale_points

__all__ = [
    "KnownDistance",
    "KnownLength",
    "ScaleEstimate",
    "collect_unscaled",
    "estimate_scale",
    "length_between",
    "parse_known_length",
    "scale_points",
]
