"""The effort log of a document, ``effort.jsonl``, with a line for each edit and activity signal.

Edits are recovered from the journal; the effort log only records how much work they were. Lines
lost when the program was killed are restored from the journal.
"""

import json
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, InputError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import Operation

EFFORT_FILE = "effort.jsonl"
MAX_EFFORT_BYTES = 256 << 20  # About two million lines.
ACTIVE_EVERY_S = 1.0  # Minimum interval of recorded activity signals.
REVISIONS = ("do", "undo", "redo")  # Steps that have a revision.
STEPS = ("open", *REVISIONS, "active")


class EffortLog:
    """The effort log of an open document, to which lines are appended.

    ``last_rev`` is the last revision in the log. ``fault`` is the reason why the last line could
    not be written, or empty.
    """

    def __init__(self, folder: Path):
        """Find the end of the log. An incomplete last line is removed by the next write."""
        self.path = folder / EFFORT_FILE
        self.fault = ""
        self.last_rev, self._active_s = 0, float("-inf")
        self._end = 0
        if self.path.exists():
            data = read_bytes(self.path, MAX_EFFORT_BYTES)
            self._end = data.rfind(b"\n") + 1
            self.last_rev = max(
                (e["rev"] for e in _events(data[: self._end]) if e["step"] in REVISIONS), default=0
            )

    def opened(self, time_s: float) -> None:
        """Record that a session starts."""
        self._add({"step": "open", "time_s": time_s})

    def step(self, rev: int, step: str, operation: Operation, actor: str, time_s: float) -> None:
        """Record a step. ``operation`` is the change that was made to the scene."""
        self.last_rev = max(self.last_rev, rev)
        self._active_s = time_s
        self._add(
            {
                "rev": rev,
                "step": step,
                "kind": operation.kind,
                "counts_as": operation.counts_as,
                "cells": len(operation.cells),
                "objects": len({o.id for o in operation.objects_before + operation.objects_after}),
                "class_id": operation.class_id,
                "actor": actor,
                "time_s": time_s,
            }
        )

    def active(self, time_s: float, actor: str = "") -> None:
        """Record that someone is at work, at most once every ``ACTIVE_EVERY_S`` seconds."""
        if not 0 <= time_s - self._active_s < ACTIVE_EVERY_S:
            self._active_s = time_s
            self._add({"step": "active", "actor": actor, "time_s": time_s})

    def _add(self, event: dict[str, Any]) -> None:
        line = json.dumps(event, sort_keys=True).encode() + b"\n"
        try:
            with open(self.path, "r+b" if self.path.exists() else "x+b") as stream:
                stream.truncate(self._end)
                stream.seek(self._end)
                stream.write(line)
            self._end += len(line)
            self.fault = ""
        except OSError as error:  # The edit itself is safe in the journal.
            self.fault = f"cannot write {self.path}: {error.strerror or error}"


def read_effort(folder: Path) -> list[dict[str, Any]]:
    """Return the events of a document's effort log in order. Damaged lines are skipped.

    Raises:
        InputError: If the document has no effort log.
        LimitError: If the effort log is too large.
    """
    path = folder / EFFORT_FILE
    if not path.is_file():
        raise InputError(folder, "no effort log found; pass a NAME.forge folder or its scene")
    return _events(read_bytes(path, MAX_EFFORT_BYTES))


def _events(data: bytes) -> list[dict[str, Any]]:
    events = []
    for line in data.split(b"\n"):
        try:
            event = json.loads(line)
            if event["step"] not in STEPS:
                continue
            event["time_s"] = float(event["time_s"])
            if event["step"] in REVISIONS:
                event["cells"], event["rev"] = int(event["cells"]), int(event["rev"])
                event["kind"], event["counts_as"] = str(event["kind"]), str(event["counts_as"])
                if event.get("class_id") is not None:
                    event["class_id"] = int(event["class_id"])
            events.append(event)
        except (*MALFORMED, RecursionError):
            continue
    return events
