"""Commands and queries on the objects of the demo room, as SceneForge sends them.

CPU time of this process, which does not depend on the load; the median of nine, after a warm-up.
"""

import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.rows import Row
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room

FIGURES = {"density_kernel": 3, "density_threshold": 0.2, "cluster_radius": 2.0}
SLIDER_MS = 50.0  # A slider that is dragged shows its answer twenty times a second.
TIMES = 9


def run() -> list[Row]:
    """Measure on a copy of the demo room."""
    with TemporaryDirectory() as folder:
        opened = demo_room()
        np.save(Path(folder) / "demo.npy", opened.grid.labels)
        editor = Editor.open(Path(folder) / "demo.npy")
        rows = [Row(what, _median_ms(ask), "ms", budget) for what, ask, budget in _asked(editor)]
        editor.close()
    return rows


def _asked(editor: Editor) -> list[tuple[str, Callable[[], Any], float | None]]:
    first = min(editor.draft.objects)
    sizes = {number: int(editor.cells_of[number]) for number in editor.draft.objects}
    large = max(sizes, key=lambda number: sizes[number])
    center = editor.draft.objects[first].center_m
    to_m = (center + np.array([0.2, 0.0, 0.0])).tolist()
    return [
        ("centers, as a slider asks", lambda: editor.ask("centers", **FIGURES), SLIDER_MS),
        ("centers of one class", lambda: editor.ask("centers", class_id=10, **FIGURES), SLIDER_MS),
        ("alternatives of the largest", lambda: editor.ask("alternatives", id=large), None),
        ("warnings", lambda: editor.ask("warnings"), None),
        ("doubtful", lambda: editor.ask("doubtful"), None),
        ("move_object", lambda: editor.preview("move_object", id=first, to_m=to_m), None),
        ("rematch", lambda: editor.preview("rematch", ids=[first]), None),
        ("recluster, all matched anew", lambda: editor.preview("recluster", **FIGURES), None),
    ]


def _median_ms(ask: Callable[[], Any]) -> float:
    ask()
    spent = []
    for _ in range(TIMES):
        start = time.process_time()
        ask()
        spent.append(time.process_time() - start)
    return 1000 * float(np.median(spent))
