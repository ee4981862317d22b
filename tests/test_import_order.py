"""The order of the tree: imports, lazy ones too, go only from later rows to earlier ones."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[1] / "src" / "world2minecraft"

# Each row may import the rows above it, and itself where it is a single package. Packages in one
# row never import each other, but for the foundation.
FOUNDATION = (
    "classes",
    "coordinates",
    "types",
    "errors",
    "files",
    "archive",
    "registry",
    "jit",
    "progress",
    "lock",
    "machine",
)
ROWS: tuple[tuple[str, ...], ...] = (
    FOUNDATION,
    ("geometry",),
    ("minecraft",),
    ("exchange",),
    ("fit",),
    ("furniture",),
    ("walk",),
    ("render",),
    ("edit",),
    ("metrics",),
    ("models",),
    (
        "scan",
        "posing",
        "stereo",
        "register",
        "occupy",
        "fuse",
        "label",
        "find",
        "furnish",
        "build",
    ),
    ("parameters", "run_folder"),
    ("steps", "kept"),
    ("prepare", "plans", "joining"),
    ("pipeline", "rebuild"),
    ("live",),
    ("rooms",),
    ("evaluate",),
    ("report",),
    ("making",),
    ("dataset",),
    ("learn",),
    ("vln",),
    ("compare",),
    ("paper",),
    ("forge",),
    ("cli",),
)
RANK = {name: rank for rank, row in enumerate(ROWS) for name in row}
TORCH = ("torch", "lightning", "torchvision")
TORCH_FOLDERS = ("learn",)
# Networks of others, asked for by name.
TORCH_FILES = (
    "external_models/hub.py",
    "external_models/single_thread.py",
    "reconstruction/occupancy/hf_segmenter.py",
)
HEAVY_FOR_HELP = ("numpy", "numba", "scipy", "sklearn", "PIL", "rich", "jinja2", "pydantic")

FILES = sorted(SOURCE.rglob("*.py"))


def owner(path: Path) -> str:
    """The package or module of the tree that a file belongs to; '' for the root's own file."""
    first = path.relative_to(SOURCE).parts[0]
    return "" if first == "__init__.py" else first.removesuffix(".py")


def imported(tree: ast.AST, package: tuple[str, ...]) -> Iterator[str]:
    """The full dotted names that a module imports, at its top or within functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*base, *filter(None, [node.module])))
            yield from (f"{module}.{alias.name}" for alias in node.names)


def imports_of(path: Path) -> list[str]:
    package = ("world2minecraft", *path.relative_to(SOURCE).parts[:-1])
    return sorted(imported(ast.parse(path.read_text()), package))


def complaint(importer: str, name: str) -> str | None:
    """Why a module of ``importer`` may not import ``name``; None where it may."""
    parts = name.split(".")
    if parts[0] in TORCH and importer not in TORCH_FOLDERS:
        return f"imports {parts[0]}; only {', '.join(TORCH_FOLDERS)}/ may"
    if parts[0] != "world2minecraft" or len(parts) < 2 or parts[1].startswith("__"):
        return None
    target = parts[1]
    if target not in RANK:
        return f"imports {target}, which has no place in the order"
    if importer == target or {importer, target} <= set(FOUNDATION):
        return None
    if importer not in RANK:
        return "is in a package that has no place in the order" if importer else "imports a part"
    if RANK[importer] <= RANK[target]:
        return f"imports {target}, which comes beside or after it"
    return None


def test_every_package_has_its_place():
    assert {owner(path) for path in FILES} - {""} <= set(RANK)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_imports_go_upward(path):
    names = imports_of(path)
    if path.relative_to(SOURCE).as_posix() in TORCH_FILES:
        names = [name for name in names if name.split(".")[0] not in TORCH]
    complaints = [complaint(owner(path), name) for name in names]
    assert not [text for text in complaints if text]


def test_modules_do_not_import_in_circles():
    """At their top: a circle would make the order of imports matter."""
    names = {path: ".".join(("world2minecraft", *_module_parts(path))) for path in FILES}
    path_of = {name: path for path, name in names.items()}
    edges = {
        name: {target for text in _top_imports(path) if (target := _nearest(text, path_of))}
        for path, name in names.items()
    }
    assert not _circle({name: targets - {name} for name, targets in edges.items()})


@pytest.mark.parametrize(
    ("importer", "name", "reason"),
    [
        ("find", "world2minecraft.reconstruction.retrieval.match", "beside"),
        ("geometry", "world2minecraft.minecraft", "after"),
        ("types", "world2minecraft.geometry", "after"),
        ("report", "world2minecraft.cli", "after"),
        ("fuse", "torch.nn", "only learn/"),
        ("fuse", "world2minecraft.helpers", "no place"),
    ],
)
def test_a_wrong_import_is_seen(importer, name, reason):
    assert reason in (complaint(importer, name) or "")


@pytest.mark.parametrize(
    ("importer", "name"),
    [
        ("cli", "world2minecraft.sceneforge"),
        ("build", "world2minecraft.minecraft.block_states"),
        ("rooms", "world2minecraft.rendering"),
        ("types", "world2minecraft.core.classes"),
        ("learn", "torch.nn"),
        ("scan", "world2minecraft.__version__"),
    ],
)
def test_a_right_import_passes(importer, name):
    assert complaint(importer, name) is None


def test_lazy_and_relative_imports_are_seen():
    code = (
        "def f():\n    from ..furnish import match\n    from . import grids\n    import torch.nn\n"
    )
    found = sorted(imported(ast.parse(code), ("world2minecraft", "find")))
    assert found == [
        "torch.nn",
        "world2minecraft.reconstruction.instances.grids",
        "world2minecraft.reconstruction.retrieval.match",
    ]


def test_help_loads_nothing_heavy():
    """The command line's start-up imports, followed through the tree at module level."""
    seen, queue = set(), [SOURCE / "cli" / "__init__.py", SOURCE / "cli" / "verbs.py"]
    while queue:
        path = queue.pop()
        for name in _top_imports(path):
            assert name.split(".")[0] not in HEAVY_FOR_HELP, f"{path.name} imports {name}"
            target = SOURCE.parent / Path(*name.split(".")[:-1])
            for file in (target.with_suffix(".py"), target / "__init__.py"):
                if file.is_file() and file not in seen:
                    seen.add(file)
                    queue.append(file)


def _module_parts(path: Path) -> tuple[str, ...]:
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


def _top_imports(path: Path) -> list[str]:
    package = ("world2minecraft", *path.relative_to(SOURCE).parts[:-1])
    tree = ast.parse(path.read_text())
    top = [node for node in tree.body if isinstance(node, (ast.Import, ast.ImportFrom))]
    return sorted(name for node in top for name in imported(ast.Module([node], []), package))


def _nearest(name: str, known: dict[str, Path]) -> str | None:
    """The module that ``a.b.c`` means: itself, or the one that holds the name c."""
    return (
        name
        if name in known
        else (parent if (parent := name.rpartition(".")[0]) in known else None)
    )


def _circle(edges: dict[str, set[str]]) -> list[str]:
    """The modules that are left when those without imports are taken away again and again."""
    left = dict(edges)
    while free := [name for name, targets in left.items() if not targets & left.keys()]:
        for name in free:
            del left[name]
    return sorted(left)
