"""Lines of JSON to and from a process: one answer for each question, none of them trusted.

What comes back is bounded in size and time. A process that says too much, too late or nothing that
can be read is ended, and everything asked of it later is refused with the reason.
"""

import json
import queue
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any, NoReturn

from world2minecraft.core.errors import ServerError

MAX_LINE = 8 << 20  # Bytes: the blocks of a chunk column take up to 1 MB.
MAX_WAITING = 16  # Lines that nobody asked for.
MAX_TOLD = 500  # Characters of an error of the other side.
_LAST_WORDS = 2_000  # Bytes of what it wrote to stderr.


class Bridge:
    """A process that answers questions.

    Args:
        command: what to run.
        folder: where.
        environment: its environment; None for ours.

    Raises:
        ServerError: it cannot be started.
    """

    def __init__(
        self, command: Sequence[str], folder: Path, environment: Mapping[str, str] | None = None
    ):
        try:
            self._process = subprocess.Popen(
                list(command), cwd=folder, env=dict(environment) if environment else None,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            )  # fmt: skip
        except OSError as error:
            raise ServerError(f"cannot run {command[0]}: {error.strerror}") from error
        self._lines: queue.Queue[bytes | None] = queue.Queue(MAX_WAITING)
        self._last_words, self._asked, self._broken = b"", 0, ""
        out, err = self._process.stdout, self._process.stderr
        threading.Thread(target=self._hear, args=(out,), daemon=True).start()
        self._overhearing = threading.Thread(target=self._overhear, args=(err,), daemon=True)
        self._overhearing.start()

    def ask(self, act: str, timeout_s: float, **values: Any) -> dict[str, Any]:
        """Return the answer to an act.

        Raises:
            ServerError: the other side refuses, is silent for too long, or cannot be understood.
        """
        if self._broken:
            raise ServerError(self._broken)
        self._asked += 1
        line = json.dumps({"id": self._asked, "do": act, **values}, allow_nan=False)
        stdin = self._process.stdin
        try:
            if stdin:
                stdin.write(line.encode() + b"\n")
                stdin.flush()
        except OSError:
            self._give_up("the body on the server has ended")
        answer = self._answer(act, timeout_s)
        if "error" in answer:
            raise ServerError(f"{act}: {_plain(answer['error'])}")
        return answer

    def close(self) -> None:
        """End the process."""
        self._broken = self._broken or "the body has left the server"
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            if stream:
                try:
                    stream.close()
                except OSError:
                    continue

    def _answer(self, act: str, timeout_s: float) -> dict[str, Any]:
        end_s = time.monotonic() + timeout_s
        while True:
            try:
                line = self._lines.get(timeout=max(end_s - time.monotonic(), 0.0))
            except queue.Empty:
                self._give_up(f"{act}: no answer in {timeout_s:g} s")
            if line is None:
                self._give_up("the body on the server has ended")
            answer = self._read(line)
            if answer.get("id") == self._asked:
                return answer

    def _read(self, line: bytes) -> dict[str, Any]:
        if len(line) >= MAX_LINE:
            self._give_up(f"an answer is longer than {MAX_LINE:,} bytes")
        try:
            answer = json.loads(line)
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict):
            self._give_up("an answer is no JSON object")
        return answer

    def _give_up(self, reason: str) -> NoReturn:
        """End the process and raise why, with the last that it wrote."""
        if self._process.poll() is None:
            self._process.kill()
        self._overhearing.join(1.0)
        words = _plain(self._last_words.decode("utf-8", "replace").strip())
        self._broken = f"{reason}; its last words: {words}" if words else reason
        raise ServerError(self._broken)

    def _hear(self, stream: IO[bytes]) -> None:
        try:
            while line := stream.readline(MAX_LINE):
                self._lines.put(line, timeout=60)
        except (OSError, ValueError, queue.Full):
            pass  # It was closed, or says what nobody asked for.
        try:
            self._lines.put(None, timeout=60)
        except queue.Full:
            return

    def _overhear(self, stream: IO[bytes]) -> None:
        try:
            while part := stream.read1(_LAST_WORDS):  # type: ignore[attr-defined]
                self._last_words = (self._last_words + part)[-_LAST_WORDS:]
        except (OSError, ValueError):
            return


def _plain(text: Any) -> str:
    """Return a text of others on one line, of printable characters, not too long."""
    kept = "".join(c if c.isprintable() else " " for c in str(text)[-MAX_TOLD:])
    return " ".join(kept.split())
