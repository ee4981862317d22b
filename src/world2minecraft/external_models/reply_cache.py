"""Cache of replies on disk, one line per question, so that runs can be resumed and replayed.

A line is ``{"key", "question", "reply"}``; pictures are their digests and no key of a server is in
it. Where there was no reply it has a ``failure`` instead, so that a replay fails as the run did;
a run that goes on asks again. A line that was cut by a crash is dropped, other damage is an error.
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
    """The replies of a file, by the keys of their questions.

    ``record`` returns what it has and takes what is new; ``replay`` has what it has.
    """

    def __init__(self, path: str | Path, mode: str = "record"):
        """Read the file.

        Raises:
            UsageError: no such mode. InputError: a file to replay is missing.
            DamagedFileError: a line is no reply. LimitError: it is too large.
        """
        if mode not in MODES:
            raise UsageError(f"replies are used to {' or to '.join(MODES)}, not to {mode!r}")
        self.path, self.mode = Path(path), mode
        self._replies: dict[str, Reply] = {}
        self._failures: dict[str, tuple[str, str]] = {}
        self._lock = threading.Lock()
        if self.path.exists():
            self._read()
        elif mode == "replay":
            raise InputError(path, "is not there; a run with --out writes replies.jsonl")

    def __len__(self) -> int:
        return len(self._replies)

    def get(self, question: Question) -> Reply | None:
        """Return the reply to a question, None where it was not asked yet.

        Raises:
            InputError: it was not asked, and this store only replays. ServerError: it was, and
            failed then.
        """
        reply = self._replies.get(question.key)
        if reply is None and self.mode == "replay":
            if question.key in self._failures:
                kind, text = self._failures[question.key]
                raise FAILURES[kind](text)
            raise InputError(
                self.path,
                f"has no reply to question {question.key[:12]}; a replay needs the same scene, "
                "model, prompts and options as the run that was recorded",
            )
        return reply

    def put(self, question: Question, reply: Reply) -> None:
        """Add a reply to the file. Raises OutputError."""
        fields = {name: value for name, value in asdict(reply).items() if name != "is_replayed"}
        self._replies[question.key] = Reply(**fields, is_replayed=True)
        self._add({"key": question.key, "question": question.to_record(), "reply": fields})

    def put_failure(self, question: Question, error: ServerError) -> None:
        """Add that a question failed in a way of ``FAILURES``. Raises OutputError."""
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
                reason = f"cannot be written: {error.strerror or error}"
                raise OutputError(self.path, reason) from error

    def _read(self) -> None:
        data = read_bytes(self.path, MAX_STORE_BYTES)
        whole, end, rest = data.rpartition(b"\n")
        for number, line in enumerate(whole.splitlines(), start=1):
            if line.strip():
                self._take(line, number)
        if not any(rest.startswith(head) or head.startswith(rest) for head in LINE_HEADS):
            raise DamagedFileError(self.path, "ends with what is no reply; is it another file?")
        if rest and self.mode == "record":
            self._drop_after(len(whole) + len(end))

    def _drop_after(self, size: int) -> None:
        try:
            with self.path.open("r+b") as stream:
                stream.truncate(size)
        except OSError as error:
            raise OutputError(self.path, f"cannot be written: {error.strerror or error}") from error

    def _take(self, line: bytes, number: int) -> None:
        try:
            record: Any = json.loads(line)
            if not isinstance(record["key"], str):
                raise TypeError("the key is no text")
            if "failure" in record:
                kind, text = record["failure"]["kind"], record["failure"]["text"]
                if kind not in FAILURES or not isinstance(text, str):
                    raise TypeError("the failure is of no kind")
                self._failures[record["key"]] = (kind, text)
            else:
                self._replies[record["key"]] = _parse_reply(record["reply"])
        except (ValueError, TypeError, KeyError, RecursionError) as error:
            raise DamagedFileError(self.path, f"line {number} is no reply ({error})") from error


def _parse_reply(fields: Any) -> Reply:
    """Return a reply of JSON. Raises TypeError, KeyError."""
    for name, kind in TYPES.items():
        if type(fields[name]) is not kind:
            raise TypeError(f"{name} is no {kind.__name__}")
    return Reply(**{**fields, "is_replayed": True})
