"""Entities as NBT."""

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.core.types import Entity
from world2minecraft.minecraft.nbt import Float


def entity_nbt(entity: Entity, number: int) -> dict[str, Any]:
    """Return an entity's tags; its UUID comes from its number, so that no two are the same."""
    digest = hashlib.sha256(f"{number} {entity.id} {entity.position}".encode()).digest()
    common = {
        "Motion": [0.0, 0.0, 0.0],
        "Rotation": [Float(0), Float(0)],
        "UUID": np.frombuffer(digest[:16], ">i4").astype(np.int32),
    }
    return {**common, **entity.nbt, "id": entity.id, "Pos": [float(v) for v in entity.position]}


def entity_tags(nbt: Mapping[str, Any]) -> list[str]:
    """Return the tags by which commands know an entity; none where a file has other things there.

    Example:
        >>> entity_tags({"Tags": ["chair", 7]}), entity_tags({"Tags": 7})
        (['chair', '7'], [])
    """
    tags = nbt.get("Tags")
    return [str(tag) for tag in tags] if isinstance(tags, list | tuple) else []
