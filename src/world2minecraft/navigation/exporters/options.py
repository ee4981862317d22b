"""Export options, item groups and the report of each exported file.

LLaMA-Factory uses the *first* ``max_samples`` rows of a file, so rows are sorted by a hash of the
seed and the item ID. The order of the input items does not matter.
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
    """The options of an export.

    Attributes:
        tasks: The tasks to export. Tasks that a set does not contain are skipped.
        compositions: The compositions to export. Missing ones are skipped.
        model: The model's name on the Hugging Face Hub, or a folder.
        max_samples: The number of rows of one SFT run, 1,000 in the paper. 0 means all rows.
        gpus: The number of GPUs of the recipe. None means 1 for SFT and 8 for EasyR1.
        max_pixels: The maximum number of pixels of an image, as in LLaMA-Factory's examples.
        image_style: "paths" for image files, or "embedded" for images within EasyR1's Parquet file.
        seed: The seed of the row order.
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
            raise UsageError(
                f"the pixel limit (--max-pixels) must be 784 to 16777216, got {self.max_pixels}"
            )
        if self.gpus is not None and not 1 <= self.gpus <= 4096:
            raise UsageError(f"gpus must be 1 to 4096, got {self.gpus}")
        if self.max_samples < 0:
            raise UsageError(
                "the row limit (--max-samples) must be 0 (all rows) or more, got "
                f"{self.max_samples}"
            )
        if not self.model.strip() or not self.model.isprintable():
            raise UsageError(
                "model must be a model name such as Qwen/Qwen2.5-VL-3B-Instruct, or a folder"
            )

    def as_data(self) -> dict[str, Any]:
        """Return the options as JSON data."""
        return {key: list(v) if isinstance(v, tuple) else v for key, v in asdict(self).items()}


@dataclass(frozen=True)
class ExportedFile:
    """A file of exported rows, with the cost of training on it.

    Attributes:
        name: The name of the data set.
        rows: The number of rows.
        command: The training command, or "".
        steps: The number of optimizer steps, 0 if the file is not for training.
        tokens: The maximum number of tokens of a row.
        notes: Remarks that the user should know.
    """

    name: str
    rows: int
    command: str = ""
    steps: int = 0
    tokens: int = 0
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ItemGroup:
    """The items of one task, composition and split, in row order."""

    task: str
    composition: str
    split: str
    items: tuple[Item, ...]

    @property
    def stem(self) -> str:
        """The part of the name shared by all splits of the task and composition."""
        return f"{self.task}_{self.composition}"

    @property
    def name(self) -> str:
        """The name of the data set and of its file."""
        return f"mcvln_{self.stem}_{self.split}"


def group_items(items: Iterable[Item], rule: ExportOptions) -> list[ItemGroup]:
    """Group items by task, composition and split, omitting empty groups.

    The composition ``combined`` is included only if the set contains both others.

    Raises:
        UsageError: If no item has a requested task and composition.
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
            f"the set has no {' or '.join(rule.tasks)} items of composition "
            f"{' or '.join(rule.compositions)}; it contains "
            f"{', '.join(held) or 'no items'}"
        )
    return parts


def validation_group(parts: Sequence[ItemGroup], train: ItemGroup) -> ItemGroup | None:
    """Return the validation group of a training group: val_unseen, else val_seen, else None."""
    beside = {part.split: part for part in parts if part.stem == train.stem}
    return next((beside[split] for split in VALIDATION_SPLITS if split in beside), None)


def shuffle_items(items: Iterable[Item], seed: int) -> tuple[Item, ...]:
    """Return items in an order that depends only on the seed and the item IDs."""

    def key(item: Item) -> bytes:
        return hashlib.sha256(f"{seed}:{item.item_id}".encode()).digest()

    return tuple(sorted(items, key=key))
