"""Text tables of run results: walks with reference agents, and answers as in the paper.

Result files are not trusted. Their values are checked before use.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.core.files import read_json
from world2minecraft.minecraftocc.statistics.tables import align_columns
from world2minecraft.navigation.agents.registry import REFERENCE_AGENTS
from world2minecraft.navigation.running.item_evaluation import COMPOSITIONS, RESULT_FILE, TRAININGS
from world2minecraft.navigation.scores import RADII_M, paired_p
from world2minecraft.navigation.types import TASKS

MAX_RESULT_BYTES = 256 << 20
_WALKED = ("ne_m", "spl", "soft_spl", "ndtw", "sdtw", "cls", "collisions", "steps")
HEADS_NOTE = (
    "NE: remaining walking distance to the goal in metres; SR: share of episodes with "
    "STOP within the given distance; SPL and SDTW at 3 m; "
    "docs/reference/vln-scores.md explains all columns"
)
_TITLES = {"next_view": "Next-View", "next_action": "Next-Action"}
_HEADS = ("Base", "Extend", "Combined")

Table = list[list[str]]


def read_result(path: str | Path) -> dict[str, Any]:
    """Read the result of a run from its folder or file.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a valid result.
    """
    place = Path(path)
    if place.is_dir():
        place = place / RESULT_FILE
        if not place.is_file():
            raise InputError(
                place,
                "not found; w2m vln run and w2m vln evaluate write this file when they finish",
            )
    data = read_json(place, MAX_RESULT_BYTES)
    if not isinstance(data, dict) or data.get("kind") not in ("walks", "answers"):
        raise DamagedFileError(place, "not a result of w2m vln run or w2m vln evaluate")
    try:
        _check(data)
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise DamagedFileError(
            place, f"not a complete result: a value for the table is missing ({error})"
        ) from error
    return data


def walks_table(results: Sequence[dict[str, Any]]) -> Table:
    """Return a table of walks with a row per agent.

    Reference agents are listed once for each set of episodes.
    """
    radii = [f"SR {radius:g} m" for radius in RADII_M]
    head = ["agent", "episodes", "NE m", *radii, "OSR 3 m", "SPL", "SoftSPL", "nDTW", "SDTW",
            "CLS", "collisions", "steps", "invalid"]  # fmt: skip
    rows, seen = [head], set()
    for result in results:
        rows.append(_walk_row(str(result["agent"]), result["summary"]))
        episodes = tuple(str(one["episode_id"]) for one in result["episodes"])
        for name, summary in sorted(result["beside"].items(), key=_beside):
            if (name, episodes) not in seen and name != result["agent"]:
                seen.add((name, episodes))
                rows.append(_walk_row(str(name), summary))
    return rows


def answers_table(results: Sequence[dict[str, Any]]) -> Table:
    """Return a table of accuracy by model, training, task and composition, as in the paper.

    Each cell contains the accuracy in percent and its 95 percent Wilson interval.
    """
    head = ["model", "training", *(f"{_TITLES[task]} {one}" for task in TASKS for one in _HEADS)]
    rows = [head]
    for result in sorted(results, key=_place):
        cells = [
            _cell(result["accuracy"].get(task, {}).get(one))
            for task in TASKS
            for one in COMPOSITIONS
        ]
        rows.append([str(result["agent"]), str(result["training"]), *cells])
    return rows


def paired_table(results: Sequence[dict[str, Any]]) -> Table:
    """Compare each pair of results on their shared items with McNemar's test."""
    rows = [["one", "other", "items", "only one right", "only other right", "p"]]
    ordered = sorted(results, key=_place)
    for n, one in enumerate(ordered):
        for other in ordered[n + 1 :]:
            shared = sorted(set(one["right"]) & set(other["right"]))
            if not shared:
                continue
            first, second = (
                np.array([result["right"][name] for name in shared], bool)
                for result in (one, other)
            )
            rows.append(
                [_label(one), _label(other), str(len(shared)), str(int((first & ~second).sum())),
                 str(int((second & ~first).sum())), f"{paired_p(first, second):.3g}"]
            )  # fmt: skip
    return rows


def format_text(table: Table) -> str:
    """Format a table as text with aligned columns.

    Raises:
        UsageError: If the table has no rows.
    """
    if not table:
        raise UsageError("a table needs at least one row")
    return "\n".join(align_columns(table))


def format_markdown(table: Table) -> str:
    """Format a table as Markdown."""
    safe = [[cell.replace("|", "\\|") for cell in row] for row in table]
    rule = ["---"] + ["---:"] * (len(table[0]) - 1)
    return "\n".join(f"| {' | '.join(row)} |" for row in (safe[0], rule, *safe[1:]))


def _check(data: dict[str, Any]) -> None:
    str(data["agent"])
    if data["kind"] == "walks":
        if not isinstance(data["episodes"], list):
            raise TypeError("episodes must be a list")
        for summary in (data["summary"], *data["beside"].values()):
            _walk_row("", summary)
        _ = [one["episode_id"] for one in data["episodes"]]
        return
    if data["training"] not in TRAININGS:
        raise ValueError(f"training must be one of {', '.join(TRAININGS)}")
    if not all(type(value) is bool for value in data["right"].values()):
        raise TypeError("right must be true or false")
    for task in TASKS:
        for one in COMPOSITIONS:
            _cell(data["accuracy"].get(task, {}).get(one))


def _walk_row(agent: str, summary: dict[str, Any]) -> list[str]:
    shares = [f"{summary[f'success_{radius:g}m']['share']:.1%}" for radius in RADII_M]
    means = [_mean(summary[name]) for name in _WALKED]
    oracle = f"{summary['oracle_3m']['share']:.1%}"
    invalid = f"{int(summary['invalid'])}" + (
        f" + {int(summary['failed'])} failed" if summary["failed"] else ""
    )
    return [agent, str(int(summary["episodes"])), means[0], *shares, oracle, *means[1:], invalid]


def _mean(value: Any) -> str:
    return "-" if value is None or not math.isfinite(value) else f"{value:.2f}"


def _cell(data: Any) -> str:
    if data is None:
        return "-"
    invalid = f" {int(data['invalid'])}!" if data["invalid"] else ""
    invalid += f" {int(data['failed'])} failed" if data.get("failed") else ""
    low, high = 100 * data["low"], 100 * data["high"]
    return f"{100 * data['share']:.1f} [{low:.0f}, {high:.0f}] n={int(data['total'])}{invalid}"


def _place(result: dict[str, Any]) -> tuple[bool, str, int]:
    """Return a sort key: baselines first, then each model's rows in the order of the paper."""
    training = str(result["training"])
    return (training != "baseline", str(result["agent"]), TRAININGS.index(training))


def _beside(entry: tuple[str, Any]) -> tuple[int, str]:
    name = entry[0]
    return (
        REFERENCE_AGENTS.index(name) if name in REFERENCE_AGENTS else len(REFERENCE_AGENTS),
        name,
    )


def _label(result: dict[str, Any]) -> str:
    training = str(result["training"])
    return f"{result['agent']} ({training})"
