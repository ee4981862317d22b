"""What the tabs are told of an operation: ``Change`` of wire.ts, and the preview of one."""

from typing import Any

import numpy as np

from world2minecraft.core.types import GridCells, Operation
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.sceneforge.array_messages import as_bytes
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.wire import counts_json, object_json

MAX_HELD_RUNS = 20_000  # As JSON 0.5 MB; of more, the page gets the whole volume again.


def change_of(editor: Editor, rev: int, step: str, operation: Operation) -> dict[str, Any]:
    """Return what every tab is told of a step that was just done to the scene.

    Objects are those that changed, and those that gained or lost cells.
    """
    draft = editor.draft
    named = {one.id for one in (*operation.objects_before, *operation.objects_after)}
    owners = np.union1d(operation.before.instance, operation.after.instance).tolist()
    changed = sorted({*named, *owners} & draft.objects.keys())
    return {
        "type": "change",
        "rev": rev,
        "kind": operation.kind,
        "counts_as": operation.counts_as,
        "actor": operation.actor,
        "step": step,
        "cells": held_runs(operation.cells, operation.after, draft.shape),
        "objects": [object_json(draft.objects[n], int(editor.cells_of[n])) for n in changed],
        "gone": sorted(named - draft.objects.keys()),
        "counts": counts_json(draft.counts),
        "undo": editor.undo_kind,
        "redo": editor.redo_kind,
    }


def preview_of(draft: SceneDraft, operation: Operation) -> dict[str, Any]:
    """Return what an operation would do: its cells as they would be, its objects, the gone."""
    counts = np.bincount(operation.after.instance, minlength=1)
    after = [
        object_json(one, counts[one.id] if one.id < len(counts) else 0)
        for one in operation.objects_after
    ]
    held = {one.id for one in operation.objects_after}
    return {
        "kind": operation.kind,
        "counts_as": operation.counts_as,
        "cells": held_runs(operation.cells, operation.after, draft.shape),
        "objects": after,
        "gone": sorted({one.id for one in operation.objects_before} - held),
    }


def held_runs(
    cells: np.ndarray, held: GridCells, shape: tuple[int, int, int]
) -> list[list[int]] | None:
    """Return what cells int [N, 3] hold as [first, length, label, instance, confidence].

    Confidence is 0 to 255. None where there would be more than ``MAX_HELD_RUNS``.
    """
    if not len(cells):
        return []
    flat = np.ravel_multi_index(tuple(cells.T), shape)
    order = np.argsort(flat, kind="stable")
    columns = (flat, held.labels, held.instance, as_bytes(held.confidence))
    rows = np.column_stack([np.asarray(one, np.int64)[order] for one in columns])
    breaks = np.ones(len(rows), bool)
    breaks[1:] = (np.diff(rows[:, 0]) != 1) | (rows[1:, 1:] != rows[:-1, 1:]).any(axis=1)
    first = np.flatnonzero(breaks)
    if len(first) > MAX_HELD_RUNS:
        return None
    lengths = np.diff(first, append=len(rows))
    return np.column_stack([rows[first, 0], lengths, rows[first, 1:]]).tolist()
