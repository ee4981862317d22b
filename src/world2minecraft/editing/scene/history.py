"""The linear history of a scene: do, undo and redo.

The next edit discards undone edits, as in most editors. Each step is written to the log, which can
be a file, before the scene changes.
"""

from typing import NamedTuple, Protocol

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene.scene_draft import SceneDraft


class Log(Protocol):
    """A log of the steps of a history.

    Operations are numbered from 0, and numbers are never reused. If a method raises an exception,
    nothing was recorded.
    """

    def do(self, operation: Operation) -> int:
        """Record an applied operation and return its number."""
        ...

    def undo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Record that an operation was undone, by whom and when."""
        ...

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Record that an operation was redone, by whom and when."""
        ...

    def operation(self, number: int) -> Operation:
        """Return the operation with a number."""
        ...


class Timeline(NamedTuple):
    """The operations that undo and redo can reach, and how many of them are applied."""

    numbers: tuple[int, ...] = ()
    kinds: tuple[str, ...] = ()
    done: int = 0

    def with_new(self, number: int, kind: str) -> "Timeline":
        """Return the timeline after a new edit, which discards undone operations."""
        kept = self.done
        return Timeline((*self.numbers[:kept], number), (*self.kinds[:kept], kind), kept + 1)

    def within(self, first: int, last: int) -> "Timeline":
        """Return the timeline restricted to the operations ``first`` to ``last`` (exclusive)."""
        return Timeline(self.numbers[first:last], self.kinds[first:last], self.done - first)

    def moved(self, steps: int) -> "Timeline":
        """Return the timeline after a redo (``steps`` 1) or an undo (``steps`` -1)."""
        return self._replace(done=self.done + steps)

    @property
    def undo_kind(self) -> str:
        """The kind of the operation that undo would undo. Empty if there is none."""
        return self.kinds[self.done - 1] if self.done else ""

    @property
    def redo_kind(self) -> str:
        """The kind of the operation that redo would redo. Empty if there is none."""
        return self.kinds[self.done] if self.done < len(self.kinds) else ""


class SceneHistory:
    """The undo and redo history of a scene. A step that raises an exception changes nothing."""

    def __init__(self, draft: SceneDraft, log: Log, line: Timeline | None = None):
        """Open the history of a scene with its timeline, which is empty if ``line`` is None."""
        self.draft, self.log, self.line = draft, log, line or Timeline()

    def do(self, operation: Operation) -> Operation:
        """Apply an operation and record it.

        Raises:
            ConflictError: If the operation does not match the scene.
        """
        self.draft.check(operation)
        number = self.log.do(operation)
        self.draft.put(operation)
        self.line = self.line.with_new(number, operation.kind)
        return operation

    def undo(self, actor: str = "", time_s: float = 0.0) -> Operation:
        """Undo the last operation and return its inverse, which was applied to the scene.

        Args:
            actor: Name of the user, for the record only.
            time_s: Time in seconds since 1970, for the record only.

        Raises:
            UsageError: If there is nothing to undo.
        """
        if not self.line.done:
            raise UsageError("nothing to undo")
        number = self.line.numbers[self.line.done - 1]
        inverse = self.log.operation(number).inverse()
        self.draft.check(inverse)
        self.log.undo(number, actor, time_s)
        self.draft.put(inverse)
        self.line = self.line.moved(-1)
        return inverse

    def redo(self, actor: str = "", time_s: float = 0.0) -> Operation:
        """Redo the last undone operation and return it.

        Args:
            actor: Name of the user, for the record only.
            time_s: Time in seconds since 1970, for the record only.

        Raises:
            UsageError: If there is nothing to redo.
        """
        if not self.line.redo_kind:
            raise UsageError("nothing to redo")
        number = self.line.numbers[self.line.done]
        operation = self.log.operation(number)
        self.draft.check(operation)
        self.log.redo(number, actor, time_s)
        self.draft.put(operation)
        self.line = self.line.moved(1)
        return operation


class MemoryLog:
    """A log that keeps operations in memory only."""

    def __init__(self):
        self.operations: list[Operation] = []

    def do(self, operation: Operation) -> int:
        """Store an operation and return its number."""
        self.operations.append(operation)
        return len(self.operations) - 1

    def undo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Do nothing, because undo steps are not recorded."""

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Do nothing, because redo steps are not recorded."""

    def operation(self, number: int) -> Operation:
        """Return the operation with a number."""
        return self.operations[number]
