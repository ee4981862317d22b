"""Number and accuracy of the display entities that represent furniture.

``python -m benchmarks.check_display_entities [--json FILE]``

Each design of the library is made at its smallest, usual and largest size, rotated by 20 degrees,
and written as display entities. ``wrong`` is the share of 2 cm cells, at the usual size, whose
centre lies in a part but in no entity or vice versa, by more than a millimetre; the entities are
read back from their NBT. It is 0 except where ``limit`` requires coarser boxes.
"""

import argparse
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from world2minecraft.construction.display.boxes import Frame, display_entities, template_boxes
from world2minecraft.construction.display.builder import max_boxes
from world2minecraft.core.coordinates import apply, block_to_room, invert
from world2minecraft.core.files import write_json
from world2minecraft.core.types import Entity
from world2minecraft.furniture import TEMPLATES, Template, template
from world2minecraft.minecraft.entities import display_cubes

CELL_M, SCALE, YAW_DEG = 0.02, 4.0, 20.0
SLACK_M = 0.001
CORNER_M = np.zeros(2)


class Row(NamedTuple):
    """What one design takes."""

    name: str
    family: str
    counts: tuple[int, int, int]  # at the smallest, the usual and the largest size
    limit: int
    wrong: float


def sizes_of(one: Template) -> list[np.ndarray]:
    """Return its smallest, usual and largest size, float64 [3] in metres."""
    return [
        np.array([getattr(span, end) for span in one.size_m])
        for end in ("minimum", "typical", "maximum")
    ]


def entities_at(one: Template, size: np.ndarray) -> tuple[list[Entity], Frame]:
    """Return the entities of a design that stands turned, and its frame."""
    parts = one.parts(size)
    states = [_block_of(one, part.role) for part in parts]
    pieces = template_boxes(parts, states, max_boxes(one), SCALE)
    frame = Frame(np.array([1.0, -1.0, 0.0]), size, YAW_DEG)
    return display_entities(pieces, frame, CORNER_M, SCALE, one.class_id, 1), frame


def _block_of(one: Template, role: str) -> str:
    material = one.materials.get(role)
    block = None if material is None else material.block("full")
    return block or "minecraft:white_concrete"


def wrong_of(one: Template, size: np.ndarray) -> float:
    """Return the share of a design's 2 cm cells that its entities show wrongly."""
    entities, frame = entities_at(one, size)
    boxes = np.array([part.box_m for part in one.parts(size)]).reshape(-1, 2, 3)
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    axes = [np.arange(a + CELL_M / 2, b, CELL_M) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    inside, nearly = np.zeros((2, len(points)), bool)
    for start, end in boxes:
        inside |= ((points > start + SLACK_M) & (points < end - SLACK_M)).all(axis=1)
        nearly |= ((points > start - SLACK_M) & (points < end + SLACK_M)).all(axis=1)
    world = apply(invert(block_to_room(CORNER_M, SCALE)), apply(frame.object_to_room, points))
    drawn = np.zeros(len(points), bool)
    for cube in display_cubes(entities):
        local = apply(invert(cube.cube_to_world), world)
        drawn |= ((local > -1e-5) & (local < 1 + 1e-5)).all(axis=1)
    wrong = (inside & ~drawn) | (drawn & ~nearly)
    return float(wrong.sum() / max(nearly.sum(), 1))


def row_of(name: str) -> Row:
    """Return what a design takes."""
    one = template(name)
    counts = [len(entities_at(one, size)[0]) for size in sizes_of(one)]
    wrong = wrong_of(one, sizes_of(one)[1])
    return Row(name, one.family, (counts[0], counts[1], counts[2]), max_boxes(one), wrong)


def design_table(rows: list[Row]) -> Table:
    """Return the designs in a table."""
    head = ("design", "family", "smallest", "usual", "largest", "limit", "wrong")
    table = Table(*head, title="Display entities by design")
    for row in rows:
        over = " !" if max(row.counts) > row.limit else ""
        counts = [str(count) for count in row.counts]
        table.add_row(row.name, row.family, *counts, f"{row.limit}{over}", f"{row.wrong:.3f}")
    return table


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    names = list(TEMPLATES.names())
    console = Console(width=110)
    rows = [row_of(name) for name in names]
    console.print(design_table(rows))
    if chosen.json is not None:
        write_json(chosen.json, [row._asdict() for row in rows])


if __name__ == "__main__":
    main()
