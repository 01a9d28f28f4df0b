# SPDX-License-Identifier: GPL-2.0-or-later
"""A section's contour as its words draw it: lines and arcs, and what comes between them.

Lengths are millimetres, X a radius value. A polar contour's plane turns with the part, its first
axis is X where the section begins; on a cylinder it is the unrolled surface.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from g12.geometry.curve import Arc, Curve, Line
from g12.lengths import MM_PER_INCH
from g12.tools.path.part import X, Z
from g12.tools.preview.moves import Event
from g12.tools.verify.expected.toolpath import NO_LENGTH

ACTS = re.compile(
    r"(M\d|S|G10|G4[39]|G5\d|G92|dwell (?!0$)|message (?!G[0-9.]+: ))"
)  # of the events of a trace: what a section does


@dataclass(frozen=True)
class Element:
    """A line or an arc of the contour; an arc has a ``centre`` and a signed ``sweep``.

    ``side`` is +1 with the tool on the left (G41), -1 on the right, 0 without compensation;
    ``ramp`` says that compensation is switched on or off along it. ``depth`` is Z at its end,
    ``feed`` along it in mm/min, None where the words do not say. A move of Z alone has no length.
    ``per_turn`` is that feed in mm per revolution, 0 where it is per minute.
    ``exact`` says whether it ends in an exact path or stop, None as it was before the section.
    """

    line: int
    start: complex
    end: complex
    side: int
    ramp: bool
    depth: float
    centre: complex | None = None
    sweep: float = 0.0
    feed: float | None = None
    exact: bool | None = None
    per_turn: float = 0.0

    @property
    def curve(self) -> Curve:
        if self.centre is None:
            return Line(self.start, self.end)
        return Arc(self.start, self.centre, self.sweep)

    @property
    def length(self) -> float:
        return self.curve.length


class ZeroLine(NamedTuple):
    """What has become of C since the cut before, or since the program began.

    ``commanded`` says that the program commanded C since. The cut before ended in line ``line``.
    ``turned`` is by how many degrees the zero line is turned against that of the last cut on the
    face, which began in line ``cut``; without one, ``cut`` 0, against the program's C0.
    """

    commanded: bool
    turned: float = 0.0
    line: int = 0
    cut: int = 0


BEGUN = ZeroLine(True)


class Act(NamedTuple):
    """Something that a section does besides moving, as a trace reports it, and its block's line.

    ``drawn`` is how many elements of the contour come before it.
    """

    line: int
    text: str
    drawn: int


@dataclass(frozen=True)
class SectionContour:
    """One run through a section: first and last line, first move and the one after it, contour.

    ``file`` is the name of a sub's own, "" for the program.

    ``start`` in the contour's plane, ``height`` above it and ``c`` (degrees) are its first point in
    program coordinates; ``zero_line`` says how C came there. ``doubt`` says why the contour could
    not be read from the words, if it could not. ``diameters`` says that X words are. ``surface`` is
    the radius of the cylinder whose unrolled surface the plane is, 0 of a polar section.

    ``acts`` are what its words command besides moving, ``events`` those of the trace.
    ``expected_state`` is the state after it by the words, ``state_after`` the actual one, both as
    ``Block.state_after`` has it; ``paths_after`` are G61 or G64, actual and expected, if known.
    ``cancelled`` is the line of a G40 after cuts on the contour without G41 or G42, 0 without one.
    ``commanded_paths`` are G61 or G64 as in force where it begins, "" if that is not known, and
    those that the words command on the way.
    """

    line: int
    last: int
    at: int
    end: int
    code: str
    start: complex
    elements: tuple[Element, ...]
    doubt: str = ""
    height: float = 0.0
    diameters: bool = False
    c: float = 0.0
    zero_line: ZeroLine = BEGUN
    acts: tuple[Act, ...] = ()
    events: tuple[Event, ...] = ()
    expected_state: Mapping[str, float] = field(default_factory=dict)
    state_after: Mapping[str, float] = field(default_factory=dict)
    paths_after: tuple[str, ...] = ()
    commanded_paths: tuple[str, ...] = ("",)
    surface: float = 0.0
    cancelled: int = 0
    file: str = ""

    @property
    def sides(self) -> list[int]:
        """Return the sides that the tool is on, ramps aside."""
        cut = (each for each in self.elements if each.length > NO_LENGTH and not each.ramp)
        return sorted({each.side for each in cut})

    @property
    def path(self) -> str:
        """G61 or G64 as in force where it begins, "" if that is not known."""
        return self.commanded_paths[0]

    @property
    def exact(self) -> bool:
        """Tell whether G61 or G61.1 is in force where it begins."""
        return self.path.startswith("G61")

    @property
    def unit(self) -> float:
        """Return the program's unit in mm."""
        return 1.0 if self.expected_state.get("_metric", True) else MM_PER_INCH

    @property
    def third(self) -> int:
        """Return the axis at right angles to the contour's plane: X of a cylinder, else Z."""
        return X if self.surface else Z
