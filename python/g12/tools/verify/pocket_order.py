# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a cycle goes down, across and to its end, and what it leaves, against the words.

Places are points in machine coordinates, mm.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.wanted_circle import AHEAD, OUTWARD, Places, Target, Wall

SAME_STATE = 1e-5  # relative: values are told with nine decimals
ACROSS = 1e-6  # mm
SAME_FAST = 0.002  # mm
KINDS = {"rapid": "rapid", "feed": "straight move", "probe": "probing move"}
ENDS, DOWN_TO, UP_TO = "it ends at", "it goes down to", "it is fed up to"
ACT = re.compile(r"(G|M\d|S|tool|dwell (?!0$))")  # of what a trace tells
TOLD = {43.0, 43.1, 43.2, 49.0, *(54.0, 55.0, 56.0, 57.0, 58.0, 59.0, 59.1, 59.2, 59.3)}
TOLD |= {61.0, 61.1, 64.0, 96.0, 97.0}  # codes of which a trace tells
UNITS, FORGOTTEN = {20.0, 21.0}, "G64 P0.1 Q0.1"  # what a preview makes of G64 where units change


class Misplaced(NamedTuple):
    """Something that is at another place than the words ask for; ``what`` in words.

    ``found`` is None where it is not there at all, ``asked`` where it is not in the words.
    """

    what: str
    found: tuple[float, ...] | None
    asked: tuple[float, ...] | None


class LeftBehind(NamedTuple):
    """A modal value that a block left otherwise than its words ask, in program units."""

    name: str
    found: float
    asked: float


def left_otherwise(block: Block, leaves: Mapping[str, float]) -> tuple[LeftBehind, ...]:
    """Return which modal values are not as they should be behind a block."""
    return tuple(
        LeftBehind(name, block.left[name], asked)
        for name, asked in leaves.items()
        if block.left and abs(block.left[name] - asked) > SAME_STATE * max(1.0, abs(asked))
    )


def acts_in(block: Block) -> tuple[str, ...]:
    """Return what a block does besides moving, as a trace tells it, though it does not say so."""
    says_more = block.m_codes or block.words.keys() & {"S", "T"} or set(block.codes) & TOLD
    told = [] if says_more else [event.text for event in block.own_events if ACT.match(event.text)]
    forgotten = FORGOTTEN if UNITS.intersection(block.codes) else None
    return tuple(dict.fromkeys(text for text in told if text != forgotten))


def misplaced(
    target: Target, moves: Sequence[Move], circles: Sequence[int], tolerance: float
) -> tuple[Misplaced, ...]:
    """Return what is not where the words want it; ``circles`` are the full ones, by indices."""
    places = target.places
    if places is None or not moves:
        return ()
    starts, ends = (
        target.wall.local(np.array([getattr(move, end)[:3] for move in moves]))
        for end in ("start", "end")
    )
    found = [
        *of_rapids(places, moves, starts, ends, circles),
        *of_plunges(places, moves, starts, ends),
        *of_depths(moves, starts, ends, () if target.schedule.helix else circles),
        *of_leads(places, starts, circles[:1] if target.schedule.helix else circles),
        *of_links(target, moves, starts, ends, circles),
        *of_finish(target, moves, starts, ends, circles),
        *of_entry(places, moves, ends),
        (ENDS, ends[-1], np.array(places.end)),
    ]
    strays = [*of_climbs(moves, starts, ends, tolerance)]
    strays += of_fast(places, moves, starts, ends) if places.fast is not None else ()
    wrong = [place for place in found if np.abs(place[1] - place[2]).max() > tolerance]
    return tuple(
        Misplaced(what, in_machine(target.wall, was), in_machine(target.wall, to))
        for what, was, to in (*wrong, *strays)
    )


def in_machine(wall: Wall, place: np.ndarray | None) -> tuple[float, ...] | None:
    """Return a place as seen from a wall's centre in machine coordinates."""
    return None if place is None else tuple(map(float, wall.origin + place @ wall.axes))


Found = Iterator["tuple[str, np.ndarray, np.ndarray]"]
Strays = Iterator["tuple[str, np.ndarray | None, np.ndarray | None]"]


def growth_of(target: Target, moves: Sequence[Move], circles: Sequence[int]) -> float:
    """Return by how much a spiral grows in a turn: twice the most of its half turns.

    These are arcs between arcs that leave the centre out, and a helix from which one comes.
    """
    kinds = [move.kind for move in moves]
    helix = target.schedule.helix
    inside = helix.radius * (1.0 + SAME_STATE) if helix and helix.within else ACROSS
    most = 0.0
    for index in range(1, len(moves) - 1):
        if kinds[index - 1 : index + 2] == ["arc"] * 3 and index not in circles:
            points = target.wall.local(np.array([moves[index].start[:3], moves[index].end[:3]]))
            start, end = np.hypot(*points[:, :2].T)
            if min(start, end) > inside:
                most = max(most, 2 * abs(end - start))
    return float(most)


def of_rapids(
    places: Places,
    moves: Sequence[Move],
    starts: np.ndarray,
    ends: np.ndarray,
    circles: Sequence[int],
) -> Found:
    """Yield the rapids: across at the height of their stage, down not below the first plane."""
    for index, move in enumerate(moves):
        start, end = starts[index], ends[index]
        if move.kind != "rapid":
            continue
        if np.abs(end - start)[:2].max() > ACROSS:
            height = height_across(places, index, starts, circles)
            yield "a rapid goes across at", end, np.array([*end[:2], height])
        elif end[2] < start[2]:
            yield "a rapid goes down to", end, np.array([*end[:2], max(end[2], places.first)])


def of_fast(places: Places, moves: Sequence[Move], starts: np.ndarray, ends: np.ndarray) -> Strays:
    """Yield the fast moves that are missing, not in the words, or not fast.

    Links from ring to ring are straight moves at feed: only those that a fast move should be, or
    that stand in its place, are looked at.
    """
    waiting = list(places.fast)
    for move, start, end in zip(moves, starts, ends):
        across = np.abs(end - start)[:2].max() > ACROSS
        if move.kind == "arc" or not across:
            continue
        next_one = next(iter(waiting), None)
        there = next_one and np.abs(end[:2] - next_one[1]).max() <= SAME_FAST
        if there and np.abs(start[:2] - next_one[0]).max() <= SAME_FAST:
            waiting.pop(0)
            if move.kind != places.straight:
                yield f"a {KINDS[places.straight]} goes as a {KINDS[move.kind]} to", None, end
        elif there and move.kind == places.straight:
            begin, _ = waiting.pop(0)
            yield f"a {KINDS[move.kind]} comes from", start, np.array([*begin, start[2]])
        elif move.kind == "rapid" or places.straight == "feed":
            yield f"a {KINDS[move.kind]} goes to", end, None
    for _, place in waiting:
        yield f"a {KINDS[places.straight]} is missing to", None, np.array([*place, ends[-1][2]])


def of_climbs(
    moves: Sequence[Move], starts: np.ndarray, ends: np.ndarray, tolerance: float
) -> Strays:
    """Yield the feed moves straight up, which no cycle has."""
    for move, start, end in zip(moves, starts, ends):
        if is_upright(move, start, end) and end[2] - start[2] > tolerance:
            yield UP_TO, end, None


def is_upright(move: Move, start: np.ndarray, end: np.ndarray) -> bool:
    """Tell whether a feed move goes square to the plane."""
    across, along = np.abs(end - start)[:2].max(), abs(end - start)[2]
    return move.kind == "feed" and bool(across <= ACROSS < along)


def height_across(places: Places, index: int, starts: np.ndarray, circles: Sequence[int]) -> float:
    """Return the height of a rapid across before, between or behind the circles."""
    before = [circle for circle in circles if circle < index]
    if not before:
        return max(starts[0][2], places.first)
    if len(before) == len(circles):
        return places.last
    return min(starts[before[-1]][2] + places.retract, places.first)


def of_plunges(
    places: Places, moves: Sequence[Move], starts: np.ndarray, ends: np.ndarray
) -> Found:
    """Yield the feed moves straight down: their place, and the first one's beginning."""
    height = places.first
    for move, start, end in zip(moves, starts, ends):
        if is_upright(move, start, end) and end[2] < start[2]:
            height = start[2] if height is None else height
            yield "it goes down from", start, np.array([*places.plunge, height])
            height = None


def of_depths(
    moves: Sequence[Move], starts: np.ndarray, ends: np.ndarray, circles: Sequence[int]
) -> Found:
    """Yield the feed moves straight down, which the next circle's depth ends."""
    for index, move in enumerate(moves):
        following = next((circle for circle in circles if circle > index), None)
        down = move.kind == "feed" and starts[index][2] - ends[index][2] > ACROSS
        if down and following is not None:
            yield DOWN_TO, ends[index], np.array([*ends[index][:2], starts[following][2]])


def of_entry(places: Places, moves: Sequence[Move], ends: np.ndarray) -> Found:
    """Yield where the first arc ends, if a spiral begins there."""
    arcs = [end for move, end in zip(moves, ends) if move.kind == "arc"]
    if places.entry and arcs:
        yield "its spiral begins at", arcs[0], np.array([*places.entry, arcs[0][2]])


def of_leads(places: Places, starts: np.ndarray, circles: Sequence[int]) -> Found:
    """Yield where the first circle of each level begins, or each one if links lead outward."""
    depth = None
    for start in starts[list(circles)]:
        if depth is None or places.link == OUTWARD or abs(start[2] - depth) > ACROSS:
            around = np.hypot(*start[:2]) * np.array(places.lead)
            yield "a circle begins at", start, np.array([*around, start[2]])
        depth = start[2]


def of_links(
    target: Target,
    moves: Sequence[Move],
    starts: np.ndarray,
    ends: np.ndarray,
    circles: Sequence[int],
) -> Found:
    """Yield the links to larger rings: straight ahead by what they are larger, and a quarter turn.

    It is no use to look at them where the circles are not those of the words.
    """
    if target.places.link != AHEAD or len(circles) != len(target.schedule.circles):
        return
    for ring, following in zip(circles, circles[1:]):
        start, larger = starts[ring], np.hypot(*starts[following][:2])
        radius = np.hypot(*start[:2])
        if larger > radius + ACROSS and moves[ring + 1].kind == "feed":
            turn = np.copysign(1.0, moves[ring].turns) / radius
            ahead = turn * np.array([-start[1], start[0], 0.0])
            yield "a link goes to", ends[ring + 1], start + (larger - radius) * ahead
            there = [*(larger * ahead)[:2], starts[following][2]]
            yield "a circle begins at", starts[following], np.array(there)


def of_finish(
    target: Target,
    moves: Sequence[Move],
    starts: np.ndarray,
    ends: np.ndarray,
    circles: Sequence[int],
) -> Found:
    """Yield where the arc behind a finish pass ends: where the rough circle before it began."""
    as_asked = len(circles) == len(target.schedule.circles) > 1
    if target.schedule.finish_turn and as_asked and circles[-1] + 1 < len(moves):
        begun, behind = starts[circles[-2]], circles[-1] + 1
        yield "its finish leads off to", ends[behind], np.array([*begun[:2], ends[behind][2]])
