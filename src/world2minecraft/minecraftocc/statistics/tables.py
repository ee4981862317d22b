"""Statistics formatted as text, as JSON and as the paper's LaTeX table."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES, display_name
from world2minecraft.minecraftocc.statistics.published_figures import (
    NYU_TRAIN_VOXELS,
    PAPER,
    PUBLISHED_SETS,
)
from world2minecraft.minecraftocc.statistics.types import (
    MIN_PICTURES,
    MIN_PIXELS,
    DatasetStatistics,
)

HEAD = (
    "data set",
    "images",
    "scenes",
    "rooms",
    "classes",
    "semantic voxels",
    "voxels/scene",
    "resolution",
)
SHOWN = 8  # Fine classes at each end of the list.
BAR = 24  # Characters of the longest bar.
_SPECIAL = {
    "\\": r"\textbackslash{}",
    "~": r"$\sim$",
    "^": r"\textasciicircum{}",
    **{letter: f"\\{letter}" for letter in "&%$#_{}"},
}


def statistics_text(statistics: DatasetStatistics) -> str:
    """Format the statistics as text: the paper's table with this data set, and its classes."""
    lines = align_columns([HEAD, *_published(), _own_row(statistics)])
    lines += ["", *_detail_lines(statistics), "", *_class_lines(statistics)]
    if statistics.fine:
        lines += ["", *_fine_lines(statistics)]
    return "\n".join(lines)


def statistics_json(statistics: DatasetStatistics) -> dict[str, Any]:
    """Return the statistics and the paper's values as a dict for JSON."""
    shares = class_shares(statistics.class_voxels)
    return {
        "name": statistics.name,
        "pictures": statistics.pictures,
        "scenes": len(statistics.scenes),
        "rooms": statistics.rooms,
        "classes": ["empty", *statistics.classes_present],
        "fine_classes": statistics.fine_classes,
        "fine_rule": {"pixels": MIN_PIXELS, "pictures": MIN_PICTURES},
        "voxels": statistics.voxels,
        "voxels_per_scene": statistics.voxels_per_scene,
        "uncut_voxels": statistics.uncut_voxels,
        "distinct_cells": statistics.distinct_cells,
        "resolution": statistics.resolution,
        "sizes_px": dict(statistics.sizes_px),
        "region": statistics.region,
        "splits": dict(statistics.splits),
        "class_voxels": dict(zip(CLASS_NAMES, statistics.class_voxels, strict=True)),
        "class_shares": dict(zip(CLASS_NAMES[1:], shares, strict=True)),
        "by_scene": [asdict(scene) for scene in statistics.scenes],
        "fine": None if statistics.fine is None else [asdict(one) for one in statistics.fine],
        "published": {
            "source": PAPER,
            "sets": [
                {**asdict(row), "voxels_per_scene": row.voxels_per_scene} for row in PUBLISHED_SETS
            ],
            "nyu_train_class_voxels": dict(zip(CLASS_NAMES, NYU_TRAIN_VOXELS, strict=True)),
        },
    }


def statistics_latex(statistics: DatasetStatistics) -> str:
    """Format the table as in the paper, for the LaTeX package ``booktabs``."""
    rows = [*_published(), _own_row(statistics)]
    head = " & ".join(rf"\textbf{{{escape_latex(word.capitalize())}}}" for word in HEAD)
    lines = [rf"\begin{{tabular}}{{l{'r' * (len(HEAD) - 2)}c}}", r"\toprule", head + r" \\"]
    lines.append(r"\midrule")
    for row in rows:
        cells = [escape_latex(word) for word in row[:-1]] + [_times(row[-1])]
        lines.append(" & ".join(cells) + r" \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}"])


def class_shares(class_voxels: Sequence[int]) -> list[float]:
    """Return the share of each of the 11 occupied classes in all occupied voxels."""
    total = sum(class_voxels[1:])
    return [count / total if total else 0.0 for count in class_voxels[1:]]


def align_columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Format rows as aligned lines, the first column to the left and the others to the right."""
    widths = [max(len(row[n]) for row in rows) for n in range(len(rows[0]))]
    return [
        "  ".join(
            word.rjust(width) if n else word.ljust(width)
            for n, (word, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def escape_latex(text: str) -> str:
    r"""Escape the special characters in a text for LaTeX.

    Example:
        >>> print(escape_latex("oak_planks & 5 %"))
        oak\_planks \& 5 \%
    """
    return "".join(_SPECIAL.get(letter, letter) for letter in text)


def format_count(number: float) -> str:
    """Format a number of cells with a suffix, as in the paper.

    Example:
        >>> format_count(23247), format_count(4_700_514), format_count(812)
        ('23.2K', '4.7M', '812')
    """
    for size, letter in ((1e9, "B"), (1e6, "M"), (1e3, "K")):
        if number >= size:
            return f"{number / size:.1f}{letter}"
    return f"{number:.0f}"


def _times(size: str) -> str:
    width, _, height = size.partition("x")
    return rf"${width} \times {height}$" if height else escape_latex(size)


def _published() -> list[tuple[str, ...]]:
    return [
        (
            row.name,
            f"{row.pictures:,}",
            f"{row.scenes:,}",
            _or_dash(row.rooms, "~"),
            f"{row.classes:,}",
            f"{row.voxels:,}",
            format_count(row.voxels_per_scene),
            row.resolution,
        )
        for row in PUBLISHED_SETS
    ]


def _own_row(statistics: DatasetStatistics) -> tuple[str, ...]:
    fine = statistics.fine_classes
    return (
        statistics.name,
        f"{statistics.pictures:,}",
        f"{len(statistics.scenes):,}",
        _or_dash(statistics.rooms),
        f"{len(statistics.classes_present) + 2 if fine is None else fine:,}",
        f"{statistics.voxels:,}",
        format_count(statistics.voxels_per_scene),
        statistics.resolution,
    )


def _or_dash(count: int | None, about: str = "") -> str:
    return "-" if count is None else f"{about}{count:,}"


def _detail_lines(statistics: DatasetStatistics) -> list[str]:
    """Return details of the data set that do not fit into the table."""
    uncut = f"{statistics.uncut_voxels:,}"
    lines = [
        "semantic voxels  counted as in the paper: occupied cells of the region of each image",
        f"                 ({statistics.region}) whose centres are inside the image;",
        f"                 {uncut} in the complete regions, as apparently counted for NYUv2",
    ]
    if statistics.distinct_cells is not None:
        share = statistics.voxels / max(statistics.distinct_cells, 1)
        lines.append(
            f"distinct cells   {statistics.distinct_cells:,} in the worlds, "
            f"each in {share:.1f} images on average"
        )
    if statistics.fine is None:
        lines.append(
            "classes          the 12 classes and unknown; this data set has no fine classes"
        )
    else:
        counted = f"{statistics.fine_classes:,} of {len(statistics.fine):,} fine classes"
        rule = f"at least {MIN_PIXELS} pixels in {MIN_PICTURES} or more images"
        lines.append(f"classes          {counted} have {rule}:")
        pieces = sum(one.is_furniture for one in statistics.fine if one.is_seen_enough)
        blocks = (statistics.fine_classes or 0) - pieces
        lines.append(f"                 {blocks:,} blocks, {pieces:,} pieces of furniture;")
        present = len(statistics.classes_present)
        lines.append(f"                 {present} of the 11 occupied classes are present")
    if statistics.rooms is None:
        lines.append("rooms            not known for all scenes")
    if len(statistics.sizes_px) > 1:
        sizes = ", ".join(f"{size} ({count:,})" for size, count in statistics.sizes_px.items())
        lines.append(f"resolutions      {sizes}")
    splits = ", ".join(f"{name} {count:,}" for name, count in statistics.splits.items())
    return [*lines, f"splits           {splits or '-'}"]


def _class_lines(statistics: DatasetStatistics) -> list[str]:
    ours, theirs = class_shares(statistics.class_voxels), class_shares(NYU_TRAIN_VOXELS)
    largest = max([*ours, 1e-9])
    rows = [("class", "voxels", "share", "NYUv2 train")]
    rows += [
        (display_name(number), f"{count:,}", f"{share:.1%}", f"{nyu:.1%}")
        for number, (count, share, nyu) in enumerate(
            zip(statistics.class_voxels[1:], ours, theirs, strict=True), 1
        )
    ]
    bars = ["", *("#" * round(BAR * share / largest) for share in ours)]
    return [f"{line}  {bar}".rstrip() for line, bar in zip(align_columns(rows), bars, strict=True)]


def _fine_lines(statistics: DatasetStatistics) -> list[str]:
    """Return the most and the least frequent of the counted fine classes."""
    counted = [one for one in statistics.fine or () if one.is_seen_enough]
    ends = [counted] if len(counted) <= 2 * SHOWN else [counted[:SHOWN], counted[-SHOWN:]]
    rows: list[tuple[str, ...]] = [("fine class", "pixels", "images")]
    for part in ends:
        rows += [(one.name, f"{one.pixels:,}", f"{one.pictures:,}") for one in part]
    lines = align_columns(rows)
    if len(ends) == 2:
        lines.insert(1 + SHOWN, f"... {len(counted) - 2 * SHOWN:,} more ...")
    return lines
