# SPDX-License-Identifier: GPL-2.0-or-later
"""How a shape is cut: its rapids, its way down, which way and how far apart its rounds go.

Lengths are millimetres, angles degrees, heights those above the face.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from shapely.geometry import Point

from g12.tools.path.part import is_sideways
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.shapes.shape_way import SAME_LEVEL, TINY, ShapeWay
from g12.tools.verify.shapes.wanted_shape import CLEARANCE

WIDEST = 0.75  # of the cutter's diameter: how much a round takes at most
FIRST = 0.9  # of the cutter's radius: so large is a hole's first ring at most
BACKWARD = 0.25  # of a turn: less is the way from a ring to where the tool goes up
SAME_FEED = 1e-3
STEEPER = 1.02  # times the steepest way down: rounding
SAME_HEIGHT = 0.005
SMALL = 0.1  # radius of a ring whose way does not tell its direction
CLEAR_OF_WALL = 0.01


class OffShape(NamedTuple):
    """Something of a shape that is not as asked: ``what`` in words for lengths, or feeds, in mm."""

    what: str
    lengths: tuple[float, ...] = ()


def motion_of_shape(
    way: ShapeWay, sections: Sequence[SectionContour], rough: Sequence[int], tolerance: float
) -> Iterator[OffShape]:
    """Yield the first of each kind of motion that is not as asked.

    ``rough`` are the moves of the last level before its finish round.
    """
    if not way.fed:
        return
    yield from off_rapids(way)
    yield from off_down(way, tolerance)
    yield from off_up(way)
    finish = [index for _, run in way.flat()[-1:] for index in run if index not in set(rough)]
    yield from off_turns(way, sections, finish)
    yield from off_takes(way, tolerance)
    times = way.times_along(finish, tolerance)
    if way.asked.allowance and times > 1:
        yield OffShape(f"its finish round is cut {times} times, not once")
    yield from off_feeds(way, sections)


def off_rapids(way: ShapeWay) -> Iterator[OffShape]:
    """Yield a rapid that is too low, in the middle of the cuts, or not back up."""
    first, last = way.fed[0], way.fed[-1]
    start, near = way.asked.start, way.asked.near
    for index in way.asked.moves:
        move, (begin, end) = way.moves[index], way.heights(index)
        if move.kind != "rapid":
            continue
        if first < index < last:
            yield OffShape("a rapid comes between its cuts, at Z{}", (min(begin, end),))
            return
        if is_sideways(move) and min(begin, end) < start - SAME_HEIGHT:
            yield OffShape("a rapid goes across at Z{}, not at Z{}", (min(begin, end), start))
            return
    height = way.heights(first)[0]
    if abs(height - near) > SAME_HEIGHT:
        yield OffShape("its rapid goes down to Z{}, not to Z{}", (height, near))
    end = way.heights(way.asked.moves[-1])[1]
    if abs(end - start) > SAME_HEIGHT:
        yield OffShape("the tool ends at Z{}, not at Z{} where it began", (end, start))


def off_down(way: ShapeWay, tolerance: float) -> Iterator[OffShape]:
    """Yield a way down that is too steep, or that is not beside the stock."""
    asked = way.asked
    below = [index for index in way.falling if way.heights(index)[1] < -SAME_LEVEL]
    if not asked.form.inside:
        places = [np.abs(way.points(index)).min() for index in below]
        beside = min(places, default=math.inf) - asked.cutter - asked.form.stock
        if beside < CLEARANCE - tolerance - SAME_LEVEL:
            what = "it comes down {} {unit} beside the stock, not {}"
            if beside < 0.0:
                what = "it comes down into the stock"
            yield OffShape(what, (beside, CLEARANCE) if beside >= 0.0 else ())
        return
    for _, group in groupby(below, lambda index: way.moves[index].line):
        run = list(group)
        fall = sum(abs(np.subtract(*way.heights(index))) for index in run)
        length = sum(way.path.part_length(index) for index in run)
        angle = math.degrees(math.asin(min(1.0, fall / max(length, TINY))))
        if angle > asked.entry_angle * STEEPER:
            what = "it goes straight down to Z{}"
            if angle < 89.0:
                most = f"{asked.entry_angle:g}° at most"
                what = f"it goes down at {angle:.3g}°, not at {most}, to Z{{}}"
            yield OffShape(what, (way.heights(run[-1])[1],))
            return


def off_up(way: ShapeWay) -> Iterator[OffShape]:
    """Yield that the tool goes up where it touches the wall or the stock."""
    place, asked = way.points(way.fed[-1])[-1], way.asked
    if way.heights(way.fed[-1])[1] > -SAME_LEVEL:
        return
    if not asked.form.inside:
        if abs(place) < asked.form.stock + asked.cutter:
            yield OffShape("the tool goes up in the stock")
    elif ring_of(way, 0.0) > SMALL:
        wall = asked.form.area.exterior.distance(Point(place.real, place.imag))
        if wall - asked.cutter < CLEAR_OF_WALL:
            yield OffShape("the tool goes up along the wall")


def off_turns(
    way: ShapeWay, sections: Sequence[SectionContour], finish: Sequence[int]
) -> Iterator[OffShape]:
    """Yield a level, or a finish round, that is cut the wrong way round.

    Of small rings the arcs of the sub's blocks tell it, whose motion is judged as a section's.
    """
    asked = way.asked
    last = set(finish)
    for height, run in way.flat():
        for indices, allowance in (
            ([index for index in run if index not in last], asked.allowance),
            ([index for index in run if index in last], 0.0),
        ):
            small = ring_of(way, allowance) <= SMALL
            turned = turned_by_words(sections, height) if small else way.turned(indices)
            if backward(turned * asked.form.outward) > BACKWARD:
                turn = "clockwise" if asked.form.inside else "counterclockwise"
                yield OffShape(f"it goes round {turn} at Z{{}}: the wrong way", (height,))
                return


def turned_by_words(sections: Sequence[SectionContour], height: float) -> np.ndarray:
    """Return the angles, radians, of the arcs that the words have at a height or down to it."""
    elements = (element for section in sections for element in section.elements)
    return np.array([each.sweep for each in elements if abs(each.depth - height) < SAME_LEVEL])


def backward(turned: np.ndarray) -> float:
    """Return how many turns those angles are that go the wrong way, above 0."""
    return float(turned[turned > 0.0].sum() / (2 * math.pi))


def off_takes(way: ShapeWay, tolerance: float) -> Iterator[OffShape]:
    """Yield a round that takes more than it should."""
    asked = way.asked
    most, slack = WIDEST * 2 * asked.cutter, tolerance + SAME_LEVEL
    for height, run in way.flat():
        for direction in way.asked.form.rays:
            radii = way.crossings(run, direction)
            if asked.form.inside:
                first = FIRST * asked.cutter
                if radii and radii[0] > first + slack:
                    what = "its first ring at Z{} has a radius of {}, not {} {unit} at most"
                    yield OffShape(what, (height, radii[0], first))
                    return
                steps = np.diff(np.maximum.accumulate(radii or [0.0]))
            else:
                rounds = np.minimum.accumulate([asked.form.stock + asked.cutter, *radii])
                steps = -np.diff(rounds)
            if steps.max(initial=0.0) > most + slack:
                what = "a round at Z{} takes {}, not {} {unit} at most"
                yield OffShape(what, (height, float(steps.max()), most))
                return


def ring_of(way: ShapeWay, allowance: float) -> float:
    """Return the radius of a hole's last ring, of the tool's centre; that of a polygon is large."""
    if not way.asked.form.inside:
        return math.inf
    return min(each.reach for each in way.asked.form.extremes) - way.asked.cutter - allowance


def off_feeds(way: ShapeWay, sections: Sequence[SectionContour]) -> Iterator[OffShape]:
    """Yield the feeds, of the words of the sub's blocks, that are not those of the call."""
    told = set()
    for section in sections:
        heights = [section.height, *(element.depth for element in section.elements)]
        for element, before in zip(section.elements, heights):
            down = abs(element.depth - before) > TINY
            wanted = way.asked.plunge_feed if down else way.asked.feed
            if None in (wanted, element.feed) or down in told:
                continue
            if abs(element.feed - wanted) > SAME_FEED * wanted:
                told.add(down)
                what = f"it {'goes down' if down else 'cuts'} at {{}}, not at {{}} {{unit}}/min"
                yield OffShape(what, (element.feed, wanted))
