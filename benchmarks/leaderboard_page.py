"""The leaderboard as tables of a page, between two marks that tell where they come from."""

from collections.abc import Sequence
from pathlib import Path

from benchmarks.leaderboard_file import INPUTS, Entry
from world2minecraft.errors import DamagedFileError
from world2minecraft.files import read_bytes
from world2minecraft.rooms.trials import DIFFICULTIES

BEGIN = "<!-- Written by python -m benchmarks.leaderboard from leaderboard.yaml -->"
END = "<!-- The end of the leaderboard -->"
TABLES = (
    (
        "Where things are: precision and recall within one voxel, exact IoU",
        ("precision", "recall", "iou"),
    ),
    ("What they are: mIoU, object F1, fronts right", ("miou", "f1", "fronts")),
    ("How well confidence is meant: calibration error", ("calibration",)),
)


def with_tables(page: Path, entries: Sequence[Entry]) -> str:
    """Return the page's text with the tables of some rows in place of what stands there.

    Raises:
        InputError: the page is missing. DamagedFileError: it lacks the two marks.
    """
    text = read_bytes(page, 1 << 20).decode("utf-8")
    before, mark, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not mark or not end:
        raise DamagedFileError(page, f"must hold the lines {BEGIN} and {END}")
    return f"{before}{BEGIN}\n\n{tables(entries)}\n{END}{after}"


def tables(entries: Sequence[Entry]) -> str:
    """Return the tables as Markdown: rows by input, then by exact IoU and F1, best first."""
    ranked = sorted(entries, key=_rank)
    parts = [_figures(title, names, ranked) for title, names in TABLES]
    return "\n".join([*parts, _methods(ranked)])


def _rank(entry: Entry) -> tuple:
    def total(name: str) -> float:
        return sum(entry.figures[difficulty].get(name, 0.0) for difficulty in DIFFICULTIES)

    return INPUTS.index(entry.input), -total("iou"), -total("f1"), entry.key


def _figures(title: str, names: Sequence[str], entries: Sequence[Entry]) -> str:
    told = [e for e in entries if any(n in e.figures[d] for d in DIFFICULTIES for n in names)]
    if not told:
        return ""
    rows = [[f"{e.method} {e.version}", e.input, *_cells(e, names)] for e in told]
    return f"**{title}**\n\n{_table(('method', 'input', *DIFFICULTIES), rows)}"


def _cells(entry: Entry, names: Sequence[str]) -> list[str]:
    def said(value: float | None) -> str:
        return "-" if value is None else f"{value:.3f}"

    return [", ".join(said(entry.figures[d].get(n)) for n in names) for d in DIFFICULTIES]


def _methods(entries: Sequence[Entry]) -> str:
    rows = [
        [f"{e.method} {e.version}", e.input, e.date, _link(e.link), f"`{e.command}`", e.note]
        for e in entries
    ]
    heads = ("method", "input", "date", "code", "command", "note")
    return f"**Who, when, how**\n\n{_table(heads, rows)}"


def _link(link: str) -> str:
    return f"[page]({link})" if link.startswith("http") else f"`{link[:10]}`"


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(line)} |\n".replace("|  |", "| |") for line in lines)
