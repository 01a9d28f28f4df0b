# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle mill event: entries and modes in, one checked perimeter or pocket out.

Source: Dynapath programming manual, section 33 "Circle Mill Event". Two front ends, one plan:
the codes (G12.2 perimeter, G13.2 pocket) and ``o<circle_mill> call`` with the control's own
fifteen entries. The comments here use the control's letters; `CODE_LETTERS` has those of the codes.

The motions of `ngc/g12_circle_mill.ngc`:

1. rapid up to W if the tool is below it, rapid in XY to the plunge point, rapid to W
2. feed at P to the level's depth: K below the last one, the last rough level at Z, or L above Z
   if the bottom is finished as well
3. perimeter: one circle at F. Pocket: feed in -Y by the roughing width, circle at F, and so on
   outward
4. for each further level: a pocket retracts 0.1 in, not above W, and rapids back to the centre
   first; a perimeter plunges at its present position
5. L with bottom finish: one more level, at Z
6. L: half circle of diameter L onto the finished side, circle, half circle off it, at V
7. rapid to O, rapid in XY to where the event started

The plunge point is the centre of a pocket, the -Y point of a perimeter.

Rules, in the order of the checks. Of a call: V and F above 0, `check_block`, G 0 or 7, L not 0; of
a code: `check_block`, L only with Q, Q above 0, L 0 or 1. Of both: X, Y, R
required, R above 0; D from 0 to 3, C required, from 0 to 2, in a pocket the pairs that put the
tool inside; no finish with C0; W known from here or an earlier event; O, the last one given, not
below W; Z required;
K, J, P above 0; a tool with a diameter in the spindle; R with room for it; J in pockets only, and
not too small; the deepest rough level below W; not too many circles; L not too small.
"""

from typing import NamedTuple

from g12.cut_report import LOADED, EventCut, UsedCutter
from g12.cycles.plan import CyclePlan, EventPlanes
from g12.errors import number
from g12.request import (
    CLOCKWISE,
    COUNTERCLOCKWISE,
    LEFT_OUT,
    Words,
    loaded_tool,
    opposite,
    steps_between,
)
from g12.state import Tool

EVENT_ENTRIES = "GXYZWORDCKJLPFV"  # of o<circle_mill> call, in this order
PERIMETER_CYCLE, POCKET_CYCLE = 0, 7  # the control's G0 and G7
NARROWER_MM = 0.254  # the default roughing width is the tool diameter less this
RETRACT_MM = 2.54  # 0.1 in, of a pocket between its levels: the manual
ROUGH_FINISH_ARCS = (  # by D
    (CLOCKWISE, CLOCKWISE),
    (COUNTERCLOCKWISE, COUNTERCLOCKWISE),
    (CLOCKWISE, COUNTERCLOCKWISE),
    (COUNTERCLOCKWISE, CLOCKWISE),
)
INNER_SIDE, ON_CIRCLE, OUTER_SIDE = -1, 0, 1  # factors of the tool radius
TOOL_SIDES = {  # by rough direction, then C: the tool centre, left, right of the profile
    CLOCKWISE: (ON_CIRCLE, OUTER_SIDE, INNER_SIDE),
    COUNTERCLOCKWISE: (ON_CIRCLE, INNER_SIDE, OUTER_SIDE),
}


class EntryLetters(NamedTuple):
    """The letters of the entries for which the two front ends have different ones."""

    first_plane: str
    second_plane: str
    side: str
    finish: str


EVENT_WORDS = "X Y Z I E R D H K J Q L P F"
CODE_LETTERS = EntryLetters("I", "E", "H", "Q")
CALL_LETTERS = EntryLetters("W", "O", "C", "L")


class EventEntries(NamedTuple):
    """An event as its front end read it; entries that both share are still among the words.

    ``planes`` are the reference planes as last commanded, ``finish`` is the finish dimension L (0:
    no finish), ``bottom`` whether it is for the bottom as well.
    """

    words: Words
    letters: EntryLetters
    planes: EventPlanes
    pocket: bool
    finish: float
    bottom: bool
    finish_feed: float


class EventCircle(NamedTuple):
    """The circle as programmed, and the side of it on which the tool's centre runs."""

    x: float
    y: float
    radius: float
    side: int
    rough_arc: int
    finish_arc: int


def plan_code(words: Words, planes: EventPlanes, pocket: bool) -> CyclePlan:
    """Return the event of a code block (G12.2, or G13.2: ``pocket``), or raise `Refusal`.

    ``planes`` are the reference planes as last commanded.
    """
    words.check_block(EVENT_WORDS)
    finish, bottom = finish_of_code(words)
    feed = words.context.feed
    return plan_event(EventEntries(words, CODE_LETTERS, planes, pocket, finish, bottom, feed))


def plan_call(words: Words, planes: EventPlanes) -> CyclePlan:
    """Return the event of one ``o<circle_mill> call``, or raise `Refusal`."""
    finish_feed = finish_feed_of_call(words)
    feed = words.take_positive("F") or words.context.feed
    words.context = words.context._replace(feed=feed)
    words.check_block(EVENT_ENTRIES)
    cycle = words.take("G") or PERIMETER_CYCLE
    if cycle not in (PERIMETER_CYCLE, POCKET_CYCLE):
        raise words.refuse_word("G", cycle, "must be 0 (perimeter) or 7 (pocket)")
    finish, bottom = finish_of_call(words)
    pocket, finish_feed = cycle == POCKET_CYCLE, finish_feed or feed
    entries = EventEntries(words, CALL_LETTERS, planes, pocket, finish, bottom, finish_feed)
    return plan_event(entries)


def entries_by_letter(values: list[float]) -> dict[str, float]:
    return {letter: value for letter, value in zip(EVENT_ENTRIES, values) if value != LEFT_OUT}


def finish_feed_of_call(words: Words) -> float | None:
    """Return V, the last entry: LinuxCNC makes it 0 if the call is too short."""
    feed = words.take("V")
    if feed is not None and feed <= 0:
        call = f"a call has {len(EVENT_ENTRIES)} entries, {number(LEFT_OUT)} leaves one out"
        raise words.refuse_word("V", feed, f"must be greater than 0 ({call})")
    return feed


def finish_of_code(words: Words) -> tuple[float, bool]:
    """Return finish dimension and bottom finish of the words Q and L."""
    is_given = "L" in words
    bottom = words.take_whole("L", least=0, most=1, default=1)
    if is_given and "Q" not in words:
        raise words.refuse_word("L", bottom, "needs Q as well: the finish dimension")
    finish = words.take_positive("Q") or 0.0
    return finish, finish > 0 and bottom == 1


def finish_of_call(words: Words) -> tuple[float, bool]:
    """Return finish dimension and bottom finish of the entry L, below zero: incremental."""
    finish = words.take("L")
    if finish == 0:
        raise words.refuse(f"L0 must not be 0; {number(LEFT_OUT)} leaves it out")
    return abs(finish or 0.0), (finish or 0.0) > 0


def plan_event(entries: EventEntries) -> CyclePlan:
    words, context = entries.words, entries.words.context
    circle = circle_of(entries)
    given = EventPlanes(*map(words.take, entries.letters[:2]))
    first_plane, commanded_second = planes_of(entries, given)
    second_plane = first_plane if commanded_second is None else commanded_second
    depth = words.require("Z", "the final depth")
    peck = words.take_positive("K")
    width = words.take_positive("J")
    plunge_feed = words.take_positive("P") or context.feed
    tool = loaded_tool(words)
    roughing = roughing_of(entries, circle, tool, width)
    depths = depths_of(entries, depth, first_plane, peck)
    words.check_count(round(roughing["rings"] * depths["levels"]), "J and K make")
    side = side_finish_of(entries, circle, tool)
    numbers = {
        "x": circle.x,
        "y": circle.y,
        "start_x": context.x,
        "start_y": context.y,
        "first_plane": first_plane,
        "second_plane": second_plane,
        "below": context.z < first_plane - context.rounding,
        "plunge_feed": plunge_feed,
        "feed": context.feed,
        "finish_feed": entries.finish_feed,
        **roughing,
        **depths,
        **side,
    }
    largest = max(roughing["rough_radius"], side["finish_radius"] if entries.finish else 0.0)
    final = depths["final_z"]
    heights = first_plane, second_plane, final
    words.check_travel((circle.x, circle.y, final), largest, heights)
    message = uncut_material(words, roughing["roughing_width"], tool)
    cut = cut_of_event(entries, circle, tool, depths)
    return CyclePlan(numbers, cut, None, message, given)


def cut_of_event(
    entries: EventEntries, circle: EventCircle, tool: Tool, depths: dict[str, float]
) -> EventCut:
    rough = (depths["z"] - depths["peck"] * level for level in range(round(depths["pecks"])))
    nearest, farthest = (circle.radius + (circle.side + out) * tool.radius for out in (-1, 1))
    return EventCut(
        (circle.x, circle.y),
        circle.side,
        farthest,
        0.0 if entries.pocket else nearest,
        (*rough, depths["rough_z"], *[depths["final_z"]] * entries.bottom),
        UsedCutter(tool.radius, LOADED, tool.number),
    )


def circle_of(entries: EventEntries) -> EventCircle:
    """Return centre, radius, side and directions: X, Y, R, D and C."""
    words, context, letter = entries.words, entries.words.context, entries.letters.side
    x = words.require("X", "the circle's centre")
    y = words.require("Y", "the circle's centre")
    radius = words.require_positive("R", "the circle's radius")
    direction = words.take_whole("D", least=0, default=0)
    if direction >= len(ROUGH_FINISH_ARCS):
        raise words.refuse(
            f"D{direction} must be at most {len(ROUGH_FINISH_ARCS) - 1}: D is the direction of the"
            " cut, the cutter is the tool in the spindle"
        )
    meaning = "0 tool centre on the circle, 1 left, 2 right of it"
    compensation = words.require_whole(letter, meaning, least=0, most=2)
    rough_arc, finish_arc = ROUGH_FINISH_ARCS[direction]
    side = TOOL_SIDES[rough_arc][compensation]
    if entries.pocket and side != INNER_SIDE:
        raise words.refuse(
            f"D{direction} with {letter}{compensation} does not put the tool inside the pocket:"
            f" D0 and D2 need {letter}2, D1 and D3 need {letter}1"
        )
    if side == ON_CIRCLE and entries.finish:
        raise words.refuse(
            f"{entries.letters.finish}{number(entries.finish)}: there is no finish pass"
            f" with the tool centre on the circle ({letter}0)"
        )
    x, y = words.absolute(x, context.x), words.absolute(y, context.y)
    return EventCircle(x, y, radius, side, rough_arc, finish_arc)


def planes_of(entries: EventEntries, given: EventPlanes) -> tuple[float, float | None]:
    """Return the reference planes W and O, both modal; no O (None) was ever commanded."""
    words, letters, earlier = entries.words, entries.letters, entries.planes
    first = earlier.first if given.first is None else given.first
    second = earlier.second if given.second is None else given.second
    if first is None:
        raise words.refuse(
            f"{letters.first_plane} is missing: the first reference plane,"
            " which no earlier event has commanded"
        )
    if second is not None and second < first - words.context.rounding:
        plane = f"{letters.first_plane}{number(first)}"
        rule = f"must not be below the first reference plane {plane}"
        if given.second is None:
            rule += f": it is that of an earlier event, give a new {letters.second_plane}"
        raise words.refuse_word(letters.second_plane, second, rule)
    return first, second


def roughing_of(
    entries: EventEntries, circle: EventCircle, tool: Tool, width: float | None
) -> dict[str, float]:
    """Return the locals of the circles of one level; a perimeter is one ring."""
    radius = circle.radius + circle.side * (tool.radius + entries.finish)
    finish, letter = entries.finish, entries.letters.finish
    cutter = 0.0 if circle.side == ON_CIRCLE else tool.radius
    if circle.side != OUTER_SIDE:
        more = f" + {letter}{number(finish)}" if finish else ""
        entries.words.check_fits("R", circle.radius, cutter, f"T{tool.number}", (finish, more))
    if entries.pocket:
        rings = rings_of(entries, radius, tool, width)
    elif width is not None:
        raise entries.words.refuse_word("J", width, "is the roughing width of a pocket")
    else:
        rings = 1
    return {
        "pocket": entries.pocket,
        "plunge_radius": 0.0 if entries.pocket else radius,
        "rings": rings,
        "roughing_width": radius / rings if entries.pocket else 0.0,
        "rough_radius": radius,
        "rough_arc": circle.rough_arc,
    }


def rings_of(entries: EventEntries, outermost: float, tool: Tool, width: float | None) -> int:
    """Return the number of equal steps outward to the last ring, none wider than ``width``."""
    words, context = entries.words, entries.words.context
    narrower, least = context.length(NARROWER_MM), context.smallest_ring
    widest = 2 * tool.radius - narrower if width is None else width
    if widest < least and width is None:
        raise words.refuse(
            f"J is missing: its default, the tool diameter {context.tool_size(2 * tool.radius)}"
            f" less {number(narrower)}, is too small"
        )
    words.check_least("J", widest, least)
    return max(1, steps_between(0.0, outermost, widest, context.rounding))


def depths_of(
    entries: EventEntries, depth: float, first_plane: float, peck: float | None
) -> dict[str, float]:
    """Return the locals of the levels from W down to Z; refuse a Z that is not below W."""
    context, letters = entries.words.context, entries.letters
    final = first_plane + depth if context.incremental else depth
    rough = final + entries.finish if entries.bottom else final
    distance = first_plane - rough
    if distance <= context.rounding:
        plane = f"{letters.first_plane}{number(first_plane)}"
        rule = f"must be below the first reference plane {plane}"
        if entries.bottom:
            rule += f" by more than {letters.finish}{number(entries.finish)}"
        raise entries.words.refuse_word("Z", depth, rule)
    peck = peck or distance
    pecks = max(0, steps_between(0.0, distance, peck, context.rounding) - 1)
    return {
        "levels": pecks + 1 + entries.bottom,
        "pecks": pecks,
        "peck": peck,
        "z": first_plane - peck if pecks else rough,
        "rough_z": rough,
        "final_z": final,
        "retract": context.length(RETRACT_MM),
    }


def side_finish_of(entries: EventEntries, circle: EventCircle, tool: Tool) -> dict[str, float]:
    """Return the locals of the side finish; refuse a finish too small for its entry arcs.

    Inside, the entry arc has the direction of the cut; outside, the opposite one.
    """
    words, finish = entries.words, entries.finish
    if finish:
        words.check_least(entries.letters.finish, finish, words.context.smallest_ring)
    other = opposite(circle.finish_arc)
    return {
        "side_finish": entries.finish > 0,
        "finish_radius": circle.radius + circle.side * tool.radius,
        "finish_arc": circle.finish_arc,
        "entry_arc": circle.finish_arc if circle.side == INNER_SIDE else other,
    }


def uncut_material(words: Words, width: float, tool: Tool) -> str | None:
    """Return the operator message of a pocket that leaves material uncut, or None."""
    if width <= 2 * tool.radius + words.context.rounding:
        return None
    return (
        f"{words.code}: the roughing width {number(width)} is greater"
        f" than the tool diameter {words.context.tool_size(2 * tool.radius)}: material is left"
        " between the rings"
    )
