# SPDX-License-Identifier: GPL-2.0-or-later
"""Which moves of a section run on the face, with which acceleration and feeds: the fastest choice.

The planner may brake anywhere with all of the face's acceleration, so C and the slide have to
follow that everywhere. With less of it the tool comes nearer to the pole on the face; with more of
it the tool reaches its feed sooner. The optimum depends on the section. It is chosen here, and set
at the stop where the machine switches to the face. Where C cannot follow F, that portion runs at
the feed that C can follow, or in segments, whichever is quicker.

The estimated time is that of a trapezoidal speed profile from stop to stop. It uses less than the
full acceleration, as LinuxCNC halves that where moves may be blended.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import ceil, log, radians, sqrt
from operator import itemgetter
from typing import NamedTuple

from g12.compensation.contour import PathElement, PlaneMove
from g12.polar.face import Demand, FaceLimits, MoveDemands

# of the INI's acceleration
ACCELERATION_SHARES = (*(0.96**k for k in range(14)), 0.5, 0.4, 0.28, 0.18, 0.1, 0.05)
PLANNED = 0.7  # of the acceleration: the planner's along the path, measured
FEED_RATIO, LEAST_FEED = 0.85, 0.08  # tried feeds: F times powers of the ratio, down to the least
CAREFUL = 0.98  # of the limits: a margin, as only some points are checked
GAIN = 0.02  # seconds: a lower acceleration has to save this at least
LEAST_GAIN = 0.9  # of the time in segments: the face has to be quicker by this at least
SWITCHING = 0.05  # seconds at rest for the switch to the face and the one back
WORTH_IT = 0.1  # seconds: two switches cost about this
STRAIGHT_ON = radians(5.0)  # a sharper corner counts as a stop


class FaceStretch(NamedTuple):
    """The moves on the face from one switch to the next.

    They run at a ``share`` of the INI's acceleration. C and the slide follow the feed ``override``.
    """

    share: float
    override: float


class _TimedElement(NamedTuple):
    """An element of the path with its demands; without them it is no move in the plane.

    ``corner``: a corner follows. ``in_segments`` is the approximate time in segments, in seconds.
    """

    move: PathElement
    stop: bool
    length: float = 0.0
    demands: MoveDemands | None = None
    corner: bool = False
    in_segments: float = 0.0


class _Span(NamedTuple):
    """A portion of an element, with its feed on the face, 0.0 in segments."""

    element: _TimedElement
    first: float
    last: float
    feed: float

    @property
    def length(self) -> float:
        return (self.last - self.first) * self.element.length


def quickest(
    path: Sequence[PathElement], stopping: Sequence[bool], limits: FaceLimits
) -> Iterator[tuple[PathElement, bool, FaceStretch | None]]:
    """Yield a path with its moves divided so that it takes the least time.

    ``stopping`` holds for each element whether it ends in a stop. It is yielded with each element,
    and so is the stretch on the face that the element belongs to, None for one in segments.
    """
    elements = [_element(*each, limits) for each in zip(path, stopping, [*path[1:], None])]
    best, least, chosen = list[_Span](), 0.0, 0.0
    for share in ACCELERATION_SHARES:
        spans = _worth_it([span for one in elements for span in _spans(one, share)])
        seconds = _seconds(spans, share * limits.round_acceleration)
        if not best or seconds < least - GAIN:
            best, least, chosen = spans, seconds, share
        if len(spans) == len(path) and all(span.feed for span in spans):
            break  # all of it at the programmed feed: a lower acceleration is slower
    best = [one if _is_followed(one, limits, chosen) else one._replace(feed=0.0) for one in best]
    for on_face, run in _stretches(_worth_it(best)):
        moves = [_move_of(span) for span in run]
        in_plane = [move for move in moves if isinstance(move, PlaneMove)]
        stretch = _highest(in_plane, limits, chosen) if on_face else None
        for span, move in zip(run, moves):
            yield move, span.element.stop and span.last == 1.0, stretch


def _element(
    move: PathElement, stop: bool, following: PathElement | None, limits: FaceLimits
) -> _TimedElement:
    if not isinstance(move, PlaneMove):
        return _TimedElement(move, stop)
    demands, length = MoveDemands(move, limits), move.length
    corner = True
    if isinstance(following, PlaneMove):
        turn = following.curve.direction(0.0) - move.curve.direction(1.0)
        corner = abs(turn) >= STRAIGHT_ON
    in_segments = length * _mean_slowness(demands.points)
    return _TimedElement(move, stop, length, demands, corner, in_segments)


def _mean_slowness(demands: Sequence[Demand]) -> float:
    """Return the approximate time in segments from first to last, for a unit of the length."""
    return sum(
        0.5 * (one.slowness + other.slowness) * (other.at - one.at)
        for one, other in zip(demands, demands[1:])
    )


def _spans(element: _TimedElement, share: float) -> list[_Span]:
    """Return an element in spans, each with a feed that C and the slide follow along all of it."""
    move, demands = element.move, element.demands
    if not isinstance(move, PlaneMove) or not demands:
        return [_Span(element, 0.0, 1.0, 1.0)]
    if demands.can_be_followed(share):
        return [_Span(element, 0.0, 1.0, move.feed)]
    points = demands.points
    levels = [
        _feed_share(CAREFUL * demands.highest_feed(point, share / CAREFUL) / move.feed)
        for point in points
    ]
    feeds = [
        _worth(move.feed * min(levels[k : k + 2]), points[k : k + 2])
        for k in range(len(points) - 1)
    ]
    spans = []
    for feed, run in groupby(zip(feeds, points, points[1:]), itemgetter(0)):
        steps = list(run)
        spans.append(_Span(element, steps[0][1].at, steps[-1][2].at, feed))
    return spans


def _feed_share(share: float) -> float:
    """Return the greatest tried share of the feed that is at most ``share``, 0.0 for too little."""
    if share >= 1.0:
        return 1.0
    return FEED_RATIO ** ceil(log(share) / log(FEED_RATIO)) if share > LEAST_FEED else 0.0


def _worth(feed: float, ends: Sequence[Demand]) -> float:
    """Return a feed between two points, 0.0 if segments are quicker."""
    in_segments = 0.5 * (ends[0].slowness + ends[1].slowness)
    return feed if feed * in_segments > LEAST_GAIN * 60.0 else 0.0


def _worth_it(spans: list[_Span]) -> list[_Span]:
    """Return spans, those on the face only where they last long enough to switch to it.

    An element that is no move in the plane belongs to the element before it.
    """
    worth: list[_Span] = []
    for on_face, run in _stretches(spans):
        if not on_face or sum(60.0 * span.length / span.feed for span in run) < WORTH_IT:
            run = [span._replace(feed=0.0) for span in run]
        worth += run
    return [_joined(list(run)) for _, run in groupby(worth, lambda span: (id(span[0]), span[3]))]


def _stretches(spans: list[_Span]) -> Iterator[tuple[bool, list[_Span]]]:
    """Yield the spans from one switch to the next, and whether they are on the face."""
    on_face, labelled = False, []
    for span in spans:
        on_face = bool(span.feed) if span.element.demands else on_face
        labelled.append((on_face, span))
    for there, run in groupby(labelled, itemgetter(0)):
        yield there, [span for _, span in run]


def _joined(run: list[_Span]) -> _Span:
    return run[0]._replace(last=run[-1].last)


def _is_followed(span: _Span, limits: FaceLimits, share: float) -> bool:
    """Return whether C and the slide follow a portion also between the points of its move."""
    move = _move_of(span)
    if not span.feed or span.length == span.element.length or not isinstance(move, PlaneMove):
        return True
    return MoveDemands(move, limits).can_be_followed(share)


def _move_of(span: _Span) -> PathElement:
    move = span.element.move
    if not isinstance(move, PlaneMove):
        return move
    if (span.first, span.last) != (0.0, 1.0):
        move = move.portion(span.first, span.last)
    return move._replace(feed=span.feed) if span.feed and span.element.demands else move


def _highest(moves: list[PlaneMove], limits: FaceLimits, share: float) -> FaceStretch:
    """Return the highest acceleration and override that moves on the face can follow."""
    demands = [MoveDemands(move, limits) for move in moves]
    more = (one for one in ACCELERATION_SHARES if one > share)
    share = next((one for one in more if all(each.can_be_followed(one) for each in demands)), share)
    overrides = (
        each.highest_feed(point, share) / move.feed
        for move, each in zip(moves, demands)
        for point in each.points
    )
    return FaceStretch(share, max(1.0, min(limits.override, *overrides)))


def _seconds(spans: list[_Span], acceleration: float) -> float:
    """Return the approximate time of spans in seconds, those on the face with an acceleration."""
    total = 0.0
    for on_face, run in _stretches(spans):
        moves = [span for span in run if span.length]
        if not on_face:
            total += sum(map(_in_segments, moves))
        elif moves:
            smooth = (_trapezoid(each, PLANNED * acceleration) for each in _smooth(moves))
            total += SWITCHING + sum(smooth)
    return total


def _in_segments(span: _Span) -> float:
    element, demands = span.element, span.element.demands
    if (span.first, span.last) == (0.0, 1.0) or not demands:
        return element.in_segments
    there = [point for point in demands.points if span.first <= point.at <= span.last]
    return element.length * _mean_slowness(there)


def _smooth(spans: list[_Span]) -> Iterator[list[_Span]]:
    stretch: list[_Span] = []
    for span in spans:
        stretch.append(span)
        if span.element.corner and span.last == 1.0:
            yield stretch
            stretch = []
    if stretch:
        yield stretch


def _trapezoid(spans: list[_Span], acceleration: float) -> float:
    """Return the seconds of moves from one stop to the next.

    Each ends at the highest speed that can be reached, and braked from in what follows.
    """
    lengths, speeds = [span.length for span in spans], [span.feed / 60.0 for span in spans]
    ends = [0.0, *(min(pair) for pair in zip(speeds, speeds[1:])), 0.0]
    for k, length in enumerate(lengths):
        ends[k + 1] = min(ends[k + 1], sqrt(ends[k] ** 2 + 2.0 * acceleration * length))
    for k in reversed(range(len(lengths))):
        ends[k] = min(ends[k], sqrt(ends[k + 1] ** 2 + 2.0 * acceleration * lengths[k]))
    return sum(
        _ramps(length, speed, acceleration, *between)
        for length, speed, between in zip(lengths, speeds, zip(ends, ends[1:]))
    )


def _ramps(length: float, speed: float, acceleration: float, begin: float, end: float) -> float:
    """Return the seconds of one move that begins and ends with given speeds."""
    most = min(speed, sqrt((begin * begin + end * end) / 2.0 + acceleration * length))
    up, down = most * most - begin * begin, most * most - end * end
    even = length - (up + down) / (2.0 * acceleration)
    return (2.0 * most - begin - end) / acceleration + max(0.0, even) / most
