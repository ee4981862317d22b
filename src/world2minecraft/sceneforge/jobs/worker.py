"""The worker process that runs a task for a job; ``subprocess_job`` starts it.

Input: one JSON line on stdin, ``[task, {arguments}]``. Output: JSON lines, first a line ``{"stage",
"done", "total", "note"}`` for each step, then ``{"result"}`` or ``{"error"}``. The process exits
when its stdin is closed, because the program that started it has then exited.
"""

import json
import os
import sys
import threading
from typing import IO, Any

from world2minecraft.core.progress import Progress
from world2minecraft.core.registry import Registry
from world2minecraft.sceneforge.jobs.jobs import describe_error

TASKS = Registry(
    "forge_task",
    {
        "survey": "world2minecraft.sceneforge.jobs.reconstruct_tasks:survey",
        "reconstruct": "world2minecraft.sceneforge.jobs.reconstruct_tasks:reconstruct",
        "demo": "world2minecraft.sceneforge.jobs.reconstruct_tasks:demo",
        "export": "world2minecraft.sceneforge.jobs.export_tasks:export",
        "share": "world2minecraft.sceneforge.jobs.export_tasks:share",
        "install": "world2minecraft.sceneforge.jobs.export_tasks:install",
        "into_world": "world2minecraft.sceneforge.jobs.export_tasks:into_world",
        "on_server": "world2minecraft.sceneforge.jobs.export_tasks:on_server",
    },
)


def main() -> None:
    """Run the task that is named on stdin."""
    answers = take_stdout()
    task, needs = json.loads(sys.stdin.buffer.readline())
    threading.Thread(target=_end_with_stdin, daemon=True).start()
    write_line(answers, run_task(task, needs, LineProgress(answers)))


def run_task(task: str, needs: dict[str, Any], progress: Progress) -> dict[str, Any]:
    """Run a task and return its last output line, with the result or the error."""
    try:
        return {"result": TASKS.load(task)(progress=progress, **needs)}
    except Exception as error:  # Any error is reported as one line.
        return {"error": describe_error(error)}


class LineProgress:
    """A ``Progress`` callback that writes each step as a line of JSON."""

    def __init__(self, answers: IO[str]):
        self._answers = answers

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Write one step as a line of JSON."""
        step = {"stage": stage, "done": int(done), "total": int(total), "note": note}
        write_line(self._answers, step)


def write_line(answers: IO[str], line: dict[str, Any]) -> None:
    """Write one output line, and exit the process if stdout is closed."""
    try:
        answers.write(json.dumps(line) + "\n")
        answers.flush()
    except OSError:
        os._exit(1)


def take_stdout() -> IO[str]:
    """Return the stream for output lines, and redirect what libraries print to stderr."""
    stdout_copy = os.dup(1)
    os.dup2(2, 1)
    return os.fdopen(stdout_copy, "w", encoding="utf-8")


def _end_with_stdin() -> None:
    while sys.stdin.buffer.read(1 << 12):
        pass
    os._exit(1)


if __name__ == "__main__":
    main()
