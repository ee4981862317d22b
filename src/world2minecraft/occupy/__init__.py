"""Stage 2: a scan becomes evidence, one item a view.

A predictor is any callable object with ``predict(scan)``; the built-in ones are in
``PREDICTORS``, others join through the entry point group ``world2minecraft.predictor``.
"""

from collections.abc import Iterator
from typing import Protocol

from world2minecraft.registry import Registry
from world2minecraft.types import GridEvidence, PointEvidence, Scan

PREDICTORS = Registry("predictor", {"depth": "world2minecraft.occupy.depth:DepthPredictor"})


class Predictor(Protocol):
    """Turns a scan into evidence, streamed: no two views need lie in memory together."""

    def predict(self, scan: Scan) -> Iterator[PointEvidence | GridEvidence]:
        """Yield one item a view, in the scan's frame and order."""
        ...


def predictor(name: str) -> Predictor:
    """Return a new predictor by name.

    Raises:
        UnknownNameError: none has this name; the message suggests the nearest.
    """
    return PREDICTORS.load(name)()
