# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state after a block, and what happens besides motion, against the words.

States are by the interpreter's names, ``_metric``, ``_feed``, in program units; events are texts
of a trace: ``M8 on``, ``S1000``, ``dwell 2``.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from types import MappingProxyType

from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.units import plain
from g12.tools.verify.expected.contour import ACTS, SectionContour
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import ANGLE, STATE, WALL

ACT = re.compile(r"(G|M\d|S|tool|dwell (?!0$))")  # of what a trace reports
UNITS, G64_OF_PREVIEW = {20.0, 21.0}, "G64 P0.1 Q0.1"
MODES = {
    "_metric": ("G20", "G21"),
    "_absolute": ("G91", "G90"),
    "_units_per_rev": ("G94", "G95"),
    "_lathe_diameter_mode": ("G8", "G7"),
    "_ijk_absolute_mode": ("G91.1", "G90.1"),
}
CODES = ("_motion_mode", "_plane")
LETTERS = {"_selected_tool": "T", "_rpm": "S"}


def judge_state(
    found: Mapping[str, float],
    expected: Mapping[str, float],
    line: int,
    allowed: Mapping[str, float] = MappingProxyType({}),
) -> Iterator[Finding]:
    """Yield the values that differ by more than is ``allowed``, or relatively by rounding.

    ``found`` is empty where the program ended in the block. Angles of C count in any turn.
    """
    for name, value in expected.items() if found else ():
        off = found[name] - value
        off = math.remainder(off, 360.0) if name == "_c" else off
        if abs(off) > allowed.get(name, STATE * max(1.0, abs(value))):
            texts = {"found": _text(name, found[name]), "expected": _text(name, value)}
            yield Finding("state", line, texts)


def judge_events(texts: Iterable[str], line: int) -> Iterator[Finding]:
    """Yield each event that the words do not have, once."""
    return (Finding("extra-event", line, {"event": text}) for text in dict.fromkeys(texts))


def extra_events(block: Block) -> Iterator[str]:
    """Yield what a block does besides moving, though its words do not have it.

    Where the units change, a preview makes another G64 of the one in force.
    """
    commanded = {f"M{code:g}" for code in block.m_codes} | {f"G{code:g}" for code in block.codes}
    for text in (event.text for event in block.own_events if ACT.match(event.text)):
        is_speed = text[0] == "S" and "S" in block.words
        is_coolant_off = 9.0 in block.m_codes and text.endswith(" off")
        is_g64 = text == G64_OF_PREVIEW and UNITS.intersection(block.codes)
        if not (is_speed or is_coolant_off or is_g64 or text.split()[0] in commanded):
            yield text


def _text(name: str, value: float) -> str:
    if name in MODES:
        return MODES[name][int(value)]
    if name in CODES:
        return f"G{value / 10:g}"
    letter = LETTERS.get(name) or name.removeprefix("_")[0].upper()
    return f"{letter}{plain(value, 4)}"


def judge_section_state(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield where a section's acts and the modal state after it differ from its words."""
    yield from judge_acts(section, moves)
    position = WALL / section.unit
    allowed = {"_x": position, "_z": position, "_c": ANGLE}
    yield from judge_state(section.state_after, section.expected_state, section.last, allowed)
    if len(set(section.paths_after)) > 1:
        found, expected = section.paths_after
        yield Finding("state", section.last, {"found": found, "expected": expected})


def judge_acts(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield the first act of a section that is missing, elsewhere or not in the words.

    An act is a text and the line of the move before it, 0 at the start.
    """
    actual = [
        (event.text, moves[event.at - 1].line if event.at > section.at else 0)
        for event in section.events
        if ACTS.match(event.text)
    ]
    cut = {moves[index].line for index in range(section.at, section.end)}
    commanded = [
        (act.text, next((e.line for e in section.elements[: act.drawn][::-1] if e.line in cut), 0))
        for act in section.acts
    ]
    pairs = zip_longest(actual, commanded)
    at = next((at for at, (one, other) in enumerate(pairs) if one != other), None)
    if at is None:
        return
    found, expected = actual[at:], commanded[at:]
    moved = bool(found and expected) and expected[0] in found
    if not expected or (moved and expected[0][0] != found[0][0]):
        act, after = found[0]
        yield Finding("act-extra", after, {"act": act, "found": _location(after)})
        return
    act, after = expected[0]
    values = {"act": act, "expected": _location(after)}
    elsewhere = [{"found": _location(line)} for text, line in found if text == act]
    code = "act-elsewhere" if elsewhere else "act-missing"
    yield Finding(code, section.acts[at].line, {**values, **(elsewhere or [{}])[0]})


def _location(after: int) -> str:
    return f"after line {after}" if after else "at the start"
