"""The options of an export, the groups of items that it writes, and the report of each file.

LLaMA-Factory takes the *first* ``max_samples`` rows of a file, so the order must not matter: it is
that of a hash of the seed and the item's id, the same whatever order the items came in.
"""

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.navigation.types import SPLITS, TASKS, Item

COMPOSITIONS = ("base", "extend", "combined")
IMAGE_STYLES = ("paths", "embedded")
TRAIN_SPLIT, VALIDATION_SPLITS = "train", ("val_unseen", "val_seen")


@dataclass(frozen=True)
class ExportOptions:
    """The choices of an export.

    tasks, compositions: those wanted; what a set does not hold is passed over. model: a name on
    the hub or a path. max_samples: rows of one SFT run, the paper's 1,000; 0 for all. gpus: that
    the recipe is written for; 1 for SFT, whose batch of 2 the paper's is, and 8 for EasyR1 where
    left out. max_pixels: of a picture, by LLaMA-Factory's examples. image_style: of EasyR1's
    parquet, ``paths`` beside ``images/`` or ``embedded`` in it. seed: of the order of rows.
    """

    tasks: tuple[str, ...] = TASKS
    compositions: tuple[str, ...] = COMPOSITIONS
    model: str = "Qwen/Qwen2.5-VL-3B-Instruct"
    max_samples: int = 1000
    gpus: int | None = None
    max_pixels: int = 262_144
    image_style: str = "paths"
    seed: int = 0

    def __post_init__(self):
        for kind, names, known in (
            ("task", self.tasks, TASKS),
            ("composition", self.compositions, COMPOSITIONS),
            ("image style", (self.image_style,), IMAGE_STYLES),
        ):
            for name in names:
                if name not in known:
                    raise UnknownNameError(kind, name, known)
        if not 28 * 28 <= self.max_pixels <= 1 << 24:
            raise UsageError(f"max_pixels is 784 to 16777216, not {self.max_pixels}")
        if self.gpus is not None and not 1 <= self.gpus <= 4096:
            raise UsageError(f"gpus is 1 to 4096, not {self.gpus}")
        if self.max_samples < 0:
            raise UsageError(f"max_samples is 0 (all rows) or more, not {self.max_samples}")
        if not self.model.strip() or not self.model.isprintable():
            raise UsageError("model is a name such as Qwen/Qwen2.5-VL-3B-Instruct, or a path")

    def as_data(self) -> dict[str, Any]:
        """Return the choices as JSON has them."""
        return {key: list(v) if isinstance(v, tuple) else v for key, v in asdict(self).items()}


@dataclass(frozen=True)
class ExportedFile:
    """One file of rows, and what the recipe beside it will do with them.

    ``tokens`` are the most that a row can take; ``steps`` of the optimizer, 0 where nothing
    trains; ``notes`` say what a user would not expect.
    """

    name: str
    rows: int
    command: str = ""
    steps: int = 0
    tokens: int = 0
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ItemGroup:
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


def group_items(items: Iterable[Item], rule: ExportOptions) -> list[ItemGroup]:
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
                    parts.append(
                        ItemGroup(task, composition, split, shuffle_items(chosen, rule.seed))
                    )
    if not parts:
        held = sorted({f"{item.composition} {item.task}" for item in every})
        raise UsageError(
            f"the set has no item of {' or '.join(rule.tasks)} that is "
            f"{' or '.join(rule.compositions)}; it has {', '.join(held) or 'none at all'}"
        )
    return parts


def validation_group(parts: Sequence[ItemGroup], train: ItemGroup) -> ItemGroup | None:
    """Return what a training part is to be validated on: scenes not seen, else ways not seen."""
    beside = {part.split: part for part in parts if part.stem == train.stem}
    return next((beside[split] for split in VALIDATION_SPLITS if split in beside), None)


def shuffle_items(items: Iterable[Item], seed: int) -> tuple[Item, ...]:
    """Return items in an order that depends on the seed and their ids alone."""

    def key(item: Item) -> bytes:
        return hashlib.sha256(f"{seed}:{item.item_id}".encode()).digest()

    return tuple(sorted(items, key=key))
