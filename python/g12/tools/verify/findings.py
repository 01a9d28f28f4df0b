# SPDX-License-Identifier: GPL-2.0-or-later
"""What is wrong with what was measured, and what else a user should know of it, in words.

A judgement of its own is a generator here, called from the one of its kind of facts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from g12.tools.units import MM, Unit, plain
from g12.tools.verify.axis_limits import Overrun
from g12.tools.verify.compare.state import StateDifference
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.pocket_area import is_wrong_tool
from g12.tools.verify.reading.circles import Cutter
from g12.tools.verify.result.tolerances import LEVEL
from g12.tools.verify.section import SectionFacts
from g12.tools.verify.wanted_contour import SectionContour

LAST_DECIMAL = 0.0005  # mm: arcs whose words are rounded do not close any better
SAME_AREA = 0.01  # mm², less is rounding
SAME_SPEED = 1.001
SAME_SIZE = 1e-4  # mm
SAME_ANGLE = 1e-3  # degree
LOST_MINUS = "lies above {}, where the tool comes from: it cuts air (a lost minus sign?)"
NOT_CUT = "nothing is cut"
UNMEASURED = "a cycle cuts here that could not be measured"


def leaving_text(left: StateDifference) -> str:
    """Return in words what is left behind otherwise than the words ask."""
    found, expected = left.texts()
    return f"it leaves {found}, not {expected}"


def overrun_text(overrun: Overrun, unit: Unit) -> str:
    """Return in words which axis leaves its travel."""
    there, limit = unit.text(overrun.position), unit.text(overrun.limit)
    return f"the {overrun.letter} axis would go to {there}, its limit is {limit} {unit.name}"


def gouged(facts: SectionFacts, unit: Unit) -> str:
    """Return the gouged area of a section in words: of a deep one only a part is measured."""
    least = facts.through and facts.gouge > SAME_AREA
    return f"{'at least ' if least else ''}{unit.area(facts.gouge)}"


def other_tool(cutter: Cutter, unit: Unit) -> str:
    """Return in words that D is not the loaded tool."""
    loaded, named = (unit.text(2 * size) for size in (cutter.loaded, cutter.radius))
    return f"the loaded tool T{cutter.tool} (⌀ {loaded}) is not D{cutter.named} (⌀ {named})"


def pocket_notes(facts: PocketFacts, unit: Unit = MM) -> Iterator[str]:
    """Yield what a user should know of a pocket that is no fault."""
    cutter = facts.target.cutter
    if cutter.word:
        yield "the tool's centre goes round on the circle, the wall is a tool radius farther"
    if facts.overruns is None:
        yield "its travel is not known: with the machine's var file the program moves otherwise"
    for overrun in facts.overruns or ():
        if not overrun.certain:
            yield f"with no work offset {overrun_text(overrun, unit)}"
    if cutter.named is None or is_wrong_tool(cutter):
        return
    if not cutter.loaded:
        lacks = f"T{cutter.tool} has no diameter" if cutter.tool > 0 else "no tool is loaded"
        yield f"{lacks}: measured with the diameter of D{cutter.named}"
    elif abs(cutter.radius - cutter.loaded) > SAME_SIZE:
        yield f"{other_tool(cutter, unit)}: measured with the cutter of D{cutter.named}"


def section_notes(facts: SectionFacts) -> Iterator[str]:
    """Yield what a user should know of a section that is no fault."""
    zero = facts.section.zero_line
    if not zero.commanded and not zero.line:
        angle = plain(facts.zero, 3)
        yield f"no C word comes before it: its zero line is where C stands, at {angle}°"
    if facts.section.surface and facts.lowest >= facts.start_height - SAME_SIZE:
        yield f"no move goes below the X of {facts.section.code}"
    if facts.in_place.degrees > SAME_ANGLE:
        degrees, seconds = plain(facts.in_place.degrees, 1), plain(facts.in_place.seconds, 1)
        yield (
            f"C turns in place at the centre, by {degrees}° in all: "
            f"there the tool rubs for {seconds} s"
        )
    if not facts.tool and any(facts.sides):
        yield "the tool has no diameter: only its centre is measured"


def section_findings(facts: SectionFacts, tolerance: float, unit: Unit = MM) -> Iterator[str]:
    """Yield what is wrong with a section."""
    if facts.section.doubt:
        yield f"the contour cannot be read from the words: {facts.section.doubt}"
        return
    yield from mistake_findings(facts)
    yield from air_findings(facts.section, unit)
    yield from contour_findings(facts, tolerance, unit)
    yield from block_findings(facts, unit)
    yield from turn_findings(facts)
    yield from motion_findings(facts, unit)
    yield from state_findings(facts)


def air_findings(section: SectionContour, unit: Unit) -> Iterator[str]:
    """Yield that a compensated contour lies as a whole above where the tool comes from."""
    depths = [each.depth for each in section.elements if each.side and not each.ramp]
    if depths and min(depths) > section.height + LEVEL:
        letter, at, start = heights_text(section, (min(depths), section.height), unit)
        yield f"its contour at {letter}{at} {LOST_MINUS.format(letter + start)}"


def heights_text(section: SectionContour, heights: Sequence[float], unit: Unit) -> list[str]:
    """Return the letter of heights above a section's plane, and them as its words have them."""
    factor = 2 if section.surface and section.diameters else 1
    letter = "X" if section.surface else "Z"
    return [letter, *(unit.text(factor * height) for height in heights)]


def mistake_findings(facts: SectionFacts) -> Iterator[str]:
    """Yield what a section's words most likely do not mean."""
    zero, other = facts.section.zero_line, facts.other_side
    if not zero.commanded and zero.turned:
        yield (
            f"C stands where line {zero.line} left it, turned by {plain(zero.turned, 1)}° "
            "against that section: G0 C0 missing?"
        )
    if other is None:
        return
    other_code, instead = ("G42", "G41") if other.side < 0 else ("G41", "G42")
    if other.inside is None:
        yield f"the tool crosses the contour on its way in: {instead}?"
    else:
        here, there = ("inside", "outside")[:: 1 if other.inside else -1]
        meant = f"else go {here} before the line with {other_code}"
        yield f"the tool is {here} the closed contour, it comes from {there}: {instead}? ({meant})"


def contour_findings(facts: SectionFacts, tolerance: float, unit: Unit) -> Iterator[str]:
    """Yield where a section leaves its contour in the plane."""
    if math.isinf(facts.deviation):
        yield "the contour is not cut"
    elif facts.deviation > tolerance + LAST_DECIMAL:
        yield f"the path is {unit.fine(facts.deviation)} {unit.name} off the contour"
    if facts.gouge > SAME_AREA:
        yield f"{gouged(facts, unit)} are gouged beyond the contour"
    if facts.left > SAME_AREA:
        yield f"{unit.area(facts.left)} of material are left standing"


def block_findings(facts: SectionFacts, unit: Unit) -> Iterator[str]:
    """Yield which heights and feeds of a section's blocks are not the words'."""
    if facts.depth_off:
        line, *heights = facts.depth_off
        letter, found, asked = heights_text(facts.section, heights, unit)
        yield f"line {line}: {letter} is {found}, not {asked} {unit.name}"
    if facts.feed_off:
        line, found, asked = facts.feed_off
        yield f"line {line}: the feed is {unit.text(found)}, not {unit.text(asked)} {unit.name}/min"


def turn_findings(facts: SectionFacts) -> Iterator[str]:
    """Yield where C is faster than it may be, or is asked to be where it turns in place."""
    speed = max(facts.c_speed, facts.turn_speed)
    if speed > facts.c_limit * SAME_SPEED:
        yield f"C turns at {speed:.4g} degrees/s, its limit is {facts.c_limit:.4g}"


def motion_findings(facts: SectionFacts, unit: Unit) -> Iterator[str]:
    """Yield how a section's lines follow each other otherwise than they should."""
    if facts.order_off:
        line, what, lengths = facts.order_off
        size = f" {unit.name}" if lengths else ""
        yield f"line {line}: {what.format(*map(unit.text, lengths))}{size}"
    for line, what, off in facts.motion_off:
        by = f", rounded by {unit.fine(off)} {unit.name} or more" if off else ""
        yield f"line {line}: it {what}{by}"


def state_findings(facts: SectionFacts) -> Iterator[str]:
    """Yield what a section does besides moving, or leaves, otherwise than its words ask."""
    if facts.act_off:
        line, text, found, asked = facts.act_off
        if asked is None:
            yield f"{text} comes {place_of_act(found)}, where the program has it not"
        elif found is None:
            yield f"line {line}: {text} does not come"
        else:
            yield f"line {line}: {text} comes {place_of_act(found)}, not {place_of_act(asked)}"
    for left in facts.left_behind:
        yield leaving_text(left)
    if len(set(facts.section.paths)) > 1:
        yield "it leaves {}, not {}".format(*facts.section.paths)


def place_of_act(line: int) -> str:
    """Return in words where something happens: behind a line that is cut."""
    return f"behind line {line}" if line else "at the start"
