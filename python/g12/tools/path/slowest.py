# SPDX-License-Identifier: GPL-2.0-or-later
"""The pace of moves: their lowest feed, its position, and their time.

Feeds are along the part in mm/min, times in seconds.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.track import Track

AT_SPEED = 0.98  # of the feed: a faster run counts as up to speed
LEAST_LENGTH = 1e-3  # mm: the feed of shorter moves is not reported


class Pace(NamedTuple):
    """The lowest feed of some moves, its move and point on the part (mm), and their time.

    ``expected`` is the time at the programmed feeds; without a run ``seconds`` is the same.
    """

    lowest: float
    point: tuple[float, ...]
    move: int
    seconds: float
    expected: float


def pace_of(
    every: Sequence[int], cutting: Sequence[int], path: Track, real: Followed | None = None
) -> Pace:
    """Return the pace of moves: the time of ``every``, the lowest feed of those ``cutting``.

    Without a run every move is at its feed, as far as speeds allow. A stretch of cutting in a run
    counts from the first sample at speed to the last: its ramps do not count as slow.
    """
    expected = sum(path.seconds(index) for index in every)
    feeds = [(path.part_feed(i), i) for i in cutting if path.part_length(i) > LEAST_LENGTH]
    lowest, move = min(feeds, default=(0.0, every[0]))
    end = tuple(path.part.points(np.array(path.moves[move].end))[0])
    programmed = Pace(lowest, end, move, expected, expected)
    if real is None:
        return programmed
    times = real.time[np.isin(real.move, every)]
    seconds = float(times[-1] - times[0]) if len(times) else 0.0
    speed = real.part_speed() * 60.0
    samples = _up_to_speed(np.isin(real.move, cutting), speed, path, real)
    if not len(samples):
        return programmed._replace(lowest=0.0, seconds=seconds)
    slowest = samples[np.argmin(speed[samples])]
    point = tuple(real.points[slowest])
    return Pace(float(speed[slowest]), point, int(real.move[slowest]), seconds, expected)


def _up_to_speed(cutting: np.ndarray, speed: np.ndarray, path: Track, real: Followed) -> np.ndarray:
    """Return the indices of the samples of the stretches of cutting, without their ramps."""
    used, back = np.unique(real.move, return_inverse=True)
    programmed = np.array([path.part_feed(index) for index in used])[back]
    edges = np.flatnonzero(np.diff(np.concatenate([[0], cutting.astype(int), [0]])))
    found = [np.empty(0, int)]
    for first, last in zip(edges[::2], edges[1::2]):
        fast = first + np.flatnonzero(speed[first:last] >= AT_SPEED * programmed[first:last])
        if len(fast):
            found.append(np.arange(fast[0], fast[-1] + 1))
    return np.concatenate(found)
