"""The pipeline stages that editing commands use, bound to a scene."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import Layout, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.editing.scene import Tools
from world2minecraft.reconstruction.instances import (
    InstanceParameters,
    find_objects,
    measure_object,
)
from world2minecraft.reconstruction.retrieval import (
    RetrievalParameters,
    fit_template,
    place_templates,
    score_placements,
)


def tools_of(rooms: Sequence[Layout] = ()) -> Tools:
    """Return the stage tools for a scene. Furniture stays within ``rooms`` if any are given."""

    def match(grid: OccupancyGrid, one: ObjectInstance) -> tuple[Placement, ...]:
        return place_templates(grid, (one,), RetrievalParameters(), rooms)

    def fit(grid: OccupancyGrid, one: ObjectInstance, name: str, turns: int | None) -> Placement:
        return fit_template(grid, one, name, turns, rooms)

    return Tools(match, find_instances, fit, measure_object, score_placements)


def find_instances(
    grid: OccupancyGrid, parameters: dict[str, Any]
) -> tuple[np.ndarray, tuple[ObjectInstance, ...]]:
    """Detect objects, and return their instance ids uint16 [X, Y, Z] and the objects.

    Raises:
        UnknownNameError: If ``find`` contains an unknown parameter.
        UsageError: If a parameter is out of range.
    """
    known = InstanceParameters.__dataclass_fields__
    for name in parameters:
        if name not in known:
            raise UnknownNameError("find parameter", name, known)
    result = find_objects(grid, InstanceParameters(**parameters))
    return result.grid.instance, result.instances
