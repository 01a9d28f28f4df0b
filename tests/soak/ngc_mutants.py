# SPDX-License-Identifier: GPL-2.0-or-later
"""Small changes of a subroutine of G-code: what whoever watches the motion should notice.

Numbers, operators, comparisons, codes, parameters that become others of the same sub or are a
little off, words and lines left out. Comments are left alone.
"""

import re
from collections import Counter

from soak.mutants import Mutant

CODES = {"G0": ("G1",), "G1": ("G0",), "G2": ("G3",), "G3": ("G2",)}
CODES |= {"G90": ("G91",), "G91.1": ("G90.1",), "G94": ("G95",)}
OPERATORS = {" + ": (" - ",), " - ": (" + ",), " * ": (" / ",), " / ": (" * ",)}
COMPARED = {" EQ ": (" NE ",), " GT ": (" GE ", " LT "), " AND ": (" OR ",)}
FIXED = {**CODES, **OPERATORS, **COMPARED}
TOKEN = re.compile(
    r"(?P<fixed> (?:EQ|GT|AND|[-+*/]) |\bG\d+(?:\.\d)?\b)"
    r"|(?P<parameter>#(?:<\w+>|\d+))(?P<set>\s*=)?"
    r"|(?P<number>(?<![\w.#])\d+(?:\.\d+)?)"
)
WORD = re.compile(r"(?<=\s)[XYZIJKF](?:-?#(?:<\w+>|\d+)|\[)")
SCALE, SHIFT = "1.02", "0.02"  # a little off: 2 %, and two hundredths of the program's unit


def mutants_of(source):
    """Return all mutants of a sub, in the order of its lines."""
    return [mutant for mutant, _ in _mutants(source)]


def mutated(source, wanted):
    """Return the sub's text with a mutant in it."""
    return next(text for mutant, text in _mutants(source) if mutant == wanted)


def _mutants(source):
    lines, seen = source.splitlines(keepends=True), Counter()
    names = list(dict.fromkeys(re.findall(r"#<\w+>|#\d+", _code(source))))
    function = next(iter(re.findall(r"^o<(\w+)> sub", source, re.MULTILINE)), "")
    for number, line in enumerate(lines):
        for at, end, new in _changes(line, names):
            old = line[at:end].strip()
            what = (function, line.strip(), old, new.strip())
            text = "".join([*lines[:number], line[:at], new, line[end:], *lines[number + 1 :]])
            yield Mutant(*what, seen[what], number + 1), text
            seen[what] += 1


def _code(source):
    return "".join(line for line in source.splitlines(keepends=True) if not line.startswith("("))


def _changes(line, names):
    """Yield what may become another text of a line: where it begins and ends, and that text."""
    if line.startswith("(") or not line.strip():
        return
    is_control = line.lstrip().startswith("o<")
    begin = line.index(">") + 1 if is_control else 0
    if not is_control:
        yield 0, len(line), "\n"
    for token in TOKEN.finditer(line, begin):
        yield from _of_token(token, line, names)
    for word in () if is_control else WORD.finditer(line):
        yield word.start(), _end_of(line, word.end()), ""


def _of_token(token, line, names):
    at, end = token.span()
    text = token[0]
    if token["fixed"]:
        yield from ((at, end, new) for new in FIXED.get(text, ()))
    elif token["number"]:
        value = float(text)
        for new in (value + 1, value / 2 if value else -1, float(SCALE) * value):
            if new != value:
                yield at, end, f"{new:g}"
    else:
        name, end = token["parameter"], at + len(token["parameter"])
        following = names.index(name)
        yield from (
            (at, end, names[(following + step) % len(names)])
            for step in (1, len(names) // 2)
            if len(names) > step > 0
        )
        if line[at - 1] == "G":
            yield at, end, f"[5 - {name}]"
        elif not token["set"]:
            yield at, end, f"[{name} * {SCALE}]"
            yield at, end, f"[{name} + {SHIFT}]"
            yield at, end, f"[0 - {name}]"


def _end_of(line, at):
    """Return where a word ends: behind its parameter or its bracket."""
    if line[at - 1] != "[":
        return at
    depth = 1
    while depth:
        depth += {"[": 1, "]": -1}.get(line[at], 0)
        at += 1
    return at
