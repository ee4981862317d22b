"""Progress reports of long work to its caller."""

from typing import Protocol


class Progress(Protocol):
    """Called with the stage, the steps done, the steps in all (0 = not known) and a short note.

    ``done`` never falls within a stage, and the last call of a stage has ``done == total``.
    """

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report one step."""
        ...


def no_progress(stage: str, done: int, total: int, note: str = "") -> None:
    """Ignore every report: the default of library calls."""
