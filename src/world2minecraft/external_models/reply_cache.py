"""A reply cache on disk with one line per question, so that runs can be resumed and replayed.

A line is ``{"key", "question", "reply"}``, with images replaced by their digests and without API
keys. A question without a reply has a ``failure`` instead, so that a replay fails like the original
run, while a resumed run asks again. An incomplete last line after a crash is dropped. Other damage
is an error.
"""

import json
import threading
from dataclasses import asdict
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    OutputError,
    ServerError,
    UsageError,
)
from world2minecraft.core.files import read_bytes
from world2minecraft.external_models.chat_messages import Question, Reply
from world2minecraft.external_models.chat_transport import (
    BusyServerError,
    RefusedQuestionError,
    UselessReplyError,
)

MODES = ("record", "replay")
FAILURES: dict[str, type[ServerError]] = {
    "busy": BusyServerError,
    "refused": RefusedQuestionError,
    "useless": UselessReplyError,
}
MAX_STORE_BYTES = 1 << 30
LINE_HEADS = (b'{"failure": ', b'{"key": ')  # Keys are sorted.
TYPES = {"text": str, "prompt_tokens": int, "completion_tokens": int, "finish": str}


class ReplyStore:
    """A reply cache in a file, keyed by question.

    The mode ``record`` returns known replies and adds new ones. The mode ``replay`` only returns
    known replies.
    """

    def __init__(self, path: str | Path, mode: str = "record"):
        """Open a cache, and read its file.

        Args:
            path: The cache file.
            mode: "record" or "replay".

        Raises:
            UsageError: If the mode is unknown.
            InputError: If the file to replay is missing.
            DamagedFileError: If a line is not a valid record.
            LimitError: If the file is too large.
        """
        if mode not in MODES:
            raise UsageError(f"the reply cache mode must be {' or '.join(MODES)}, got {mode!r}")
        self.path, self.mode = Path(path), mode
        self._replies: dict[str, Reply] = {}
        self._failures: dict[str, tuple[str, str]] = {}
        self._lock = threading.Lock()
        if self.path.exists():
            self._read()
        elif mode == "replay":
            raise InputError(
                path,
                "not found; a run with an output folder (--out) writes replies.jsonl",
            )

    def __len__(self) -> int:
        return len(self._replies)

    def get(self, question: Question) -> Reply | None:
        """Return the reply to a question, or None if it is not cached.

        Raises:
            InputError: If the question is unknown and the cache only replays.
            ServerError: If the cache only replays and the recorded question failed.
        """
        reply = self._replies.get(question.key)
        if reply is None and self.mode == "replay":
            if question.key in self._failures:
                kind, text = self._failures[question.key]
                raise FAILURES[kind](text)
            raise InputError(
                self.path,
                f"no reply is recorded for question {question.key[:12]}; a replay requires "
                "the same scene, model, prompts and options as the recorded run",
            )
        return reply

    def put(self, question: Question, reply: Reply) -> None:
        """Append a reply to the file.

        Raises:
            OutputError: If the file cannot be written.
        """
        fields = {name: value for name, value in asdict(reply).items() if name != "is_replayed"}
        self._replies[question.key] = Reply(**fields, is_replayed=True)
        self._add({"key": question.key, "question": question.to_record(), "reply": fields})

    def put_failure(self, question: Question, error: ServerError) -> None:
        """Append a failure of one of the kinds in ``FAILURES`` to the file.

        Raises:
            OutputError: If the file cannot be written.
        """
        for kind, own in FAILURES.items():
            if isinstance(error, own):
                failure = {"kind": kind, "text": str(error)}
                record = {"key": question.key, "question": question.to_record(), "failure": failure}
                self._add(record)

    def _add(self, line: dict[str, Any]) -> None:
        with self._lock:
            try:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                with self.path.open("a", encoding="utf-8") as stream:
                    stream.write(json.dumps(line, sort_keys=True) + "\n")
            except OSError as error:
                reason = f"cannot be written ({error.strerror or error})"
                raise OutputError(self.path, reason) from error

    def _read(self) -> None:
        data = read_bytes(self.path, MAX_STORE_BYTES)
        whole, end, rest = data.rpartition(b"\n")
        for number, line in enumerate(whole.splitlines(), start=1):
            if line.strip():
                self._take(line, number)
        if not any(rest.startswith(head) or head.startswith(rest) for head in LINE_HEADS):
            raise DamagedFileError(
                self.path,
                "the last line is not a recorded reply; check that this is a replies.jsonl file",
            )
        if rest and self.mode == "record":
            self._drop_after(len(whole) + len(end))

    def _drop_after(self, size: int) -> None:
        try:
            with self.path.open("r+b") as stream:
                stream.truncate(size)
        except OSError as error:
            raise OutputError(
                self.path, f"cannot be written ({error.strerror or error})"
            ) from error

    def _take(self, line: bytes, number: int) -> None:
        try:
            record: Any = json.loads(line)
            if not isinstance(record["key"], str):
                raise TypeError("the key must be a string")
            if "failure" in record:
                kind, text = record["failure"]["kind"], record["failure"]["text"]
                if kind not in FAILURES or not isinstance(text, str):
                    raise TypeError("unknown kind of failure")
                self._failures[record["key"]] = (kind, text)
            else:
                self._replies[record["key"]] = _parse_reply(record["reply"])
        except (ValueError, TypeError, KeyError, RecursionError) as error:
            raise DamagedFileError(
                self.path, f"line {number} is not a valid reply record ({error})"
            ) from error


def _parse_reply(fields: Any) -> Reply:
    """Parse the reply of a JSON record.

    Raises:
        TypeError: If a field has the wrong type.
        KeyError: If a field is missing.
    """
    for name, kind in TYPES.items():
        if type(fields[name]) is not kind:
            raise TypeError(f"{name} must be of type {kind.__name__}")
    return Reply(**{**fields, "is_replayed": True})
