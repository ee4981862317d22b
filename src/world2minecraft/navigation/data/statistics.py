"""Statistics of a set: instruction lengths, splits, answers and distractors, and a histogram plot.

Lengths are measured per item, in characters and in words. The standard deviation is that of a
sample (ddof 1), as in pandas' ``describe``, which the paper's table appears to use. The plot shows
the lengths for two tasks and three compositions, like the paper's figure.
"""

import io
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import chisquare

from world2minecraft.core.errors import MissingExtraError
from world2minecraft.core.files import write_bytes
from world2minecraft.navigation.data.blind_baselines import BaselineRow
from world2minecraft.navigation.data.splits import Leaks
from world2minecraft.navigation.types import SPLITS, TASKS, Item

# From the paper's table "Statistical Summary of Instruction Lengths", in characters.
PAPER_LENGTHS = {
    ("next_action", "base"): (769, 79.01, 32.87, 15, 57.0, 78.0, 96.0, 187),
    ("next_action", "extend"): (1351, 171.37, 67.10, 62, 117.0, 156.0, 232.0, 334),
    ("next_action", "combined"): (2120, 137.87, 72.34, 15, 81.0, 121.0, 181.0, 334),
    ("next_view", "base"): (290, 87.41, 33.57, 28, 64.0, 87.0, 99.0, 187),
    ("next_view", "extend"): (1132, 173.23, 66.70, 62, 121.0, 156.0, 232.0, 334),
    ("next_view", "combined"): (1422, 155.73, 70.48, 28, 103.0, 145.0, 208.0, 334),
}
PARTS = ("base", "extend", "combined")
_TITLES = {"next_view": "Next-View", "next_action": "Next-Action"}
SIZE_IN, DPI, BIN = (10.76, 5.56), 100, 20  # A bin covers 20 characters.
COLOUR = "#5684b4"


@dataclass(frozen=True)
class Lengths:
    """Summary statistics of instruction lengths."""

    count: int
    mean: float
    std: float
    least: float
    quarter: float
    median: float
    three_quarters: float
    most: float


def lengths_of(values: Sequence[int]) -> Lengths:
    """Return the summary of lengths, with zeros for an empty sequence.

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
    """The statistics of a set, keyed by task and part: base, extend or combined."""

    characters: dict[tuple[str, str], Lengths]
    words: dict[tuple[str, str], Lengths]
    splits: dict[tuple[str, str], Counter[str]]
    letters: dict[str, Counter[str]]  # by task
    letter_p: dict[str, float]  # p-value of uniformly distributed letters, by task
    actions: Counter[str]  # correct answers of Next-Action
    kinds: Counter[str]  # of distractors
    grades: Counter[str]
    ranks: Counter[str]  # distractors that resemble the current view more than the correct option
    levels: Counter[str]  # of instructions, by item
    scenes: dict[str, int]  # number of scenes by part


def compute_statistics(items: Sequence[Item]) -> SetStatistics:
    """Compute the statistics of items."""
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
    """Return the p-value of Pearson's chi-squared test for uniformly distributed letters."""
    own = [item for item in items if item.task == task and len(item.options) == 4]
    if not own:
        return 1.0
    counts = Counter(item.answer for item in own)
    return float(chisquare([counts[letter] for letter in "ABCD"]).pvalue)


def statistics_text(statistics: SetStatistics, leaks: Leaks) -> str:
    """Format the statistics: lengths beside those of the paper, splits, balance and leaks."""
    head = ("count", "mean", "std", "min", "25%", "50%", "75%", "max")
    lines = [f"{'characters per item':28}" + "".join(f"{word:>7}" for word in head)]
    for task in TASKS[::-1]:
        for part in PARTS:
            own = tuple(asdict(statistics.characters[task, part]).values())
            lines.append(_row(f"{_TITLES[task]} {part}", own))
            lines.append(_row("    paper", PAPER_LENGTHS[task, part]))
    lines += ["", *_splits(statistics), "", *_balance(statistics), "", *_leaks(leaks)]
    return "\n".join(lines)


def _row(title: str, values: Sequence[float]) -> str:
    return f"{title:28}" + "".join(
        f"{value:7.0f}" if n == 0 or value == int(value) else f"{value:7.1f}"
        for n, value in enumerate(values)
    )


def _splits(statistics: SetStatistics) -> list[str]:
    lines = [f"{'items':28}" + "".join(f"{split:>12}" for split in SPLITS)]
    for task in TASKS[::-1]:
        for part in PARTS[:2]:
            counts = statistics.splits[task, part]
            cells = "".join(f"{counts[split]:12,}" for split in SPLITS)
            lines.append(f"{_TITLES[task] + ' ' + part:28}{cells}")
    scenes = ", ".join(f"{statistics.scenes[part]} {part}" for part in PARTS[:2])
    return [*lines, f"{'scenes':28}{scenes}"]


def _balance(statistics: SetStatistics) -> list[str]:
    lines = []
    for task in TASKS[::-1]:
        counts_line = _counts_text(statistics.letters[task])
        p = statistics.letter_p[task]
        test = f"chi-squared test for uniformity: p = {p:.2f}"
        lines.append(f"{_TITLES[task] + ' answers':28}{counts_line}  ({test})")
    lines.append(f"{'correct actions':28}{_counts_text(statistics.actions)}")
    lines.append(f"{'distractor kinds':28}{_counts_text(statistics.kinds)}")
    lines.append(f"{'grades':28}{_counts_text(statistics.grades)}")
    lines.append(f"{'nearer distractors':28}{_counts_text(statistics.ranks)}")
    lines.append(f"{'instruction levels':28}{_counts_text(statistics.levels)}")
    return lines


def _counts_text(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{name or '-'} {counts[name]:,}" for name in sorted(counts)) or "none"


def _leaks(leaks: Leaks) -> list[str]:
    counts_line = (
        f"{len(leaks.images)} images, {len(leaks.scenes)} scenes, "
        f"{len(leaks.trajectories)} walks, {len(leaks.instructions)} instructions"
    )
    word = "shared with training" if leaks.is_clean else "LEAK: shared with training"
    return [f"{word:28}{counts_line}"]


def statistics_json(
    statistics: SetStatistics, leaks: Leaks, rows: Sequence[BaselineRow]
) -> dict[str, Any]:
    """Return all statistics as JSON data."""
    named = {
        name: {f"{task} {part}": asdict(own) for (task, part), own in table.items()}
        for name, table in (("characters", statistics.characters), ("words", statistics.words))
    }
    splits = {f"{task} {part}": dict(own) for (task, part), own in statistics.splits.items()}
    return {
        **named,
        "splits": splits,
        "letters": {task: dict(own) for task, own in statistics.letters.items()},
        "letter_p": statistics.letter_p,
        "actions": dict(statistics.actions),
        "wrong_pictures": dict(statistics.kinds),
        "grades": dict(statistics.grades),
        "nearer": dict(statistics.ranks),
        "levels": dict(statistics.levels),
        "scenes": statistics.scenes,
        "leaks": {name: len(value) for name, value in asdict(leaks).items()},
        "baselines": [
            {
                "task": row.task,
                "name": row.name,
                "hits": row.accuracy.hits,
                "total": row.accuracy.total,
                "low": row.accuracy.low,
                "high": row.accuracy.high,
                "chance": row.chance,
                "flagged": row.is_flagged,
            }
            for row in rows
        ],
    }


def write_histograms(items: Sequence[Item], path: str | Path) -> None:
    """Plot histograms of the instruction lengths in characters as a PNG.

    The user's matplotlib settings are ignored, so that the same items give an identical file.

    Raises:
        MissingExtraError: If matplotlib is not installed.
        OutputError: If the file cannot be written.
    """
    try:
        import matplotlib.style  # noqa: PLC0415  # An extra, and slow to import.
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("plotting histograms", "vln") from error
    longest = max((len(item.instruction.text) for item in items), default=1)
    edges = np.arange(0, longest + BIN, BIN)
    stream = io.BytesIO()
    with matplotlib.style.context("default"):
        figure = Figure(SIZE_IN, layout="constrained")
        panels = figure.subplots(len(TASKS), len(PARTS), sharex=True, squeeze=False)
        for row, task in enumerate(TASKS[::-1]):
            for axes, part in zip(panels[row], PARTS, strict=True):
                lengths = _lengths(items, task, part)
                axes.hist(lengths, edges, color=COLOUR, rwidth=0.9)
                axes.set_title(f"{task.replace('_', ' ')}, {part}: {len(lengths):,}", fontsize=10)
                axes.set_xlim(0, edges[-1])
        figure.supxlabel("characters", fontsize=10)
        figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None})
    write_bytes(path, stream.getvalue())


def _lengths(items: Sequence[Item], task: str, part: str) -> list[int]:
    """Return the instruction lengths of a task and a part of the items."""
    return [
        len(item.instruction.text) for item in items if item.task == task and _is_of(item, part)
    ]
