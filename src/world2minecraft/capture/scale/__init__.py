"""The metric scale of a capture whose unit nobody knows, as photos give it.

``collect_unscaled`` gathers the surface, ``estimate_scale`` finds the factor to metres from the
habits of rooms and people, or from lengths that the user knows: ``parse_known`` takes one by its
name, ``KnownPoints`` by two pixels.
"""

from world2minecraft.capture.scale.estimate import ScaleEstimate, estimate_scale
from world2minecraft.capture.scale.known_lengths import (
    Known,
    KnownPoints,
    length_between,
    parse_known,
)
from world2minecraft.capture.scale.measurements import collect_unscaled, resized

__all__ = [
    "Known",
    "KnownPoints",
    "ScaleEstimate",
    "collect_unscaled",
    "estimate_scale",
    "length_between",
    "parse_known",
    "resized",
]
