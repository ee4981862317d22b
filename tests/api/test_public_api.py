"""The public API: what ``import world2minecraft`` offers, and what it costs."""

import ast
import inspect
import os
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest

import world2minecraft as w2m
from world2minecraft import api

ROOT = Path(__file__).resolve().parents[2]
CLI = ROOT / "src" / "world2minecraft" / "cli"
MAX_NAMES = 42
HEAVY = ("numpy", "numba", "scipy", "PIL", "torch", "rich", "typing", "inspect", "tempfile")
# What verbs may use beside the API: errors, progress, files, the kernels' cache, the machine.
ALLOWED = ("api", "cli", "core")


def test_the_public_names_are_few_and_each_is_found():
    assert 8 <= len(w2m.__all__) <= MAX_NAMES
    for name in w2m.__all__:
        assert getattr(w2m, name) is not None, name
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        w2m.nothing  # noqa: B018


@pytest.mark.parametrize("name", api.__all__)
def test_every_public_name_is_documented(name):
    value = getattr(w2m, name)
    text = inspect.getdoc(value) or ""
    assert text.splitlines()[0].endswith("."), name
    if inspect.isfunction(value):
        assert "Example:" in text or name == "build_on_server", name  # That one needs a server.
        for parameter in inspect.signature(value).parameters:
            assert f"{parameter}:" in text, f"{name}: {parameter} is not described"


def test_the_page_of_the_api_shows_the_exceptions():
    page = (ROOT / "docs" / "reference" / "api.md").read_text()
    tree = dedent((w2m.errors.__doc__ or "").partition("::\n\n")[2].partition("\n\nEach")[0])
    assert tree.count("Error") >= 13 and tree in page


def test_importing_the_package_loads_no_library():
    code = "import sys, world2minecraft; print(*sys.modules)"
    # What measures coverage in other processes imports modules itself.
    clean = {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE_")}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=clean
    )
    assert not set(HEAVY) & set(done.stdout.split())


def test_the_table_of_homes_is_that_of_the_imports():
    tree = ast.parse(Path(api.__file__).read_text())
    imported = {
        (node.module or "").removeprefix("world2minecraft.api."): {a.name for a in node.names}
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("world2minecraft.")
    }
    assert {home: set(names) for home, names in api._MODULES.items()} == imported


def test_verbs_use_the_api_and_nothing_below_it():
    beside = {
        f"{path.relative_to(CLI)}: {module}"
        for path in sorted(CLI.rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom) and (module := node.module or "").count(".")
        if module.startswith("world2minecraft.") and module.split(".")[1] not in ALLOWED
    }
    assert not beside
