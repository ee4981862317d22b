"""The figures of a set as a table for people, and as JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from world2minecraft.navigation.data.blind_baselines import BaselineRow
from world2minecraft.navigation.data.leaks import Leaks
from world2minecraft.navigation.data.statistics import PAPER_LENGTHS, PARTS, SetStatistics
from world2minecraft.navigation.values import SPLITS, TASKS

_TITLES = {"next_view": "Next-View", "next_action": "Next-Action"}


def statistics_text(statistics: SetStatistics, leaks: Leaks) -> str:
    """Return the table of lengths beside the paper's, the splits, the balance and the leaks."""
    head = ("count", "mean", "std", "min", "25%", "50%", "75%", "max")
    lines = [f"{'characters, by item':28}" + "".join(f"{word:>7}" for word in head)]
    for task in TASKS[::-1]:
        for part in PARTS:
            own = tuple(asdict(statistics.characters[task, part]).values())
            lines.append(_row(f"{_TITLES[task]} {part}", own))
            lines.append(_row("    the paper's", PAPER_LENGTHS[task, part]))
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
        told = _counted(statistics.letters[task])
        p = statistics.letter_p[task]
        lines.append(f"{_TITLES[task] + ' answers':28}{told}  (even by chance: p = {p:.2f})")
    lines.append(f"{'right actions':28}{_counted(statistics.actions)}")
    lines.append(f"{'wrong pictures':28}{_counted(statistics.kinds)}")
    lines.append(f"{'grades':28}{_counted(statistics.grades)}")
    lines.append(f"{'nearer than the right one':28}{_counted(statistics.ranks)}")
    lines.append(f"{'levels of instructions':28}{_counted(statistics.levels)}")
    return lines


def _counted(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{name or '-'} {counts[name]:,}" for name in sorted(counts)) or "none"


def _leaks(leaks: Leaks) -> list[str]:
    told = (
        f"{len(leaks.images)} pictures, {len(leaks.scenes)} scenes, "
        f"{len(leaks.trajectories)} walks, {len(leaks.instructions)} instructions"
    )
    word = "train shares with the rest" if leaks.is_clean else "LEAK: train shares"
    return [f"{word:28}{told}"]


def figures(statistics: SetStatistics, leaks: Leaks, rows: Sequence[BaselineRow]) -> dict[str, Any]:
    """Return every figure as JSON has it."""
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
