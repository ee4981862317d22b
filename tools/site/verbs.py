"""MkDocs hook: one page of all verbs of ``w2m``, each as its ``--help`` says it."""

from typing import Any

from mkdocs.structure.files import File

from world2minecraft.cli.verbs import VERBS, load

PAGE = "reference/verbs.md"
WIDTH = 100


def on_files(files: Any, config: Any) -> Any:
    """Add the page."""
    files.append(File.generated(config, PAGE, content=text()))
    return files


def text() -> str:
    """Return the page's text."""
    rows = "\n".join(f"| [`w2m {verb}`](#{_anchor(verb)}) | {VERBS[verb]} |" for verb in VERBS)
    head = f"# All verbs\n\n`w2m VERB --help` prints the same.\n\n| verb | |\n|---|---|\n{rows}\n"
    return "\n".join([head, *(_section(verb) for verb in VERBS)])


def _section(verb: str) -> str:
    command = load(verb)
    context = command.make_context(
        f"w2m {verb}", [], resilient_parsing=True, max_content_width=WIDTH, terminal_width=WIDTH
    )
    return f"## w2m {verb} {{ #{_anchor(verb)} }}\n\n```text\n{command.get_help(context)}\n```\n"


def _anchor(verb: str) -> str:
    return verb.replace(" ", "-")
