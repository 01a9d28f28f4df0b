# SPDX-License-Identifier: GPL-2.0-or-later
"""Codes and lines that most likely mean something else than they do."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import pairwise

from g12.tools.machine.ini import Ini
from g12.tools.machine.stored_positions import unset_positions
from g12.tools.preview.executed_blocks import Text
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.result.finding import Finding

STORED = {28.0: "G28", 30.0: "G30"}
SETTING = {28.1: "G28", 30.1: "G30"}
RETURN_LEVELS = {98.0: "G94", 99.0: "G95"}  # what a lathe of the Fanuc kind means by them
DRILLING = (73.0, 74.0, *map(float, range(81, 90)))  # cycles that have return levels
TABLE = {("L", "1"), ("L", "10"), ("L", "11")}  # of G10: the tool table
SHIFTS = (52.0, 92.0)  # add to the work offset until G92.1, also in the next program
SHIFTED = ("axis_offset_x", "axis_offset_y", "axis_offset_z")  # in the interpreter's state
LEAST_SHIFT = 1e-6
STRAIGHT_BACK = -0.999999  # cosine of the angle between the two directions, at most


def judge_home(texts: Sequence[Text], ini: Ini) -> Iterator[Finding]:
    """Yield the first G28 and the first G30 of a lathe whose position the var file does not have.

    It is a rapid to machine zero, not to a tool change.
    """
    waiting = set(unset_positions(ini))
    for text in texts:
        waiting -= {SETTING.get(number, "") for number in text.codes}
        for code in waiting.intersection(STORED.get(number, "") for number in text.codes):
            waiting.discard(code)
            yield Finding("place-not-set", text.number, {"code": code})


def judge_preview(texts: Sequence[Text], swaps_pockets: bool) -> Iterator[Finding]:
    """Yield the lines that LinuxCNC's preview may execute otherwise than the machine.

    With a random tool changer, which swaps pockets, it does not change the loaded tool by G10.
    """
    found = {
        "block-delete": [text.number for text in texts if text.deleted],
        "tool-table-set": [t.number for t in texts if swaps_pockets and _sets_tools(t)],
    }
    for code, lines in found.items():
        if lines:
            yield Finding(code, lines[0], {"lines": lines})


def _sets_tools(text: Text) -> bool:
    return 10.0 in text.codes and not TABLE.isdisjoint(text.words)


def judge_left_offset(texts: Sequence[Text], state: Mapping[str, float]) -> Iterator[Finding]:
    """Yield a note of the last G92 or G52, if its offset is in force at the program's end."""
    left = [*(state[name] for name in SHIFTED), math.remainder(state["CC_axis_offset"], 360.0)]
    set_by = [(text.number, code) for text in texts for code in text.codes if code in SHIFTS]
    if max(map(abs, left)) > LEAST_SHIFT:
        for line, code in set_by[-1:]:
            yield Finding("offset-left", line, {"code": f"G{code:g}"})


def judge_return_levels(texts: Sequence[Text], codes: Codes) -> Iterator[Finding]:
    """Yield the first G98 and G99 outside of a lathe's sections, where no drilling cycle is."""
    if any(code in DRILLING for text in texts for code in text.codes):
        return
    waiting = dict(RETURN_LEVELS)
    for text, _, inside in codes.with_switches(texts):
        for code in () if inside else text.codes:
            if code in waiting:
                values = {"code": f"G{code:g}", "meant": waiting.pop(code)}
                yield Finding("return-level", text.number, values)


def judge_unrun(texts: Sequence[Text], codes: Codes, run: Collection[int]) -> Iterator[Finding]:
    """Yield one note of the cycles, sections and calls that are not in a program's ``run`` lines.

    It ends before them, jumps over them, or deletes their blocks.
    """
    unrun = {
        text.number: name
        for text, switch, _ in codes.with_switches(texts)
        if (name := codes.commanded(text, switch)) and text.number not in run
    }
    for line, name in list(unrun.items())[:1]:
        yield Finding("never-run", line, {"code": name, "more": set(unrun) - {line}})


def judge_reversals(sections: Sequence[SectionContour]) -> Iterator[Finding]:
    """Yield the lines under G41 or G42 that go straight back: a lost minus sign does that."""
    for section in sections:
        drawn = [element for element in section.elements if element.length]
        for before, after in pairwise(drawn):
            if goes_back(before, after):
                values = {"line": before.line, "code": "G41" if after.side > 0 else "G42"}
                yield Finding("goes-back", after.line, values, file=section.file)


def goes_back(before: Element, after: Element) -> bool:
    """Return whether both are lines of a compensated contour, the second back along the first."""
    if not before.side or before.side != after.side or before.ramp or after.ramp:
        return False
    if before.centre is not None or after.centre is not None:
        return False
    ways = (before.end - before.start) * (after.end - after.start).conjugate()
    return ways.real < STRAIGHT_BACK * abs(ways)
