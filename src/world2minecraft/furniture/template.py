"""Templates: parametric pieces of furniture with a named front.

A template's frame: origin in the middle of its footprint, z = 0 at its bottom, its front looks to
+x. Sizes are in the order of ``Placement.size_m``: front-to-back (x), side (y), height (z).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import checks
from world2minecraft.furniture.materials import Material
from world2minecraft.furniture.template_parameters import Look

Mount = Literal["floor", "wall", "ceiling", "any"]
STALE = "; recreate an outdated placements.json with --from furnish"


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
    """A template's size in blocks: whole blocks that a design fills, the exact size, the scale."""

    depth: int
    width: int
    height: int
    exact: tuple[float, float, float]
    per_metre: float = 1.0


Parameters = Mapping[str, float]
Build = Callable[[float, float, float, Look], list[Part]]
Design = Callable[[BlockSize, Look], Sequence[LocalBlock]]


@dataclass(frozen=True, eq=False)
class Template:
    """A parametric piece of furniture.

    name: as in ``Placement.template``.
    class_id: its object class, 5 to 11.
    size_m: how deep, wide and high such furniture is; a match looks no further.
    build: parts of a given depth, width, height and look.
    design: its vanilla blocks; none where its parts are to be built instead.
    parameters: the names that ``build`` knows.
    turns: how many quarter turns give different shapes: 4, 2 (its half turn is itself), or 1.
    mount: ``floor`` (stands on the floor), ``wall`` (hangs on one), ``ceiling`` (hangs from it)
        or ``any``.
    title: what people call it; the name in words where none is given.
    family: which templates are of one shape, so that one may stand for another.
    materials: what each role is made of; without any, blocks are recoloured by their names.
    options: the choices that its family offers, as this template makes them.
    clearance_m: the room that it needs before its front, behind it and at each side.
    matched: whether objects are matched against it; others are chosen after the match.
    suits: the colours, sRGB, of things that rather are of this design than of another of its
        family; empty suits all.
    """

    name: str
    class_id: int
    size_m: tuple[Span, Span, Span]
    build: Build
    design: Design
    parameters: Mapping[str, Span] = field(default_factory=dict)
    turns: Literal[1, 2, 4] = 4
    mount: Mount = "floor"
    title: str = ""
    family: str = ""
    materials: Mapping[str, Material] = field(default_factory=dict)
    options: Mapping[str, str] = field(default_factory=dict)
    clearance_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    matched: bool = True
    suits: tuple[tuple[int, int, int], ...] = ()

    def __post_init__(self):
        checks.identifier("name", self.name)
        put = object.__setattr__
        put(self, "title", self.title or self.name.replace("_", " "))
        put(self, "family", self.family or self.name)
        put(self, "materials", MappingProxyType(dict(self.materials)))
        put(self, "options", MappingProxyType(dict(self.options)))
        if self.class_id not in OBJECT_CLASSES:
            raise ValueError(f"class_id must be an object class from 5 to 11, got {self.class_id}")
        for span in (*self.size_m, *self.parameters.values()):
            if not span.minimum <= span.typical <= span.maximum:
                raise ValueError(f"a span must increase from minimum to maximum, got {tuple(span)}")
        sorted_parameters = dict(sorted(self.parameters.items()))
        put(self, "parameters", MappingProxyType(sorted_parameters))

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
                    f"template {self.name} has no parameter {name!r}; parameters: {known}{STALE}"
                )
            span = self.parameters[name]
            if not span.minimum - 1e-6 <= value <= span.maximum + 1e-6:
                raise ParameterError(
                    f"{name} of template {self.name} must be between {span.minimum:g} and "
                    f"{span.maximum:g}, got {value:g}{STALE}"
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
        return tuple(self.build(depth, width, height, self.look(parameters)))

    def look(self, parameters: Parameters | None = None) -> Look:
        """Return what its build and its design go by: parameters, options and materials.

        Raises:
            ParameterError: ``complete`` refuses a parameter.
        """
        return Look(self.name, self.complete(parameters), self.options, self.materials)

    def blocks(self, size: BlockSize, parameters: Parameters | None = None) -> list[LocalBlock]:
        """Return its vanilla blocks at a size; none where its parts are to be built instead.

        Raises:
            ParameterError: ``complete`` refuses a parameter.
        """
        return list(self.design(size, self.look(parameters)))
