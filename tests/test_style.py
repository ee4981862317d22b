"""Style that no linter checks: each test reports all offenders at once."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "src" / "world2minecraft"
MAX_MODULE_LINES = 700
MAX_FUNCTION_LINES = 60
MAX_KERNEL_LINES = 80  # Compiled loops carry much state, and calls with that much state cost.
EMPTY_NAMES = ("utils", "util", "helpers", "helper", "common", "misc")
KERNELS = {"njit", "lean", "inlined", "inner", "inner_call"}

Function = ast.FunctionDef | ast.AsyncFunctionDef


@cache
def sources() -> dict[str, tuple[str, ast.Module]]:
    """The text and the syntax tree of each module, by its path within the package."""
    paths = sorted(SOURCE.rglob("*.py"))
    texts = {path.relative_to(SOURCE).as_posix(): path.read_text() for path in paths}
    return {name: (text, ast.parse(text)) for name, text in texts.items()}


def functions() -> Iterator[tuple[str, Function]]:
    """All functions, each with a name to report it by."""
    for name, (_, tree) in sources().items():
        for node in ast.walk(tree):
            if isinstance(node, Function):
                yield f"{name}:{node.lineno} {node.name}", node


def public_functions(tree: ast.Module) -> Iterator[Function]:
    """The functions of a module, and the methods of its public classes, that others may call."""
    classes = [n for n in tree.body if isinstance(n, ast.ClassDef) and n.name[0] != "_"]
    for node in [*tree.body, *(member for one in classes for member in one.body)]:
        if isinstance(node, Function) and node.name[0] != "_":
            yield node


def is_kernel(function: Function) -> bool:
    """Whether numba compiles it; numba finds the types itself."""
    names = {node.id for node in function.decorator_list if isinstance(node, ast.Name)}
    return bool(KERNELS & names)


def untyped(function: Function) -> list[str]:
    """The parameters without a type, and ``return`` where that has none."""
    of = function.args
    every = [*of.posonlyargs, *of.args, *of.kwonlyargs, *filter(None, [of.vararg, of.kwarg])]
    missing = [a.arg for a in every if a.annotation is None and a.arg not in ("self", "cls")]
    return missing + ([] if function.returns is not None else ["return"])


def test_modules_are_read_in_a_sitting():
    long = {
        n: lines
        for n, (text, _) in sources().items()
        if (lines := text.count("\n")) > MAX_MODULE_LINES
    }
    assert not long


def test_functions_fit_on_a_screen():
    long = {
        name: lines
        for name, node in functions()
        if (lines := code_lines(node))
        > (MAX_KERNEL_LINES if is_kernel(node) else MAX_FUNCTION_LINES)
    }
    assert not long


def code_lines(node: Function) -> int:
    """The lines of a function without its docstring."""
    first = node.body[0]
    docstring = first if ast.get_docstring(node) is not None else None
    spared = (docstring.end_lineno or 0) - docstring.lineno + 1 if docstring else 0
    return (node.end_lineno or 0) - node.lineno + 1 - spared


def test_public_functions_are_typed_and_documented():
    faults = [
        f"{name}: no docstring" for name, (_, t) in sources().items() if not ast.get_docstring(t)
    ]
    for name, (_, tree) in sources().items():
        for node in public_functions(tree):
            missing = [] if is_kernel(node) else untyped(node)
            missing += [] if ast.get_docstring(node) else ["docstring"]
            faults += [f"{name}:{node.lineno} {node.name}: {missing}"] if missing else []
    assert not faults


def test_the_library_neither_prints_nor_asserts():
    faults = []
    for name, (text, tree) in sources().items():
        for node in ast.walk(tree) if "print" in text or "assert" in text else ():
            printed = isinstance(node, ast.Call) and getattr(node.func, "id", "") == "print"
            if isinstance(node, ast.Assert) or (printed and not name.startswith("cli/")):
                faults.append(f"{name}:{node.lineno}")
    assert not faults


def test_module_names_say_what_is_inside():
    assert not [n for n in sources() if set(n.removesuffix(".py").split("/")) & set(EMPTY_NAMES)]


def test_no_work_is_left_for_later():
    assert not [n for n, (text, _) in sources().items() if "TODO" in text or "FIXME" in text]


def test_numba_is_imported_by_core_alone():
    def imports_numba(node: ast.AST) -> bool:
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        return "numba" in names

    users = {
        name
        for name, (text, tree) in sources().items()
        if "numba" in text and any(map(imports_numba, ast.walk(tree)))
    }
    assert users == {"core/jit.py", "core/precompile.py"}


def test_test_files_have_names_of_their_own():
    """pytest imports test files by bare names: the second of two would not run."""
    names = [path.name for path in Path(__file__).parent.rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))


def test_names_of_tests_are_at_most_60_characters():
    names = [
        f"{path.name}: {name}"
        for path in Path(__file__).parent.rglob("test_*.py")
        for name in re.findall(r"^ *(?:async )?def (test_\w+)", path.read_text(), re.MULTILINE)
        if len(name) > 60
    ]
    assert not names, f"{len(names)} of them"
