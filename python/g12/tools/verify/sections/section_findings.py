# SPDX-License-Identifier: GPL-2.0-or-later
"""Every finding and note of a section, each with the line that it is about."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from g12.machine_ini import AXES
from g12.tools.verify.compare.path import EXTRA, MISSING, OFF, RAPID, Point
from g12.tools.verify.compare.state import judge_state
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL, SIZE, TURNING
from g12.tools.verify.sections.section import SectionFacts
from g12.tools.verify.sections.section_state import OffAct

SAME_ANGLE = 1e-3  # degree
CODES = {OFF: "path-off", MISSING: "path-missing", EXTRA: "path-extra", RAPID: "rapid"}
SIDES = {1: ("G41", "G42"), -1: ("G42", "G41")}  # the code in force, and the other one


def judge_section(facts: SectionFacts) -> Iterator[Finding]:
    """Yield the findings and notes of a section."""
    section = facts.section
    found = [*doubted(facts)] if section.doubt else [*findings_in(facts), *notes_on(facts)]
    yield from (replace(each, file=section.file) for each in found)


def doubted(facts: SectionFacts) -> Iterator[Finding]:
    """Yield that a contour could not be read."""
    yield Finding("contour-unread", facts.section.line, {"why": facts.section.doubt})


def findings_in(facts: SectionFacts) -> Iterator[Finding]:
    """Yield what is wrong with a section."""
    yield from mistaken_side(facts)
    yield from mistaken_zero(facts)
    yield from cut_in_air(facts)
    yield from off_path(facts)
    yield from off_feed(facts)
    yield from off_c(facts)
    yield from off_motion(facts)
    yield from off_state(facts)


def mistaken_side(facts: SectionFacts) -> Iterator[Finding]:
    """Yield that compensation takes the tool to the side that it does not come from."""
    other = facts.other_side
    if other is None:
        return
    code, instead = SIDES[other.side]
    if other.inside is None:
        yield Finding("side-crossed", facts.section.line, {"instead": instead})
        return
    here, there = ("inside", "outside")[:: 1 if other.inside else -1]
    values = {"here": here, "there": there, "code": code, "instead": instead}
    yield Finding("side-other", facts.section.line, values)


def mistaken_zero(facts: SectionFacts) -> Iterator[Finding]:
    """Yield that C was not turned back after the section before."""
    zero = facts.section.zero_line
    if not zero.commanded and zero.turned:
        values = {"line": zero.line, "turned": zero.turned}
        yield Finding("zero-line-turned", facts.section.line, values)


def cut_in_air(facts: SectionFacts) -> Iterator[Finding]:
    """Yield that a compensated contour lies as a whole above where the tool comes from."""
    section = facts.section
    depths = [each.depth for each in section.elements if each.side and not each.ramp]
    if depths and min(depths) > section.height + LEVEL:
        factor = 2 if section.surface and section.diameters else 1
        levels = {"level": factor * min(depths), "start": factor * section.height}
        values = {"letter": AXES[section.third], **levels}
        yield Finding("above-start", section.line, values)


def off_path(facts: SectionFacts) -> Iterator[Finding]:
    """Yield the first place where the toolpath is not the one that the words ask for."""
    off = facts.path.difference
    if off is None:
        return
    expected = off.expected
    line = expected.line if expected else facts.section.last
    values = {"what": expected.name if expected else "", "size": off.size}
    yield at_point(facts, CODES[off.kind], line, off.at, values)


def at_point(
    facts: SectionFacts, code: str, line: int, at: Point, values: Mapping[str, Any]
) -> Finding:
    """Return a finding at a point of the plane, which it names as the program writes it."""
    section, plane = facts.section, facts.plane
    words = plane.words(at, section.diameters)
    return Finding(code, line, {**values, "at": words}, plane.place(at))


def off_feed(facts: SectionFacts) -> Iterator[Finding]:
    """Yield the first feed along the toolpath that is not the words'."""
    off = facts.feed_off
    if off:
        values = {"what": off.expected.name, "made": off.made, "expected": off.asked}
        end = off.expected.point(1.0)
        yield at_point(facts, "feed", off.expected.line, end, values)


def off_c(facts: SectionFacts) -> Iterator[Finding]:
    """Yield where C is faster than it may be, or turns farther than it needs to."""
    turns, section = facts.turns, facts.section
    speed = max(turns.speed, turns.asked)
    if speed > facts.c_limit * TURNING:
        yield Finding("c-speed", section.line, {"made": speed, "limit": facts.c_limit})
    if turns.too_far is not None:
        line, degrees = turns.too_far
        yield Finding("c-turned-too-far", line, {"turned": degrees})


def off_motion(facts: SectionFacts) -> Iterator[Finding]:
    """Yield lines that are blended where they should stop, or stop where they should not."""
    for off in facts.motion_off:
        yield Finding(off.code, off.line, off.values)


def off_state(facts: SectionFacts) -> Iterator[Finding]:
    """Yield what a section does besides moving, or leaves, otherwise than its words ask."""
    section = facts.section
    if facts.act_off:
        yield act_finding(facts.act_off)
    yield from judge_state(facts.left_behind, (), section.last)
    if len(set(section.paths)) > 1:
        found, expected = section.paths
        yield Finding("state", section.last, {"found": found, "expected": expected})


def act_finding(off: OffAct) -> Finding:
    """Return the finding of an act that is missing, in another place or not in the words."""
    found, asked = map(place_of_act, (off.found, off.asked))
    if off.asked is None:
        return Finding("act-extra", off.line, {"act": off.text, "found": found})
    if off.found is None:
        return Finding("act-missing", off.line, {"act": off.text})
    return Finding("act-elsewhere", off.line, {"act": off.text, "found": found, "asked": asked})


def place_of_act(line: int | None) -> str:
    """Return in words where something happens: after a line that is cut."""
    return f"after line {line}" if line else "at the start"


def notes_on(facts: SectionFacts) -> Iterator[Finding]:
    """Yield what a user should know of a section that is no fault."""
    section, zero = facts.section, facts.section.zero_line
    if not zero.commanded and not zero.line:
        yield Finding("zero-line-unknown", section.line, {"angle": facts.zero})
    if section.surface and facts.lowest >= facts.start_height - SIZE:
        values = {"letter": AXES[section.third], "code": section.code}
        yield Finding("not-below-start", section.line, values)
    if facts.in_place.degrees > SAME_ANGLE:
        yield Finding("rubs", section.line, facts.in_place._asdict())
    if not facts.tool and any(facts.sides):
        yield Finding("no-diameter", section.line)
