"""Which items of a set are asked: by split, task and composition, or a number of them drawn."""

import random
from collections.abc import Sequence

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.navigation.running.evaluating import COMPOSITIONS
from world2minecraft.navigation.values import SPLITS, TASKS, Item

CHOICES = (*SPLITS, "test", "all")


def picked_items(
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
