"""Make the test vectors that the page and the program share, ``tests/sceneforge/vectors/*.json``.

Run by hand when their meaning changes; a test holds the committed files to this script::

    python tools/make_edit_vectors.py

=================  ==========================================================================
``runs.json``      cells, their flat numbers and their runs; runs that are refused
``box.json``       two corners and the runs of the box between them, cut at the grid's sides
``flood.json``     labels, a first cell, and the runs of what holds to it by faces
``changes.json``   a scene, a command, the ``cells`` of its Change when done and undone, the
                   scene then
=================  ==========================================================================

Volumes are lists in C order, cell (x, y, z) at (x * Y + y) * Z + z; confidence is 0 to 255.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid, SceneObject
from world2minecraft.editing.scene import SceneDraft, Tools, parse_command, runs_of_cells
from world2minecraft.editing.scene.cell_patch import box_cells, cells_of_runs
from world2minecraft.editing.scene.object_conversion import connected_component

TARGET = Path(__file__).parents[1] / "tests" / "sceneforge" / "vectors"
SHAPES = ((1, 1, 1), (4, 3, 2), (2, 5, 3), (1, 7, 1))
REFUSED = ([[0, 0]], [[-1, 2]], [[20, 5]], [[0, 3], [2, 2]], [[0, 1, 2]])
COMMANDS: tuple[dict[str, Any], ...] = (
    {"op": "set_cells", "cells": [[0, 7]], "class_id": 3},
    {"op": "set_cells", "cells": [[3, 2], [30, 9]], "class_id": 0, "verb": "erase"},
    {"op": "set_cells", "cells": [[10, 30]], "class_id": 5, "locked": [3]},
    {"op": "set_cells", "cells": [[0, 60]], "class_id": 8},
    {"op": "fill_box", "low": [1, 1, 1], "high": [2, 2, 2], "class_id": 2},
    {"op": "fill_box", "low": [3, 3, 4], "high": [0, 0, 0], "class_id": 0},
    {"op": "delete_class", "class_id": 5},
    {"op": "relabel_class", "from_id": 3, "to_id": 2},
    {"op": "paste", "cells": [[0, 20]], "by": [1, 0, 0], "mirror": "z"},
)
TOOLS = Tools(match=lambda grid, one: (), find=lambda grid, fields: (grid.instance, ()))


def main() -> None:
    """Write all files."""
    TARGET.mkdir(parents=True, exist_ok=True)
    for name, value in vectors().items():
        (TARGET / name).write_text(text_of(value))


def text_of(value: dict[str, list]) -> str:
    """Return the text of a file: one case a line."""
    parts = [
        f"{json.dumps(key)}: [\n  " + ",\n  ".join(map(json.dumps, rows)) + "\n ]"
        for key, rows in value.items()
    ]
    return "{\n " + ",\n ".join(parts) + "\n}\n"


def vectors() -> dict[str, dict[str, list]]:
    """Return the content of each file."""
    return {
        "runs.json": {"cases": list(run_cases()), "refused": list(refused_cases())},
        "box.json": {"cases": list(box_cases())},
        "flood.json": {"cases": list(flood_cases())},
        "changes.json": {"cases": list(change_cases())},
    }


def run_cases():
    """Yield cells in mixed order, and their runs."""
    for number, shape in enumerate(SHAPES * 2):
        rng = np.random.default_rng(number)
        flat = np.flatnonzero(rng.random(int(np.prod(shape))) < (0.3, 0.8)[number // len(SHAPES)])
        mixed = rng.permutation(flat)
        cells = np.column_stack(np.unravel_index(mixed, shape))
        runs = runs_of_cells(cells, shape).tolist()
        yield {"shape": shape, "cells": cells.tolist(), "flat": flat.tolist(), "runs": runs}


def refused_cases():
    """Yield runs that no grid of 24 cells has, and what is said of them."""
    for runs in REFUSED:
        try:
            cells_of_runs(runs, (4, 3, 2))
        except UsageError as error:
            yield {"shape": (4, 3, 2), "runs": runs, "error": str(error)}


def box_cases():
    """Yield boxes within and across the sides of grids."""
    for number in range(12):
        rng = np.random.default_rng(number)
        shape = SHAPES[number % len(SHAPES)]
        low = [int(rng.integers(-1, side)) for side in shape]
        high = [int(rng.integers(0, side + 1)) for side in shape]
        runs = runs_of_cells(box_cells(low, high, shape), shape).tolist()
        yield {"shape": shape, "low": low, "high": high, "runs": runs}


def flood_cases():
    """Yield floods through labels of three classes, and through a spiral."""
    for number in range(10):
        rng = np.random.default_rng(number)
        shape = (5, 4, 3)
        labels = rng.choice([0, 3, 3, 5], shape).astype(np.uint8)
        yield flood_case(labels, tuple(int(rng.integers(side)) for side in shape))
    spiral = np.zeros((5, 5, 1), np.uint8)
    spiral[0], spiral[:, 4], spiral[4], spiral[2:, 0], spiral[2, :3] = 3, 3, 3, 3, 3
    yield flood_case(spiral, (0, 0, 0))


def flood_case(labels: np.ndarray, seed: tuple[int, ...]) -> dict[str, Any]:
    """Return one flood."""
    cells = connected_component(labels, seed)  # type: ignore[arg-type]
    runs = runs_of_cells(cells, labels.shape).tolist()  # type: ignore[arg-type]
    flat = int(np.ravel_multi_index(seed, labels.shape))
    return {"shape": labels.shape, "labels": labels.ravel().tolist(), "seed": flat, "runs": runs}


def change_cases():
    """Yield each command done to a scene."""
    for number, fields in enumerate(COMMANDS):
        draft = scene(number)
        before = volume(draft)
        operation = parse_command(fields).plan(draft, TOOLS)
        draft.apply(operation)
        flat = sorted(np.ravel_multi_index(tuple(operation.cells.T), draft.shape).tolist())
        after = volume(draft)
        yield {
            "shape": draft.shape,
            "command": fields,
            "before": before,
            "after": after,
            "done": held_runs(after, flat),
            "undone": held_runs(before, flat),
            "gone": [one.id for one in operation.objects_before],
            "counts": draft.counts[:12].tolist(),
        }


def scene(seed: int) -> SceneDraft:
    """Return 4 x 3 x 5 cells with two chairs and a table among structure and unseen cells."""
    rng = np.random.default_rng(seed)
    shape = (4, 3, 5)
    labels = rng.choice([0, 0, 3, 5, 8, 255], shape).astype(np.uint8)
    instance = np.zeros(shape, np.uint16)
    instance[labels == 5] = rng.choice([1, 2], int((labels == 5).sum()))
    instance[labels == 8] = 300
    unseen = labels == 255
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.where(unseen, 0, rng.random(shape)).astype(np.float16),
        colour=np.zeros((*shape, 3), np.uint8),
        source=np.where(unseen, 0, 1).astype(np.uint8),
        instance=instance,
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )
    box = (np.ones(3), np.ones(3), 0.0, 0.5)
    return SceneDraft(grid, [SceneObject(n, c, *box) for n, c in ((1, 5), (2, 5), (300, 8))])


def volume(draft: SceneDraft) -> dict[str, list[int]]:
    """Return what the page keeps of a scene's cells."""
    sure = np.round(draft.confidence.astype(np.float32) * 255).astype(int)
    arrays = {"labels": draft.labels, "instance": draft.instance, "confidence": sure}
    return {name: values.ravel().tolist() for name, values in arrays.items()}


def held_runs(held: dict[str, list[int]], flat: list[int]) -> list[list[int]]:
    """Return the HeldRuns of cells, one after another, as a reader would write them."""
    runs: list[list[int]] = []
    for cell in flat:
        values = [held[name][cell] for name in ("labels", "instance", "confidence")]
        if runs and runs[-1][0] + runs[-1][1] == cell and runs[-1][2:] == values:
            runs[-1][1] += 1
        else:
            runs.append([cell, 1, *values])
    return runs


if __name__ == "__main__":
    main()
