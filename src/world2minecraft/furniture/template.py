"""Templates: parametric pieces of furniture with a defined front.

The origin of a template's frame is the centre of its footprint, z = 0 is its bottom, and its front
faces +x. Sizes are in the order of ``Placement.size_m``: front-to-back (x), side (y), height (z).
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
    """A parameter is not defined in a template, or its value is out of range."""


class Span(NamedTuple):
    """The minimum, typical and maximum value of a size in metres or of a parameter."""

    minimum: float
    typical: float
    maximum: float

    def clip(self, value: float) -> float:
        """Return ``value`` clipped to the range."""
        return min(max(value, self.minimum), self.maximum)


class Part(NamedTuple):
    """A box of a template: x0 y0 z0 x1 y1 z1 in metres, with its role, such as ``seat``."""

    box_m: np.ndarray  # float64 [6]
    role: str


class LocalBlock(NamedTuple):
    """A block of a design that faces east: cell (front-to-back, side, up), state and role."""

    cell: tuple[int, int, int]
    state: str
    role: str


class BlockSize(NamedTuple):
    """A template's size in blocks: the whole blocks of a design, the exact size and the scale."""

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

    name: Name, as in ``Placement.template``.
    class_id: Object class, 5 to 11.
    size_m: Ranges of depth, width and height in metres, which limit matching.
    build: Function from a depth, width, height and look to parts.
    design: Function that returns vanilla blocks, or none if the parts should be built instead.
    parameters: Ranges of the parameters of ``build``.
    turns: Number of quarter turns with different shapes: 4, 2 (symmetric under a half turn) or 1.
    mount: ``floor``, ``wall``, ``ceiling`` or ``any``.
    title: Display name. The default is the name in words.
    family: Name shared by templates of the same shape, which can replace each other.
    materials: Material of each role. Without materials, blocks are recoloured by their names.
    options: Values of the options of its family.
    clearance_m: Free space required in front, behind and at each side, in metres.
    matched: Whether objects are matched against this template. Others are chosen after the match.
    suits: sRGB colours of objects for which this design is preferred within its family. Empty for
    all colours.
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
        """The typical size in metres."""
        depth, width, height = (span.typical for span in self.size_m)
        return depth, width, height

    def complete(self, parameters: Parameters | None = None) -> dict[str, float]:
        """Return the values of all parameters, with typical values for those that are not given.

        Raises:
            ParameterError: If a name is unknown or a value is out of range, as may happen with
                placements of another version. It is also a ValueError.
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
        """Return the boxes of a template of a given size, in its own frame.

        Args:
            size_m: Depth, width and height in metres, each above 0.
            parameters: Values for some of the template's parameters. The others have typical
                values.

        Raises:
            ValueError: If a size is not above 0.
            ParameterError: If ``complete`` rejects a parameter.
        """
        depth, width, height = (checks.positive("size_m", float(side)) for side in size_m)
        return tuple(self.build(depth, width, height, self.look(parameters)))

    def look(self, parameters: Parameters | None = None) -> Look:
        """Return the look for ``build`` and ``design``: parameters, options and materials.

        Raises:
            ParameterError: If ``complete`` rejects a parameter.
        """
        return Look(self.name, self.complete(parameters), self.options, self.materials)

    def blocks(self, size: BlockSize, parameters: Parameters | None = None) -> list[LocalBlock]:
        """Return the vanilla blocks for a size, or none if the parts should be built instead.

        Raises:
            ParameterError: If ``complete`` rejects a parameter.
        """
        return list(self.design(size, self.look(parameters)))
