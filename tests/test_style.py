"""The limits that keep the code small: style is a test, so that it cannot slip."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[1] / "src" / "world2minecraft"
FILES = sorted(SOURCE.rglob("*.py"))
MAX_FILE_LINES = 350
MAX_FUNCTION_LINES = 60
MAX_KERNEL_LINES = 80  # Compiled loops carry much state, and calls with that much state cost.
EMPTY_NAMES = ("utils", "util", "helpers", "helper", "common", "misc")

Function = ast.FunctionDef | ast.AsyncFunctionDef
each_file = pytest.mark.parametrize(
    "path", FILES, ids=lambda path: str(path.relative_to(SOURCE).as_posix())
)


def functions(tree: ast.AST) -> list[Function]:
    return [
        node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    ]


def public_functions(tree: ast.Module) -> list[Function]:
    """The functions of a module and the methods of its public classes that others may call."""
    bodies = [tree.body]
    bodies += [
        node.body for node in tree.body if isinstance(node, ast.ClassDef) and node.name[0] != "_"
    ]
    return [
        node
        for body in bodies
        for node in body
        if isinstance(node, Function) and node.name[0] != "_"
    ]


def untyped(function: Function) -> list[str]:
    arguments = function.args
    every = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    every += [extra for extra in (arguments.vararg, arguments.kwarg) if extra]
    missing = [a.arg for a in every if a.annotation is None and a.arg not in ("self", "cls")]
    return missing + ([] if function.returns is not None else ["return"])


def is_kernel(function: Function) -> bool:
    """Whether it is compiled by numba, which finds the types itself."""
    names = [node.id for node in function.decorator_list if isinstance(node, ast.Name)]
    return bool({"njit", "lean", "inlined", "inner", "inner_call"} & set(names))


def limit(function: Function) -> int:
    return MAX_KERNEL_LINES if is_kernel(function) else MAX_FUNCTION_LINES


@each_file
def test_a_file_is_read_in_a_sitting(path):
    assert len(path.read_text().splitlines()) <= MAX_FILE_LINES


@each_file
def test_a_function_fits_on_a_screen(path):
    long = {
        node.name: lines
        for node in functions(ast.parse(path.read_text()))
        if (lines := (node.end_lineno or 0) - node.lineno + 1) > limit(node)
    }
    assert not long


@each_file
def test_public_functions_are_typed_and_documented(path):
    tree = ast.parse(path.read_text())
    assert ast.get_docstring(tree), "a file starts with what it is for"
    public = public_functions(tree)
    faults = {node.name: untyped(node) for node in public if untyped(node) and not is_kernel(node)}
    faults |= {node.name: ["docstring"] for node in public if not ast.get_docstring(node)}
    assert not faults


@each_file
def test_the_library_neither_prints_nor_asserts(path):
    nodes = list(ast.walk(ast.parse(path.read_text())))
    asserts = [node.lineno for node in nodes if isinstance(node, ast.Assert)]
    prints = [
        node.lineno
        for node in nodes
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "print"
    ]
    assert not asserts
    assert not prints or path.relative_to(SOURCE).parts[0] == "cli"


@each_file
def test_a_name_says_what_it_holds(path):
    assert path.stem not in EMPTY_NAMES
    assert path.parent.name not in EMPTY_NAMES


@each_file
def test_no_work_is_left_for_later(path):
    marks = [line for line in path.read_text().splitlines() if "TODO" in line or "FIXME" in line]
    assert not marks


@each_file
def test_numba_is_reached_through_jit_alone(path):
    if path == SOURCE / "jit.py":
        return
    tree = ast.parse(path.read_text())
    names = [
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    ]
    names += [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert not [name for name in names if name == "numba.njit" or name == "numba"]


def test_no_two_test_files_have_one_name():
    """pytest collects a folder of tests by bare names: the second of two would not run."""
    names = [path.name for path in Path(__file__).parent.rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))
