"""What the documentation of version 0.1 showed still works: commands, snippets and tutorials.

``docs_of_0_1`` holds its commands, its Python, and those of its tutorials that have since changed;
``test_tutorials`` runs these.
"""

import ast
import inspect
import re
import shlex
import warnings
from importlib import import_module
from pathlib import Path

import pytest

from world2minecraft.cli.verbs import VERBS, load

FOLDER = Path(__file__).parent / "docs_of_0_1"
COMMANDS = (FOLDER / "commands.txt").read_text().splitlines()
SNIPPET = re.compile(r"^# (\S+)\n\n```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
SNIPPETS = SNIPPET.findall((FOLDER / "snippets.md").read_text())
PACKAGE = "world2minecraft"


@pytest.fixture(scope="module")
def verbs():
    return {name: load(name) for name in VERBS}


def test_every_command_is_accepted(verbs):
    assert len(COMMANDS) > 200
    refused = {}
    for line in COMMANDS:
        words = shlex.split(line, comments=True)[1:]
        name = " ".join(words[:2]) if " ".join(words[:2]) in VERBS else words[0]
        try:
            verbs[name].make_context(name, words[len(name.split()) :])
        except Exception as error:
            refused[line] = str(error)
    assert not refused


def imported(tree):
    """The objects that a snippet imports from the package, by name."""
    found = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE):
                module = import_module(node.module or "")
                found |= {alias.asname or alias.name: getattr(module, alias.name)
                          for alias in node.names}  # fmt: skip
    return found


@pytest.mark.parametrize(("page", "code"), SNIPPETS)
def test_every_call_of_a_snippet_is_accepted(page, code):
    tree = ast.parse(code)
    try:
        names = imported(tree)
    except ImportError as error:
        if str(error.name).startswith(PACKAGE):
            raise
        pytest.skip(f"{error.name} is not installed")
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or ast.unparse(node.func) not in names:
            continue
        spread = [a for a in node.args if isinstance(a, ast.Starred)]
        if not spread and all(keyword.arg for keyword in node.keywords):
            given = {str(keyword.arg): keyword.value for keyword in node.keywords}
            inspect.signature(names[ast.unparse(node.func)]).bind(*node.args, **given)
