"""Evaluation of answers to items: selection, queries, and scores by task and composition.

All replies are stored. An answer that cannot be parsed counts as wrong. If the server fails for
several items in a row, the run ends, because the score would only reflect the server.
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
MAX_FAILED = 5  # Items in a row, each of which was queried several times.
TRAININGS = ("none", "sft", "rft", "baseline")
CHOICES = (*SPLITS, "test", "all")


def json_line(value: dict[str, Any]) -> str:
    """Return a value as one line of JSON with a line break."""
    return json.dumps(value, allow_nan=False, sort_keys=True) + "\n"


class Answerer(Protocol):
    """The interface of objects that answer items. Implementations must be thread-safe."""

    name: str

    def answer(self, item: Item) -> Answer:
        """Return the answer to an item."""
        ...


@dataclass(frozen=True)
class AnsweredItem:
    """An item with its answer."""

    item: Item
    answer: Answer

    @property
    def is_right(self) -> bool:
        """Whether the answer is correct."""
        return self.answer.letter == self.item.answer


def evaluate(
    items: Sequence[Item], answerer: Answerer, *, jobs: int = 1, progress: Progress | None = None
) -> list[AnsweredItem]:
    """Answer all items, and return the answers in the order of the items.

    Args:
        items: The items.
        answerer: The answerer.
        jobs: The number of concurrent queries.
        progress: Called after each item.

    Raises:
        UsageError: If there are no items, or ``jobs`` is less than 1.
        ServerError: If the server fails for several items in a row.
    """
    if not items:
        raise UsageError("no items to answer; check the split (--split)")
    if jobs < 1:
        raise UsageError(f"jobs must be 1 or more, got {jobs}")
    found: list[AnsweredItem] = []
    failed, right = 0, 0
    for item, answer in _ask_all(items, answerer.answer, jobs):
        found.append(AnsweredItem(item, answer))
        right += found[-1].is_right
        failed = failed + 1 if answer.outcome == "failed" else 0
        if failed >= MAX_FAILED:
            raise ServerError(
                f"{failed} items in a row were not answered "
                f"({answer.details.get('problem', '')}); run the same command again to "
                "continue"
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
    """Return the accuracy by task, then by composition, omitting combinations without items.

    Each entry contains the share, the hits, the total, the Wilson interval and the invalid answers.
    "combined" covers both compositions.
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
    """Write ``answers.jsonl``, with one line per item, and ``result.json``.

    Args:
        folder: The output folder.
        found: The answered items.
        facts: Additional values for the result, such as the model and its cost.
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
    """Select the items of a split, a task and a composition, in their order.

    Args:
        items: The items of a set.
        split: One of ``SPLITS``, "test" for both validation splits, or "all".
        task: One of ``TASKS``, or "both".
        composition: "base", "extend", or "combined" for both.
        count: The maximum number of items, sampled uniformly. None selects all.
        seed: The seed of the random sample.

    Raises:
        UnknownNameError: If a split, task or composition is unknown.
        UsageError: If no items match.
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
            f"none of the {len(items):,} items has split {split}, task {task} and "
            f"composition {composition}; try the split all (--split all)"
        )
    if count is None or count >= len(found):
        return found
    drawn = set(random.Random(seed).sample(range(len(found)), count))
    return [item for n, item in enumerate(found) if n in drawn]
