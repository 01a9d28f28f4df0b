# SPDX-License-Identifier: GPL-2.0-or-later
"""Every small change that could be made to a module: what its tests should notice.

Comparisons, operators, signs, numbers, texts, conditions, arguments, calls, what is returned, and
statements left out. Documentation, annotations and imports are left alone.
"""

import ast
import copy
from collections import Counter
from typing import NamedTuple

COMPARED = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt,),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt,),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
COMPUTED = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitOr: ast.BitAnd,
    ast.BitAnd: ast.BitOr,
}
CALLED = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "any": "all", "all": "any"}

ALIKE = ("hypot", "isclose", "dist")  # whatever the order of their arguments


class Mutant(NamedTuple):
    """A change of a module: in which function, in which line (its text), from what to what.

    ``before`` counts the same changes in front of it.
    """

    function: str
    text: str
    old: str
    new: str
    before: int
    line: int

    @property
    def name(self):
        """What a list calls it: the same as long as its line reads the same."""
        again = f" ({self.before + 1})" if self.before else ""
        return f"{self.function}: {self.old} -> {self.new}{again} in: {self.text}"


def mutants_of(source):
    """Return all mutants of a module, in the order of its lines."""
    return [mutant for mutant, _ in _mutants(source)]


def mutated(source, wanted):
    """Return the module's text with a mutant in it."""
    return next(text() for mutant, text in _mutants(source) if mutant == wanted)


def _mutants(source):
    """Yield each mutant, and what gives the module's text while it is in there."""
    tree, lines, seen = ast.parse(source), source.splitlines(), Counter()
    for function, values, key, node in list(_places(tree)):
        text = lines[node.lineno - 1].strip()
        for changed in _changes(node):
            what = (function, text, _text(node), _text(changed))
            values[key] = changed
            yield Mutant(*what, seen[what], node.lineno), lambda: ast.unparse(tree)
            values[key] = node
            seen[what] += 1


def _text(node):
    if isinstance(node, ast.If):
        return f"if {ast.unparse(node.test)}"
    return " ".join(ast.unparse(node).split())


def _places(node, function="module"):
    """Yield what may change: its function, what holds it under which key, and the node."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases"):
            continue
        values = value if isinstance(value, list) else vars(node)
        for key, child in list(enumerate(value)) if values is value else [(name, value)]:
            if not isinstance(child, ast.AST) or _is_left_alone(child):
                continue
            inner = function
            if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
                inner = child.name if function == "module" else f"{function}.{child.name}"
            if isinstance(child, (ast.expr, ast.stmt)):
                yield inner, values, key, child
            yield from _places(child, inner)


def _is_left_alone(node):
    documentation = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    return documentation or isinstance(node, (ast.Import, ast.ImportFrom))


def _changes(node):
    """Yield what a node may become."""
    make = _CHANGES.get(type(node))
    if make:
        yield from make(node)


def _with(node, **fields):
    changed = copy.copy(node)
    for name, value in fields.items():
        setattr(changed, name, value)
    return changed


def _compare(node):
    for k, operator in enumerate(node.ops):
        for other in COMPARED[type(operator)]:
            yield _with(node, ops=[*node.ops[:k], other(), *node.ops[k + 1 :]])


def _compute(node):
    if type(node.op) in COMPUTED:
        yield _with(node, op=COMPUTED[type(node.op)]())


def _unary(node):
    if isinstance(node.op, (ast.USub, ast.Not)) and not isinstance(node.operand, ast.Constant):
        yield node.operand


def _boolean(node):
    yield _with(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    for k in range(len(node.values)):
        left = node.values[:k] + node.values[k + 1 :]
        yield _with(node, values=left) if len(left) > 1 else left[0]


def _constant(node):
    value = node.value
    if isinstance(value, bool):
        yield ast.Constant(not value)
    elif isinstance(value, (int, float)):
        yield ast.Constant(value + 1)
        if value:
            yield ast.Constant(value / 2 if isinstance(value, float) else 0)
    elif isinstance(value, str):
        yield ast.Constant(value + "@")


def _conditional(node):
    yield _with(node, test=ast.Constant(True))
    yield _with(node, test=ast.Constant(False))


def _call(node):
    name = getattr(node.func, "id", None)
    if name in CALLED:
        yield _with(node, func=ast.Name(CALLED[name]))
    if name in (*CALLED, *ALIKE) or any(isinstance(value, ast.Starred) for value in node.args):
        return
    for k in range(len(node.args) - 1):
        a, b = node.args[k : k + 2]
        if ast.dump(a) != ast.dump(b):
            yield _with(node, args=[*node.args[:k], b, a, *node.args[k + 2 :]])


def _returned(node):
    if node.value is not None and not (
        isinstance(node.value, ast.Constant) and node.value.value is None
    ):
        yield ast.Return(ast.Constant(None))


def _left_out(node):
    yield ast.Pass()


def _augmented(node):
    yield ast.Pass()
    if type(node.op) in COMPUTED:
        yield _with(node, op=COMPUTED[type(node.op)]())


_CHANGES = {
    ast.Compare: _compare,
    ast.BinOp: _compute,
    ast.UnaryOp: _unary,
    ast.BoolOp: _boolean,
    ast.Constant: _constant,
    ast.If: _conditional,
    ast.IfExp: _conditional,
    ast.Call: _call,
    ast.Return: _returned,
    ast.Expr: _left_out,
    ast.Raise: _left_out,
    ast.Continue: _left_out,
    ast.AugAssign: _augmented,
}
