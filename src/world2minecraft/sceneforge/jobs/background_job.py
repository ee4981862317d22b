"""Long queries and plans about a large scene, computed by a job on a copy of the scene.

Editing continues meanwhile. Every tab sees the progress of the job and may cancel it. An operation
planned on the copy is applied only if the cells that it changes are still the same.
"""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import Any, TypeVar

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.jobs.jobs import CancelledError, JobProgress, Jobs

# Queries and commands that take seconds on millions of cells, with the titles of their jobs.
TITLES = {
    "floaters": "Finding floaters",
    "holes": "Finding holes",
    "doubtful": "Finding issues",
    "smooth": "Smoothing furniture",
    "remove_floaters": "Deleting floaters",
    "fill_holes": "Filling holes",
}
# The stages of these jobs. A plan that reports no progress has only ``scene``.
STAGES = ("scene", "planes", "pieces", "doubts")

Value = TypeVar("Value")


def copy_editor(editor: Editor) -> Editor:
    """Return a copy of the current scene that another thread can read and plan on."""
    held, draft = editor.opened, editor.draft
    return Editor(replace(held, grid=draft.grid(), objects=tuple(draft.objects.values())))


async def run_in_background(
    jobs: Jobs, name: str, copy: Editor, work: Callable[[Editor], Value]
) -> Value:
    """Run a function on a copy of the scene as a job, and return its result.

    Args:
        jobs: The jobs of the server.
        name: Name of the job, a key of ``TITLES``.
        copy: Copy of the scene, for this job only. The job reports the calls to its ``progress``.
        work: Function to run on the copy.

    Raises:
        UsageError: If the job is cancelled. Exceptions of ``work`` are passed on.
    """
    loop = asyncio.get_running_loop()
    answer: asyncio.Future[Value] = loop.create_future()

    def settle(act: Callable[[Any], None], value: Any) -> None:
        if not answer.done():  # The request may have ended.
            act(value)

    def run(report: JobProgress) -> None:
        """Work on the copy, and settle the answer with the result or the error."""
        try:
            report("scene", 0, 0)
            copy.progress = report
            value = work(copy)
            report("scene", 1, 1)  # The last moment to be cancelled.
        except BaseException as error:
            failure = UsageError(f"{TITLES[name]}: cancelled")
            failure = failure if isinstance(error, CancelledError) else error
            with suppress(RuntimeError):  # The server may have stopped.
                loop.call_soon_threadsafe(settle, answer.set_exception, failure)
            raise
        loop.call_soon_threadsafe(settle, answer.set_result, value)

    jobs.start(TITLES[name], run)
    return await answer
