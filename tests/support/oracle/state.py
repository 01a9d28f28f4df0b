# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state around a cut, and what happens in it besides motion."""

import cmath
import json
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from g12.tools.preview.moves import MESSAGE, Event, Trace
from g12.tools.units import plain
from support.oracle.toolpath import Difference

FOUND, LEFT = "found ", "left "
MOTION, PLANE, UNITS, DISTANCE, FEED_MODE, PATH = "1", "3", "5", "6", "7", "11"
GROUPS = {  # of LinuxCNC's active codes
    **dict.fromkeys(("G0", "G1", "G2", "G3"), MOTION),
    **dict.fromkeys(("G90", "G91"), DISTANCE),
    **dict.fromkeys(("G93", "G94", "G95"), FEED_MODE),
    **dict.fromkeys(("G61", "G61.1", "G64"), PATH),
}
SAME = 1e-5  # relative
LETTERS = "XYZABC"


class Surroundings(NamedTuple):
    """The state before a cut and after it, the events between them, the path mode at each."""

    found: dict
    left: dict
    events: Sequence[Event]
    paths: tuple[str, str]


def surroundings_of(trace: Trace, lines: Sequence[str]) -> list[Surroundings]:
    """Return those of each cut of a trace of a `ModalTracer`; of a program by its lines.

    G10 sets its parameters and T the next tool before LinuxCNC reports their line.
    """
    found, path, every = None, "", []
    for event in trace.events:
        if event.text.startswith(FOUND):
            found, begun, events = json.loads(event.text.removeprefix(FOUND)), path, []
        elif event.text.startswith(LEFT):
            left = json.loads(event.text.removeprefix(LEFT))
            for word, name in (("G10", "offsets"), ("G92", "offsets"), ("T", "T")):
                if word in lines[event.line - 1]:
                    left[name] = found[name]
            every.append(Surroundings(found, left, events, (begun, path)))
            found = None
        elif found:
            events.append(event)
        if event.text.startswith("G6"):
            path = event.text
    return every


def judge_state(cut, around: Surroundings, leaves: str, is_section: bool) -> Iterator[Difference]:
    """Yield what the cut leaves otherwise: ``leaves`` are codes and F that its words command.

    Without them the motion and the path mode, F and S of a section are not compared.
    """
    report, found, left = cut.report, around.found, around.left
    codes = dict(found["codes"])
    codes[UNITS] = "G21" if report.frame.mm == 1.0 else "G20"
    codes[DISTANCE] = "G91" if report.incremental else "G90"
    codes[FEED_MODE] = "G95" if report.per_revolution else "G94"
    codes[PLANE] = getattr(report.cut, "plane", codes[PLANE])
    same_unit = codes[UNITS] == found["codes"][UNITS]
    feed = report.words.get("F", report.feed) if report.code == "circle_mill" else report.feed
    numbers = {"T": found["T"], "S": found["S"], "F": feed if same_unit else None}
    if is_section:
        numbers["F"] = numbers["S"] = None
    for word in leaves.split():
        if word[0] in numbers:
            numbers[word[0]] = float(word[1:])
        else:
            codes[GROUPS[word]] = word
    if is_section and not leaves:
        codes |= {group: left["codes"][group] for group in (MOTION, PATH)}
    for group, code in codes.items():
        if left["codes"][group] != code:
            yield otherwise(cut, left["codes"][group], code)
    for letter, value in numbers.items():
        if value is not None and abs(left[letter] - value) > SAME * max(1.0, abs(value)):
            yield otherwise(cut, f"{letter}{plain(left[letter], 4)}", f"{letter}{plain(value, 4)}")
    yield from judge_zero(cut, found, left)


def judge_zero(cut, found, left) -> Iterator[Difference]:
    """Yield where the program's coordinates are others than before, and another system's."""
    unit = cut.report.frame.mm
    position = moved(left["tip"], left["zero"])
    expected = moved_back(position, found["zero"])
    for axis, letter in enumerate(LETTERS):
        now, then = (value[axis] / (unit if axis < 3 else 1.0) for value in (left["tip"], expected))
        if abs(now - then) > SAME:
            yield otherwise(cut, f"{letter}{plain(now, 4)}", f"{letter}{plain(then, 4)}")
    for name, values in found["offsets"].items():
        if left["offsets"][name] != values:
            yield Difference("extra-event", cut.line, f"{name} comes in it")


def otherwise(cut, now: str, then: str) -> Difference:
    return Difference("state", cut.last_line, f"it leaves {now}, not {then}")


def moved(tip, zero) -> list[float]:
    """Return the position in machine coordinates without the tool's length taken off."""
    work, g92, length, rotation = zero
    x, y, *rest = (a + b for a, b in zip(tip, g92))
    turned = complex(x, y) * cmath.rect(1.0, math.radians(rotation))
    return [a + b + c for a, b, c in zip((turned.real, turned.imag, *rest), work, length)]


def moved_back(position, zero) -> list[float]:
    """Return the tip in program coordinates."""
    work, g92, length, rotation = zero
    x, y, *rest = (a - b - c for a, b, c in zip(position, work, length))
    turned = complex(x, y) * cmath.rect(1.0, -math.radians(rotation))
    return [a - b for a, b in zip((turned.real, turned.imag, *rest), g92)]


def judge_events(cut, events: Sequence[Event]) -> Iterator[Difference]:
    """Yield what happens besides motion though nothing does by the page."""
    for text in dict.fromkeys(event.text for event in events):
        if not text.startswith(MESSAGE):
            yield Difference("extra-event", cut.line, f"{text} comes in it")
