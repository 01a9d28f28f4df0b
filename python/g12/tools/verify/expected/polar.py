# SPDX-License-Identifier: GPL-2.0-or-later
"""The contour of a polar section from its blocks' words, as polar.md has them.

Lengths are millimetres, X a radius value. The plane turns with the part, its first axis is X where
the section begins.
"""

import cmath
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from g12.geometry.curve import FULL_TURN, recentred, sweep_between
from g12.lengths import MM_PER_INCH
from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import FEED_UNKNOWN, Block
from g12.tools.verify.expected.contour import Element

SIDES = {40.0: 0, 41.0: 1, 42.0: -1}
CONTOUR = "XYCUHIJRZWK"
EXACT_HERE = 9.0
PATHS = {61.0: True, 61.1: True, 64.0: False}  # code: exact
FEED_MODES = {94.0: False, 98.0: False, 95.0: True, 99.0: True}  # code: per revolution
SAVE, RESTORE, SAVE_FOR_SUB = 70.0, 72.0, 73.0
AT_CENTRE = 0.01  # mm: there the angle of C is not known
SAME_END = 1e-6  # mm: an arc that ends as near to its start is a full circle


class Pen:
    """Follows the words of a polar section's blocks, as the mode's rules say."""

    surface = 0.0
    across = "XYCUHIJR"  # the letters of moves in the plane

    def __init__(self, first: Block, ini: Ini) -> None:
        state, settings = first.state, ini.settings
        self.unit = 1.0 if state["_metric"] else MM_PER_INCH
        in_g7 = state["_lathe_diameter_mode"]
        diameters = {"diameter": True, "radius": False}.get(settings.polar_x, in_g7)
        self.x_unit = self.unit / 2 if diameters else self.unit
        self.at = complex(state["_x"] * self.unit, 0.0)
        self.beside, self.tool = ini.tool_beside, self.at + 1j * ini.tool_beside
        self.depth = state["_z"] * self.unit
        self.absolute = bool(state["_absolute"])
        self.motion, self.side, self.changes = state["_motion_mode"] / 10, 0, False
        self.rapid_feed = settings.polar_g0_feed and settings.polar_g0_feed * ini.mm
        self.exact: bool | None = None
        self.feed = None if state["_feed"] == FEED_UNKNOWN else state["_feed"] * self.unit
        self.per_revolution, self.speed = bool(state["_units_per_rev"]), state["_rpm"]
        self._saved: tuple | None = None  # by M70 and M73

    def draw(self, block: Block) -> Iterator[Element]:
        """Yield the element that a block adds, if any."""
        for code in block.m_codes:
            self._save_or_restore(code)
        for code in block.codes:
            self._switch(code)
        words = block.words
        self.speed = words.get("S", self.speed)
        self.feed = words["F"] * self.unit if "F" in words else self.feed
        if not any(letter in words for letter in CONTOUR):
            return
        depth, self.depth = self.depth, self._height(words)
        end = self._place(words)
        centre, sweep = self._turn(words, end)
        if not any(letter in words for letter in self.across):
            end = self.tool
        if end != self.tool or centre is not None:
            line = block.text.number
            ramp, self.changes = self.changes, False
            form = self.tool, end, self.side, ramp, self.depth, centre, sweep
            yield Element(line, *form, **self._how(block))
        elif depth != self.depth:
            still = Element(block.text.number, end, end, 0, False, self.depth)
            yield replace(still, **self._how(block))
        if end != self.tool or centre is not None:
            self.at = self.tool = end

    def leaves(self, state: Mapping[str, float]) -> dict[str, float]:
        """Return the state after the section, of which ``state`` is the one before it.

        Not a feed that is not known.
        """
        found = {
            "_metric": state["_metric"],
            "_absolute": float(self.absolute),
            "_units_per_rev": float(self.per_revolution),
            "_motion_mode": 10 * self.motion,
            **self._position(state["_c"]),
        }
        return found if self.feed is None else {**found, "_feed": self.feed / self.unit}

    def _height(self, words: dict) -> float:
        """Return how high above the plane a block ends."""
        return self._to(words, "Z", None, self.depth, self.unit)

    def _place(self, words: dict) -> complex:
        """Return where in the plane a block ends."""
        return complex(
            self._to(words, "X", "U", self.at.real, self.x_unit),
            self._to(words, "C" if "C" in words else "Y", "H", self.at.imag, self.unit),
        )

    def _arm(self, words: dict) -> complex | None:
        """Return the vector from an arc's start to its centre, if the words say it."""
        if "I" in words or "J" in words:
            return complex(words.get("I", 0.0), words.get("J", 0.0)) * self.unit
        return None

    def _position(self, c: float) -> dict[str, float]:
        """Return X, Z and C, which was ``c`` before the section; not C of a tool in the centre."""
        radius, angle = cmath.polar(self.tool)
        slide = math.sqrt(max(0.0, radius**2 - self.beside**2))
        angle -= math.atan2(self.beside, slide)
        found = {"_x": slide / self.unit, "_z": self.depth / self.unit}
        return {**found, "_c": c + math.degrees(angle)} if radius > AT_CENTRE else found

    def _how(self, block: Block) -> dict[str, Any]:
        """Return the feed and the exact stop of an element."""
        per_turn = self.feed if self.per_revolution and self.motion != 0.0 else None
        return {"feed": self._feed(), "exact": self._exact(block), "per_turn": per_turn or 0.0}

    def _feed(self) -> float | None:
        if self.motion == 0.0:
            return self.rapid_feed
        if self.feed is None:
            return None
        return self.feed * (self.speed if self.per_revolution else 1.0)

    def _exact(self, block: Block) -> bool | None:
        return True if EXACT_HERE in block.codes else self.exact

    def _save_or_restore(self, code: float) -> None:
        if code in (SAVE, SAVE_FOR_SUB):
            self._saved = self.absolute, self.motion, self.feed, self.per_revolution, self.speed
        elif code == RESTORE and self._saved:
            self.absolute, self.motion, self.feed, self.per_revolution, self.speed = self._saved

    def _switch(self, code: float) -> None:
        if code in SIDES:
            self.changes = self.changes or SIDES[code] != self.side
            self.side = SIDES[code]
        elif code in (0.0, 1.0, 2.0, 3.0):
            self.motion = code
        elif code in (90.0, 91.0):
            self.absolute = code == 90.0
        elif code in PATHS:
            self.exact = PATHS[code]
        elif code in FEED_MODES:
            changed = self.per_revolution != FEED_MODES[code]
            self.per_revolution, self.feed = FEED_MODES[code], 0.0 if changed else self.feed

    def _to(self, words: dict, letter: str, step: str | None, now: float, unit: float) -> float:
        """Return where a coordinate goes: by its word, by its incremental word, or nowhere."""
        if letter in words:
            return words[letter] * unit + (0.0 if self.absolute else now)
        return now + words.get(step, 0.0) * unit

    def _turn(self, words: dict, end: complex) -> tuple[complex | None, float]:
        """Return an arc's centre and its sweep; no centre for a line."""
        if self.motion not in (2.0, 3.0):
            return None, 0.0
        turn, arm = (1 if self.motion == 3.0 else -1), self._arm(words)
        whole = abs(end - self.at) < SAME_END
        if "R" in words:
            centre = centre_of(self.at, end, words["R"] * self.unit, turn)
        elif arm is not None:
            centre = self.at + arm if whole else recentred(self.at, end, self.at + arm)
        else:
            return None, 0.0
        return centre, turn * FULL_TURN if whole else sweep_between(self.at, end, centre, turn)


def centre_of(start: complex, end: complex, radius: float, turn: int) -> complex:
    """Return the centre of an arc by its radius; a negative one is for the arc over 180 degrees."""
    chord = end - start
    half = abs(chord) / 2
    height = math.sqrt(max(0.0, radius * radius - half * half))
    left = 1j * chord / abs(chord)
    return (start + end) / 2 + left * height * turn * math.copysign(1.0, radius)
