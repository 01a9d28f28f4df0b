# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.6/G13.6 thread milling: inside or outside, right or left, tapered, one tooth or many.

The motions are in `ngc/g12_thread.ngc`. One run of the tool is a half circle onto the thread, its
helix, a half circle off it; the half circles have the share of the pitch that makes them tangent in
space. Nothing goes below Z. With one tooth a run is the whole length, with more it is one turn.
"""

from math import ceil, sqrt
from typing import NamedTuple

from g12.cut_report import ThreadCut
from g12.cycles.plan import CLEARANCE_MM, CyclePlan, Hole, hole_of, turns_of
from g12.errors import number
from g12.request import COUNTERCLOCKWISE, Cutter, Words, opposite, steps_between
from g12.settings import Settings

THREAD_WORDS = "X Y Z I P R K H J Q L E D F"
INSIDE, OUTSIDE = 0, 1  # H
HEIGHT = sqrt(3) / 2  # of the sharp 60 degree triangle, in pitches
DEPTHS = {INSIDE: 5 / 8, OUTSIDE: 17 / 24}  # of a thread in these heights: ISO 68, ISO 724
WITHIN_MM = 0.002  # of a taper: its arcs
MOST_TAPER = 1  # E: a cone of 53 degrees; pipe threads have 0.0625
QUARTER = 0.03  # greatest error of a quarter turn's arc, per change of the radius in it


class Thread(NamedTuple):
    """The thread's words: radii at R, signed pitch, side, change of radius per length, teeth."""

    large: float
    small: float
    pitch: float
    outside: bool
    taper: float
    teeth: int

    def smallest(self, depth: float) -> float:
        """Return the smaller radius where the taper makes it smallest, at its top or at Z."""
        return self.small - max(0.0, self.taper) * depth


def plan(words: Words, arc: int, _: Settings) -> CyclePlan:
    words.check_block(THREAD_WORDS)
    hole = hole_of(words)
    thread = thread_of(words)
    high = thread.large - thread.small
    infeed = words.take_positive("Q") or high
    springs = words.take_whole("L", least=0)
    cutter = words.sized_cutter()
    check_room(words, hole, thread, cutter)
    passes = max(1, steps_between(thread.small, thread.large, infeed, words.context.rounding))
    ratio = lead_ratio(words, hole, thread, cutter)
    runs = runs_of(words, hole, thread, ratio, arc)
    turns = ceil(runs["runs"] * abs(runs["rise"] / thread.pitch) * (passes + springs))
    words.check_count(turns, "P, Q and L make")
    side = 1 if thread.outside else -1
    radius = (thread.small if thread.outside else thread.large) + side * cutter.radius
    numbers = {
        **hole._asdict(),
        **runs,
        **segments_of(words, thread, runs["rise"], arc),
        "radius": radius + side * high * (passes - 1) / passes,
        "step": -side * high / passes,
        "infeeds": passes - 1,
        "passes": passes + springs,
        "outside": thread.outside,
        "ratio": ratio,
        "taper": thread.taper,
        "arc": arc,
        "lead_arc": opposite(arc) if thread.outside else arc,
    }
    widest = radius + abs(thread.taper) * hole.depth
    if thread.outside:
        widest = (widest + high) * (1 - 2 * ratio)
    highest = max(runs["begin"], runs["last"] + runs["rise"] + 2 * runs["lead"])
    words.check_travel((hole.x, hole.y, hole.z), widest, (hole.start, hole.z, highest))
    cut = ThreadCut((hole.x, hole.y), *thread, hole.top, (hole.z,), cutter.used)
    return CyclePlan(numbers, cut, cutter)


def thread_of(words: Words) -> Thread:
    large = words.require_positive("I", "the radius of the larger diameter")
    pitch = words.require("P", "the pitch, below 0 for a left-hand thread")
    least = 2 * words.context.smallest_ring
    if abs(pitch) < least:
        rule = f"must be at least {number(least)} in size: below 0 is a left-hand thread"
        raise words.refuse_word("P", pitch, rule)
    side = words.take_whole("H", least=INSIDE, most=OUTSIDE, default=INSIDE)
    teeth = words.take_whole("J", least=1, default=1)
    small = words.take_positive("K") or large - DEPTHS[side] * HEIGHT * abs(pitch)
    if small <= 0:
        raise words.refuse_word("P", pitch, f"is too large for I{number(large)}")
    if small >= large - words.context.smallest_ring:
        raise words.refuse_word("K", small, f"must be less than I{number(large)}")
    taper = words.take("E") or 0.0
    if abs(taper) > MOST_TAPER:
        raise words.refuse_word("E", taper, "changes the diameter by more than the length")
    return Thread(large, small, pitch, side == OUTSIDE, taper / 2, teeth)


def check_room(words: Words, hole: Hole, thread: Thread, cutter: Cutter) -> None:
    """Refuse a thread shorter than its pitch, or one in which the cutter does not fit."""
    context = words.context
    if hole.depth < abs(thread.pitch) - context.rounding:
        rule = f"is longer than the thread, {number(hole.depth)} from its top to Z"
        raise words.refuse_word("P", thread.pitch, rule)
    smallest = thread.smallest(hole.depth)
    if smallest < context.smallest_ring:
        raise words.refuse_word("E", 2 * thread.taper, "leaves no diameter at Z")
    if not thread.outside and cutter.radius > smallest - context.smallest_ring:
        size = context.tool_size(2 * cutter.radius)
        raise words.refuse(
            f"the tool diameter {size} ({cutter.source}) must be less than the smaller diameter"
            f" {number(2 * smallest)}{' at Z' if thread.taper else ''}"
        )


def lead_ratio(words: Words, hole: Hole, thread: Thread, cutter: Cutter) -> float:
    """Return the half circles' radius to the thread's: outside below 0, clear of the crest."""
    if not thread.outside:
        return 0.5
    narrow = thread.smallest(hole.depth) + cutter.radius
    return (narrow - thread.large - cutter.radius - words.context.length(CLEARANCE_MM)) / (
        2 * narrow
    )


def runs_of(words: Words, hole: Hole, thread: Thread, ratio: float, arc: int) -> dict[str, float]:
    """Return the locals of the runs: their number, the first and the last, how each rises.

    Right-hand and counterclockwise is up, as left-hand and clockwise. Several teeth cut as many
    pitches in a turn; the last run overlaps instead of going beyond the top by a pitch or more. A
    thread is refused whose half circles are so wide beside it that nothing is left of the helix.
    """
    pitch = abs(thread.pitch)
    share = abs(pitch * ratio) / 2  # as the groove falls beside the half circle
    if share > pitch - words.context.smallest_ring:
        lead = f"the half circle onto the thread would rise by {number(share)}"
        rule = f"is too thin: {lead}, the pitch is {number(pitch)}"
        raise words.refuse_word("K", thread.small, rule)
    sign = 1 if (thread.pitch > 0) == (arc == COUNTERCLOCKWISE) else -1
    rise, beyond, runs = hole.depth - share, 0.0, 1
    if thread.teeth > 1:
        pitches = max(0, ceil(rise / pitch - 1e-6) - thread.teeth)
        rise, beyond, runs = pitch, pitches * pitch, ceil(pitches / thread.teeth) + 1
    begin = hole.z if sign > 0 else hole.z + beyond + rise + 2 * share
    return {
        "runs": runs,
        "begin": begin,
        "last": begin + sign * beyond,
        "advance": sign * thread.teeth * pitch,
        "lead": sign * share,
        "rise": sign * rise,
    }


def segments_of(words: Words, thread: Thread, rise: float, arc: int) -> dict[str, float]:
    """Return the locals of a helix: one arc of all turns, or short ones along a taper."""
    pitch = abs(thread.pitch)
    if not thread.taper:
        return {"segments": 1, **turns_of(abs(rise), pitch, arc)}
    error = QUARTER * abs(thread.taper) * pitch / 4
    finer = max(1, ceil((error / words.context.length(WITHIN_MM)) ** (1 / 3)))
    segments = ceil(4 * finer * abs(rise) / pitch)
    return {"segments": segments, **turns_of(abs(rise) / segments, pitch, arc)}
