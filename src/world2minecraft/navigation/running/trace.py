"""The trace of a walk, with one line per decision: the view, the model's reply and the moves made.

``trace.jsonl`` starts with the episode and ends with its score. Lines are appended during the walk,
so a run can be followed, and the trace remains readable after a crash.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, OutputError
from world2minecraft.core.files import parse_json_lines, read_bytes, write_bytes
from world2minecraft.navigation.agents.types import Decision, Observation
from world2minecraft.navigation.agents.vlm_agent import encode_jpeg
from world2minecraft.navigation.agents.vlm_prompts import MOVE_NAMES
from world2minecraft.navigation.running.episode_runner import EpisodeWalk
from world2minecraft.navigation.types import Episode, Move, Stance

TRACE_FILE, VIEWS_FOLDER = "trace.jsonl", "views"
MAX_TRACE_BYTES = 256 << 20


class TraceWriter:
    """An observer that writes the trace of an episode into a folder."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._number = 0

    def on_begin(self, episode: Episode, agent: str) -> None:
        """Start a new trace file, and delete the images of a previous walk.

        Raises:
            OutputError: If the folder cannot be written.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            for old in (self.folder / VIEWS_FOLDER).glob("[0-9]*.jpg"):
                old.unlink()  # Left by a longer walk.
            (self.folder / TRACE_FILE).unlink(missing_ok=True)
        except OSError as error:
            raise OutputError(
                self.folder, f"cannot be written ({error.strerror or error})"
            ) from error
        self._number = 0
        goals = [list(goal) for goal in episode.goals]
        self._line(
            {
                "episode": episode.episode_id,
                "scene": episode.scene_id,
                "agent": agent,
                "instruction": episode.instruction.text,
                "goal": episode.goal_name,
                "goals": goals,
                "start": asdict(episode.start),
                "move_set": episode.move_set,
            }
        )

    def on_decision(
        self, sight: Observation, decision: Decision, made: Sequence[tuple[Move, bool]]
    ) -> None:
        """Write a decision, and the view on which it is based."""
        line: dict[str, Any] = {
            "decision": self._number,
            "step": sight.step,
            "stance": asdict(sight.stance),
            "outcome": decision.outcome,
            "moves": [MOVE_NAMES[move] for move in decision.moves],
            "made": [[MOVE_NAMES[move], collided] for move, collided in made],
            "thought": decision.thought,
            "progress": decision.progress,
            **({"told": decision.details} if decision.details else {}),
        }
        if sight.colour.shape[0] > 1:
            data = encode_jpeg(sight.colour)
            name = f"{VIEWS_FOLDER}/{self._number:04d}.jpg"
            write_bytes(self.folder / name, data)
            line |= {"view": name, "view_sha256": hashlib.sha256(data).hexdigest()}
        self._number += 1
        self._line(line)

    def on_stance(
        self, stance: Stance, step: int, decision: Decision | None, move: Move | None
    ) -> None:
        """Ignore the stance, because decisions contain it."""

    def on_end(self, walk: EpisodeWalk) -> None:
        """Write the score."""
        self._line(
            {
                "end": walk.end,
                "stance": asdict(walk.stances[-1]),
                "steps": walk.steps,
                "invalid": walk.invalid,
                "failed": walk.failed,
                "score": score_json(walk),
            }
        )

    def _line(self, value: dict[str, Any]) -> None:
        """Append a line. The file is not left open, since an interrupted walk has no end."""
        try:
            with (self.folder / TRACE_FILE).open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(value, allow_nan=False) + "\n")
        except OSError as error:
            reason = f"cannot be written ({error.strerror or error})"
            raise OutputError(self.folder / TRACE_FILE, reason) from error


def score_json(walk: EpisodeWalk) -> dict[str, Any]:
    """Return the score of a walk as JSON data, with infinite values as null."""
    fields = asdict(walk.score)
    return {
        name: None if isinstance(value, float) and value == float("inf") else value
        for name, value in fields.items()
    }


def decision_text(decision: Decision, made: Sequence[tuple[Move, bool]]) -> str:
    """Return a short description of a decision and its moves."""
    if decision.outcome != "moves":
        return f"{decision.outcome.upper()}: {decision.details.get('problem', '')}"
    words = [MOVE_NAMES[move] + (" (blocked)" if collided else "") for move, collided in made]
    return " ".join(words)


def read_trace(path: str | Path) -> list[dict[str, Any]]:
    """Return the lines of a trace: the episode, the decisions and the score.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is empty, or a line is not a JSON object.
        LimitError: If the file is too large.
    """
    data = read_bytes(path, MAX_TRACE_BYTES)
    try:
        lines = [row for _, row in parse_json_lines(data.decode(), Path(path))]
    except UnicodeDecodeError as error:
        raise DamagedFileError(path, "not a UTF-8 text file") from error
    if not lines:
        raise DamagedFileError(path, "the file is empty; expected a trace of w2m vln run")
    return lines


def traces_in(folder: Path) -> list[Path]:
    """Return the trace files of a run, one per walk.

    For a single walk, the path is returned even if the file does not exist.
    """
    several = sorted(folder.glob(f"episodes/*/{TRACE_FILE}"))
    return several if several and not (folder / TRACE_FILE).is_file() else [folder / TRACE_FILE]


def stances_of(lines: Sequence[Mapping[str, Any]], path: Path) -> list[Stance]:
    """Return the stance at each decision of a trace and at its end.

    Raises:
        DamagedFileError: If a stance is invalid.
    """
    stances = []
    for number, line in enumerate(lines, 1):
        if "stance" not in line:
            continue
        try:
            values = {key: float(value) for key, value in line["stance"].items()}
            stances.append(Stance(**values))
        except MALFORMED as error:
            raise DamagedFileError(path, f"line {number} has no valid stance ({error})") from error
        if not np.isfinite(list(values.values())).all():
            raise DamagedFileError(path, f"line {number} has a stance that is not finite")
    return stances
