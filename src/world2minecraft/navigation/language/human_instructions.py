"""Human-written instructions, read from a table and added to trajectories.

The columns are trajectory_id and instruction, and optionally annotator_id, language and level. A
trajectory can have any number of instructions.
"""

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import parse_json_lines, read_bytes
from world2minecraft.navigation.item_prompts import find_reserved_token
from world2minecraft.navigation.types import LEVELS, Instruction, Trajectory

MAX_BYTES = 64 << 20
MAX_TEXT = 4_000  # Characters; the paper's longest instruction has 334.
MAX_ROWS = 1_000_000


def read_annotations(path: str | Path) -> list[tuple[str, Instruction]]:
    """Read instructions, each with the ID of its trajectory.

    Args:
        path: A CSV file with a header row, or a JSONL file.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If a line is incomplete or invalid.
        LimitError: If the file is too large.
    """
    source = Path(path)
    try:
        text = read_bytes(source, MAX_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise DamagedFileError(source, "not a UTF-8 text file") from error
    rows = _csv_rows(text) if source.suffix.lower() == ".csv" else parse_json_lines(text, source)
    if len(rows) > MAX_ROWS:
        raise LimitError(source, f"file has {len(rows):,} lines, the limit is {MAX_ROWS:,}")
    return [_annotation(row, number, source) for number, row in rows]


def with_annotations(
    trajectories: Sequence[Trajectory], annotations: Iterable[tuple[str, Instruction]], source: str
) -> list[Trajectory]:
    """Return trajectories with human instructions added, without duplicates.

    Args:
        trajectories: The trajectories of a set.
        annotations: The result of ``read_annotations``.
        source: The name of the file for error messages.

    Raises:
        InputError: If an instruction refers to an unknown trajectory.
    """
    of = {one.trajectory_id: one for one in trajectories}
    for trajectory_id, instruction in annotations:
        if trajectory_id not in of:
            some = f"; an existing ID is {min(of)}" if of else ""
            raise InputError(
                source,
                f"refers to trajectory {trajectory_id!r}, which the set does not contain{some}",
            )
        one = of[trajectory_id]
        if instruction not in one.instructions:
            of[trajectory_id] = replace(one, instructions=(*one.instructions, instruction))
    return [of[one.trajectory_id] for one in trajectories]


def _annotation(row: Mapping[str, Any], number: int, source: Path) -> tuple[str, Instruction]:
    values = {}
    for key in ("trajectory_id", "instruction"):
        value = row.get(key)
        if not isinstance(value, str) or not value.strip() or len(value) > MAX_TEXT:
            raise DamagedFileError(
                source, f"line {number}: {key} must be a string of at most {MAX_TEXT} characters"
            )
        values[key] = value.strip()
    if mark := find_reserved_token(values["instruction"]):
        raise DamagedFileError(
            source,
            f"line {number}: text must not contain {mark!r}, which models interpret as a "
            "special token",
        )
    who, language = str(row.get("annotator_id") or ""), str(row.get("language") or "en")
    level = str(row.get("level") or "landmark")
    if level not in LEVELS:
        known = ", ".join(LEVELS)
        raise DamagedFileError(
            source, f"line {number}: level must be one of {known}, got {level!r}"
        )
    text = " ".join(values["instruction"].split())
    return values["trajectory_id"], Instruction(
        text, "human", level, annotator=who[:200], language=language[:20]
    )


def _csv_rows(text: str) -> list[tuple[int, Mapping[str, Any]]]:
    reader = csv.DictReader(io.StringIO(text), skipinitialspace=True)
    return [(number, row) for number, row in enumerate(reader, 2)]
