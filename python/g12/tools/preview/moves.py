# SPDX-License-Identifier: GPL-2.0-or-later
"""The values of a trace: moves, events, modal state.

Lengths are millimetres and angles degrees, whatever the program and the machine use.
Positions are those of the controlled point in machine coordinates: work offsets, G92 and the
rotation of the work coordinate system are resolved.  The tool length offset is not added, so
with no work offset they are the program's positions.  (A real machine's axes are at the position
plus ``Move.tool_offset``.)
"""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import NamedTuple, Self

from g12.cut_report import CutReport
from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.filter import OpenedProgram

MESSAGE = "message "  # begins the text of an event
G92_OFF_CODE = 922  # 2.9 lists G92.2 where no G92 offset is active, 2.10 nothing
IS_LENGTH = tuple(
    letter in "XYZUVW" for letter in AXIS_LETTERS
)  # for each of AXES: whether it is a length
CLOSED_ARC = 1e-6  # mm; an arc whose ends are nearer is a full circle, as in motion
THIRD_AXIS = {17: 2, 18: 1, 19: 0}

Position = tuple  # nine floats in the order of AXES: mm, degrees for A, B, C


class ReportedCut(NamedTuple):
    """A cut of the package, from its first move ``at`` to ``end``, the move after it.

    ``line`` is the program's; ``last_line`` is that of the block that ends it, in the report's own
    file. ``c_commanded`` is how C was since the cut before: to an "angle", by an "increment", or ""
    not at all.
    """

    at: int
    end: int
    line: int
    last_line: int
    c_commanded: str
    report: CutReport


class Message(NamedTuple):
    """A message to the operator without an error: ``(MSG, …)`` or a handler's MESSAGE."""

    line: int
    text: str


def message_lines(messages: Iterable[Message]) -> list[str]:
    """Return messages as lines, each once."""
    lines = (f"message, line {line}: {text.strip()}" for line, text in messages)
    return list(dict.fromkeys(lines))


class Event(NamedTuple):
    """An action between two moves, as text: ``tool 1``, ``S1000``, ``M8 on``.

    ``at`` is the index of the next move, ``line`` the program's line. LinuxCNC reports spindle,
    coolant, work offset and path mode when the next line starts.
    """

    at: int
    line: int
    text: str


class Error(NamedTuple):
    """The interpreter's own text for the block that was refused, and that block's line."""

    text: str
    line: int

    @property
    def rule(self) -> str:
        """The text without ``line``, for output that has it in front: ``G12: I is missing …``."""
        return re.sub(rf"^(\S+) line {self.line}: ", r"\1: ", self.text)


class ToolTable(NamedTuple):
    """Diameters, lengths along Z and offsets along X, in mm by tool number."""

    diameters: Mapping[int, float]
    lengths: Mapping[int, float]
    offsets: Mapping[int, float]


@dataclass(frozen=True)
class Modes:
    """The modal state of an interpreter, in LinuxCNC's words.

    ``gcodes`` and ``mcodes`` are like ``("G1", "G17", "G90.1", …)``, one per modal group with
    a code active.  ``feed`` and ``speed`` are the F and S words in program units, ``blending``
    is G64's (P, Q) in program units.
    """

    gcodes: tuple[str, ...]
    mcodes: tuple[str, ...]
    feed: float
    speed: float
    blending: tuple[float, float]


class Move(NamedTuple):
    """One canonical move.

    ``kind`` is ``rapid``, ``feed``, ``arc`` or ``probe``.  ``line`` is the interpreter's, which a
    GUI highlights: in a subroutine that subroutine's line; in a Python remap 0, unless the remap
    sets it, as a G12.1 section does, to the contour's block.  ``block`` is the line of the program
    itself whose block makes the move, of a sub the line that calls it.

    ``feed`` is mm/min under ``feed_mode`` G94 and G93 (the interpreter resolves inverse time),
    mm/rev under G95; degrees for a straight move of rotary axes alone; 0 for a rapid.
    ``plane`` is 17, 18 or 19, ``tool`` the number of the tool in the spindle, 0 or less for
    none.

    Of an arc, ``centre`` is the centre (x, y, z) at the level of the start, ``turns`` the
    interpreter's count (positive counterclockwise seen from the plane's positive third axis,
    1 or -1 for anything up to a full circle) and ``rotation`` the angle of the work coordinate
    system about Z in degrees, which turns G18 and G19 planes.

    ``remap`` is the remapped code that makes the move, ``G12``, "" without one. ``exact``: it ends
    in an exact path or stop (G61, G61.1, before a dwell), not blended into the next.
    ``by_machine``: its block names a machine position (G53, G28, G30), which no work offset shifts.
    ``acceleration`` is the share of the INI's for X and Y at which the face's kinematics run it.
    """

    kind: str
    line: int
    block: int
    start: Position
    end: Position
    feed: float
    feed_mode: str
    plane: int
    tool: int
    tool_offset: Position
    centre: tuple[float, float, float] | None = None
    turns: int = 0
    rotation: float = 0.0
    remap: str = ""
    exact: bool = False
    by_machine: bool = False
    acceleration: float = 1.0

    @property
    def radius(self) -> float:
        return math.hypot(*self._in_plane(self.start)[:2])

    @property
    def sweep(self) -> float:
        """Signed angle of an arc in radians, positive counterclockwise in its plane."""
        one, two, _ = self._in_plane(self.start)
        end_one, end_two, _ = self._in_plane(self.end)
        angle = math.atan2(one * end_two - two * end_one, one * end_one + two * end_two)
        turn = math.copysign(2 * math.pi, self.turns)
        closed = math.dist((one, two), (end_one, end_two)) < CLOSED_ARC
        first = turn if closed else angle + (turn if angle * turn < 0 else 0.0)
        return first + turn * (abs(self.turns) - 1)

    @property
    def length(self) -> float:
        """Length of the path in X, Y, Z, mm (the helix of an arc included)."""
        if self.kind != "arc":
            return math.dist(self.start[:3], self.end[:3])
        rise = self._in_plane(self.end)[2] - self._in_plane(self.start)[2]
        return math.hypot(self.radius * self.sweep, rise)

    def _in_plane(self, position: Sequence[float]) -> tuple[float, float, float]:
        """First, second and third axis of the plane, seen from the centre of the arc."""
        (x, y, z), (x0, y0, z0) = position[:3], self.centre
        x, y, z = x - x0, y - y0, z - z0
        if self.rotation:
            x, y = _rotated(x, y, -self.rotation)
        third = THIRD_AXIS[self.plane]
        first, second, last = ((x, y, z) * 2)[third + 1 : third + 4]
        return first, second, last


@dataclass(frozen=True)
class Trace:
    """The trace of one program.

    ``error`` is None for a program that ran to its end. ``modes`` is the state after the last
    block that succeeded, M2 included. ``state`` has the interpreter's own variables in program
    units (motion_mode, plane, feed_rate …), after the refused block if there was one. ``printed``
    is the text of ``(print, …)`` and of Python, ``position`` the end of the last move, ``globals``
    the global named parameters after the program. ``events`` include the messages. ``tables`` are
    the tool tables, each with the number of moves before it; the last is as the program leaves it.
    ``cuts`` are the package's, if they were asked for.
    """

    moves: list[Move]
    events: list[Event]
    error: Error | None
    modes: Modes
    state: dict[str, float]
    printed: str
    position: Position
    globals: dict[str, float]
    tables: Sequence[tuple[int, ToolTable]]
    cuts: Sequence[ReportedCut] = ()

    @property
    def diameters(self) -> Mapping[int, float]:
        """The tools' diameters as the program leaves them."""
        return self.tables[-1][1].diameters

    def table_at(self, index: int) -> ToolTable:
        """Return the tool table at a move, which G10 L1 changes, as far as that is known."""
        following = bisect_right(self.tables, index, key=itemgetter(0))
        return self.tables[max(following - 1, 0)][1]

    def radius(self, index: int) -> float:
        """Return the radius of a move's tool, 0 if it has none."""
        return self.table_at(index).diameters.get(self.moves[index].tool, 0.0) / 2

    def in_source(self, opened: OpenedProgram) -> Self:
        """Return the trace of a filtered program with the line numbers of the user's file."""
        if not opened.is_filtered:
            return self
        line, error = opened.source_line, self.error
        return replace(
            self,
            moves=[move._replace(block=line(move.block)) for move in self.moves],
            events=[event._replace(line=line(event.line)) for event in self.events],
            error=error
            and error._replace(text=opened.in_source(error.text), line=line(error.line)),
        )

    @property
    def messages(self) -> list[Message]:
        found = (each for each in self.events if each.text.startswith(MESSAGE))
        return [Message(each.line, each.text.removeprefix(MESSAGE)) for each in found]


def modes(gcodes: Iterable[int], mcodes: Iterable[int], settings: Sequence[float]) -> Modes:
    """Return the modal state from LinuxCNC's arrays, each without its first item."""
    return Modes(
        tuple(f"G{code / 10:g}" for code in gcodes if code >= 0 and code != G92_OFF_CODE),
        tuple(f"M{code}" for code in mcodes if code > 0),
        settings[0],
        settings[1],
        (settings[2], settings[3]),
    )


def _rotated(x: float, y: float, degrees: float) -> tuple[float, float]:
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return x * cos - y * sin, x * sin + y * cos
