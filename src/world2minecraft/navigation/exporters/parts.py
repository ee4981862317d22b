"""Which items go together: by task, by composition and by split, in an order of chance.

LLaMA-Factory takes the *first* ``max_samples`` rows of a file, so the order must say nothing: it is
that of a hash of the seed and the item's id, the same whatever order the items came in.
"""

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.exporters.rules import HandoffRule
from world2minecraft.navigation.values import SPLITS, Item

TRAIN, HELD_OUT = "train", ("val_unseen", "val_seen")


@dataclass(frozen=True)
class Part:
    """The items of one task, composition and split, in the order of the rows."""

    task: str
    composition: str
    split: str
    items: tuple[Item, ...]

    @property
    def stem(self) -> str:
        """What it shares with the other splits of its task and composition."""
        return f"{self.task}_{self.composition}"

    @property
    def name(self) -> str:
        """What its file and its data set are called."""
        return f"mcvln_{self.stem}_{self.split}"


def parts_of(items: Iterable[Item], rule: HandoffRule) -> list[Part]:
    """Return the parts that hold an item; ``combined`` only where there are both others.

    Raises:
        UsageError: none of the items is of a task and composition that are wanted.
    """
    every = list(items)
    both = {item.composition for item in every} >= {"base", "extend"}
    parts = []
    for task in rule.tasks:
        for composition in rule.compositions:
            if composition == "combined" and not both:
                continue
            for split in SPLITS:
                chosen = [
                    item
                    for item in every
                    if item.task == task
                    and item.split == split
                    and composition in (item.composition, "combined")
                ]
                if chosen:
                    parts.append(Part(task, composition, split, shuffled(chosen, rule.seed)))
    if not parts:
        held = sorted({f"{item.composition} {item.task}" for item in every})
        raise UsageError(
            f"the set has no item of {' or '.join(rule.tasks)} that is "
            f"{' or '.join(rule.compositions)}; it has {', '.join(held) or 'none at all'}"
        )
    return parts


def held_out(parts: Sequence[Part], train: Part) -> Part | None:
    """Return what a training part is to be validated on: scenes not seen, else ways not seen."""
    beside = {part.split: part for part in parts if part.stem == train.stem}
    return next((beside[split] for split in HELD_OUT if split in beside), None)


def shuffled(items: Iterable[Item], seed: int) -> tuple[Item, ...]:
    """Return items in an order that depends on the seed and their ids alone."""

    def key(item: Item) -> bytes:
        return hashlib.sha256(f"{seed}:{item.item_id}".encode()).digest()

    return tuple(sorted(items, key=key))
