"""The simplest engine: this process, one item after another."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any


class HereEngine:
    """Calls a task in this process."""

    def __init__(self):
        """Begin with no notes."""
        self.notes: list[str] = []

    def __enter__(self) -> "HereEngine":
        """Return the engine."""
        return self

    def __exit__(self, *_: object) -> None:
        """End; there is nothing to end."""

    def run(
        self,
        task: Callable[[Any, Callable[[int], None]], Any],
        items: Sequence[Any],
        tick: Callable[[int], None],
    ) -> Iterator[tuple[int, Any]]:
        """Give each item's number and result, in order."""
        for number, item in enumerate(items):
            yield number, task(item, tick)
