"""The interface for progress reports of long operations."""

from typing import Protocol


class Progress(Protocol):
    """A callback for progress reports of an operation with several stages.

    It receives the stage, the number of completed steps, the total number of steps (0 if unknown)
    and a short note. ``done`` never decreases within a stage, and the last call of a stage has
    ``done == total``.
    """

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report a step."""
        ...


def no_progress(stage: str, done: int, total: int, note: str = "") -> None:
    """Ignore all reports. This is the default of library functions."""
