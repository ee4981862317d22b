"""The effort of editing a scene: operations by kind, active time, and the paper's table of both.

An event is a line of a document's ``effort.jsonl``. It has ``step`` (``open``, ``do``, ``undo``,
``redo``, or ``active`` for work without an edit) and ``time_s``. Edits also have ``kind``,
``counts_as``, ``cells``, ``class_id`` and ``actor``.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from world2minecraft.core.types.edit import COUNTED

IDLE_AFTER_S = 10.0  # Who does nothing for so long has stopped to work.
# The paper's table, means of 15 scenes: from scratch, and from its reconstruction.
PAPER_SCRATCH = {
    "total_s": 482.0, "automatic_s": None, "manual_s": 482.0,
    "operations": 340.0, "add": 319.3, "delete": None, "orient": 20.7,
}  # fmt: skip
PAPER_REFINED = {
    "total_s": 70.38, "automatic_s": 5.88, "manual_s": 64.5,
    "operations": 24.5, "add": 9.7, "delete": 7.6, "orient": 7.2,
}  # fmt: skip


@dataclass(frozen=True)
class Effort:
    """The editing effort of one scene.

    Attributes:
        name: The name of the scene.
        operations: The number of operations, including those undone later.
        counted: The number of operations by counted kind.
        undone: The number of undo steps, which are not operations.
        redone: The number of redo steps, which are not operations.
        cells: The number of edited cells.
        active_s: The time of active work in seconds.
        automatic_s: The time of the reconstruction in seconds, or None if unknown.
        by_kind: The number of operations by kind.
        by_class: The number of operations by semantic class.
    """

    name: str
    operations: int
    counted: Mapping[str, int]
    undone: int
    redone: int
    cells: int
    active_s: float
    automatic_s: float | None = None
    by_kind: Mapping[str, int] | None = None
    by_class: Mapping[int, int] | None = None

    @property
    def total_s(self) -> float:
        """The total time in seconds."""
        return self.active_s + (self.automatic_s or 0.0)


def active_s(events: Iterable[Mapping[str, Any]], idle_after_s: float = IDLE_AFTER_S) -> float:
    """Return the time of active work in seconds.

    This is the sum of the gaps between events, each at most ``idle_after_s``, without the gaps
    between sessions (``open``). Negative gaps, after the clock was set back, count as zero.
    """
    total, last = 0.0, None
    for event in events:
        now = float(event["time_s"])
        if last is not None and event["step"] != "open":
            total += min(max(now - last, 0.0), idle_after_s)
        last = now
    return total


def effort_of(
    name: str, events: Sequence[Mapping[str, Any]], automatic_s: float | None = None
) -> Effort:
    """Compute the effort of a scene from its events.

    Args:
        name: The name of the scene.
        events: The lines of ``effort.jsonl`` in order.
        automatic_s: The time of the preceding reconstruction in seconds.
    """
    done = [event for event in events if event["step"] == "do"]
    steps = Counter(event["step"] for event in events)
    counted = Counter(event["counts_as"] for event in done)
    return Effort(
        name=name,
        operations=len(done),
        counted={kind: counted[kind] for kind in COUNTED},
        undone=steps["undo"],
        redone=steps["redo"],
        cells=sum(int(event["cells"]) for event in done),
        active_s=active_s(events),
        automatic_s=automatic_s,
        by_kind=dict(sorted(Counter(event["kind"] for event in done).items())),
        by_class=dict(sorted(_by_class(done).items())),
    )


def mean_row(efforts: Sequence[Effort]) -> dict[str, float | None]:
    """Return the means over scenes by the row names of the paper, with None for missing values.

    The automatic time is averaged over the scenes that have one.
    """
    if not efforts:
        return dict.fromkeys((*PAPER_REFINED, "move", "relabel", "other", "undone"))
    automatic = [e.automatic_s for e in efforts if e.automatic_s is not None]
    automatic_mean = _mean(automatic) if automatic else None
    manual = _mean([e.active_s for e in efforts])
    row: dict[str, float | None] = {
        "total_s": manual + (automatic_mean or 0.0),
        "automatic_s": automatic_mean,
        "manual_s": manual,
        "operations": _mean([e.operations for e in efforts]),
    }
    row |= {kind: _mean([e.counted[kind] for e in efforts]) for kind in COUNTED}
    return row | {"undone": _mean([e.undone for e in efforts])}


def improvement(scratch: float | None, ours: float | None) -> float | None:
    """Return the ratio of both values, or None if either is missing or zero."""
    return scratch / ours if scratch and ours else None


def _by_class(done: Iterable[Mapping[str, Any]]) -> Counter[int]:
    return Counter(int(e["class_id"]) for e in done if e.get("class_id") is not None)


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
