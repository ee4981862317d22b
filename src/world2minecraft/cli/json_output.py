"""The option ``--json`` of verbs that print results, with an optional file name."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

OPTION, FILE = "--json", "[FILE]"
STDOUT = Path("-")
JsonOutput = Annotated[
    Path | None,
    typer.Option(OPTION, metavar=FILE, help="Print all results as JSON, or write them to FILE."),
]


def prints_json(json_file: Path | None) -> bool:
    """Return whether only JSON is printed to stdout."""
    return json_file == STDOUT


def print_json(value: Any) -> None:
    """Print a value as one JSON document."""
    print(json.dumps(value, indent=1, sort_keys=True, allow_nan=False))


def complete_json_option(words: Sequence[str], options: Iterable[Any]) -> list[str]:
    """Add the file name ``-`` to a ``--json`` option without a file, for verbs with ``JsonOutput``.

    Args:
        words: Command-line arguments after the verb.
        options: Parameters of the verb.
    """
    if not any(OPTION in one.opts and one.metavar == FILE for one in options):
        return list(words)
    return [
        f"{OPTION}={STDOUT}" if word == OPTION and after[:1] == "-" != after else word
        for word, after in zip(words, [*words[1:], "--"], strict=False)
    ]
