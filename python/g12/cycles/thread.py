# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.6/G13.6 thread milling: inside or outside, right or left, tapered, one tooth or many.

The motions are in `ngc/g12_thread.ngc`. One run of the tool is a half circle onto the thread, its
helix, a half circle off it; the half circles have the share of the pitch that makes them tangent in
space. Nothing goes below Z. With one tooth a run is the whole length, with more it is one turn.

Rules, in the order of the checks: the modes of `check_modes`; every word known; Z required, R not
above the tool, Z below it; I required, above 0; P required, not 0; H whole, 0 or 1; J whole, from
1; K above 0, less than I; E from -1 to 1; Q above 0; L whole, from 0; the cutter; a length of a
pitch; a diameter above 0 over the whole taper; inside room for the cutter in the smaller diameter;
half circles that rise by less than a pitch; not too many turns.
"""

from math import ceil, cos, pi, sin, sqrt
from typing import NamedTuple

from g12.cut_report import ThreadCut
from g12.cycles.plan import (
    CLEARANCE_MM,
    Chosen,
    CyclePlan,
    Hole,
    check_block,
    chosen_cutter,
    hole_of,
    turns_of,
)
from g12.errors import number
from g12.request.common import CLOCKWISE, COUNTERCLOCKWISE, CycleExtent, check_count, steps_between
from g12.request.words import XY, Words

THREAD_WORDS = "X Y Z I P R K H J Q L E D F"
INSIDE, OUTSIDE = 0, 1  # H
HEIGHT = sqrt(3) / 2  # of the sharp 60 degree triangle, in pitches
DEPTHS = {INSIDE: 5 / 8, OUTSIDE: 17 / 24}  # of a thread in these heights: ISO 68, ISO 724
WITHIN_MM = 0.002  # of a taper: its arcs
MOST_TAPER = 1  # E: a cone of 53 degrees; pipe threads have 0.0625
QUARTER = 0.0212  # greatest error of a quarter turn's arc, per change of the radius in it


class Thread(NamedTuple):
    """The thread's words: radii at R, signed pitch, side, teeth, change of radius per length."""

    large: float
    small: float
    pitch: float
    outside: bool
    teeth: int
    taper: float

    def smallest(self, depth: float) -> float:
        """Return the smaller radius where the taper makes it smallest, at its top or at Z."""
        return self.small - max(0.0, self.taper) * depth


def plan_thread(words: Words, arc: int) -> CyclePlan:
    check_block(words, THREAD_WORDS)
    hole = hole_of(words)
    thread = thread_of(words)
    infeed = words.take_positive("Q") or thread.large - thread.small
    springs = words.take_whole("L", least=0)
    cutter = chosen_cutter(words)
    check_room(words, hole, thread, cutter)
    side = 1 if thread.outside else -1
    radius = (thread.small if thread.outside else thread.large) + side * cutter.radius
    rounding = words.context.rounding
    passes = max(1, steps_between(thread.small, thread.large, infeed, rounding))
    step = -side * (thread.large - thread.small) / passes
    clearance = words.context.length(CLEARANCE_MM)
    narrow = thread.smallest(hole.depth) + cutter.radius
    beside = (thread.large + cutter.radius + clearance - narrow) / 2
    ratio = -beside / narrow if thread.outside else 0.5
    share = abs(thread.pitch * ratio) / 2  # as the groove falls beside the half circle
    check_lead(words, thread, share)
    runs = runs_of(hole, thread, share, arc)
    check_count(words, ceil(runs["turns"] * abs(runs["rise"] / thread.pitch) * (passes + springs)),
                f"P{number(thread.pitch)} makes")  # fmt: skip
    other = CLOCKWISE + COUNTERCLOCKWISE - arc
    numbers = {
        "x": hole.x,
        "y": hole.y,
        "start": hole.start,
        "clear": hole.clear,
        "top": hole.top,
        "radius": radius - step * (passes - 1),
        "step": step,
        "infeeds": passes - 1,
        "passes": passes + springs,
        "outside": thread.outside,
        "ratio": ratio,
        "taper": thread.taper,
        "arc": arc,
        "lead_arc": other if thread.outside else arc,
        **runs,
        **segments_of(words, thread, runs["rise"], arc),
    }
    outermost = radius + abs(thread.taper) * hole.depth
    if thread.outside:
        outermost = (outermost + thread.large - thread.small) * (1 - 2 * ratio)
    ends = [runs["begin"], runs["begin"] + runs["rise"] + 2 * runs["lead"]]
    extent = CycleExtent(
        XY, (hole.x, hole.y, hole.bottom), outermost, (hole.start, hole.bottom, max(ends))
    )

    def cut() -> ThreadCut:
        return ThreadCut(
            (hole.x, hole.y),
            thread.large,
            thread.small,
            thread.pitch,
            thread.outside,
            thread.taper,
            thread.teeth,
            hole.top,
            (hole.bottom,),
            cutter.used,
        )

    return cutter.plan(numbers, extent, cut)


def thread_of(words: Words) -> Thread:
    large = words.require_positive("I", "the radius of the larger diameter")
    pitch = words.require("P", "the pitch, below 0 for a left-hand thread")
    if abs(pitch) < words.context.smallest_ring:
        raise words.refuse_word("P", pitch, "must not be 0: below 0 is a left-hand thread")
    side = words.take_whole("H", least=INSIDE, most=OUTSIDE, default=INSIDE)
    teeth = words.take_whole("J", least=1, default=1)
    small = words.take_positive("K")
    if small is None:
        small = large - DEPTHS[side] * HEIGHT * abs(pitch)
        if small <= 0:
            raise words.refuse_word("P", pitch, f"is too large for I{number(large)}")
    if small >= large - words.context.smallest_ring:
        raise words.refuse_word("K", small, f"must be less than I{number(large)}")
    taper = words.take("E") or 0.0
    if abs(taper) > MOST_TAPER:
        raise words.refuse_word("E", taper, "changes the diameter by more than the length")
    return Thread(large, small, pitch, side == OUTSIDE, teeth, taper / 2)


def check_room(words: Words, hole: Hole, thread: Thread, cutter: Chosen) -> None:
    """Refuse a thread shorter than its pitch, or one in which the cutter does not fit."""
    context = words.context
    if hole.depth < abs(thread.pitch) - context.rounding:
        rule = f"is longer than the thread, {number(hole.depth)} from its top to Z"
        raise words.refuse_word("P", thread.pitch, rule)
    smallest = thread.smallest(hole.depth)
    if smallest < context.smallest_ring:
        raise words.refuse_word("E", 2 * thread.taper, "leaves no diameter at Z")
    if thread.outside or cutter.radius < smallest - context.smallest_ring:
        return
    size = context.tool_size(2 * cutter.radius)
    raise words.refuse(
        f"the tool diameter {size} ({cutter.source}) must be less than the smaller diameter"
        f" {number(2 * smallest)}{' at Z' if thread.taper else ''}"
    )


def check_lead(words: Words, thread: Thread, share: float) -> None:
    """Refuse half circles so wide beside a thin thread that nothing is left of the helix."""
    pitch = abs(thread.pitch)
    if share > pitch - words.context.smallest_ring:
        rise = f"the half circle onto the thread would rise by {number(share)}"
        rule = f"is too thin: {rise}, the pitch is {number(pitch)}"
        raise words.refuse_word("K", thread.small, rule)


def runs_of(hole: Hole, thread: Thread, share: float, arc: int) -> dict[str, float]:
    """Return the locals of the runs: their number, where the first begins, how each rises.

    Right-hand and counterclockwise is up, as left-hand and clockwise. Several teeth cut as many
    pitches in a turn; the last run overlaps instead of going beyond the top by a pitch or more.
    """
    pitch = abs(thread.pitch)
    up = (thread.pitch > 0) == (arc == COUNTERCLOCKWISE)
    sign = 1 if up else -1
    height, beyond, turns = hole.depth - share, 0.0, 1
    advance = thread.teeth * pitch
    if thread.teeth > 1:
        pitches = max(0, ceil(height / pitch - 1e-6) - thread.teeth)
        height, beyond, turns = pitch, pitches * pitch, ceil(pitches / thread.teeth) + 1
    begin = hole.bottom if up else hole.bottom + beyond + height + 2 * share
    last = beyond - advance * (turns - 2)
    return {
        "turns": turns,
        "begin": begin,
        "lead": sign * share,
        "rise": sign * height,
        "advance": sign * advance,
        "last_advance": sign * last,
    }


def segments_of(words: Words, thread: Thread, rise: float, arc: int) -> dict[str, float]:
    """Return the locals of a helix: one arc of all turns, or short ones along a taper."""
    pitch = abs(thread.pitch)
    if not thread.taper:
        turns = turns_of(abs(rise), pitch, arc)
        return {
            "segments": 1,
            "rounds": turns["rounds"],
            "turn_x": turns["end_x"],
            "turn_y": turns["end_y"],
        }
    error = QUARTER * abs(thread.taper) * pitch / 4
    finer = max(1, ceil((error / words.context.length(WITHIN_MM)) ** (1 / 3)))
    segments = ceil(4 * finer * abs(rise) / pitch)
    angle = 2 * pi * abs(rise) / pitch / segments * (1 if arc == COUNTERCLOCKWISE else -1)
    return {"segments": segments, "rounds": 1, "turn_x": cos(angle), "turn_y": sin(angle)}
