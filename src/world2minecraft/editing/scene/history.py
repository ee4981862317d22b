"""The linear history of a scene: do, undo and redo.

The history is linear: what was undone is forgotten by the next edit, as in every editor. Each step
is in the log, which may be a file, before the scene changes.
"""

from typing import NamedTuple, Protocol

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene.scene_draft import SceneDraft


class Log(Protocol):
    """Where the steps of a history are kept. Operations have numbers from 0, never used again.

    A method that raises has kept nothing.
    """

    def do(self, operation: Operation) -> int:
        """Keep an operation that is done; return its number."""
        ...

    def undo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep that an operation was taken back, by whom and when."""
        ...

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep that an operation was done again, by whom and when."""
        ...

    def operation(self, number: int) -> Operation:
        """Return an operation."""
        ...


class Timeline(NamedTuple):
    """The operations that undo and redo can reach: numbers and kinds, and how many are done."""

    numbers: tuple[int, ...] = ()
    kinds: tuple[str, ...] = ()
    done: int = 0

    def with_new(self, number: int, kind: str) -> "Timeline":
        """Return the line after an edit: what was undone is out of reach."""
        kept = self.done
        return Timeline((*self.numbers[:kept], number), (*self.kinds[:kept], kind), kept + 1)

    def within(self, first: int, last: int) -> "Timeline":
        """Return the line of the operations at places ``first`` to before ``last`` alone."""
        return Timeline(self.numbers[first:last], self.kinds[first:last], self.done - first)

    def moved(self, steps: int) -> "Timeline":
        """Return the line with one more (1) or fewer (-1) operations done."""
        return self._replace(done=self.done + steps)

    @property
    def undo_kind(self) -> str:
        """The kind of what undo would take back; empty where there is nothing."""
        return self.kinds[self.done - 1] if self.done else ""

    @property
    def redo_kind(self) -> str:
        """The kind of what redo would do again; empty where there is nothing."""
        return self.kinds[self.done] if self.done < len(self.kinds) else ""


class SceneHistory:
    """The one that changes a scene. A step that raises has changed nothing."""

    def __init__(self, draft: SceneDraft, log: Log, line: Timeline | None = None):
        """Take a scene with the line that leads to it; nothing is done yet where it is None."""
        self.draft, self.log, self.line = draft, log, line or Timeline()

    def do(self, operation: Operation) -> Operation:
        """Do an operation. Raises ConflictError, or what the log raises."""
        self.draft.check(operation)
        number = self.log.do(operation)
        self.draft.put(operation)
        self.line = self.line.with_new(number, operation.kind)
        return operation

    def undo(self, actor: str = "", time_s: float = 0.0) -> Operation:
        """Take the last operation back; return what was done to the scene, its inverse.

        Args:
            actor: who does so; only recorded.
            time_s: when, in seconds since 1970; only recorded.

        Raises:
            UsageError: nothing is done.
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
        """Do again what was last undone; return it.

        Args:
            actor: who does so; only recorded.
            time_s: when, in seconds since 1970; only recorded.

        Raises:
            UsageError: nothing was undone since the last edit.
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
    """A log that is kept nowhere."""

    def __init__(self):
        self.operations: list[Operation] = []

    def do(self, operation: Operation) -> int:
        """Keep an operation; return its number."""
        self.operations.append(operation)
        return len(self.operations) - 1

    def undo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep nothing."""

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep nothing."""

    def operation(self, number: int) -> Operation:
        """Return an operation."""
        return self.operations[number]
