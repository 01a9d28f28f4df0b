# SPDX-License-Identifier: GPL-2.0-or-later
"""The surfaces on which a machine runs a mill's flat program: words, sections and holes of each.

On the face of a bar X and Y become those of G12.1, and Z is along the spindle. Round a part one
axis is a length along it, the other one an angle in G07.1, and Z is the height above the axis: the
program's Z0 is the surface. Seen from the tool the drawing keeps its hands.

| machine | along the part | round it | out of it |
|---|---|---|---|
| lathe with C | X is Z | Y is C, the other way round | Z is X, a diameter |
| mill with A | X | Y is A, the other way round | Z |
| mill with B | Y | X is B | Z |
"""

import re
from collections.abc import Mapping
from math import degrees, fmod
from typing import NamedTuple

from g12.lengths import DEGREES_PER_TURN
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord

SIGNED_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
LEAST_RADIUS = {"G20": 0.2, "G21": 5.0}  # a section begins off the spindle's axis


class DrilledHole(NamedTuple):
    """A hole: where it is in the mill's X and Y, and the entries of its call, all as text."""

    x: str
    y: str
    depth: str
    retract: str
    feed: str
    peck: str
    dwell: str


class Winding(NamedTuple):
    """The machine's axes that run a flat program round a part."""

    wound: str  # the mill's axis that becomes an angle
    sense: float  # of that angle
    slides: Mapping[str, str]  # the machine's for X and Y, where there is one
    out: str  # the axis away from the part
    scale: int  # of its words: 2 for diameters
    arms: Mapping[str, tuple[str, float, float]] = {}  # of arcs, as `RoundPart.change` takes them


WINDINGS = {  # by the rotary axis
    "A": Winding("Y", -1.0, {"X": "X", "Y": "Y"}, "Z", 1),
    "B": Winding("X", 1.0, {"X": "X", "Y": "Y"}, "Z", 1),
    "C": Winding("Y", -1.0, {"X": "Z"}, "X", 2, {"I": ("K", 1.0, 0.0), "J": ("J", -1.0, 0.0)}),
}


def is_plain_number(value: str) -> bool:
    return bool(SIGNED_NUMBER.fullmatch(value))


def times(value: str, factor: float, plus: float = 0.0) -> str:
    """Return a value multiplied, and something added, with six decimals or as an expression."""
    if is_plain_number(value):
        text = f"{float(value) * factor + plus:.6f}".rstrip("0")
        return "0." if text == "-0." else text
    added = f" + {plus:g}" if plus else ""
    return f"[{value}] * {factor:.10g}{added}"


def _word(letter: str, value: str) -> ForeignWord:
    if is_plain_number(value):
        return ForeignWord(letter, value)
    return ForeignWord(letter, f"[{value}]", "expression")


class FaceOfBar:
    """The face of a bar: in a section Y is C, so that its words stay."""

    section = "on"  # the state's name for a section
    y_in = "C"  # the axis whose position is followed for Y in it
    away = "Z"  # the axis along which the tool leaves the part of a lathe, "" on a mill

    def __init__(self, draft: Draft) -> None:
        self.draft, self.control = draft, draft.control

    def words(self) -> None:
        """Rewrite the words of a block."""

    def home(self) -> None:
        """Rewrite the words of a block that goes to a machine position."""
        self.draft.comment_out("Y", ": no Y here")

    def begin(self, x: str, y: str, feed: float) -> list[str]:
        """Return the lines that begin a section at a point."""
        least = LEAST_RADIUS[self.draft.state.units]
        start = f"[2 * SQRT[[{x}] ** 2 + [{y}] ** 2 + {least:g} ** 2]]"
        if is_plain_number(x) and is_plain_number(y):
            start = f"{2 * max(abs(complex(float(x), float(y))), least):.4f}"
        on = self.control.polar_codes[0]
        return [f"G0 X{start} C0", "G8", on, f"G1 X{x} C{y} G94 F{feed:g}"]

    def end(self) -> list[str]:
        return [self.control.polar_codes[1], "G7"]

    def hole(self, cycle: str, hole: DrilledHole) -> list[str]:
        entries = (times(hole.x, 2), *hole[1:])
        return [f"o<face_hole_at> call {' '.join(f'[{entry}]' for entry in entries)} [0]"]


class RoundPart(FaceOfBar):
    """A part that turns: in a lathe about C, on a mill about A or B."""

    section = "cylinder"
    y_in = "Y"

    def __init__(self, draft: Draft) -> None:
        super().__init__(draft)
        turn = self.control.value("mill", "turn", "")
        self.turn, self.winding = turn or "C", WINDINGS[turn or "C"]
        self.away = "" if turn else self.winding.out

    @property
    def diameter(self) -> float:
        value = self.control.value("mill", "diameter", 0.0)
        if not value:
            raise NotTranslated(
                "the diameter of the part is not known: say --diameter, or diameter = … under "
                "[mill]"
            )
        return value

    @property
    def degrees_per_length(self) -> float:
        sense = self.winding.sense * self.control.value("mill", "sense", 1.0)
        return sense * degrees(2 / self.diameter)

    def height(self) -> tuple[str, float, float]:
        """Return what becomes of Z; where it is no increment, the part's radius is added."""
        added = self.diameter / 2 if self.draft.state.distance == "G90" else 0.0
        return self.winding.out, self.winding.scale, self.winding.scale * added

    def change(self, changes: Mapping[str, tuple[str, float, float]]) -> None:
        """Rewrite words: for each letter the new one, a factor, something to add."""
        for at, word in enumerate(self.draft.words):
            if word.letter in changes:
                letter, factor, added = changes[word.letter]
                self.draft.words[at] = _word(letter, times(word.value, factor, added))

    def words(self) -> None:
        wound, slides = self.winding.wound, self.winding.slides
        changes = {a: (slide, 1.0, 0.0) for a, slide in slides.items() if a != slide}
        changes[wound] = (self.turn, self.degrees_per_length, 0.0)
        self.change({**changes, "Z": self.height(), **self.winding.arms})

    def home(self) -> None:
        """Leave G53 of a mill alone: its words are the machine's own."""
        if not self.away:
            self.change({} if "G53" in self.draft.codes() else {"Z": self.height()})
            return
        self.words()
        if self.draft.take(self.turn):
            self.draft.comments.append("Y: no such slide here")

    def _angle(self, x: str, y: str) -> str:
        return times(x if self.winding.wound == "X" else y, self.degrees_per_length)

    def _slides(self, x: str, y: str) -> str:
        """Return the words that lead the slides above a point: one that is wound goes to 0."""
        values = {"X": x, "Y": y, self.winding.wound: "0"}
        return " ".join(f"{slide}{values[axis]}" for axis, slide in self.winding.slides.items())

    def begin(self, x: str, y: str, feed: float) -> list[str]:
        code, word = self.control.cylinder_code
        size = self.diameter if word == "diameter" else self.diameter / 2
        angle = _word(self.turn, self._angle(x, y)).text
        return [f"G0 {self._slides(x, y)} {angle}", f"{code} {self.turn}{size:g}"]

    def end(self) -> list[str]:
        return [f"{self.control.cylinder_code[0]} {self.turn}0"]

    def hole(self, cycle: str, hole: DrilledHole) -> list[str]:
        angle = self._angle(hole.x, hole.y)
        return self._side_hole(hole, angle) if self.away else self._cycle(cycle, hole, angle)

    def _side_hole(self, hole: DrilledHole, angle: str) -> list[str]:
        if is_plain_number(angle):
            angle = times(str(fmod(float(angle), DEGREES_PER_TURN)), 1.0)
        entries = ("1", hole.x, angle, "-9999", f"{self.diameter:g}", *hole[2:], "0")
        return [f"o<side_holes> call {' '.join(f'[{entry}]' for entry in entries)}"]

    def _cycle(self, cycle: str, hole: DrilledHole, angle: str) -> list[str]:
        there, radius = self._slides(hole.x, hole.y), self.diameter / 2
        bottom, retract = times(hole.depth, -1, radius), times(hole.retract, 1, radius)
        peck = times(hole.peck, -1 if cycle == "G73" else 1)  # below 0 for chips alone
        more = {"G82": f" P{hole.dwell}", "G73": f" Q{peck}", "G83": f" Q{peck}"}.get(cycle, "")
        heights = f"{_word('Z', bottom).text} {_word('R', retract).text}"
        return [
            f"G0 {there} {_word(self.turn, angle).text}",
            f"G98 {cycle} {there} {heights}{more} F{hole.feed}",
            "G80",
        ]


def surface_of(draft: Draft) -> FaceOfBar:
    return FaceOfBar(draft) if draft.control.onto == "face" else RoundPart(draft)
