"""Commands: edits requested by a person, a script or a model, planned as ``Operation``.

A command is a small validated value that describes an edit. ``plan`` returns the resulting change
of cells and objects, or raises ``UsageError`` with advice. The JSON form of commands is the local
API of SceneForge, and its TypeScript types are generated from these classes.
"""

from abc import abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import ObjectInstance, OccupancyGrid, Operation, Placement
from world2minecraft.editing.scene.scene_draft import SceneDraft

MAX_RUNS = 200_000


def unavailable_tool(*_given: Any) -> Any:
    """Raise ``UsageError`` in place of a tool that was not provided."""
    raise UsageError("this edit requires a reconstruction stage; open the scene with Editor")


def keep_fit(
    _grid: OccupancyGrid, _one: ObjectInstance, placements: tuple[Placement, ...]
) -> tuple[Placement, ...]:
    """Return placements as they are, in place of a tool that was not provided."""
    return placements


class Tools(NamedTuple):
    """Functions of the reconstruction stages that commands use.

    ``match`` returns the furniture for an object in a grid. ``find`` returns the object id of each
    cell and the objects, for given ``InstanceParameters``. ``fit`` returns one template fitted to
    an object, with a given or the best rotation, regardless of its surroundings. ``measure``
    returns the object with an id and a class that consists of cells int32 [N, 3], with its bounding
    box and front. ``score`` returns the furniture of an object with its IoU where it stands now.
    """

    match: Callable[[OccupancyGrid, ObjectInstance], tuple[Placement, ...]]
    find: Callable[[OccupancyGrid, dict[str, Any]], tuple[np.ndarray, tuple[ObjectInstance, ...]]]
    fit: Callable[[OccupancyGrid, ObjectInstance, str, int | None], Placement] = unavailable_tool
    measure: Callable[[OccupancyGrid, int, int, np.ndarray], ObjectInstance] = unavailable_tool
    score: Callable[
        [OccupancyGrid, ObjectInstance, tuple[Placement, ...]], tuple[Placement, ...]
    ] = keep_fit


class Command(BaseModel):
    """Base class of all commands. Each subclass adds ``op``, a literal with its name."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @abstractmethod
    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation that this command performs on a scene.

        Raises:
            UsageError: If the command cannot be applied to this scene. The message states the
                reason.
        """
