"""The metric scale of a capture whose unit is unknown, as photos give it.

``collect_unscaled`` gathers the surface, ``estimate_scale`` finds the factor to metres from usual
sizes in rooms, or from lengths that the user knows: ``parse_known_length`` takes one by its name,
``KnownDistance`` by two pixels.
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
