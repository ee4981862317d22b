"""Evaluate answers to items: select them, ask one by one, score by task and composition.

Each reply is kept. An answer that cannot be read is wrong and counted as such; where a server
fails several items in a row the run ends, for its score would measure the server alone.
"""

import hashlib
import json
import random
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from world2minecraft.core.errors import ServerError, UnknownNameError, UsageError
from world2minecraft.core.files import write_json, write_text
from world2minecraft.core.progress import Progress
from world2minecraft.navigation.agents.question_answering import Answer
from world2minecraft.navigation.scores import rate
from world2minecraft.navigation.types import SPLITS, TASKS, Item

COMPOSITIONS = ("base", "extend", "combined")
ANSWERS_FILE, RESULT_FILE = "answers.jsonl", "result.json"
MAX_FAILED = 5  # In a row; each was asked several times.
TRAININGS = ("none", "sft", "rft", "baseline")
CHOICES = (*SPLITS, "test", "all")


def json_line(value: dict[str, Any]) -> str:
    """Return a value as one line of JSON, with its end."""
    return json.dumps(value, allow_nan=False, sort_keys=True) + "\n"


class Answerer(Protocol):
    """What answers items; threads may share it."""

    name: str

    def answer(self, item: Item) -> Answer:
        """Return what is said to an item."""
        ...


@dataclass(frozen=True)
class AnsweredItem:
    """An item with what was said to it."""

    item: Item
    answer: Answer

    @property
    def is_right(self) -> bool:
        """Whether the letter is the right one."""
        return self.answer.letter == self.item.answer


def evaluate(
    items: Sequence[Item], answerer: Answerer, *, jobs: int = 1, progress: Progress | None = None
) -> list[AnsweredItem]:
    """Ask all items, ``jobs`` at a time, and return the answers in the order of the items.

    Raises:
        UsageError: there is no item. ServerError: the server failed several items in a row. What
        the answerer raises.
    """
    if not items:
        raise UsageError("there is no item to ask; is the split right?")
    if jobs < 1:
        raise UsageError(f"--jobs is 1 or more, not {jobs}")
    found: list[AnsweredItem] = []
    failed, right = 0, 0
    for item, answer in _ask_all(items, answerer.answer, jobs):
        found.append(AnsweredItem(item, answer))
        right += found[-1].is_right
        failed = failed + 1 if answer.outcome == "failed" else 0
        if failed >= MAX_FAILED:
            raise ServerError(
                f"{failed} items in a row had no answer ({answer.details.get('problem', '')}); "
                "the same command goes on from here"
            )
        if progress is not None:
            progress("ask", len(found), len(items), f"{right / len(found):.0%} right")
    return found


def _ask_all(
    items: Sequence[Item], ask: Callable[[Item], Answer], jobs: int
) -> Iterator[tuple[Item, Answer]]:
    if jobs == 1:
        yield from ((item, ask(item)) for item in items)
        return
    with ThreadPoolExecutor(jobs) as pool:
        try:
            yield from zip(items, pool.map(ask, items), strict=True)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def accuracy(found: Sequence[AnsweredItem]) -> dict[str, dict[str, Any]]:
    """Return accuracy by task, then by composition: share, hits, total, Wilson interval, invalid.

    Combined are the two together. What has no item is left out.
    """
    table: dict[str, dict[str, Any]] = {}
    for task in TASKS:
        for composition in COMPOSITIONS:
            own = [
                one
                for one in found
                if one.item.task == task and composition in (one.item.composition, "combined")
            ]
            if own:
                table.setdefault(task, {})[composition] = _cell(own)
    return table


def _cell(own: Sequence[AnsweredItem]) -> dict[str, Any]:
    result = rate(sum(one.is_right for one in own), len(own))
    outcomes = [one.answer.outcome for one in own]
    return {
        "share": result.share,
        "hits": result.hits,
        "total": result.total,
        "low": result.low,
        "high": result.high,
        "chance": sum(1 / len(one.item.options) for one in own) / len(own),
        "invalid": outcomes.count("invalid"),
        "failed": outcomes.count("failed"),
    }


def write_result(folder: str | Path, found: Sequence[AnsweredItem], facts: dict[str, Any]) -> None:
    """Write ``answers.jsonl``, a line an item, and ``result.json``.

    ``facts`` are added to the result: who answered, how it was trained, what it cost.
    """
    out = Path(folder)
    lines = [
        json_line(
            {
                "item_id": one.item.item_id,
                "task": one.item.task,
                "composition": one.item.composition,
                "scene_id": one.item.scene_id,
                "answer": one.item.answer,
                "said": one.answer.letter,
                "is_right": one.is_right,
                "outcome": one.answer.outcome,
                "told": one.answer.details,
            }
        )
        for one in found
    ]
    write_text(out / ANSWERS_FILE, "".join(lines))
    names = "\n".join(one.item.item_id for one in found)
    result = {
        "kind": "answers",
        "items_sha256": hashlib.sha256(names.encode()).hexdigest(),
        "accuracy": accuracy(found),
        "right": {one.item.item_id: one.is_right for one in found},
        **facts,
    }
    write_json(out / RESULT_FILE, result)


def select_items(
    items: Sequence[Item],
    *,
    split: str = "test",
    task: str = "both",
    composition: str = "combined",
    count: int | None = None,
    seed: int = 0,
) -> list[Item]:
    """Return the items of a split, a task and a composition, in their order.

    Args:
        items: of a set.
        split: one of ``SPLITS``, ``test`` for both of val, or ``all``.
        task: one of ``TASKS``, or ``both``.
        composition: ``base``, ``extend``, or ``combined`` for both.
        count: at most so many, drawn evenly from all; the same for the same seed.
        seed: of the draw.

    Raises:
        UnknownNameError: a name is none of these. UsageError: no item is left.
    """
    for kind, name, known in (
        ("split", split, CHOICES),
        ("task", task, (*TASKS, "both")),
        ("composition", composition, COMPOSITIONS),
    ):
        if name not in known:
            raise UnknownNameError(kind, name, known)
    splits = {"test": SPLITS[1:], "all": SPLITS}.get(split, (split,))
    found = [
        item
        for item in items
        if item.split in splits
        and task in (item.task, "both")
        and composition in (item.composition, "combined")
    ]
    if not found:
        raise UsageError(
            f"none of {len(items):,} items is of split {split}, task {task} and composition "
            f"{composition}; try --split all"
        )
    if count is None or count >= len(found):
        return found
    drawn = set(random.Random(seed).sample(range(len(found)), count))
    return [item for n, item in enumerate(found) if n in drawn]
