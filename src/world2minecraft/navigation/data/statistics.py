"""What a set holds: lengths of instructions as the paper's table has them, answers, wrong choices.

Lengths are counted by items, in characters and in words; ``std`` is that of a sample (ddof 1), as
pandas' ``describe`` gives it, which the paper's table looks made by.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chisquare

from world2minecraft.navigation.values import TASKS, Item

# Of the paper's table "Statistical Summary of Instruction Lengths", in characters.
PAPER_LENGTHS = {
    ("next_action", "base"): (769, 79.01, 32.87, 15, 57.0, 78.0, 96.0, 187),
    ("next_action", "extend"): (1351, 171.37, 67.10, 62, 117.0, 156.0, 232.0, 334),
    ("next_action", "combined"): (2120, 137.87, 72.34, 15, 81.0, 121.0, 181.0, 334),
    ("next_view", "base"): (290, 87.41, 33.57, 28, 64.0, 87.0, 99.0, 187),
    ("next_view", "extend"): (1132, 173.23, 66.70, 62, 121.0, 156.0, 232.0, 334),
    ("next_view", "combined"): (1422, 155.73, 70.48, 28, 103.0, 145.0, 208.0, 334),
}
PARTS = ("base", "extend", "combined")


@dataclass(frozen=True)
class Lengths:
    """How long instructions are."""

    count: int
    mean: float
    std: float
    least: float
    quarter: float
    median: float
    three_quarters: float
    most: float


def lengths_of(values: Sequence[int]) -> Lengths:
    """Return the summary of lengths; zeros where there are none.

    Example:
        >>> lengths_of([10, 20, 30])
        Lengths(count=3, mean=20.0, std=10.0, least=10.0, quarter=15.0, median=20.0, three_quarters=25.0, most=30.0)
    """  # noqa: E501
    if not len(values):
        return Lengths(0, *[0.0] * 7)
    data = np.asarray(values, float)
    std = float(data.std(ddof=1)) if len(data) > 1 else 0.0
    five = (float(value) for value in np.percentile(data, [0, 25, 50, 75, 100]))
    return Lengths(len(data), float(data.mean()), std, *five)


@dataclass(frozen=True)
class SetStatistics:
    """The figures of a set. Keys are task and part: base, extend, combined."""

    characters: dict[tuple[str, str], Lengths]
    words: dict[tuple[str, str], Lengths]
    splits: dict[tuple[str, str], Counter[str]]
    letters: dict[str, Counter[str]]  # by task
    letter_p: dict[str, float]  # how likely letters so uneven are by chance
    actions: Counter[str]  # right answers of Next-Action
    kinds: Counter[str]  # of wrong pictures
    grades: Counter[str]
    ranks: Counter[str]  # wrong pictures that are nearer to the present one than the right one
    levels: Counter[str]  # of instructions, by item
    scenes: dict[str, int]  # how many, by part


def statistics_of(items: Sequence[Item]) -> SetStatistics:
    """Return the figures of items."""
    characters, words, splits = {}, {}, {}
    for task in TASKS:
        for part in PARTS:
            own = [item for item in items if item.task == task and _is_of(item, part)]
            texts = [item.instruction.text for item in own]
            characters[task, part] = lengths_of([len(text) for text in texts])
            words[task, part] = lengths_of([len(text.split()) for text in texts])
            splits[task, part] = Counter(item.split for item in own)
    letters = {task: Counter(item.answer for item in items if item.task == task) for task in TASKS}
    views = [item for item in items if item.task == "next_view"]
    wrong = [one.kind for item in views for one in item.options if one.label != item.answer]
    return SetStatistics(
        characters, words, splits, letters,
        {task: _evenness(items, task) for task in TASKS},
        Counter(str(i.extra.get("gold", "")) for i in items if i.task == "next_action"),
        Counter(wrong), Counter(str(item.extra.get("grade", "")) for item in views),
        Counter(str(item.extra.get("nearer", "")) for item in views),
        Counter(item.instruction.level for item in items),
        {part: len({i.scene_id for i in items if _is_of(i, part)}) for part in PARTS},
    )  # fmt: skip


def _is_of(item: Item, part: str) -> bool:
    return part in ("combined", item.composition)


def _evenness(items: Sequence[Item], task: str) -> float:
    """Return the p of Pearson's test that every letter is as likely."""
    own = [item for item in items if item.task == task and len(item.options) == 4]
    if not own:
        return 1.0
    counts = Counter(item.answer for item in own)
    return float(chisquare([counts[letter] for letter in "ABCD"]).pvalue)
