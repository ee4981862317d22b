"""Show progress on stderr as bars in a terminal, or as plain lines elsewhere.

Both displays implement ``core.progress.Progress``. A reconstruction also shows the remaining time
of the whole run, which ``api.time_left`` estimates.
"""

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TextIO

from world2minecraft.api.time_left import TimeLeft, stages_from
from world2minecraft.core.progress import Progress

LINE_INTERVAL_S = 30.0  # Between the lines of a long stage, where there is no terminal.
WHOLE_RUN = "Whole run"

# What each stage does, as people read it. A stage that is not listed is shown by its name.
STAGE_TEXTS = {
    "ask": "Asking the model",
    "build": "Building the world",
    "capture": "Scanning the room virtually",
    "check": "Checking the blocks",
    "compile": "Compiling kernels",
    "count": "Counting cells",
    "export": "Exporting",
    "film": "Drawing the film",
    "find": "Finding objects",
    "follow": "Following the capture",
    "frames": "Reading frames",
    "furnish": "Matching furniture",
    "fuse": "Fusing depth into voxels",
    "houses": "Generating houses",
    "images": "Rendering images",
    "index": "Writing the index",
    "join": "Joining rooms",
    "judge": "Grading rooms",
    "label": "Labelling voxels",
    "layouts": "Scoring layouts",
    "load": "Loading chunks",
    "mesh": "Reading the mesh",
    "photo": "Tracing light",
    "photos": "Reading photos",
    "plan": "Building the floor plan",
    "poses": "Estimating camera poses",
    "quality": "Measuring image quality",
    "register": "Refining camera poses",
    "render": "Rendering views",
    "repair": "Comparing furniture with photos",
    "report": "Writing the report",
    "room": "Generating the room",
    "scan": "Reading the capture",
    "scenes": "Generating scenes",
    "score": "Scoring predictions",
    "seen": "Finding visible cells",
    "segment": "Segmenting images",
    "share": "Reading the room",
    "shrink": "Resizing photos",
    "stereo": "Estimating depth",
    "train": "Training",
    "truth": "Comparing with ground truth",
    "verify": "Verifying checksums",
    "views": "Planning views",
    "walks": "Planning walks",
    "ways": "Planning routes to objects",
    "words": "Rephrasing instructions",
    "write": "Writing files",
}


def stage_text(stage: str) -> str:
    """Return the description of a stage, such as "Fusing depth into voxels" for ``fuse``."""
    return STAGE_TEXTS.get(stage, stage)


@contextmanager
def show_progress(
    stream: TextIO | None = None, *, stages: Sequence[str] = (), until: str = ""
) -> Iterator[Progress]:
    """Show progress while the ``with`` block runs.

    Args:
        stream: Text stream to write to. Defaults to stderr.
        stages: Stages of the whole run, such as ``time_left.DEMO``. By default, they are inferred
            if the first reported stage is the first stage of a reconstruction.
        until: Last stage, for a reconstruction that ends early.

    Example:
        >>> import io
        >>> lines = io.StringIO()
        >>> with show_progress(lines) as progress:
        ...     progress("fuse", 0, 2)
        ...     progress("fuse", 2, 2)
        >>> lines.getvalue().splitlines()[0]
        'Fusing depth into voxels ...'
    """
    target = sys.stderr if stream is None else stream
    whole = WholeRun(stages, until)
    if target.isatty():
        with _bars(target, whole) as bars:
            yield bars
    else:
        lines = LineProgress(target, whole=whole)
        yield lines
        lines.finish()


class WholeRun:
    """The remaining time of a run with several stages, if the stages are known.

    The arguments are those of ``show_progress``.
    """

    def __init__(self, stages: Sequence[str] = (), until: str = ""):
        self._until = until
        self._estimate = TimeLeft(stages) if stages else None

    def report(self, stage: str, done: int, total: int, now_s: float) -> None:
        """Update the estimate with a progress report at time ``now_s`` in seconds."""
        if self._estimate is None and (stages := stages_from(stage)):
            last = stages.index(self._until) if self._until in stages else len(stages)
            self._estimate = TimeLeft(stages[: last + 1])
        if self._estimate is not None:
            self._estimate.report(stage, done, total, now_s)

    @property
    def is_known(self) -> bool:
        """Whether the stages of the run are known."""
        return self._estimate is not None

    def left_s(self, now_s: float) -> float | None:
        """Return the remaining time in seconds, or None if it is unknown."""
        return None if self._estimate is None else self._estimate.left_s(now_s)

    def text(self, now_s: float) -> str:
        """Return the remaining time as text in parentheses, or an empty string if it is unknown."""
        left = self.left_s(now_s)
        return "" if left is None else f" (about {format_duration(left)} left in total)"


class LineProgress:
    """Progress as text lines at the start and end of each stage, and every 30 seconds between."""

    def __init__(
        self,
        stream: TextIO,
        clock: Callable[[], float] = time.monotonic,
        whole: WholeRun | None = None,
    ):
        self._stream, self._clock = stream, clock
        self._whole = WholeRun() if whole is None else whole
        self._stage, self._began, self._note = "", 0.0, ""
        self._printed = 0.0  # When the last line was printed.

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report a step. Most steps print nothing."""
        now = self._clock()
        self._whole.report(stage, done, total, now)
        if stage != self._stage:
            self.finish()
            self._stage, self._began, self._printed = stage, now, now
            self._print(f"{stage_text(stage)} ...{self._whole.text(now)}")
        self._note = note
        if total and done >= total:
            self.finish()
        elif total and done and now - self._printed >= LINE_INTERVAL_S:
            self._printed = now
            left = format_duration((now - self._began) * (total - done) / done)
            facts = ", ".join(filter(None, (f"{done:,} of {total:,}", note, f"{left} left")))
            self._print(f"{stage_text(stage)}: {facts}{self._whole.text(now)}")

    def finish(self) -> None:
        """End the current stage, and print its duration."""
        if not self._stage:
            return
        seconds = self._clock() - self._began
        note = f" ({self._note})" if self._note else ""
        self._print(f"{stage_text(self._stage)}: done in {seconds:.1f} s{note}")
        self._stage, self._note = "", ""

    def _print(self, line: str) -> None:
        self._stream.write(f"{line}\n")
        self._stream.flush()


def format_duration(seconds: float) -> str:
    """Return a duration as a short text.

    Example:
        >>> [format_duration(seconds) for seconds in (7.2, 125, 8000)]
        ['7 s', '2 min', '2.2 h']
    """
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


@contextmanager
def _bars(stream: TextIO, whole: WholeRun) -> Iterator[Progress]:
    from rich import progress as rich_progress
    from rich.console import Console

    columns = (
        rich_progress.TextColumn("{task.description:<27}"),
        rich_progress.BarColumn(bar_width=20),
        rich_progress.TaskProgressColumn(),
        rich_progress.TimeElapsedColumn(),
        rich_progress.TextColumn("{task.fields[left]}"),
        rich_progress.TextColumn("[dim]{task.fields[note]}", markup=True),
    )
    with rich_progress.Progress(*columns, console=Console(file=stream)) as display:
        bars = BarProgress(display, whole)
        yield bars
        bars.finish()


class BarProgress:
    """Progress as bars on a rich display: one for the whole run and one for each stage."""

    def __init__(self, display: Any, whole: WholeRun, clock: Callable[[], float] = time.monotonic):
        self._display, self._whole, self._clock = display, whole, clock
        self._stage, self._began = "", clock()
        self._task: Any = None
        self._run_task: Any = None
        self._run_began = self._began

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report a step and update the bars."""
        now = self._clock()
        self._whole.report(stage, done, total, now)
        self._show_whole_run(now)
        if stage != self._stage:
            self._stage, self._began = stage, now
            self._task = self._add(stage_text(stage), total or None)
        plain = note.replace("[", "\\[")  # Brackets in a file's name are no markup.
        left = (now - self._began) * (total - done) / done if total and done else None
        self._display.update(
            self._task, completed=done, total=total or None, note=plain, left=_left_text(left)
        )
        if total and done >= total:
            self._stage = ""

    def finish(self) -> None:
        """Fill the bar of the whole run."""
        if self._run_task is not None:
            self._display.update(self._run_task, completed=1.0, left="")

    def _show_whole_run(self, now: float) -> None:
        if self._run_task is None and self._whole.is_known:
            self._run_task = self._add(WHOLE_RUN, 1.0)
        left = self._whole.left_s(now)
        if left is None:
            return
        passed = now - self._run_began
        share = passed / max(passed + left, 1e-9)
        self._display.update(self._run_task, completed=share, left=_left_text(left))

    def _add(self, text: str, total: float | None) -> Any:
        return self._display.add_task(text, total=total, note="", left="")


def _left_text(left_s: float | None) -> str:
    return f"{format_duration(left_s)} left" if left_s else ""
