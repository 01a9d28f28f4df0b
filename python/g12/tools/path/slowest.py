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
    point: tuple[float, float, float]
    move: int
    seconds: float
    expected: float


def pace_of(
    every: Sequence[int], cutting: Sequence[int], path: Track, real: Followed | None = None
) -> Pace:
    """Return the pace of moves: the time of ``every``, the lowest feed of those ``cutting``."""
    programmed = pace_of_path(every, cutting, path)
    return programmed if real is None else real_pace(every, cutting, path, real, programmed)


def pace_of_path(every: Sequence[int], cutting: Sequence[int], path: Track) -> Pace:
    """Return the pace along a part with every move at its feed, as far as speeds allow."""
    seconds = sum(path.seconds(index) for index in every)
    feeds = [(path.part_feed(i), i) for i in cutting if path.part_length(i) > LEAST_LENGTH]
    lowest, index = min(feeds, default=(0.0, every[0]))
    x, y, z = path.end(index)
    return Pace(lowest, (x, y, z), index, seconds, seconds)


def real_pace(
    every: Sequence[int], cutting: Sequence[int], path: Track, real: Followed, programmed: Pace
) -> Pace:
    """Return the pace of a run.

    A stretch of cutting counts from the first sample at speed to the last: acceleration and braking
    do not count as slow.
    """
    times = real.time[np.isin(real.move, every)]
    seconds = float(times[-1] - times[0]) if len(times) else 0.0
    speed = real.part_speed() * 60.0
    found = [
        stretch[np.argmin(speed[stretch])]
        for stretch in up_to_speed(np.isin(real.move, cutting), speed, path, real)
    ]
    if not found:
        return programmed._replace(lowest=0.0, seconds=seconds)
    slowest = min(found, key=lambda index: speed[index])
    point = tuple(real.points[slowest])
    return Pace(float(speed[slowest]), point, int(real.move[slowest]), seconds, programmed.expected)


def up_to_speed(cutting: np.ndarray, speed: np.ndarray, path: Track, real: Followed) -> list:
    """Return the indices of the samples of each stretch of cutting, without its ramps."""
    used, back = np.unique(real.move, return_inverse=True)
    programmed = np.array([path.part_feed(index) for index in used])[back]
    edges = np.flatnonzero(np.diff(np.concatenate([[0], cutting.astype(int), [0]])))
    found = []
    for first, last in zip(edges[::2], edges[1::2]):
        stretch = np.arange(first, last)
        fast = np.flatnonzero(speed[stretch] >= AT_SPEED * programmed[stretch])
        if len(fast):
            found.append(stretch[fast[0] : fast[-1] + 1])
    return found
