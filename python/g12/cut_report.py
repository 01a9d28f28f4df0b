# SPDX-License-Identifier: GPL-2.0-or-later
"""What a planner reports of a cut: typed records, and their text in a comment of the preview.

Lengths are in program units, X is a radius, positions are the program's, angles of C in degrees.
`ProgramFrame` converts to machine millimetres.
"""

from cmath import rect
from collections.abc import Sequence
from math import radians
from typing import Any, NamedTuple, get_args

SCHEMA = 1  # another number: records that mean something else
ASKED = "g12_reports"  # attribute of the interpreter: a dict where reports are asked for
CUT, MORE, END = "g12 cut ", "g12 more ", "g12 end"  # comments, the first two with JSON
BY_D, BY_LAST_D, LOADED, NO_CUTTER = "D", "last D", "loaded", ""  # what a cutter comes from


class ProgramFrame(NamedTuple):
    """The program's frame on the machine.

    ``mm`` is the length of a program unit in mm. ``zero`` is where X, Y, Z and C are 0, in program
    units, without the tool's length, ``rotation`` that about Z in degrees. ``shifted``: G92 or G52
    is part of it.
    """

    mm: float
    zero: tuple[float, float, float, float]
    rotation: float
    shifted: bool

    def level(self, z: float) -> float:
        """Return a program's Z on the machine, in mm."""
        return (self.zero[2] + z) * self.mm

    def point(self, x: float, y: float) -> complex:
        """Return a program's X and Y on the machine, in mm."""
        turned = complex(x, y) * rect(1.0, radians(self.rotation))
        return (complex(*self.zero[:2]) + turned) * self.mm


class UsedCutter(NamedTuple):
    """The cutter that a path is computed with: its radius, where that is from, number of D or T.

    The number of the last D is 0 if G41 or G42 commanded it. `LOADED` in a Haas pocket: the program
    has commanded no D, an earlier program may have.
    """

    radius: float
    source: str
    number: int = 0


class PocketCut(NamedTuple):
    """A block of G12 or G13: circles about ``centre`` in ``plane``, at ``levels`` across it.

    ``wall`` is the radius of what this block clears, ``first`` that of the first circle,
    ``step`` the growth from there, 0 with a single circle. ``inner`` is the radius of what stays in
    the middle, below 0 if nothing. With a cutter of radius 0 all are the tool centre's.
    """

    plane: str
    centre: tuple[float, float, float]
    wall: float
    first: float
    step: float
    inner: float
    levels: tuple[float, ...]
    cutter: UsedCutter


class EventCut(NamedTuple):
    """A circle mill event: the tool on ``side`` of a circle, -1 in it, 0 on it, 1 outside.

    ``wall`` is the radius of what it clears, ``boss`` that of what stays in the middle.
    """

    centre: tuple[float, float]
    side: int
    wall: float
    boss: float
    levels: tuple[float, ...]
    cutter: UsedCutter


class ThreadCut(NamedTuple):
    """A milled thread: its radii at ``top``, the signed pitch, the growth of the radius with Z.

    ``levels`` is its lower end, ``teeth`` are the cutter's along its axis.
    """

    centre: tuple[float, float]
    large: float
    small: float
    pitch: float
    outside: bool
    taper: float
    teeth: int
    top: float
    levels: tuple[float]
    cutter: UsedCutter


class FrameCut(NamedTuple):
    """A rectangle: ``lengths`` along X and Y, the tool on ``side``: -1 in it, 1 outside.

    ``middle``: what is farther than the tool from its wall stays.
    """

    centre: tuple[float, float]
    lengths: tuple[float, float]
    corner: float
    side: int
    middle: bool
    levels: tuple[float, ...]
    cutter: UsedCutter


class CutElement(NamedTuple):
    """A line, an arc or a plunge of a section: line of the program, compensation, feed, levels.

    ``side`` is 1 with G41, -1 with G42, ``radius`` the cutter's. ``start``, ``end`` and ``centre``
    are in the plane: X + jC on the face, C + jZ on a cylinder, C as a length. A line has no
    ``centre``, a plunge has no ``end``. ``sweep`` is in radians, counterclockwise.
    """

    line: int
    side: int
    radius: float
    feed: float
    z0: float
    z1: float
    start: complex | None = None
    end: complex | None = None
    centre: complex | None = None
    sweep: float = 0.0


class SectionCut(NamedTuple):
    """A section: on the face with ``surface`` 0, else on the cylinder of that radius.

    On the face the zero line of its plane is where C is before, and levels are Z; on a cylinder
    they are X. ``diameters``: its X words are. ``turn`` is the rotary axis: round a mill's part its
    plane is X + jA or B + jY, and levels are Z. ``sense`` is -1 where a positive angle leads to the
    left or down. Its angle is in the place of C in the frame and in the position.
    """

    surface: float
    diameters: bool
    elements: tuple[CutElement, ...]
    turn: str = "C"
    sense: float = 1.0


class ShapePasses(NamedTuple):
    """What all shapes on the face have: levels of Z, cutter, feeds."""

    levels: tuple[float, ...]
    cutter: UsedCutter
    feed: float
    plunge_feed: float


class PolygonCut(NamedTuple):
    """A polygon, or two flats, on a bar's end; the middle of the first flat is at ``angle``."""

    sides: int
    across_flats: float
    corner_radius: float
    stock_diameter: float
    angle: float
    passes: ShapePasses


class SlotCut(NamedTuple):
    """A slot with round ends about the centre, along ``angle``."""

    width: float
    length: float
    angle: float
    passes: ShapePasses


class RoundPocketCut(NamedTuple):
    """A round pocket; ``centre`` is X and C as a length."""

    centre: tuple[float, float]
    diameter: float
    passes: ShapePasses


class HolesCut(NamedTuple):
    """Holes along Z in the face (``surface`` 0), or along X in a cylinder of that radius.

    ``places`` are X, Z and C at the face or surface. ``kind`` is the call's: 1 and 2 tap, with
    ``feed`` as pitch.
    """

    surface: float
    places: tuple[tuple[float, float, float], ...]
    depth: float
    kind: int
    feed: float


PlannedCut = (
    PocketCut
    | EventCut
    | ThreadCut
    | FrameCut
    | SectionCut
    | PolygonCut
    | SlotCut
    | RoundPocketCut
    | HolesCut
)
NAMES = "pocket, event, thread, frame, section, polygon, slot, round pocket, holes"  # in that order
KINDS: dict[str, type[PlannedCut]] = dict(zip(NAMES.split(", "), get_args(PlannedCut)))


class CutReport(NamedTuple):
    """A cut, and the state before it.

    ``line`` is in ``file``, "" is the program. ``at`` is the tool's X, Y, Z and C. ``incremental``:
    G91. ``words`` are the block's as LinuxCNC has parsed them, or the entries of the call.
    """

    code: str
    line: int
    file: str
    frame: ProgramFrame
    at: tuple[float, float, float, float]
    feed: float
    per_revolution: bool
    incremental: bool
    words: dict[str, float]
    cut: PlannedCut


def report_text(report: CutReport) -> str:
    """Return a report as the text of its comment."""
    kind = next(name for name, cut in KINDS.items() if isinstance(report.cut, cut))
    return CUT + _json({"schema": SCHEMA, "kind": kind, **_named(report)})


def more_text(elements: Sequence[CutElement]) -> str:
    """Return further elements of the section that was reported last as the text of a comment."""
    return MORE + _json(elements)


def _json(value: object) -> str:
    import json  # not needed at LinuxCNC's start

    return json.dumps(value, default=lambda point: (point.real, point.imag))


def _named(record: Any) -> dict[str, Any]:
    """Return a record as names and values; elements are rows."""
    values = record._asdict()
    own = {name: _named(value) for name, value in values.items() if hasattr(value, "_asdict")}
    return {**values, **own}
