"""MkDocs hook: one page of all commands that measure something, from what their files say."""

import ast
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

FOLDER = Path(__file__).parents[2] / "benchmarks"
PAGE = "results/benchmarks.md"
HEAD = """# Benchmarks

Every figure of these pages comes from a command that anyone can run, in a clone of the repository.
`python -m benchmarks` (`make bench`) measures speed and peak memory against the budgets, each in a
process of its own; `--only NAME` takes one. `--checks` runs the checks of quality, and `--list`
lists all. A figure that a page calls measured once was measured with version 0.1 by the script
named there, which is in the history of the repository at commit 1f340e9.
"""


def on_files(files: Any, config: Any) -> Any:
    """Add the page."""
    files.append(File.generated(config, PAGE, content=text()))
    return files


def text() -> str:
    """Return the page's text: speed first, then checks, then the rest that can be run."""
    told = {_name(path): ast.get_docstring(_tree(path)) or "" for path in _files()}
    speed = {name: words for name, words in told.items() if name.startswith("bench_")}
    checks = {name: words for name, words in told.items() if name.startswith("check_")}
    others = {name: words for name, words in told.items() if name not in speed | checks}
    return "\n".join(
        [
            HEAD,
            _section("Speed and memory", speed),
            _section("How right it is", checks),
            _section("Training, reports, the public benchmark", others),
        ]
    )


def _section(title: str, told: dict[str, str]) -> str:
    return f"## {title}\n\n" + "\n".join(_entry(name, told[name]) for name in sorted(told))


def _entry(name: str, words: str) -> str:
    command = f"benchmarks --only {name.removeprefix('bench_')}"
    command = command if name.startswith("bench_") else f"benchmarks.{name}"
    return f"### {name}\n\n`python -m {command}`\n\n{words}\n"


def _name(path: Path) -> str:
    return path.parent.name if path.stem == "__main__" else path.stem


def _files() -> list[Path]:
    """Return the files that can be run: benchmarks by their name, others by their last lines."""
    return [*FOLDER.glob("*/__main__.py")] + [
        path
        for path in sorted(FOLDER.glob("*.py"))
        if path.stem.startswith("bench_")
        or ("__name__ ==" in path.read_text("utf-8") and path.stem != "__main__")
    ]


def _tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text("utf-8"))
