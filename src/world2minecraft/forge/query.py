"""What all questions about a scene share; ``queries`` has them by name."""

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict

if TYPE_CHECKING:
    from world2minecraft.forge.editor import Editor


class Query(BaseModel):
    """A small checked value, as a command is; it changes nothing."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @abstractmethod
    def answer(self, editor: "Editor") -> Any:
        """Return the answer as JSON values.

        Raises:
            UsageError: it cannot be answered for this scene; the message says why.
        """
