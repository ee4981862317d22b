"""What a piece of furniture is before it stands anywhere: a parametric shape with a named front.

A template's frame: origin in the middle of its footprint, z = 0 at its bottom, its front looks to
+x. Sizes are in the order of ``Placement.size_m``: front-to-back (x), side (y), height (z).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from world2minecraft.classes import OBJECT_CLASSES
from world2minecraft.errors import UsageError
from world2minecraft.types import checks

STALE = "; placements.json of another version is made anew by --from furnish"


class ParameterError(UsageError, ValueError):
    """A template has no such parameter, or not with such a value."""


class Span(NamedTuple):
    """The smallest, the usual and the largest value of a size in metres or of a parameter."""

    minimum: float
    typical: float
    maximum: float

    def clip(self, value: float) -> float:
        """Return the value of the span that is nearest to ``value``."""
        return min(max(value, self.minimum), self.maximum)


class Part(NamedTuple):
    """One box of a template: x0 y0 z0 x1 y1 z1 in metres, and what it is, such as ``seat``."""

    box_m: np.ndarray  # float64 [6]
    role: str


class LocalBlock(NamedTuple):
    """One block of a design that looks east: cell (front-to-back, side, up), state and role."""

    cell: tuple[int, int, int]
    state: str
    role: str


class BlockSize(NamedTuple):
    """A template's size in blocks: whole blocks that a design fills, and the exact size."""

    depth: int
    width: int
    height: int
    exact: tuple[float, float, float]


Parameters = Mapping[str, float]
Build = Callable[[float, float, float, Parameters], list[Part]]
Design = Callable[[BlockSize, Parameters], list[LocalBlock]]


@dataclass(frozen=True, eq=False)
class Template:
    """A parametric piece of furniture.

    name: as in ``Placement.template``.
    class_id: its object class, 5 to 11.
    size_m: how deep, wide and high such furniture is; a match looks no further.
    build: parts of a given depth, width, height and parameters.
    design: its vanilla blocks for scales where parts would crumble.
    parameters: the names that ``build`` knows.
    turns: how many quarter turns give different shapes: 4, 2 (its half turn is itself), or 1.
    mount: ``floor`` (stands on the floor), ``wall`` (hangs on one) or ``any``.
    """

    name: str
    class_id: int
    size_m: tuple[Span, Span, Span]
    build: Build
    design: Design
    parameters: Mapping[str, Span] = field(default_factory=dict)
    turns: Literal[1, 2, 4] = 4
    mount: Literal["floor", "wall", "any"] = "floor"

    def __post_init__(self):
        checks.identifier("name", self.name)
        if self.class_id not in OBJECT_CLASSES:
            raise ValueError(f"class_id must be an object class, 5 to 11, not {self.class_id}")
        for span in (*self.size_m, *self.parameters.values()):
            if not span.minimum <= span.typical <= span.maximum:
                raise ValueError(f"a span must rise from minimum to maximum, not {tuple(span)}")
        sorted_parameters = dict(sorted(self.parameters.items()))
        object.__setattr__(self, "parameters", MappingProxyType(sorted_parameters))

    @property
    def typical_m(self) -> tuple[float, float, float]:
        """The usual size."""
        depth, width, height = (span.typical for span in self.size_m)
        return depth, width, height

    def complete(self, parameters: Parameters | None = None) -> dict[str, float]:
        """Return every parameter of the template, the usual value where none is given.

        Raises:
            ParameterError: a name is unknown, or a value lies outside its span, as in the
                placements of another version; it is a ValueError too.
        """
        given = dict(parameters or {})
        for name, value in given.items():
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise ParameterError(
                    f"{self.name} has no parameter {name!r}; it has: {known}{STALE}"
                )
            span = self.parameters[name]
            if not span.minimum - 1e-6 <= value <= span.maximum + 1e-6:
                raise ParameterError(
                    f"{name} of {self.name} must lie between {span.minimum:g} and "
                    f"{span.maximum:g}, not {value:g}{STALE}"
                )
        return {
            name: float(given.get(name, self.parameters[name].typical)) for name in self.parameters
        }

    def parts(self, size_m: np.ndarray, parameters: Parameters | None = None) -> tuple[Part, ...]:
        """Return the boxes of a template of any size, in its own frame.

        Args:
            size_m: depth, width and height in metres, each above 0.
            parameters: some of the template's parameters; the others are usual.

        Raises:
            ValueError: a size is not above 0. ParameterError: ``complete`` refuses a parameter.
        """
        depth, width, height = (checks.positive("size_m", float(side)) for side in size_m)
        return tuple(self.build(depth, width, height, self.complete(parameters)))
