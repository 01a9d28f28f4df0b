# SPDX-License-Identifier: GPL-2.0-or-later
"""What the tool's path about a pocket's centre surely clears and spares, told by distances alone.

Areas tell the same of any path, but take a hundred times as long: they are worked out where this
tells nothing. Paths are points (n, 3) as seen from the centre, lengths mm.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

SECTORS = 720  # directions in which a pocket is looked at
FINE = 1e-5  # chord error of the polylines that stand for arcs
SAME_RADIUS = 1e-6

Span = tuple[float, float]  # of distances from the centre


def polar(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sector about the centre and the distance from it of points."""
    turn = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1.0
    sector = np.minimum((turn * SECTORS).astype(int), SECTORS - 1)
    return sector, np.hypot(points[:, 0], points[:, 1])


def clears(lines: Sequence[np.ndarray], cutter: float, wanted: Span) -> bool:
    """Tell whether a cutter, by its radius, surely clears all between two distances.

    False says nothing.
    """
    all_round = [span for line in lines for span in cleared_all_round(line, cutter)]
    low = covered_up(wanted[0], all_round)
    high = -covered_up(-wanted[1], [(-last, -first) for first, last in all_round])
    return low >= high or (bool(lines) and in_every_sector(lines, cutter, (low, high)))


def covered_up(at: float, spans: Iterable[Span]) -> float:
    """Return up to where some spans cover everything from a distance on."""
    for first, last in sorted(spans):
        at = max(at, last) if first <= at else at
    return at


def cleared_all_round(line: np.ndarray, cutter: float) -> list[Span]:
    """Return what is cleared in all directions: along a circle about the centre, and from there."""
    sector, radius = polar(line)
    least, most = float(radius.min()), float(radius.max())
    spans = [(0.0, cutter - least)]
    if most - least < SAME_RADIUS and len(np.unique(sector)) == SECTORS:
        spans.append((most - cutter, least + cutter - FINE))
    return [span for span in spans if span[1] > span[0]]


def in_every_sector(lines: Sequence[np.ndarray], cutter: float, wanted: Span) -> bool:
    """Tell whether the places of the cutter on points of paths clear what is wanted.

    A cutter whose centre is at the distance d clears, in all directions that are by no more than
    the angle w from it, what is between d cos w - h and d cos w + h, h**2 = c**2 - (d sin w)**2, or
    between d - c and there if that is less.
    """
    sector, centre = polar(np.concatenate(lines))
    width, (low, high) = 2 * np.pi / SECTORS, wanted
    half = np.sqrt(np.maximum(0.0, cutter**2 - (centre * np.sin(width)) ** 2))
    first = np.maximum(centre - cutter, centre * np.cos(width) - half)
    last = centre * np.cos(width) + half
    kept = (half > 0.0) & (last > low) & (first < high)
    order = np.lexsort((first[kept], sector[kept]))
    sector, first, last = (column[kept][order] for column in (sector, first, last))
    if len(np.unique(sector)) < SECTORS:
        return False
    apart = 2 * sector * (high - low)  # one sector behind the other, in one row
    first, last = np.maximum(first, low) + apart, np.minimum(last, high) + apart
    reach, begins = np.maximum.accumulate(last), np.append(True, np.diff(sector) > 0)
    ends = np.append(begins[1:], True)
    before = np.where(begins, low + apart, np.append(0.0, reach[:-1]))
    return bool((first <= before).all() and (reach[ends] >= (high + apart)[ends]).all())
