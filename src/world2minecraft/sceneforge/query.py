"""What all questions about a scene share; ``queries`` has them by name."""

from abc import abstractmethod
from typing import Any, Protocol

from pydantic import BaseModel, ConfigDict

from world2minecraft.core.progress import Progress
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.sceneforge.sources import Opened


class QueriedScene(Protocol):
    """What a question may look at: an open editor has all of it."""

    progress: Progress

    @property
    def draft(self) -> SceneDraft:
        """The scene as it is now."""
        ...

    @property
    def opened(self) -> Opened:
        """The scene as it was opened first."""
        ...


class Query(BaseModel):
    """A small checked value, as a command is; it changes nothing."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @abstractmethod
    def answer(self, scene: QueriedScene) -> Any:
        """Return the answer as JSON values.

        Raises:
            UsageError: it cannot be answered for this scene; the message says why.
        """
