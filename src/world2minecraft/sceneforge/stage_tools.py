"""The stages that commands may ask for, wired to a scene."""

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
)


def tools_of(rooms: Sequence[Layout] = ()) -> Tools:
    """Return the tools for a scene whose furniture stays within ``rooms``, where any are given."""

    def match(grid: OccupancyGrid, one: ObjectInstance) -> tuple[Placement, ...]:
        return place_templates(grid, (one,), RetrievalParameters(), rooms)

    def fit(grid: OccupancyGrid, one: ObjectInstance, name: str, turns: int | None) -> Placement:
        return fit_template(grid, one, name, turns, rooms)

    return Tools(match, find_instances, fit, measure_object)


def find_instances(
    grid: OccupancyGrid, parameters: dict[str, Any]
) -> tuple[np.ndarray, tuple[ObjectInstance, ...]]:
    """Return the instance ids uint16 [X, Y, Z] and the objects that ``find`` finds.

    Raises:
        UnknownNameError: ``find`` has no such parameter. UsageError: one is out of its range.
    """
    known = InstanceParameters.__dataclass_fields__
    for name in parameters:
        if name not in known:
            raise UnknownNameError("parameter of find", name, known)
    result = find_objects(grid, InstanceParameters(**parameters))
    return result.grid.instance, result.instances
