"""Text tables of the layout comparison, with a row per method in the paper's order."""

from collections.abc import Mapping, Sequence
from typing import Any

HEADS: tuple[str, ...] = (
    "method", "scenes", "objects", "OOB", "scenes OOB", "collisions", "semantic",
    "solid collisions", "unplaced",
)  # fmt: skip
OTHER_HEADS: tuple[str, ...] = (
    "method", "corner OOB", "scenes corner OOB", "overlaps", "scenes colliding",
    "semantic precision", "semantic with structure",
)  # fmt: skip
NOTES: tuple[str, ...] = (
    (
        "OOB: share of objects out of bounds with its confidence interval; collisions: pairs "
        "per scene; semantic: share of the true categories that are present; solid "
        "collisions: pairs per scene whose solid parts overlap."
    ),
    (
        "corner OOB: LayoutGPT's rule, an object with a corner more than 10 cm outside the "
        "room; overlaps: pairs per scene with any common volume."
    ),
)


def layout_table(summaries: Mapping[str, Mapping[str, Any]]) -> list[list[str]]:
    """Return the paper's scores by method, with empty cells for unknown values."""
    rows = [list(HEADS)]
    for method, told in summaries.items():
        low, high = told["out_of_bounds_interval"]
        rate = f"{told['out_of_bounds']:.3f} ({low:.3f} to {high:.3f})"
        rows.append(
            [method, f"{told['scenes']:,}", f"{told['objects']:,}", rate,
             f"{told['scenes_out_of_bounds']:.3f}", f"{told['collisions']:.2f}",
             _known(told["semantic_integrity"], 3), f"{told['solid_collisions']:.2f}",
             f"{told['unplaced']:,}"]
        )  # fmt: skip
    return rows


def other_table(summaries: Mapping[str, Mapping[str, Any]]) -> list[list[str]]:
    """Return additional scores by method, including those by other methods' rules."""
    rows = [list(OTHER_HEADS)]
    for method, told in summaries.items():
        rows.append(
            [method, f"{told['reaching_out']:.3f}", f"{told['scenes_reaching_out']:.3f}",
             f"{told['overlaps']:.2f}", f"{told['scenes_with_collisions']:.3f}",
             _known(told["semantic_precision"], 3),
             _known(told["semantic_integrity_with_structure"], 3)]
        )  # fmt: skip
    return rows


def grade_table(
    means: Mapping[str, Mapping[str, tuple[float, float, int] | None]],
) -> list[list[str]]:
    """Return the mean grades by method, with their standard deviation over scenes."""
    rows: list[list[str]] = []
    for method, told in means.items():
        if not rows:
            rows.append(["method", "scenes", *told])
        counts = [one[2] for one in told.values() if one is not None]
        cells = ["" if one is None else f"{one[0]:.3f} +- {one[1]:.3f}" for one in told.values()]
        rows.append([method, str(max(counts, default=0)), *cells])
    return rows


def by_method(pairs: Sequence[tuple[str, Any]]) -> dict[str, list[Any]]:
    """Group values by method, in the order in which the methods first occur."""
    groups: dict[str, list[Any]] = {}
    for method, one in pairs:
        groups.setdefault(method, []).append(one)
    return groups


def _known(value: float | None, decimals: int) -> str:
    return "" if value is None else f"{value:.{decimals}f}"
