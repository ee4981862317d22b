"""Commands: the edits that a person, a script or a model requests, planned as ``Operation``.

A command is a small checked value that says what is wanted. ``plan`` looks at the scene and
returns what that means for each cell and object, or raises ``UsageError`` with what to do.
Their JSON form is the local API of SceneForge; its TypeScript types are made from these classes.
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
    """Stand for a tool that was not given: raise ``UsageError``."""
    raise UsageError("this edit needs a stage that is not at hand; open the scene with Editor")


class Tools(NamedTuple):
    """What commands need of the stages, which edits do not know.

    ``match`` returns the furniture that stands for an object in a grid; ``find`` the instance of
    each cell and the objects, by the parameters given (``InstanceParameters``). ``fit`` returns one
    template in an object's place, in the turn given or the best, whatever is there. ``measure``
    returns the object of an id and a class that cells int32 [N, 3] are: its box and its front.
    """

    match: Callable[[OccupancyGrid, ObjectInstance], tuple[Placement, ...]]
    find: Callable[[OccupancyGrid, dict[str, Any]], tuple[np.ndarray, tuple[ObjectInstance, ...]]]
    fit: Callable[[OccupancyGrid, ObjectInstance, str, int | None], Placement] = unavailable_tool
    measure: Callable[[OccupancyGrid, int, int, np.ndarray], ObjectInstance] = unavailable_tool


class Command(BaseModel):
    """What all commands share; each adds ``op``, a literal that names it."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @abstractmethod
    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return what this does to a scene.

        Raises:
            UsageError: it cannot be done to this scene; the message says why.
        """
