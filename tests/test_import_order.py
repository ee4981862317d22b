"""The order of the tree: imports go one way, lazy and type-only ones included."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "src" / "world2minecraft"
ROOT = SOURCE.name

# A package imports only from packages above it.
ORDER = (
    "core",
    "geometry",
    "minecraft",
    "external_models",
    "formats",
    "furniture",
    "rendering",
    "editing",
    "construction",
    "capture",
    "reconstruction",
    "procgen",
    "evaluation",
    "runs",
    "minecraftocc",
    "networks",
    "navigation",
    "paper",
    "sceneforge",
    "api",
    "cli",
    "__main__",
)
# Stages of a reconstruction never import each other; pipeline.py joins them. Semantics may read
# the layout: both are the paper's labels of cells.
STAGES = ("registration", "occupancy", "fusion", "semantics", "instances", "retrieval")
TORCH = ("torch", "lightning", "torchvision")
TORCH_USERS = (
    "networks",
    "external_models.transformers_hub",
    "reconstruction.occupancy.hf_segmenter",
)
HEAVY_FOR_HELP = ("numpy", "numba", "scipy", "sklearn", "PIL", "rich", "jinja2", "pydantic")
MAX_TOP_ENTRIES = 25

Edges = dict[str, set[str]]


def module_name(path: Path) -> str:
    """The dotted name of a file without the leading ``world2minecraft.``; '' for the root's own."""
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(nodes: list[ast.stmt]) -> Iterator[str]:
    """The full dotted names that statements import, at any depth."""
    for statement in nodes:
        for node in ast.walk(statement):
            if isinstance(node, ast.Import):
                yield from (alias.name for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                base = "." * node.level + (node.module or "")
                yield from (f"{base}.{alias.name}" for alias in node.names)


@cache
def sources() -> dict[str, tuple[str, ...]]:
    """The names that each module imports, by the module's dotted name."""
    paths = sorted(SOURCE.rglob("*.py"))
    return {module_name(path): tuple(imported(ast.parse(path.read_text()).body)) for path in paths}


def module_edges(imports: dict[str, tuple[str, ...]]) -> Edges:
    """Which modules of the package each module imports."""
    edges: Edges = {}
    for module, names in imports.items():
        ours = [name.removeprefix(f"{ROOT}.") for name in names if name.startswith(f"{ROOT}.")]
        found = {n if n in imports else n.rpartition(".")[0] for n in ours}
        edges[module] = found - {module, ""}
    return edges


def unit_edges(edges: Edges, package: str) -> Edges:
    """Imports between the modules and sub-packages of one package."""
    prefix = f"{package}." if package else ""
    units: Edges = {}
    for module, targets in edges.items():
        if not module.startswith(prefix) or not module:
            continue
        unit = module.removeprefix(prefix).split(".")[0]
        inside = {t.removeprefix(prefix).split(".")[0] for t in targets if t.startswith(prefix)}
        units.setdefault(unit, set()).update(inside - {unit})
    return units


def circle(edges: Edges) -> list[str]:
    """What is left when nodes that import nothing, or that nothing imports, go again and again."""
    left = {name: targets & edges.keys() for name, targets in edges.items()}
    while True:
        used = set().union(*left.values())
        inside = {n: t & left.keys() for n, t in left.items() if n in used and t & left.keys()}
        if inside == left:
            return sorted(left)
        left = inside


def against_order(edges: Edges) -> list[str]:
    """Imports of a package from one that is not above it."""
    rank = {name: place for place, name in enumerate(ORDER)}
    faults = []
    for module, targets in edges.items():
        for target in targets:
            ours, theirs = module.split(".")[0], target.split(".")[0]
            if ours and ours != theirs and rank.get(ours, -1) <= rank.get(theirs, len(rank)):
                faults.append(f"{module} imports {target}")
    return sorted(faults)


def between_stages(edges: Edges) -> list[str]:
    """Imports of one stage of the reconstruction from another."""
    stage_of = {
        module: parts[1]
        for module in edges
        if (parts := module.split("."))[0] == "reconstruction" and parts[1:2]
    }
    return sorted(
        f"{module} imports {target}"
        for module, targets in edges.items()
        for target in targets
        if stage_of.get(module) in STAGES
        and stage_of.get(target) in STAGES
        and stage_of[module] != stage_of[target]
    )


def torch_imports(imports: dict[str, tuple[str, ...]]) -> list[str]:
    """Modules outside the networks and the adapters of hub models that import torch."""
    return sorted(
        module
        for module, names in imports.items()
        if any(name.split(".")[0] in TORCH for name in names) and not module.startswith(TORCH_USERS)
    )


def test_the_top_of_the_package_has_few_entries():
    entries = {path.name for path in SOURCE.iterdir() if path.name != "__pycache__"}
    assert len(entries) <= MAX_TOP_ENTRIES, sorted(entries)
    assert {name.removesuffix(".py") for name in entries} >= set(ORDER)


def test_packages_import_only_from_packages_above_them():
    assert against_order(module_edges(sources())) == []


def test_modules_do_not_import_in_circles():
    assert circle(module_edges(sources())) == []


def test_parts_of_one_package_do_not_import_in_circles():
    edges = module_edges(sources())
    packages = {module.rpartition(".")[0] for module in edges}
    circles = {package: circle(unit_edges(edges, package)) for package in packages}
    assert {package: found for package, found in circles.items() if found} == {}


def test_stages_do_not_import_each_other():
    assert between_stages(module_edges(sources())) == []


def test_torch_is_imported_by_networks_and_hub_adapters_only():
    assert torch_imports(sources()) == []


def test_imports_are_absolute():
    relative = {m: [n for n in names if n.startswith(".")] for m, names in sources().items()}
    assert {module: names for module, names in relative.items() if names} == {}


def test_each_rule_sees_a_fault():
    late = {"core.files": {"cli.demo"}, "cli.demo": set()}
    assert against_order(late) == ["core.files imports cli.demo"]
    assert against_order({"helpers": {"core.files"}, "core.files": set()}) != []
    assert circle({"a": {"b"}, "b": {"a"}, "c": {"a"}}) == ["a", "b"]
    parts = {"p.x.one": {"p.y.two"}, "p.y.three": {"p.x.four"}, "p.y.two": set(), "p.x.four": set()}
    assert circle(parts) == []
    assert circle(unit_edges(parts, "p")) == ["x", "y"]
    stages = {"reconstruction.fusion.a": {"reconstruction.instances.b"}}
    stages["reconstruction.instances.b"] = set()
    assert between_stages(stages) == ["reconstruction.fusion.a imports reconstruction.instances.b"]
    assert torch_imports({"capture.scan": ("torch.nn",), "networks.batch": ("torch",)}) == [
        "capture.scan"
    ]


def test_lazy_and_type_only_imports_are_seen():
    code = (
        "if TYPE_CHECKING:\n    from world2minecraft.cli import demo\n"
        "def f():\n    from world2minecraft.runs import run\n    import torch.nn\n"
    )
    found = sorted(imported(ast.parse(code).body))
    assert found == ["torch.nn", "world2minecraft.cli.demo", "world2minecraft.runs.run"]


def test_help_loads_nothing_heavy():
    """The command line's start-up imports, followed through the tree at module level."""
    seen, queue = set(), [SOURCE / "cli" / "__init__.py", SOURCE / "cli" / "verbs.py"]
    while queue:
        path = queue.pop()
        top = [n for n in ast.parse(path.read_text()).body if isinstance(n, ast.stmt)]
        names = imported([n for n in top if isinstance(n, (ast.Import, ast.ImportFrom))])
        for name in names:
            assert name.split(".")[0] not in HEAVY_FOR_HELP, f"{path.name} imports {name}"
            target = SOURCE.parent / Path(*name.split(".")[:-1])
            for file in (target.with_suffix(".py"), target / "__init__.py"):
                if file.is_file() and file not in seen:
                    seen.add(file)
                    queue.append(file)
