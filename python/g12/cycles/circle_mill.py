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

Rules, in the order of the checks. Of a call: V and F above 0, `check_modes`, G 0 or 7, L not 0; of
a code: `check_modes`, every word known, L only with Q, Q above 0, L 0 or 1. Of both: X, Y, R
required, R above 0; D from 0 to 3, C required, from 0 to 2, in a pocket the pairs that put the
tool inside; no finish with C0; W known from here or an earlier event, O not below W; Z required;
K, J, P above 0; a tool with a diameter in the spindle; R with room for it; J in pockets only, and
not too small; the deepest rough level below W; not too many circles; L not too small.

`check_start` is not needed: the first move goes to the plunge point, which X and Y name.
"""

from typing import NamedTuple

from g12.errors import number
from g12.lengths import ROUNDING_MM
from g12.request.common import (
    CLOCKWISE,
    COUNTERCLOCKWISE,
    LEFT_OUT,
    SMALLEST_RING_MM,
    check_count,
    check_modes,
    coordinate,
    loaded_tool,
    steps_between,
)
from g12.request.context import XY, Context, Tool
from g12.request.travel import CycleExtent
from g12.request.words import Words

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

    ``plane`` is the first reference plane last commanded (None: none was), ``finish`` the
    finish dimension L (0: no finish), ``bottom`` whether it is for the bottom as well.
    """

    words: Words
    letters: EntryLetters
    context: Context
    plane: float | None
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


class EventPosition(NamedTuple):
    """The event's XY positions and reference planes; ``below``: the tool starts below W."""

    x: float
    y: float
    start_x: float
    start_y: float
    first_plane: float
    second_plane: float
    below: bool


class Roughing(NamedTuple):
    """The circles of one level, radii of the tool centre; a perimeter is one ring.

    ``plunge_radius`` is the distance of the plunge point from the centre, in -Y.
    """

    pocket: bool
    plunge_radius: float
    rings: int
    roughing_width: float
    rough_radius: float
    rough_arc: int


class Depths(NamedTuple):
    """The levels: ``pecks`` of them above the last rough one, ``z`` the first one's depth."""

    levels: int
    pecks: int
    peck: float
    z: float
    rough_z: float
    final_z: float
    retract: float


class SideFinish(NamedTuple):
    """The finish pass along the side, ``side_finish`` False for none, and its tangent entry."""

    side_finish: bool
    finish_radius: float
    finish_arc: int
    entry_arc: int

    @property
    def radius(self) -> float:
        return self.finish_radius if self.side_finish else 0.0


class EventFeeds(NamedTuple):
    """Feeds per minute or revolution."""

    plunge_feed: float
    feed: float
    finish_feed: float


class MillEvent(NamedTuple):
    """A checked event. Lengths and feeds are in program units."""

    position: EventPosition
    roughing: Roughing
    depths: Depths
    side_finish: SideFinish
    feeds: EventFeeds
    message: str | None  # for the operator, never a refusal

    def extent(self) -> CycleExtent:
        position, final = self.position, self.depths.final_z
        radius = max(self.roughing.rough_radius, self.side_finish.radius)
        heights = (position.first_plane, position.second_plane, final)
        return CycleExtent(XY, (position.x, position.y, final), radius, heights)

    def locals(self) -> dict[str, float]:
        groups = (self.position, self.roughing, self.depths, self.side_finish, self.feeds)
        return {name: value for group in groups for name, value in group._asdict().items()}


def plan_code(words: Words, context: Context, plane: float | None, pocket: bool) -> MillEvent:
    """Return the event of a code block (G12.2, or G13.2: ``pocket``), or raise `Refusal`.

    ``plane`` is the first reference plane last commanded, None if there is none.
    """
    check_modes(words, context)
    words.check_known(EVENT_WORDS)
    finish, bottom = finish_of_code(words)
    return plan_event(
        EventEntries(
            words, CODE_LETTERS, context, plane, pocket, finish, bottom, finish_feed=context.feed
        )
    )


def plan_call(words: Words, context: Context, plane: float | None) -> MillEvent:
    """Return the event of one ``o<circle_mill> call``, or raise `Refusal`."""
    finish_feed = finish_feed_of_call(words)
    context = context._replace(feed=words.take_positive("F") or context.feed)
    check_modes(words, context)
    cycle = words.take("G") or PERIMETER_CYCLE
    if cycle not in (PERIMETER_CYCLE, POCKET_CYCLE):
        raise words.refuse(f"G{number(cycle)} must be 0 (perimeter) or 7 (pocket)")
    pocket = cycle == POCKET_CYCLE
    finish, bottom = finish_of_call(words)
    feed = finish_feed or context.feed
    return plan_event(
        EventEntries(words, CALL_LETTERS, context, plane, pocket, finish, bottom, finish_feed=feed)
    )


def entries_by_letter(values: list[float]) -> dict[str, float]:
    """Return a call's entries by letter, without those that are left out."""
    return {letter: value for letter, value in zip(EVENT_ENTRIES, values) if value != LEFT_OUT}


def finish_feed_of_call(words: Words) -> float | None:
    """Return V, the last entry: LinuxCNC makes it 0 if the call is too short."""
    feed = words.take("V")
    if feed is not None and feed <= 0:
        raise words.refuse(
            f"V{number(feed)} must be greater than 0 (a call has {len(EVENT_ENTRIES)} entries,"
            f" {number(LEFT_OUT)} leaves one out)"
        )
    return feed


def finish_of_code(words: Words) -> tuple[float, bool]:
    """Return finish dimension and bottom finish of the words Q and L."""
    if "L" in words and "Q" not in words:
        raise words.refuse("L needs Q as well: the finish dimension")
    finish = words.take_positive("Q") or 0.0
    bottom = words.take_whole("L", least=0, most=1, default=1)
    return finish, finish > 0 and bottom == 1


def finish_of_call(words: Words) -> tuple[float, bool]:
    """Return finish dimension and bottom finish of the entry L, below zero: incremental."""
    finish = words.take("L")
    if finish == 0:
        raise words.refuse(f"L0 must not be 0; {number(LEFT_OUT)} leaves it out")
    return abs(finish or 0.0), (finish or 0.0) > 0


def plan_event(entries: EventEntries) -> MillEvent:
    words, context = entries.words, entries.context
    circle = circle_of(entries)
    first_plane, second_plane = planes_of(entries)
    depth = words.require("Z", "the final depth")
    peck = words.take_positive("K")
    width = words.take_positive("J")
    plunge_feed = words.take_positive("P") or context.feed
    tool = loaded_tool(words, context)
    roughing = roughing_of(entries, circle, tool, width)
    depths = depths_of(entries, depth, first_plane, peck)
    check_count(words, roughing.rings * depths.levels, "J and K make")
    below = context.z < first_plane - context.length(ROUNDING_MM)
    return MillEvent(
        EventPosition(circle.x, circle.y, context.x, context.y, first_plane, second_plane, below),
        roughing,
        depths,
        side_finish_of(entries, circle, tool),
        EventFeeds(plunge_feed, context.feed, entries.finish_feed),
        uncut_material(entries, roughing, tool),
    )


def circle_of(entries: EventEntries) -> EventCircle:
    """Return centre, radius, side and directions: X, Y, R, D and C."""
    words, letter = entries.words, entries.letters.side
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
        raise entries.words.refuse(
            f"D{direction} with {letter}{compensation} does not put the tool inside the pocket:"
            f" D0 and D2 need {letter}2, D1 and D3 need {letter}1"
        )
    if side == ON_CIRCLE and entries.finish:
        raise entries.words.refuse(
            f"{entries.letters.finish}{number(entries.finish)}: there is no finish pass"
            f" with the tool centre on the circle ({letter}0)"
        )
    context = entries.context
    x, y = coordinate(x, context.x, context), coordinate(y, context.y, context)
    return EventCircle(x, y, radius, side, rough_arc, finish_arc)


def planes_of(entries: EventEntries) -> tuple[float, float]:
    """Return the reference planes W, modal, and O, which is W unless the block has it."""
    words, letters = entries.words, entries.letters
    first, second = words.take(letters.first_plane), words.take(letters.second_plane)
    if first is None:
        first = entries.plane
    if first is None:
        raise entries.words.refuse(
            f"{letters.first_plane} is missing: the first reference plane,"
            " which no earlier event has commanded"
        )
    if second is None:
        second = first
    if second < first - entries.context.length(ROUNDING_MM):
        raise entries.words.refuse(
            f"{letters.second_plane}{number(second)} must not be below the first reference"
            f" plane {letters.first_plane}{number(first)}"
        )
    return first, second


def roughing_of(
    entries: EventEntries, circle: EventCircle, tool: Tool, width: float | None
) -> Roughing:
    radius = circle.radius + circle.side * (tool.radius + entries.finish)
    check_room(entries, circle, tool, radius)
    if not entries.pocket:
        if width is not None:
            raise entries.words.refuse(f"J{number(width)} is the roughing width of a pocket")
        return Roughing(False, radius, 1, 0.0, radius, circle.rough_arc)
    rings = rings_of(entries, radius, tool, width)
    return Roughing(True, 0.0, rings, radius / rings, radius, circle.rough_arc)


def check_room(entries: EventEntries, circle: EventCircle, tool: Tool, radius: float) -> None:
    """Refuse a circle too small for its tool and finish: ``radius`` is the tool centre's."""
    smallest = entries.context.length(SMALLEST_RING_MM)
    if radius >= smallest:
        return
    if circle.side == ON_CIRCLE:
        raise entries.words.refuse(f"R{number(circle.radius)} must be at least {number(smallest)}")
    finish = f" + {entries.letters.finish}{number(entries.finish)}" if entries.finish else ""
    raise entries.words.refuse(
        f"R{number(circle.radius)} must be greater than the tool radius"
        f" {entries.context.tool_size(tool.radius)} (T{tool.number}){finish}"
    )


def rings_of(entries: EventEntries, outermost: float, tool: Tool, width: float | None) -> int:
    """Return the number of equal steps outward to the last ring, none wider than ``width``."""
    length = entries.context.length
    widest = 2 * tool.radius - length(NARROWER_MM) if width is None else width
    least = length(SMALLEST_RING_MM)
    if widest < least and width is None:
        size = entries.context.tool_size(2 * tool.radius)
        raise entries.words.refuse(
            f"J is missing: its default, the tool diameter {size}"
            f" less {number(length(NARROWER_MM))}, is too small"
        )
    if widest < least:
        raise entries.words.refuse(f"J{number(widest)} must be at least {number(least)}")
    return max(1, steps_between(0.0, outermost, widest, length(ROUNDING_MM)))


def depths_of(
    entries: EventEntries, depth: float, first_plane: float, peck: float | None
) -> Depths:
    """Return the levels from W down to Z; refuse a Z that is not below W."""
    context = entries.context
    final = first_plane + depth if context.incremental else depth
    rough = final + entries.finish if entries.bottom else final
    distance = first_plane - rough
    if distance <= context.length(ROUNDING_MM):
        finish = (
            f" by more than {entries.letters.finish}{number(entries.finish)}"
            if entries.bottom
            else ""
        )
        raise entries.words.refuse(
            f"Z{number(depth)} must be below the first reference plane"
            f" {entries.letters.first_plane}{number(first_plane)}{finish}"
        )
    peck = peck or distance
    pecks = max(0, steps_between(0.0, distance, peck, context.length(ROUNDING_MM)) - 1)
    first = first_plane - peck if pecks else rough
    levels = pecks + 1 + entries.bottom
    return Depths(levels, pecks, peck, first, rough, final, context.length(RETRACT_MM))


def side_finish_of(entries: EventEntries, circle: EventCircle, tool: Tool) -> SideFinish:
    """Return the side finish; refuse a finish dimension too small for its entry arcs.

    Inside, the entry arc has the direction of the cut; outside, the opposite one.
    """
    smallest = entries.context.length(SMALLEST_RING_MM)
    if 0 < entries.finish < smallest:
        raise entries.words.refuse(
            f"{entries.letters.finish}{number(entries.finish)} must be at least {number(smallest)}"
        )
    other = CLOCKWISE + COUNTERCLOCKWISE - circle.finish_arc
    return SideFinish(
        side_finish=entries.finish > 0,
        finish_radius=circle.radius + circle.side * tool.radius,
        finish_arc=circle.finish_arc,
        entry_arc=circle.finish_arc if circle.side == INNER_SIDE else other,
    )


def uncut_material(entries: EventEntries, roughing: Roughing, tool: Tool) -> str | None:
    """Return the operator message of a pocket that leaves material uncut, or None."""
    rounding = entries.context.length(ROUNDING_MM)
    if roughing.roughing_width <= 2 * tool.radius + rounding:
        return None
    return (
        f"{entries.words.code}: the roughing width {number(roughing.roughing_width)} is greater"
        f" than the tool diameter {entries.context.tool_size(2 * tool.radius)}: material is left"
        " between the rings"
    )
