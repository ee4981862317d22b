"""The JSON messages that describe a scene to the page, with the types of ``web/src/wire.ts``."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COLOURS, CLASS_COUNT, CLASS_NAMES
from world2minecraft.core.types import Placement, SceneObject
from world2minecraft.core.vocabulary import object_title

PROTOCOL = 1


def classes_json() -> list[dict[str, Any]]:
    """Return the twelve classes with their colours, as ``ClassInfo`` objects."""
    rows = zip(CLASS_NAMES, CLASS_COLOURS, strict=True)
    return [
        {"id": number, "name": name, "colour": list(colour)}
        for number, (name, colour) in enumerate(rows)
    ]


def counts_json(counts: np.ndarray) -> list[int]:
    """Return the number of cells of each class. ``counts`` int [256] is indexed by label."""
    return counts[:CLASS_COUNT].tolist()


def object_json(one: SceneObject, cells: int) -> dict[str, Any]:
    """Return an object with the number of its cells, as a ``SceneObject``."""
    return {
        "id": one.id,
        "class_id": one.class_id,
        "name": one.name,
        "name_confidence": float(one.name_confidence),
        "title": object_title(one.name, one.class_id),
        "center_m": _metres(one.center_m),
        "size_m": _metres(one.size_m),
        "yaw_deg": float(one.yaw_deg),
        "confidence": float(one.confidence),
        "cells": int(cells),
        "placements": [placed_json(placed) for placed in one.placements],
    }


def placed_json(placed: Placement) -> dict[str, Any]:
    """Return a piece of placed furniture, as a ``Placed`` object."""
    return {
        "template": placed.template,
        "center_m": _metres(placed.center_m),
        "size_m": _metres(placed.size_m),
        "quarter_turns": int(placed.quarter_turns),
        "iou": float(placed.iou),
        "parameters": {name: float(value) for name, value in placed.parameters.items()},
        "alternatives": [
            {"template": a.template, "quarter_turns": int(a.quarter_turns), "iou": float(a.iou)}
            for a in placed.alternatives
        ],
    }


def objects_json(objects: Mapping[int, SceneObject], owned: np.ndarray) -> list[dict[str, Any]]:
    """Return all objects by id. ``owned`` int [65536] is the number of cells of each id."""
    return [object_json(objects[number], owned[number]) for number in sorted(objects)]


def _metres(values: np.ndarray) -> list[float]:
    return [float(value) for value in values]
