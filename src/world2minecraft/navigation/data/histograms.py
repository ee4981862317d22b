"""How long instructions are, drawn as the paper's figure has it: two tasks, three parts."""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import MissingExtraError
from world2minecraft.core.files import write_bytes
from world2minecraft.navigation.data.statistics import PARTS
from world2minecraft.navigation.values import TASKS, Item

SIZE_IN, DPI, BIN = (10.76, 5.56), 100, 20  # A bar for so many characters.
COLOUR = "#5684b4"


def write_histograms(items: Sequence[Item], path: str | Path) -> None:
    """Draw the lengths of instructions, in characters by item, as a PNG.

    Settings of matplotlib on this machine are left out: the same items give the same bytes.

    Raises:
        MissingExtraError: matplotlib is not installed. OutputError: it cannot be written.
    """
    try:
        import matplotlib.style  # noqa: PLC0415  # An extra, and slow to import.
        from matplotlib.figure import Figure  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("drawing histograms", "vln") from error
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
    """Return the lengths of the instructions of a task, of all items or a part of them."""
    return [
        len(item.instruction.text)
        for item in items
        if item.task == task and part in ("combined", item.composition)
    ]
