"""Show a walk live in the terminal: the agent's view, thoughts and actions.

In a terminal, the view is drawn with coloured half-block characters. Elsewhere, each decision is
printed as a line.
"""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from world2minecraft.api.agents import (
        Decision,
        Episode,
        EpisodeWalk,
        Move,
        Observation,
        Stance,
    )

VIEW_COLUMNS, VIEW_ROWS = 64, 24
MAX_ROWS = 8
UPPER = "\u2580"  # The upper half of a cell; its lower half is the background.


class LineView:
    """An observer that prints a line for each decision."""

    def __init__(self, stream: TextIO, on_begin: Callable[[], None] = lambda: None):
        self._stream, self._before_first = stream, on_begin

    def on_begin(self, episode: "Episode", agent: str) -> None:
        """Print the instruction of an episode."""
        self._before_first()
        self._before_first = lambda: None
        self._say(f"{agent}: {episode.instruction.text}")

    def on_decision(
        self, sight: "Observation", decision: "Decision", made: "Sequence[tuple[Move, bool]]"
    ) -> None:
        """Print the decision."""
        from world2minecraft.api.agents import decision_text

        thought = f"   {decision.thought}" if decision.thought else ""
        self._say(f"  {sight.step:>4}  {decision_text(decision, made)}{thought}")

    def on_stance(
        self, stance: "Stance", step: int, decision: "Decision | None", move: "Move | None"
    ) -> None:
        """Print nothing, because each decision has its own line."""

    def on_end(self, walk: "EpisodeWalk") -> None:
        """Print how the walk ended."""
        from world2minecraft.api.agents import walk_end_text

        self._say(f"  {walk_end_text(walk)}")

    def _say(self, text: str) -> None:
        print(plain_text(text), file=self._stream, flush=True)


class ScreenView(LineView):
    """An observer that shows the view in half-block characters above the latest decisions."""

    def __init__(self, display: Any, on_begin: Callable[[], None] = lambda: None):
        self._display, self._before_first = display, on_begin
        self._rows: list[tuple[str, str, str]] = []
        self._head, self._foot = "", ""
        self._view: Any = None

    def on_begin(self, episode: "Episode", agent: str) -> None:
        """Clear the table for a new walk. The first walk starts the display."""
        self._before_first()
        self._before_first = lambda: None
        self._display.start()
        self._head, self._foot, self._rows = f"{agent}: {episode.instruction.text}", "", []
        self._draw()

    def on_decision(
        self, sight: "Observation", decision: "Decision", made: "Sequence[tuple[Move, bool]]"
    ) -> None:
        """Show the view and add the decision to the table."""
        from world2minecraft.api.agents import decision_text

        if sight.colour.shape[0] > 1:
            self._view = half_blocks(sight.colour)
        row = (str(sight.step), decision_text(decision, made), decision.thought)
        self._rows = [*self._rows, row][-MAX_ROWS:]
        self._draw()

    def on_end(self, walk: "EpisodeWalk") -> None:
        """Show how the walk ended."""
        from world2minecraft.api.agents import walk_end_text

        self._foot = walk_end_text(walk)
        self._draw()

    def _draw(self) -> None:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        table = Table(box=None, expand=True)
        for name, ratio in (("step", 1), ("does", 4), ("thinks", 10)):
            table.add_column(name, ratio=ratio, overflow="fold")
        for row in self._rows:
            table.add_row(*(Text(plain_text(cell)[:300]) for cell in row))
        parts = [Text(plain_text(self._head), style="bold"), self._view, table, Text(self._foot)]
        self._display.update(Group(*(part for part in parts if part is not None)), refresh=True)


@contextmanager
def live_view(
    stream: TextIO | None = None, on_begin: Callable[[], None] = lambda: None
) -> Iterator[LineView]:
    """Yield an observer that shows walks while the ``with`` block runs.

    Args:
        stream: Text stream to write to. Defaults to stderr.
        on_begin: Callback that is called before the first walk.
    """
    target = sys.stderr if stream is None else stream
    if not target.isatty():
        yield LineView(target, on_begin)
        return
    from rich.console import Console
    from rich.live import Live

    display = Live(console=Console(file=target), auto_refresh=False)
    try:
        yield ScreenView(display, on_begin)
    finally:
        display.stop()


def half_blocks(colour: Any) -> Any:
    """Return an image, uint8 [H, W, 3], as text of coloured half-block characters."""
    import numpy as np
    from PIL import Image
    from rich.style import Style
    from rich.text import Text

    size = (VIEW_COLUMNS, 2 * VIEW_ROWS)
    small = np.asarray(Image.fromarray(colour).resize(size, Image.Resampling.BOX))
    text = Text()
    for row in range(VIEW_ROWS):
        for upper, lower in zip(small[2 * row], small[2 * row + 1], strict=True):
            text.append(UPPER, Style(color=_hex(upper), bgcolor=_hex(lower)))
        text.append("\n")
    return text


def plain_text(text: str) -> str:
    """Return a text on one line without control characters.

    Example:
        >>> plain_text("go" + chr(27) + "[2J on")
        'go [2J on'
    """
    return "".join(mark if mark.isprintable() else " " for mark in text)


def _hex(rgb: Any) -> str:
    red, green, blue = (int(value) for value in rgb)
    return f"#{red:02x}{green:02x}{blue:02x}"
