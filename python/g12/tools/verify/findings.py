# SPDX-License-Identifier: GPL-2.0-or-later
"""What is wrong with what was measured, and what else a user should know of it, in words.

A judgement of its own is a generator here, called from the one of its kind of facts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import zip_longest

from g12.tools.units import MM, Unit, plain
from g12.tools.verify.axis_limits import Overrun
from g12.tools.verify.pocket import SAME_LEVEL, PocketFacts
from g12.tools.verify.pocket_entry import entry_findings
from g12.tools.verify.pocket_order import DOWN_TO, ENDS, UP_TO, LeftBehind
from g12.tools.verify.reading.codes import EVENT
from g12.tools.verify.section import SectionFacts
from g12.tools.verify.wanted_circle import Cutter, Target
from g12.tools.verify.wanted_contour import SectionContour

LAST_DECIMAL = 0.0005  # mm: arcs whose words are rounded do not close any better
SAME_AREA = 0.01  # mm², less is rounding
MOST_JUMP = 1.0  # degree
SAME_SPEED = 1.001
WEAR = 0.05  # of its diameter: D differs from the loaded tool by more than an allowance for wear
SAME_SIZE = 1e-4  # mm
SAME_ANGLE = 1e-3  # degree
SAME = 2e-3  # mm: circles of the same depth and radius
MODES = {
    "_metric": ("G20", "G21"),
    "_absolute": ("G91", "G90"),
    "_units_per_rev": ("G94", "G95"),
    "_lathe_diameter_mode": ("G8", "G7"),
    "_ijk_absolute_mode": ("G91.1", "G90.1"),
}
LOST_MINUS = "lies above {}, where the tool comes from: it cuts air (a lost minus sign?)"
NOT_CUT = "nothing is cut"
UNMEASURED = "a cycle cuts here that could not be measured"


def pocket_findings(facts: PocketFacts, tolerance: float, unit: Unit = MM) -> Iterator[str]:
    """Yield what is wrong with a pocket."""
    if not facts.depths:
        yield NOT_CUT
        return
    yield from wall_findings(facts, tolerance, unit)
    wrong_depth = list(depth_findings(facts, tolerance, unit))
    yield from wrong_depth
    yield from schedule_findings(facts, unit)
    yield from entry_findings(facts.helix, facts.target.schedule.helix, unit)
    if not wrong_depth:
        yield from order_findings(facts, tolerance, unit)
    yield from place_findings(facts, (ENDS, DOWN_TO, UP_TO) if wrong_depth else (), unit)
    yield from left_findings(facts)
    yield from (f"{text} comes in it, where the program has it not" for text in facts.acts)
    for overrun in facts.overruns or ():
        if overrun.certain:
            yield overrun_text(overrun, unit)


def wall_findings(facts: PocketFacts, tolerance: float, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with the wall of a pocket and what lies inside it."""
    target = facts.target
    if is_wrong_tool(target.cutter):
        wall, cut = (unit.text(size) for size in (target.wall.radius, wall_of_loaded(target)))
        yield f"{other_tool(target.cutter, unit)}: the wall comes out at radius {cut}, not {wall}"
    if facts.deviation > tolerance:
        yield f"the wall is {unit.fine(facts.deviation)} {unit.name} off the programmed circle"
    if facts.gouge > SAME_AREA:
        yield f"{unit.area(facts.gouge)} are gouged beyond the wall"
    if facts.left > SAME_AREA:
        yield f"{unit.area(facts.left)} of material are left standing"
    if target.schedule.smooth and facts.jump > MOST_JUMP:
        place = place_text(facts.jump_at, unit)
        yield f"the direction jumps by {facts.jump:.3g} degrees at {place}"


def depth_findings(facts: PocketFacts, tolerance: float, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with the depths that a pocket is cut at."""
    deepest = facts.target.schedule.deepest
    if cuts_air(facts.target, tolerance):
        at, start = (unit.text(facts.target.wall.height(depth)) for depth in (deepest, 0.0))
        yield f"its depth Z{at} {LOST_MINUS.format(f'Z{start}')}"
        return
    too_high = facts.depths[-1] - deepest
    if abs(too_high) > tolerance:
        yield f"the depth is off by {unit.fine(too_high)} {unit.name}"
    elif min(deepest, 0.0) - facts.lowest > tolerance:
        yield f"it goes {unit.fine(deepest - facts.lowest)} {unit.name} below its depth"
    else:
        yield from level_findings(facts, max(tolerance, SAME_LEVEL), unit)


def cuts_air(target: Target, tolerance: float) -> bool:
    """Tell whether a pocket lies above where the tool comes from; an event begins at its W."""
    return target.source.dialect != EVENT and target.schedule.deepest > tolerance


def level_findings(facts: PocketFacts, tolerance: float, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with the levels of a pocket whose last one is right."""
    wanted, cut = sorted(facts.target.schedule.levels, reverse=True), facts.depths
    equal = len(wanted) == len(cut)
    if not equal or max(map(abs, map(float.__sub__, wanted, cut))) > tolerance:
        heights = (map(facts.target.wall.height, depths) for depths in (cut, wanted))
        was, asked = (", ".join(map(unit.text, some)) for some in heights)
        yield f"it is cut at {was}, not at {asked} {unit.name}"


def schedule_findings(facts: PocketFacts, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with how a pocket is cut: turns, passes and feeds."""
    asked = facts.target.schedule
    if facts.feed:
        yield "a move has the feed {}, not {}".format(*map(unit.text, facts.feed))
    if facts.other_mode:
        minute, turn = "per minute", "per revolution"
        yield "a move has its feed {}, not {}".format(
            *(minute, turn) if asked.rev else (turn, minute)
        )
    if facts.passes != asked.passes:
        yield f"full circles along the wall: {facts.passes}, not {asked.passes}"
        return
    rough = facts.circles[:-1] if asked.finish_turn else facts.circles
    wrong = [cut for cut, turn in zip(facts.cut, rough) if asked.turn not in (0, turn)]
    if wrong:
        yield f"it turns the wrong way: {circle_text(wrong[0], facts, unit)}"
    if asked.finish_turn and asked.finish_turn not in facts.circles[-1:]:
        yield "its finish pass turns the wrong way"


def order_findings(facts: PocketFacts, tolerance: float, unit: Unit) -> Iterator[str]:
    """Yield which circles are not those of the words, if their number along the wall is right."""
    asked = facts.target.schedule
    if asked.pitch and facts.growth > asked.pitch + SAME:
        apart, pitch = unit.text(facts.growth), unit.text(asked.pitch)
        yield f"its turns are {apart} apart, not {pitch} {unit.name}"
    if not asked.circles or facts.passes != asked.passes or facts.deviation > tolerance:
        return
    for cut, wanted in zip_longest(facts.cut, asked.circles):
        if cut is None or wanted is None or max(map(abs, map(float.__sub__, cut, wanted))) > SAME:
            was, instead = (circle_text(circle, facts, unit) for circle in (cut, wanted))
            yield f"{was} is cut in place of {instead}"
            return


def circle_text(circle: tuple[float, float] | None, facts: PocketFacts, unit: Unit) -> str:
    """Return a circle of the tool's centre in words."""
    if circle is None:
        return "nothing"
    depth = unit.text(facts.target.wall.height(circle[0]))
    return f"a circle of {unit.text(circle[1])} {unit.name} (tool centre) at {depth}"


def place_findings(facts: PocketFacts, told: Sequence[str], unit: Unit) -> Iterator[str]:
    """Yield what is not where the words want it: the first of each kind but what is ``told``."""
    for what, found, asked in {place.what: place for place in facts.misplaced[::-1]}.values():
        if what in told:
            continue
        if found is None:
            yield f"{what} {place_text(asked, unit)}"
        elif asked is None:
            yield f"{what} {place_text(found, unit)}, where the cycle has it not"
        else:
            yield f"{what} {place_text(found, unit)}, not {place_text(asked, unit)}"


def place_text(point: Sequence[float], unit: Unit) -> str:
    """Return a place on the machine in words."""
    return " ".join(f"{letter}{unit.text(at)}" for letter, at in zip("XYZ", point))


def left_findings(facts: PocketFacts) -> Iterator[str]:
    """Yield what is left behind otherwise than the words ask; a feed only if all moves had it."""
    for left in facts.left_behind:
        if left.name != "_feed" or not facts.feed:
            yield leaving_text(left)


def leaving_text(left: LeftBehind) -> str:
    """Return in words what is left behind otherwise than the words ask, in program units."""
    name, found, asked = left
    if name in MODES:
        was, instead = (MODES[name][int(on)] for on in (found, asked))
    elif name in ("_motion_mode", "_plane"):
        was, instead = (f"G{mode / 10:g}" for mode in (found, asked))
    else:
        letter = name.removeprefix("_")[0].upper()
        was, instead = (f"{letter}{plain(value, 4)}" for value in (found, asked))
    return f"it leaves {was}, not {instead}"


def overrun_text(overrun: Overrun, unit: Unit) -> str:
    """Return in words which axis leaves its travel."""
    there, limit = unit.text(overrun.position), unit.text(overrun.limit)
    return f"the {overrun.letter} axis would go to {there}, its limit is {limit} {unit.name}"


def gouged(facts: SectionFacts, unit: Unit) -> str:
    """Return the gouged area of a section in words: of a deep one only a part is measured."""
    least = facts.through and facts.gouge > SAME_AREA
    return f"{'at least ' if least else ''}{unit.area(facts.gouge)}"


def is_wrong_tool(cutter: Cutter) -> bool:
    """Tell whether D names another cutter than the loaded one, by more than wear."""
    known = cutter.named is not None and cutter.loaded > 0.0
    return known and abs(cutter.radius - cutter.loaded) > WEAR * cutter.loaded


def wall_of_loaded(target: Target) -> float:
    """Return the radius of the wall that the loaded tool cuts."""
    return target.wall.radius - target.cutter.radius + target.cutter.loaded


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
    if depths and min(depths) > section.height + SAME_LEVEL:
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
