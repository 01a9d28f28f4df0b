# SPDX-License-Identifier: GPL-2.0-or-later
"""Expressions of macro controls as LinuxCNC writes them: text to text, nothing is evaluated.

What differs from LinuxCNC and is written anew or refused:

- FIX and FUP go towards and away from zero there, down and up here: written with ABS and a sign.
- MOD has the sign of what is divided there, none here: refused.
- AND, OR and XOR work on bits there and on truth here: only between bracketed comparisons.
- #0, the empty variable, has no counterpart.
"""

import re
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated, excerpt

OWN = "\0"  # before the number of a parameter of LinuxCNC's own: no program's text has it
UNSIGNED = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
OPERATOR = re.compile(r"EQ|NE|GT|GE|LT|LE|AND|XOR|OR|MOD|[-+*/]")
PARAMETER_NAME = re.compile(f"#({OWN}?[0-9]+)")
FUNCTION = re.compile(r"(SIN|COS|TAN|ASIN|ACOS|ATAN|SQRT|SQR|ABS|ROUND|FIX|FUP|LN|EXP)(?=\[)")
LONGER_NAMES = {"SQR": "SQRT"}
COMPARING = frozenset(("EQ", "NE", "GT", "GE", "LT", "LE"))
JOINING = frozenset(("AND", "OR", "XOR"))
DEEPEST_BRACKETS = 8  # brackets within brackets
LOCAL_VARIABLES = range(1, 31)  # of one call
COMMON = (range(100, 200), range(500, 1000))
OTHER_MEANING = (
    "means something else on LinuxCNC: variables are #1 to #30, #100 to #199 and #500 to #999"
)
POSITION_VARIABLES = {5041: 5420, 5042: 5421, 5043: 5422}  # of the tool, X Y Z
WITHOUT_COUNTERPART = {
    0: "the empty variable: LinuxCNC has none: give each argument in G65, without the question",
    3000: "an alarm: write M0 with a message, (MSG, …)",
    3006: "a stop with a message: write M0 (MSG, …)",
}
NONE: frozenset[int] = frozenset()


class Expression(NamedTuple):
    """An expression as LinuxCNC reads it; variables by their numbers."""

    text: str
    read: frozenset[int]  # variables in it
    is_condition: bool
    end: int  # index after it in the text


def value_from(text: str, start: int) -> Expression:
    """Return the value that is at ``start``: a number, a variable or brackets, with a sign."""
    return _operand(text, start, 0)


def bracketed_from(text: str, start: int) -> Expression:
    if text[start : start + 1] != "[":
        raise NotTranslated(f"[ is missing before {excerpt(text[start:]) or 'the end'}")
    return _brackets(text, start, 0)


def expression_from(text: str, start: int, depth: int = 0) -> Expression:
    """Return values with operators between them, as far as they go."""
    first = _operand(text, start, depth)
    parts, operators, at = [first], [], first.end
    while operator := OPERATOR.match(text, at):
        parts.append(_operand(text, operator.end(), depth))
        operators.append(operator[0])
        at = parts[-1].end
    _check_operators(parts, operators)
    return _joined(parts, operators) if operators else first


def _operand(text: str, start: int, depth: int) -> Expression:
    at = start
    while at < len(text) and text[at] in "+-":
        at += 1
    found = _unsigned(text, at, depth)
    is_negative = text[start:at].count("-") % 2
    return _value(found, f"-{found.text}") if is_negative else found


def _value(of: Expression, text: str) -> Expression:
    """Return an expression that is worked out from another's value: no condition."""
    return Expression(text, of.read, False, of.end)


def _unsigned(text: str, at: int, depth: int) -> Expression:
    if number := UNSIGNED.match(text, at):
        return Expression(number[0], NONE, False, number.end())
    if text.startswith("#", at):
        return _variable(text, at, depth)
    if text.startswith("[", at):
        return _brackets(text, at, depth)
    if function := FUNCTION.match(text, at):
        return _function(function[1], text, function.end(), depth)
    if at >= len(text):
        raise NotTranslated("a value is missing at the end")
    raise NotTranslated(f"{excerpt(text[at:])} is no number, variable or function")


def _variable(text: str, at: int, depth: int) -> Expression:
    if text.startswith("[", at + 1):
        raise NotTranslated(f"{excerpt(text[at:])}: write the variable by its number, or its value")
    digits = PARAMETER_NAME.match(text, at)
    if not digits:
        raise NotTranslated(f"{excerpt(text[at:])} is no variable: # and a number")
    variable = variable_number(digits[1])
    return Expression(f"#{variable}", frozenset((variable,)), False, digits.end())


def variable_number(digits: str) -> int:
    """Return LinuxCNC's number of a variable, or refuse one that it does not have."""
    if digits.startswith(OWN):
        return int(digits[1:])
    number = int(digits[:9])
    if number in WITHOUT_COUNTERPART:
        raise NotTranslated(f"#{number}, {WITHOUT_COUNTERPART[number]}")
    if not _is_kept(number) and number not in POSITION_VARIABLES:
        say = f'say under [variables] what it is, {digits[:9]} = "…"'
        raise NotTranslated(f"#{digits[:9]} {OTHER_MEANING}; {say}")
    return POSITION_VARIABLES.get(number, number)


def _is_kept(number: float) -> bool:
    """Whether a variable has its number on LinuxCNC, too, and no other meaning there."""
    return any(number in numbers for numbers in (LOCAL_VARIABLES, *COMMON))


def _brackets(text: str, start: int, depth: int) -> Expression:
    if depth >= DEEPEST_BRACKETS:
        raise NotTranslated(f"more than {DEEPEST_BRACKETS} brackets within brackets")
    inner = expression_from(text, start + 1, depth + 1)
    if text[inner.end : inner.end + 1] != "]":
        raise NotTranslated(f"] is missing before {excerpt(text[inner.end :]) or 'the end'}")
    return inner._replace(text=f"[{inner.text}]", end=inner.end + 1)


def _function(name: str, text: str, at: int, depth: int) -> Expression:
    argument = _brackets(text, at, depth)
    if name in ("FIX", "FUP"):
        e = argument.text
        return _value(argument, f"[{name}[ABS{e}] * [1 - 2 * [{e} LT 0]]]")
    if name != "ATAN":
        return _value(argument, f"{LONGER_NAMES.get(name, name)}{argument.text}")
    if not text.startswith("/[", argument.end):
        raise NotTranslated("ATAN needs two values, ATAN[…]/[…]: write /[1] behind it")
    below = _brackets(text, argument.end + 1, depth)
    read = argument.read | below.read
    return Expression(f"ATAN{argument.text}/{below.text}", read, False, below.end)


def _joined(parts: list[Expression], operators: list[str]) -> Expression:
    return Expression(
        " ".join([parts[0].text, *(f"{o} {p.text}" for o, p in zip(operators, parts[1:]))]),
        NONE.union(*(part.read for part in parts)),
        not (COMPARING | JOINING).isdisjoint(operators),
        parts[-1].end,
    )


def _check_operators(parts: list[Expression], operators: list[str]) -> None:
    joining = JOINING.intersection(operators)
    if joining and (
        len(set(operators)) > 1
        or not all(part.is_condition and part.text.startswith("[") for part in parts)
    ):
        name = sorted(joining)[0]
        raise NotTranslated(f"{name} is translated between comparisons in brackets only")
    if "MOD" in operators:
        raise NotTranslated("MOD has another sign on LinuxCNC: write a - b * FIX[a / b]")
    if sum(operator in COMPARING for operator in operators) > 1:
        raise NotTranslated("two comparisons in a row: put brackets around each")
