"""The comparison as a table of text: a row a method, in the order and the manner of the paper."""

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
    "OOB: share of objects out of bounds, with its interval; collisions: pairs a scene; semantic: "
    "share of the true categories; solid collisions: pairs a scene whose solid parts meet.",
    "corner OOB: LayoutGPT's own rule, a corner over 10 cm outside; overlaps: pairs a scene that "
    "share any volume.",
)


def layout_table(summaries: Mapping[str, Mapping[str, Any]]) -> list[list[str]]:
    """Return the figures that the paper compares, by method; blank where nothing is known."""
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
    """Return the figures by the rules of others, and what stands behind the first ones."""
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
    """Return a judge's grades by method: the mean, and the deviation over scenes."""
    rows: list[list[str]] = []
    for method, told in means.items():
        if not rows:
            rows.append(["method", "scenes", *told])
        counts = [one[2] for one in told.values() if one is not None]
        cells = ["" if one is None else f"{one[0]:.3f} +- {one[1]:.3f}" for one in told.values()]
        rows.append([method, str(max(counts, default=0)), *cells])
    return rows


def by_method(pairs: Sequence[tuple[str, Any]]) -> dict[str, list[Any]]:
    """Return things by their method, in the order in which methods first come."""
    groups: dict[str, list[Any]] = {}
    for method, one in pairs:
        groups.setdefault(method, []).append(one)
    return groups


def _known(value: float | None, decimals: int) -> str:
    return "" if value is None else f"{value:.{decimals}f}"
