"""Progress on stderr: a bar with the time left on a terminal, plain lines elsewhere.

Both are ``progress.Progress``: called with stage, done, total and note.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TextIO

from world2minecraft.core.progress import Progress

LINE_INTERVAL_S = 30.0  # Between the lines of a long stage, where there is no terminal.


@contextmanager
def show_progress(stream: TextIO | None = None) -> Iterator[Progress]:
    """Show progress while the block runs, on stderr or ``stream``.

    Example:
        >>> import io
        >>> lines = io.StringIO()
        >>> with show_progress(lines) as progress:
        ...     progress("fuse", 0, 2)
        ...     progress("fuse", 2, 2)
        >>> lines.getvalue().splitlines()[0]
        'fuse ...'
    """
    target = sys.stderr if stream is None else stream
    if target.isatty():
        with _bars(target) as bars:
            yield bars
    else:
        lines = LineProgress(target)
        yield lines
        lines.finish()


class LineProgress:
    """One line when a stage begins, one every half minute, and one, with its time, at its end."""

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic):
        self._stream, self._clock = stream, clock
        self._stage, self._began, self._note = "", 0.0, ""
        self._told = 0.0  # When the last line was printed.

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report one step; most are not printed."""
        if stage != self._stage:
            self.finish()
            self._stage, self._began = stage, self._clock()
            self._told = self._began
            print(f"{stage} ...", file=self._stream, flush=True)
        self._note = note
        if total and done >= total:
            self.finish()
        elif total and done and (now := self._clock()) - self._told >= LINE_INTERVAL_S:
            self._told = now
            left = format_duration((now - self._began) * (total - done) / done)
            told = f", {note}" if note else ""
            line = f"{stage} {done:,} of {total:,}{told}, {left} left"
            print(line, file=self._stream, flush=True)

    def finish(self) -> None:
        """End the stage that runs, if one does: stages of unknown length end with the next."""
        if not self._stage:
            return
        seconds = self._clock() - self._began
        note = f" ({self._note})" if self._note else ""
        print(f"{self._stage} done in {seconds:.1f} s{note}", file=self._stream, flush=True)
        self._stage, self._note = "", ""


def format_duration(seconds: float) -> str:
    """Return a time in two words.

    Example:
        >>> [format_duration(seconds) for seconds in (7.2, 125, 8000)]
        ['7 s', '2 min', '2.2 h']
    """
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


@contextmanager
def _bars(stream: TextIO) -> Iterator[Progress]:
    from rich import progress as rich_progress
    from rich.console import Console

    columns = (
        rich_progress.TextColumn("{task.description:<10}"),
        rich_progress.BarColumn(bar_width=28),
        rich_progress.TaskProgressColumn(),
        rich_progress.TimeElapsedColumn(),
        rich_progress.TextColumn("left"),
        rich_progress.TimeRemainingColumn(),
        rich_progress.TextColumn("[dim]{task.fields[note]}", markup=True),
    )
    with rich_progress.Progress(*columns, console=Console(file=stream)) as display:
        yield BarProgress(display)


class BarProgress:
    """One bar a stage, on a rich display; a stage that is done keeps its line and its time."""

    def __init__(self, display: Any):
        self._display = display
        self._stage = ""
        self._task: Any = None

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report one step."""
        if stage != self._stage:
            self._stage = stage
            self._task = self._display.add_task(stage, total=total or None, note="")
        plain = note.replace("[", "\\[")  # Brackets in a file's name are no markup.
        self._display.update(self._task, completed=done, total=total or None, note=plain)
        if total and done >= total:
            self._stage = ""
