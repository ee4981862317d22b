"""How long instructions are, drawn as the paper's figure has it: two tasks, three parts."""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.files import write_bytes
from world2minecraft.vln.data.statistics import PARTS
from world2minecraft.vln.values import TASKS, Item

PANEL_PX, MARGIN_PX, BIN = (300, 190), 44, 20  # A bar for so many characters.
_INK, _BAR, _PAPER = (40, 40, 46), (86, 132, 180), (255, 255, 255)


def write_histograms(items: Sequence[Item], path: str | Path) -> None:
    """Draw the lengths of instructions, in characters by item, as a PNG.

    Raises:
        OutputError: it cannot be written.
    """
    wide, high = PANEL_PX[0] + MARGIN_PX, PANEL_PX[1] + 2 * MARGIN_PX
    image = Image.new("RGB", (wide * len(PARTS) + MARGIN_PX, high * len(TASKS)), _PAPER)
    draw = ImageDraw.Draw(image)
    longest = max((len(item.instruction.text) for item in items), default=1)
    for row, task in enumerate(TASKS[::-1]):
        for column, part in enumerate(PARTS):
            lengths = [
                len(item.instruction.text)
                for item in items
                if item.task == task and part in ("combined", item.composition)
            ]
            corner = (MARGIN_PX + column * wide, MARGIN_PX + row * high)
            title = f"{task.replace('_', ' ')}, {part}: {len(lengths):,}"
            _panel(draw, corner, title, lengths, longest)
    buffer = io.BytesIO()
    image.save(buffer, "PNG")
    write_bytes(path, buffer.getvalue())


def _panel(
    draw: ImageDraw.ImageDraw,
    corner: tuple[int, int],
    title: str,
    lengths: Sequence[int],
    longest: int,
) -> None:
    left, top = corner
    wide, high = PANEL_PX
    font = ImageFont.load_default(13)
    edges = np.arange(0, longest + BIN, BIN)
    counts = np.histogram(lengths, edges)[0] if len(edges) > 1 else np.zeros(1)
    most, each = max(int(counts.max(initial=0)), 1), wide / max(len(counts), 1)
    for n, count in enumerate(counts):
        tall = high * int(count) / most
        x = left + n * each
        draw.rectangle([x + 1, top + high - tall, x + each - 1, top + high], fill=_BAR)
    draw.line([left, top, left, top + high, left + wide, top + high], fill=_INK)
    draw.text((left, top - 22), title, fill=_INK, font=font)
    draw.text((left - 4, top - 6), f"{most:,}", fill=_INK, font=font, anchor="ra")
    for value in range(0, longest + 1, 100):
        x = left + value / (BIN * len(counts)) * wide
        draw.text((x, top + high + 4), str(value), fill=_INK, font=font, anchor="ma")
