"""The small faults of a module: one changed operator, number or condition each.

In: a source file. Out: the faulty sources, in the order of their places. The changes are those of
cosmic-ray's operators. Of its replacements of one operator by each other one, those are taken that
keep the types: a sum becomes a difference and no shift, which any test would notice.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

BINARY = (
    *("Add_Sub", "Sub_Add", "Mul_Div", "Div_Mul", "FloorDiv_Mul", "Mod_FloorDiv", "Pow_Mul"),
    *("LShift_RShift", "RShift_LShift", "BitOr_BitAnd", "BitAnd_BitOr", "BitXor_BitAnd"),
)
COMPARISON = (
    *("Lt_LtE", "LtE_Lt", "Gt_GtE", "GtE_Gt", "Eq_NotEq", "NotEq_Eq", "Is_IsNot", "IsNot_Is"),
    *("Lt_GtE", "LtE_Gt", "Gt_LtE", "GtE_Lt"),
)
OPERATORS = (
    *(f"ReplaceBinaryOperator_{change}" for change in BINARY),
    *(f"ReplaceComparisonOperator_{change}" for change in COMPARISON),
    *(f"ReplaceUnaryOperator_Delete_{sign}" for sign in ("USub", "Invert", "Not")),
    *("NumberReplacer", "ReplaceTrueWithFalse", "ReplaceFalseWithTrue", "AddNot"),
    *("ReplaceAndWithOr", "ReplaceOrWithAnd", "ReplaceBreakWithContinue"),
    *("ReplaceContinueWithBreak", "ExceptionReplacer", "ZeroIterationForLoop"),
)
# A star there is no product: the end of the positional arguments, or what is unpacked.
NO_PRODUCT = ("parameters", "typedargslist", "dictorsetmaker")

Place = tuple[int, int]  # Line from 1, column from 0.


@dataclass(frozen=True)
class Fault:
    """One faulty source."""

    line: int  # From 1.
    before: str  # The line as it is, stripped.
    after: str  # The line with the fault, stripped.
    in_function: bool
    source: str

    @property
    def change(self) -> str:
        """What was changed, in a line."""
        return f"{self.before}  =>  {self.after}"


def faults_of(source: str) -> list[Fault]:
    """Return the faults of a module, by line; needs cosmic-ray (``make mutants`` fetches it)."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.operators.provider import OperatorProvider

    tree, known = get_ast(source), OperatorProvider()
    operators = [known[name]() for name in OPERATORS]
    silent, functions = _declarations(source), _functions(source)
    found = {}
    for node in list(ast_nodes(tree)):
        for operator in operators:
            for index, (start, _) in enumerate(list(operator.mutation_positions(node))):
                if _within(start, silent) or node.parent.type in NO_PRODUCT:
                    continue
                faulty = _mutated(tree, node, operator, index)
                if faulty == source or not _compiles(faulty):
                    continue
                line, before, after = _changed_line(source, faulty)
                found[faulty] = Fault(line, before, after, _within(start, functions), faulty)
    if tree.get_code() != source:
        raise RuntimeError("a fault was left in the source of those that followed")
    return sorted(found.values(), key=lambda fault: (fault.line, fault.change))


def _mutated(tree: Any, node: Any, operator: Any, index: int) -> str:
    """Return the source with one node changed; the tree is as before."""
    from cosmic_ray.ast import ast_nodes

    values = [(part, part.value) for part in ast_nodes(node) if hasattr(part, "value")]
    siblings, children = list(node.parent.children), list(getattr(node, "children", []))
    new = operator.mutate(node, index)
    if new is not node:
        node.parent.children[siblings.index(node)] = new
    faulty = tree.get_code()
    node.parent.children[:] = siblings
    if children:
        node.children[:] = children
    for part, value in values:
        part.value = value
    return faulty


def _compiles(source: str) -> bool:
    try:
        compile(source, "fault", "exec")
    except SyntaxError:
        return False
    return True


def _changed_line(source: str, faulty: str) -> tuple[int, str, str]:
    pairs = zip(source.splitlines(), faulty.splitlines(), strict=False)
    for number, (before, after) in enumerate(pairs, start=1):
        if before != after:
            return number, before.strip(), " ".join(after.split())
    return 1, "", ""


def _declarations(source: str) -> list[tuple[Place, Place]]:
    """The spans of annotations, decorators and ``strict=``: they declare what is so anyhow."""
    nodes: list[ast.expr | None] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.arg | ast.AnnAssign):
            nodes.append(node.annotation)
        elif isinstance(node, ast.FunctionDef):
            nodes += [node.returns, *node.decorator_list]
        elif isinstance(node, ast.keyword) and node.arg == "strict":
            nodes.append(node.value)
        elif isinstance(node, ast.ClassDef):
            nodes += node.decorator_list
    return [_span(node) for node in nodes if node is not None]


def _functions(source: str) -> list[tuple[Place, Place]]:
    """The spans of the bodies of functions: what runs when one is called."""
    bodies: Iterator[list[ast.stmt]] = (
        node.body for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)
    )
    return [(_span(body[0])[0], _span(body[-1])[1]) for body in bodies]


def _span(node: ast.expr | ast.stmt) -> tuple[Place, Place]:
    return (node.lineno, node.col_offset), (node.end_lineno or 0, node.end_col_offset or 0)


def _within(place: Place, spans: list[tuple[Place, Place]]) -> bool:
    return any(start <= place < end for start, end in spans)
