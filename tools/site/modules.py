"""MkDocs hook: a page for each package of the library, from its docstrings.

A page holds the package and its public modules in the order of their names; sub-packages have pages
of their own. The command line and the server of SceneForge are left out: they are not a library.
"""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

SOURCE = Path(__file__).parents[2] / "src" / "world2minecraft"
LEFT_OUT = {"api", "cli", "sceneforge"}  # docs/reference/api.md shows the first.
# What ``nav`` says where these pages belong.
PLACE = "API"


def on_files(files: Any, config: Any) -> Any:
    """Add the pages, and put them into the navigation."""
    entries: list[Any] = [{"world2minecraft": "api/root.md"}]
    files.append(File.generated(config, "api/root.md", content=_root()))
    for folder in _packages(SOURCE):
        name = _dotted(folder)
        page = f"api/{name}.md"
        files.append(File.generated(config, page, content=_page(name, folder)))
        entries.append({name: page})
    (place,) = [entry for entry in config.nav if PLACE in entry]
    place[PLACE] = [*place[PLACE], *entries]
    return files


def _packages(folder: Path) -> Iterator[Path]:
    """Yield the packages below a folder, each before its own."""
    for one in sorted(folder.iterdir()):
        if (one / "__init__.py").is_file() and one.name not in LEFT_OUT:
            yield one
            yield from _packages(one)


def _root() -> str:
    modules = "\n".join(_entry(f"world2minecraft.{name}", 2) for name in _modules(SOURCE))
    return f"# world2minecraft\n\nThe modules beside the packages.\n\n{modules}"


def _page(name: str, folder: Path) -> str:
    """Return a page's text: mkdocstrings puts in what the modules say."""
    whole = f"world2minecraft.{name}"
    own = _defined(folder / "__init__.py")
    members = "\n".join(f"        - {one}" for one in own) or "        []"
    top = f"::: {whole}\n    options:\n      show_root_heading: false\n      members:\n{members}\n"
    modules = "\n".join(_entry(f"{whole}.{one}", 2) for one in _modules(folder))
    return f"# {name}\n\n{top}\n{modules}"


def _entry(name: str, level: int) -> str:
    return f"::: {name}\n    options:\n      heading_level: {level}\n"


def _modules(folder: Path) -> list[str]:
    return sorted(one.stem for one in folder.glob("*.py") if one.stem[0] != "_")


def _defined(path: Path) -> list[str]:
    """Return the public names that a file defines itself; what it passes on has its own place."""
    tree = ast.parse(path.read_text("utf-8"))
    kinds = (ast.FunctionDef, ast.ClassDef)
    return [one.name for one in tree.body if isinstance(one, kinds) and one.name[0] != "_"]


def _dotted(folder: Path) -> str:
    return ".".join(folder.relative_to(SOURCE).parts)
