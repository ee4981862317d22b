"""What a person, a script or a model asks for; a plan of it is an ``Operation``.

A command is a small checked value that says what is wanted. ``plan`` looks at the scene and
returns what that means for each cell and object, or raises ``UsageError`` with what to do.
Their JSON form is the local API of SceneForge; its TypeScript types are made from these classes.
"""

from abc import abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict

from world2minecraft.edit.scene.draft import SceneDraft
from world2minecraft.types import ObjectInstance, OccupancyGrid, Operation, Placement

MAX_RUNS = 200_000


class Tools(NamedTuple):
    """What commands need of the stages, which edits do not know.

    ``match`` returns the furniture that stands for an object in a grid; ``find`` the grid with
    its instances and the objects, by the parameters given.
    """

    match: Callable[[OccupancyGrid, ObjectInstance], tuple[Placement, ...]]
    find: Callable[[OccupancyGrid, dict[str, Any]], tuple[np.ndarray, tuple[ObjectInstance, ...]]]


class Command(BaseModel):
    """What all commands share; each adds ``op``, a literal that names it."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @abstractmethod
    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return what this does to a scene.

        Raises:
            UsageError: it cannot be done to this scene; the message says why.
        """
