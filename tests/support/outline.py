# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawings of parts, and how near to them points lie: nothing here knows the package."""

import math

import numpy as np

SAME_HEADING = 0.01  # degrees
TRACK = 200  # points looked at together


class Line:
    """A straight piece of an outline, from one point to another."""

    def __init__(self, start, end):
        self.start, self.end = np.array(start, float), np.array(end, float)

    def distances(self, points):
        along = self.end - self.start
        t = np.clip((points - self.start) @ along / (along @ along), 0, 1)
        return np.hypot(*(points - self.start - t[:, None] * along).T)

    def points(self, step):
        count = max(2, math.ceil(np.hypot(*(self.end - self.start)) / step))
        return self.start + np.linspace(0, 1, count)[:, None] * (self.end - self.start)

    def headings(self):
        """Return the direction at both ends, degrees."""
        angle = math.degrees(math.atan2(*(self.end - self.start)[::-1]))
        return angle, angle

    def aside(self, distance):
        """Return the parallel line on the left."""
        along = (self.end - self.start) / np.hypot(*(self.end - self.start))
        normal = distance * np.array([-along[1], along[0]])
        return Line(self.start + normal, self.end + normal)


class Arc:
    """A circular piece: centre, radius, angle of its start and signed sweep in degrees."""

    def __init__(self, centre, radius, start, sweep):
        self.centre, self.radius = np.array(centre, float), radius
        self.first, self.sweep = math.radians(start), math.radians(sweep)
        self.start, self.end = self._at([0, 1])

    def distances(self, points):
        away = points - self.centre
        angles = np.arctan2(away[:, 1], away[:, 0])
        turned = (angles - self.first) * np.sign(self.sweep) % (2 * math.pi)
        to_circle = np.abs(np.hypot(*away.T) - self.radius)
        to_ends = np.min([np.hypot(*(points - end).T) for end in (self.start, self.end)], axis=0)
        return np.where(turned <= abs(self.sweep), to_circle, to_ends)

    def points(self, step):
        count = max(2, math.ceil(abs(self.sweep) * self.radius / step))
        return self._at(np.linspace(0, 1, count))

    def headings(self):
        """Return the direction at both ends, degrees."""
        first = math.degrees(self.first) + math.copysign(90, self.sweep)
        return first, first + math.degrees(self.sweep)

    def aside(self, distance):
        """Return the concentric arc on the left."""
        radius = self.radius - distance * np.sign(self.sweep)
        return Arc(self.centre, radius, math.degrees(self.first), math.degrees(self.sweep))

    def _at(self, fractions):
        angles = self.first + np.asarray(fractions) * self.sweep
        return self.centre + self.radius * np.column_stack([np.cos(angles), np.sin(angles)])


def lines(*points):
    """Return the lines from point to point."""
    return [Line(start, end) for start, end in zip(points, points[1:])]


def outward(pieces, distance):
    """Return each piece set ``distance`` to the left, with the arc about the corner behind it."""
    moved = [[piece.aside(distance)] for piece in pieces]
    for group, piece, following in zip(moved, pieces, pieces[1:]):
        before, after = piece.headings()[1], following.headings()[0]
        turn = (after - before + 180) % 360 - 180
        if abs(turn) > SAME_HEADING and distance:
            group.append(Arc(piece.end, distance, before + 90, turn))
    return moved


def distances(pieces, points):
    """Return each point's distance to the nearest piece."""
    return np.min([piece.distances(points) for piece in pieces], axis=0)


def deviation(pieces, points, step):
    """Return how far the points leave the outline, and how far the outline leaves the points."""
    there = distances(pieces, points).max()
    tracks = [points[at : at + TRACK + 1] for at in range(0, len(points) - 1, TRACK)]
    low = np.array([track.min(axis=0) for track in tracks]) - 10 * step
    high = np.array([track.max(axis=0) for track in tracks]) + 10 * step
    back = 0.0
    for target in np.concatenate([piece.points(step) for piece in pieces]):
        near = np.flatnonzero(((low < target) & (target < high)).all(axis=1))
        back = max(back, min(_to_track(tracks[at], target) for at in near))
    return there, back


def _to_track(track, target):
    start, along = track[:-1], np.diff(track, axis=0)
    squared = np.maximum((along**2).sum(axis=1), 1e-18)
    t = np.clip(((target - start) * along).sum(axis=1) / squared, 0, 1)
    return np.hypot(*(start + t[:, None] * along - target).T).min()


def fitted_line(points):
    """Return direction in degrees (0 to 180) and distance from the origin of the best line."""
    middle = points.mean(axis=0)
    _, _, (along, normal) = np.linalg.svd(points - middle, full_matrices=False)
    return math.degrees(math.atan2(along[1], along[0])) % 180, abs(middle @ normal)


def fitted_circle(points):
    """Return centre and radius of the best circle."""
    system = np.column_stack([2 * points, np.ones(len(points))])
    x, c, rest = np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)[0]
    return (x, c), math.sqrt(rest + x * x + c * c)
