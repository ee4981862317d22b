"""Questions about a scene, by name: what ``Editor.ask`` and ``POST /api/ask`` answer.

Like a command, a query is a small checked value; it changes nothing. A new one is a class and
its line in ``QUERIES``.
"""

from typing import Any

from pydantic import ValidationError

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.editing.scene.command_registry import first_fault
from world2minecraft.sceneforge.cell_queries import CELL_QUERIES
from world2minecraft.sceneforge.object_queries import OBJECT_QUERIES
from world2minecraft.sceneforge.query import QueriedScene, Query


class Counts(Query):
    """How many cells each class has, and how many objects there are."""

    def answer(self, scene: QueriedScene) -> Any:
        """Return ``{"cells": by class id, "objects": number}``."""
        counts = scene.draft.counts[:12].tolist()
        return {"cells": counts, "objects": len(scene.draft.objects)}


QUERIES: dict[str, type[Query]] = {"counts": Counts, **CELL_QUERIES, **OBJECT_QUERIES}


def parse_query(name: str, fields: dict[str, Any]) -> Query:
    """Return the query of a name.

    Raises:
        UnknownNameError: there is none. UsageError: a field is wrong; the message names it.
    """
    if name not in QUERIES:
        raise UnknownNameError("query", name, QUERIES)
    try:
        return QUERIES[name].model_validate(fields)
    except ValidationError as error:
        raise UsageError(first_fault(name, error)) from error
