# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section does block by block: heights and feeds against the words.

Lengths are millimetres, feeds mm/min along the part, C's speed degrees/s.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

from g12.tools.path.part import C, Y
from g12.tools.path.track import Track, feed_length, rate
from g12.tools.preview.moves import Move
from g12.tools.verify.section_motion import SectionAxes, turns
from g12.tools.verify.wanted_contour import Element, SectionContour

SAME_LEVEL = 1e-3  # mm
SAME_FEED = 0.01
LEAST_ON_FACE = 0.5  # of the feed: so slow may a part of a line be on the face of the kinematics
LEAST_LENGTH = 0.02  # mm: the feed of a shorter piece is rounding
SHORT = 0.02  # mm: less of a line may be rounding
BEND = 3.0 * math.sqrt(3.0) / 8.0
TURN = 1e-6  # mm along the part: C turns in place


class OffWords(NamedTuple):
    """A value that a line has not as its words ask: what was found, and what is asked."""

    line: int
    found: float
    asked: float


class InPlace(NamedTuple):
    """Turns of C where the tool stays on its place on the part: degrees and seconds in all."""

    degrees: float
    seconds: float


class OffOrder(NamedTuple):
    """A line that is not cut in its place, or not as long: ``what`` in words for ``lengths``."""

    line: int
    what: str
    lengths: tuple[float, ...] = ()


class BlockOfSection(NamedTuple):
    """The moves (indices) of one block, or of equal lines in a row, and what they should make.

    ``above`` is the height in front of the block, program coordinates: Z, of a cylinder X.
    """

    elements: list[Element]
    above: float
    moves: list[int]


def drawn_blocks(section: SectionContour) -> list[tuple[list[Element], float]]:
    """Return the elements of each block, or of equal lines in a row, and the height in front."""
    groups = [list(group) for _, group in groupby(section.elements, lambda element: element.line)]
    return list(zip(groups, [section.height, *(group[-1].depth for group in groups)]))


def blocks_moved(
    section: SectionContour, moves: Sequence[Move]
) -> Iterator[tuple[list[int], int | None]]:
    """Yield the moves (indices) of each line in turn, with the drawn block that they make.

    That is an index into ``drawn_blocks``, None where no block of the line is left.
    """
    lines = [elements[0].line for elements, _ in drawn_blocks(section)]
    at = 0
    for line, own in groupby(range(section.at, section.end), lambda index: moves[index].line):
        found = next((index for index in range(at, len(lines)) if lines[index] == line), None)
        at = at if found is None else found + 1
        yield list(own), found


def blocks_cut(section: SectionContour, moves: Sequence[Move]) -> Iterator[BlockOfSection]:
    """Yield the blocks of a section that moved, in order."""
    drawn = drawn_blocks(section)
    for own, found in blocks_moved(section, moves):
        if found is not None:
            yield BlockOfSection(*drawn[found], own)


def order_off(
    section: SectionContour, moves: Sequence[Move], path: Track, tolerance: float
) -> OffOrder | None:
    """Return the first line that is not cut, or not where the words have it, or not as long."""
    drawn, cut = drawn_blocks(section), 0
    for own, found in blocks_moved(section, moves):
        length = sum(map(path.part_length, own))
        if found is None and length > SHORT:
            return OffOrder(moves[own[0]].line, "is cut where the program has it not")
        if found is not None:
            missing, cut = not_cut(drawn[cut:found]), found + 1
            lengths = length, between_ends(own, path)
            off = missing or length_off(*drawn[found], *lengths, tolerance)
            if off:
                return off
    return not_cut(drawn[cut:])


def not_cut(drawn: Sequence[tuple[list[Element], float]]) -> OffOrder | None:
    """Return the first of some blocks that is more than rounding, as one that is not cut."""
    missing = (elements for elements, above in drawn if length_wanted(elements, above) > SHORT)
    return next((OffOrder(elements[0].line, "is not cut") for elements in missing), None)


def between_ends(own: Sequence[int], path: Track) -> float:
    """Return how far the ends of some moves are from each other on the part."""
    ends = path.vertices(own[0]).start, path.vertices(own[-1]).stop - 1
    return float(np.linalg.norm(path.points[ends[1]] - path.points[ends[0]]))


def length_off(
    elements: Sequence[Element], above: float, length: float, straight: float, tolerance: float
) -> OffOrder | None:
    """Return what a block's length is if it is not the words'.

    Of a compensated block the words do not tell it, but a ramp goes ``straight``. Pieces of an arc
    are longer than it where they go along outside of it, by no more than the ``tolerance``.
    """
    asked = length_wanted(elements, above)
    if any(element.side or element.ramp for element in elements):
        if not (len(elements) == 1 and elements[0].ramp):
            return None
        asked = straight
    beside = tolerance * sum(abs(element.sweep) for element in elements)
    if abs(length - asked) <= SHORT + SAME_FEED * asked + beside:
        return None
    return OffOrder(elements[0].line, "its path is {}, not {}", (length, asked))


def length_wanted(group: Sequence[Element], above: float) -> float:
    """Return the length of elements that follow each other from a height on."""
    heights = [above, *(element.depth for element in group)]
    rises = [after - before for before, after in zip(heights, heights[1:])]
    return sum(math.hypot(element.length, rise) for element, rise in zip(group, rises))


def depth_off(
    section: SectionContour, moves: Sequence[Move], path: Track, tolerance: float
) -> OffWords | None:
    """Return the first height that is not as the words ask.

    The tolerance is that of the contour: inside a line that changes Z it holds in space.
    """
    face = moves[section.at].start[section.third] - section.height
    for block in blocks_cut(section, moves):
        off = depth_off_in(block, face, path, tolerance)
        if off:
            return off
    asked = section.elements[-1].depth if section.elements else section.height
    found = moves[section.end - 1].end[section.third] - face
    wrong = abs(found - asked) > SAME_LEVEL
    return OffWords(section.last, found, asked) if wrong else None


def depth_off_in(
    block: BlockOfSection, face: float, path: Track, tolerance: float
) -> OffWords | None:
    """Return the height of a block that is farthest from what its words ask, if it is too far."""
    vertices = slice(path.vertices(block.moves[0]).start, path.vertices(block.moves[-1]).stop)
    heights = path.points[vertices, 2] - face
    wanted, allowed = heights_wanted(block, path.points[vertices], heights, tolerance)
    allowed[-1] = SAME_LEVEL
    beyond = np.abs(heights - wanted) - allowed
    worst = int(beyond.argmax())
    if beyond[worst] <= 0.0:
        return None
    return OffWords(block.elements[0].line, float(heights[worst]), float(wanted[worst]))


def heights_wanted(
    block: BlockOfSection, points: np.ndarray, heights: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the heights that a block asks for at points along it, and how far off they may be.

    Z changes evenly along one element that is not compensated; else any height between those of
    the elements will do but for the last. A place may lie as far from a line in space as the
    tolerance has it: the steeper, the more that is in Z.
    """
    first, last = block.elements[0], block.elements[-1]
    depths = [block.above, *(element.depth for element in block.elements)]
    allowed = np.full(len(heights), SAME_LEVEL)
    if len(block.elements) == 1 and first.length and not (first.side or first.ramp):
        steps = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        rise = last.depth - block.above
        if rise:
            allowed += tolerance * math.hypot(1.0, rise / first.length)
        return block.above + rise * along / (along[-1] or 1.0), allowed
    wanted = np.clip(heights, min(depths), max(depths))
    wanted[-1] = last.depth
    return wanted, allowed


def feed_off(
    section: SectionContour,
    moves: Sequence[Move],
    path: Track,
    tolerance: float,
    axes: SectionAxes,
) -> OffWords | None:
    """Return the first feed along the part that is not the words'.

    A piece's feed is right if the piece lasts as long as what it is for.
    """
    for block in blocks_cut(section, moves):
        feeds = {element.feed for element in block.elements}
        turned = any(turns(moves[index]) for index in block.moves)
        slow = turned or outruns_c(block, path, axes)
        for index in block.moves if None not in feeds else ():
            if path.part_length(index) < LEAST_LENGTH:
                continue
            share = LEAST_ON_FACE if slow and is_on_face(moves[index]) else 1.0
            least, most = lengths_meant(block, index, path, tolerance)
            most = feed_asked(moves[index], most)
            enough = [feed for feed in feeds if most >= share * (1.0 - SAME_FEED) * feed]
            highest = (1.0 + SAME_FEED) * max(enough, default=0.0)
            if not most or feed_asked(moves[index], least) <= highest:
                continue
            least -= drawn_in(block, index, path, tolerance)
            if feed_asked(moves[index], least) > highest:
                return OffWords(block.elements[0].line, most, min(feeds))
    return None


def outruns_c(block: BlockOfSection, path: Track, axes: SectionAxes) -> bool:
    """Tell whether a line passes the spindle so near that C cannot follow it at its feed.

    At the distance d and the speed v C turns by v / d, on a straight line with (v / d)**2 times
    3 sqrt(3) / 8 at the most.
    """
    vertices = slice(path.vertices(block.moves[0]).start, path.vertices(block.moves[-1]).stop)
    nearest = max(float(np.hypot(*path.points[vertices, :2].T).min()), TURN)
    turning = max(each.feed or 0.0 for each in block.elements) / 60.0 / nearest
    return turning > math.radians(axes.c_speed) or turning**2 * BEND > axes.c


def is_on_face(move: Move) -> bool:
    """Tell whether a move is one of X and Y, on the kinematics' face.

    Where a line goes there in part only, C cannot follow all of it: that part may be slower.
    """
    return not turns(move) and (move.kind == "arc" or move.start[Y] != move.end[Y])


def lengths_meant(
    block: BlockOfSection, index: int, path: Track, tolerance: float
) -> tuple[float, float]:
    """Return how long that is at the least and at the most which a move is for, mm.

    A straight move in X and C is a spiral on the part. Of a line it makes the chord between its
    ends, to the last digit. Of what is curved or compensated it makes no less than that, and no
    less than its own path without 2 pi times the tolerance: of two curves that bend one way, one
    within a distance of the other, the outer one is no longer by more (Steiner).
    """
    chord, length = float(np.linalg.norm(chord_of(index, path))), path.part_length(index)
    if is_straight(block):
        return chord, chord
    return max(chord, length - math.tau * tolerance), length


def drawn_in(block: BlockOfSection, index: int, path: Track, tolerance: float) -> float:
    """Return by how much the chord of a move is shorter on a curve within the tolerance, mm.

    Where the path turns by an angle from chord to chord, both ends move by the tolerance towards
    the inside of the curve.
    """
    if is_straight(block):
        return 0.0
    near = [at for at in (index - 1, index, index + 1) if at in block.moves]
    chords = [chord_of(at, path) for at in near]
    ways = [chord / max(float(np.linalg.norm(chord)), TURN) for chord in chords]
    return tolerance * max((math.dist(*pair) for pair in zip(ways, ways[1:])), default=0.0)


def is_straight(block: BlockOfSection) -> bool:
    """Tell whether a block is lines without compensation."""
    return not any(each.side or each.ramp or each.centre is not None for each in block.elements)


def chord_of(index: int, path: Track) -> np.ndarray:
    """Return the vector (3,) from the start of a move to its end, on the part."""
    points = path.points[path.vertices(index)]
    return points[-1] - points[0]


def feed_asked(move: Move, length: float) -> float:
    """Return the feed along the part that a move's F makes of a length, whatever the axes can do.

    That of a rapid is 0.
    """
    if move.kind == "rapid":
        return 0.0
    programmed = move.length if move.kind == "arc" else feed_length(move)
    return length / programmed * rate(move, 0.0) * 60.0 if programmed else 0.0


def turn_speed(section: SectionContour, moves: Sequence[Move], path: Track) -> float:
    """Return the highest speed that F asks of C where it turns in place."""
    in_place = turns_in_place(section, moves, path)
    return max((rate(moves[index], 0.0) for index in in_place), default=0.0)


def turned_in_place(section: SectionContour, moves: Sequence[Move], path: Track) -> InPlace:
    """Return how far and how long C turns in place where the tool is below the part's face."""
    face = moves[section.at].start[section.third] - section.height
    lowest = min(moves[index].end[section.third] for index in range(section.at, section.end))
    top = face - SAME_LEVEL if lowest < face - SAME_LEVEL else math.inf
    low = [i for i in turns_in_place(section, moves, path) if moves[i].end[section.third] < top]
    angles = (abs(moves[index].end[C] - moves[index].start[C]) for index in low)
    return InPlace(sum(angles), sum(path.seconds(index) for index in low))


def turns_in_place(section: SectionContour, moves: Sequence[Move], path: Track) -> list[int]:
    """Return the moves of a section at feed in which C turns and the tool stays on its place."""
    return [
        index
        for index in range(section.at, section.end)
        if moves[index].kind != "rapid"
        and moves[index].start[C] != moves[index].end[C]
        and path.part_length(index) < TURN
    ]
