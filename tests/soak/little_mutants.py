# SPDX-License-Identifier: GPL-2.0-or-later
"""Values of a module that come out a hundredth too large: what is worked out, asked for, returned.

What is no number ends in an error, and is refused.
"""

import ast
from collections import Counter

from soak.mutants import Mutant

LARGER = "1.01 * "
WORKED_OUT = (ast.Add, ast.Sub, ast.Mult, ast.Div)


def mutants_of(source):
    """Return all mutants of a module, in the order of its lines."""
    lines, seen, found = source.splitlines(), Counter(), []
    for function, node in _numbers(ast.parse(source)):
        old = " ".join(ast.unparse(node).split())
        what = (function, lines[node.lineno - 1].strip(), old, f"{LARGER}({old})")
        found.append(Mutant(*what, seen[what], node.lineno))
        seen[what] += 1
    return found


def mutated(source, wanted):
    """Return the module's text with a mutant in it."""
    tree = ast.parse(source)
    number = mutants_of(source).index(wanted)
    node = [node for _, node in _numbers(tree)][number]
    return ast.unparse(_Larger(node).visit(tree))


class _Larger(ast.NodeTransformer):
    def __init__(self, wanted):
        self._wanted = wanted

    def visit(self, node):
        if node is self._wanted:
            return ast.BinOp(ast.Constant(1.01), ast.Mult(), node)
        return self.generic_visit(node)


def _numbers(node, function="module"):
    """Yield what may be a number inside functions, with the function's name."""
    for child in ast.iter_child_nodes(node):
        inner = function
        if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
            inner = child.name if function == "module" else f"{function}.{child.name}"
        worked_out = isinstance(child, ast.BinOp) and isinstance(child.op, WORKED_OUT)
        read = isinstance(child, ast.Attribute) and isinstance(child.ctx, ast.Load)
        if (worked_out or read) and function != "module":
            yield function, child
        yield from _numbers(child, inner)
