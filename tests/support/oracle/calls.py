# SPDX-License-Identifier: GPL-2.0-or-later
"""A reported call of a shape or of holes, in mm; X is a radius, angles are degrees."""

import math

X, Y, Z, C = 0, 1, 2, 5


class SubCall:
    """The entries of a call, the cutter's radius, the tool's position, what it turns C by.

    ``found`` is the modal state before it, ``first`` its first move, ``turned`` the turn of its
    first move that turns C.
    """

    def __init__(self, report, found, cutter, settings, moves):
        self.name, self.line, self.given = report.code, report.line, report.words
        self.cutter, self.settings = cutter, settings
        self.unit, self._report = report.frame.mm, report
        in_g7 = found["codes"]["15"] == "G7"
        self.diameters = {"diameter": True, "radius": False}.get(settings.polar_x, in_g7)
        x, _, z, c = report.at
        self.at = (x * self.unit, z * self.unit, c)
        zero = report.frame.zero
        self.zero = (zero[0] * self.unit, zero[2] * self.unit, zero[3])
        self.beside = moves[0].start[Y]
        turns = (move.end[C] - move.start[C] for move in moves)
        self.turned = next((turn for turn in turns if abs(turn) > 1e-8), 0.0)
        self._per_minute = self.unit * (found["S"] if report.per_revolution else 1.0)

    @property
    def is_side(self):
        return self.name == "side_holes"

    @property
    def surface(self):
        return self.length("surface_diameter") / 2

    def length(self, name, default=0.0):
        return self.given[name] * self.unit if name in self.given else default

    def x(self):
        return self.length("x") / (2 if self.diameters else 1)

    def feed(self):
        """Return the feed per minute."""
        return self.given.get("feed", self._report.feed) * self._per_minute

    def feed_as_given(self):
        """Return the feed in mm per minute or revolution, and whether it is per revolution."""
        feed = self.given.get("feed", self._report.feed)
        return feed * self.unit, self._report.per_revolution

    def plunge_feed(self):
        if "plunge_feed" in self.given:
            return self.given["plunge_feed"] * self._per_minute
        return self.feed() * self.settings.plunge_feed / 100

    def turn_to(self, angle):
        """Return by how much C turns to an angle; the machine chooses the whole turns."""
        turn = angle - self.at[2]
        return turn + 360.0 * round((self.turned - turn) / 360.0)


def equal_steps(first, last, most, rounding):
    """Return the ends of the fewest equal steps of at most ``most``.

    A rest of at most ``rounding`` is no step of its own.
    """
    count = math.ceil((abs(last - first) - rounding) / most)
    return [first + (last - first) * step / count for step in range(1, count + 1)]
