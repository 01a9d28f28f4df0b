# SPDX-License-Identifier: GPL-2.0-or-later
"""Findings of what was laid along an expected toolpath."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from g12.tools.verify.compare.path import (
    EXTRA,
    FEED,
    FEED_MODE,
    MISSING,
    OFF,
    Laid,
    PathDifference,
    Point,
)
from g12.tools.verify.result.finding import Finding

ToMachine = Callable[[Point], Sequence[float]]
InWords = Callable[[Point], Sequence[tuple[str, Any]]]
PER = {False: "per minute", True: "per revolution"}


def judge_path(
    laid: Laid, line: int, file: str, to_machine: ToMachine, words: InWords | None = None
) -> Iterator[Finding]:
    """Yield the differences of a toolpath.

    ``to_machine`` makes machine coordinates of a point, ``words`` the letters and values by which
    a sentence names it, if those are others.
    """
    for difference in laid.differences:
        at = tuple(to_machine(difference.at))
        expected = difference.expected
        own = expected.line if expected and expected.line else line
        values = {"at": words(difference.at) if words else at, **_values(difference)}
        yield Finding(_code(difference), own, values, at, file)


def _code(difference: PathDifference) -> str:
    kind, expected = difference.kind, difference.expected
    if kind in (OFF, MISSING, EXTRA):
        return f"path-{kind}"
    if kind == FEED:
        return "feed-rev" if expected.per_rev else "feed"
    if kind == FEED_MODE:
        return "feed-mode"
    return "not-rapid" if expected.rapid else "rapid"


def _values(difference: PathDifference) -> Mapping[str, Any]:
    expected = difference.expected
    if expected is None:
        return {}
    values = {"what": expected.name, "size": difference.size}
    if difference.kind == FEED:
        values |= {"made": difference.size, "expected": expected.feed}
    if difference.kind == FEED_MODE:
        values |= {"made": PER[not expected.per_rev], "expected": PER[expected.per_rev]}
    return values
