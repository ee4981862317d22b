"""The Python in the docs imports what is there."""

import ast
import re
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def imports_of(page):
    for block in BLOCK.findall(page.read_text()):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("world2mine"):
                yield from ((node.module, alias.name) for alias in node.names)


def is_there(module, name):
    try:
        return hasattr(import_module(module), name)
    except ModuleNotFoundError:
        return False


def test_python_in_the_docs_imports_what_is_there():
    found = [(page.name, *one) for page in PAGES for one in imports_of(page)]
    assert len(found) > 60
    assert not [one for one in found if not is_there(*one[1:])]
