# SPDX-License-Identifier: GPL-2.0-or-later
"""A traced program: its state at each move, and where the tool's tip is on the part."""

import cmath
import math
import re
from bisect import bisect_right
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np

from g12.machine_ini import AXIS_LETTERS, remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.path.follow import Followed, Samples, follow
from g12.tools.path.part import (
    C,
    Part,
    Surface,
    X,
    Y,
    Z,
    last_zero,
    part_of,
    part_of_program,
    shares_along,
)
from g12.tools.path.track import Track, limits_of
from g12.tools.preview.moves import Move, Trace
from g12.tools.units import plain
from g12.tools.verify.model.cut import Cut, cuts_of
from g12.tools.verify.model.finding import Finding, Kind

SIZE = 1e-3  # mm: lengths that differ by less are equal
CHORD = 2e-3  # of the paths that are judged
KEPT_TIPS = 16384  # moves
ALONG_X, ALONG_Z = np.eye(9)[[X, Z]]
A, B = 3, 4
# Kinds of events: a length is G43, G43.1, G43.2, G49, or a tool from M6 on without one.
SPINDLE, SPEED, LENGTH = r"M[345]$", r"S[\d.]+$", r"G43|G49|tool "
RUNS = ("M3", "M4")
DIALECT = re.compile(r"prolog=g1[23]_(\w+)")
MOTION = re.compile(r"G0*([0-3]|5(?:\.\d)?|33(?:\.1)?|38\.\d|7[346]|8\d)(?![.\d])")
TAPS = {"33.1", "74", "84"}
ENDS = re.compile(r"M0*(2|30)(?!\d)")
COMMENT = re.compile(r"\(.*?\)|;.*")
SUB_CALL, SUB_BEGIN = (re.compile(rf"O\s*<?(\w+)>?\s*{word}") for word in ("CALL", "SUB"))
M98 = re.compile(r"^(?=.*M\s*98(?!\d)).*P\s*0*(\d+)", re.MULTILINE)  # words in any order
PROGRAM_BEGIN = re.compile(r"^\s*(?:N\d+\s*)?O\s*0*(\d+)\s*$", re.MULTILINE)


class Stretch(NamedTuple):
    """Successive moves at feed of one cut, or of none, with one tool and ``sides``; or one rapid.

    ``sides`` are those of ``TracedProgram.sides``, none where that is None; ``radius`` is the
    cutter's. ``is_known``: whether what is solid is known.
    """

    moves: range
    is_rapid: bool
    cut: Cut | None
    sides: Collection[float]
    radius: float
    is_known: bool


@dataclass(eq=False)
class TracedProgram:
    """A program as it moves on a machine, with ``samples`` as a run does.

    ``parameters`` are the var file's, ``surface`` is the radius of the cylinder that pictures show.
    """

    file: Path
    ini: Ini
    trace: Trace
    samples: Samples | None = None
    parameters: dict[int, float] = field(default_factory=dict)
    surface: float = 0.0

    def __post_init__(self) -> None:
        ini, trace = self.ini, self.trace
        self.moves, self.cuts, self.limits = trace.moves, cuts_of(trace), limits_of(ini)
        self._events: dict[str, list[tuple[int, str]]] = {}
        self._starts = [cut.at for cut in self.cuts]
        self._tool_beside = ini.tool_beside
        self.turning = part_of(ini).turning
        # A mill cuts round a part that its rotary axis turns.
        self.is_round = not self.turning and any(cut.surface for cut in self.cuts)
        self.several_spindles = ini.number("TRAJ", "SPINDLES", 1) > 1
        # The names of the cycles that the machine's codes call.
        names = ((each.code, DIALECT.search(str(each))) for each in remap_lines(ini.all))
        self.dialects = {code: name[1] for code, name in names if name}
        # The program's zero on the machine where it first cuts, without a cut where it ends.
        ends = (last_zero(trace, X), last_zero(trace, Y), last_zero(trace, Z))
        self.zero = self.cuts[0].zero if self.cuts else ends
        self.z0 = self.zero[Z]
        # Whether a work offset is set: without one the program's zero is the machine's.
        zeros = [cut.zero for cut in self.cuts] or [self.zero]
        self.is_placed = any(abs(value) > SIZE for zero in zeros for value in zero)
        offsets = (move.tool_offset[axis] for move in self.moves for axis in (X, Z))
        self.uses_lengths = any(abs(offset) > SIZE for offset in offsets)

    @cached_property
    def texts(self) -> list[str]:
        """The program's lines, without comments, in upper case."""
        text = self.file.read_text(encoding="utf-8", errors="replace")
        return [COMMENT.sub("", line).upper() for line in text.splitlines()]

    @property
    def end_line(self) -> int:
        """The line that ends it after its last move, by M2 or M30; else that of the move."""
        last = self.moves[-1].block
        ends = (n for n, text in enumerate(self.texts, 1) if n > last and ENDS.search(text))
        return next(ends, last)

    @cached_property
    def tapping(self) -> set[int]:
        """The lines in which a code of a tap is in force."""
        found, tapping = set(), False
        for number, text in enumerate(self.texts, 1):
            codes = MOTION.findall(text)
            tapping = codes[-1] in TAPS if codes else tapping
            found |= {number} if tapping else set()
        return found

    # ------------------------------------------------------------ the part

    @cached_property
    def part(self) -> Part:
        """The part of pictures: about the X0 of its first cut, or the unrolled ``surface``."""
        if self.surface:
            return self._surface(self.surface)
        found = part_of_program(self.ini, self.trace, bool(self.cuts) and self.turning)
        if found.turning and self.cuts:
            return replace(found, centre=self.cuts[0].zero[X])
        return found

    def on_surface(self, radius: float) -> Self:
        return replace(self, surface=radius)

    @cached_property
    def path(self) -> Track:
        """The moves as one polyline in time."""
        return Track(self.part, self.moves, self.limits, self.trace.modes.speed)

    @cached_property
    def real(self) -> Followed | None:
        """The motion of the run, laid on the path."""
        return follow(self.path, self.samples, self.ini.mm) if self.samples else None

    def part_at(self, radius: float, index: int) -> Part:
        """Return the part as the tool of a move sees it: the face, or a cylinder of a radius.

        The spindle's axis is where X0 is, which may differ from tool to tool.
        """
        cut, tool = self.cut_near(index), self.moves[index].tool
        following = self.cuts[cut.index + 1 : cut.index + 2] if cut and cut.end <= index else []
        if cut and following and self.moves[cut.at].tool != tool:
            (cut,) = following
        if radius:
            return self._surface(radius, cut.zero[cut.roles.height] if cut else 0.0)
        centre = cut.zero[X] if cut else 0.0
        return Part(self.turning, self._tool_beside, centre if self.turning else 0.0)

    def _surface(self, radius: float, centre: float = 0.0) -> Surface:
        own = next((cut for cut in self.cuts if cut.surface == radius), None)
        if not own:
            return Surface(True, 0.0, centre, radius=radius)
        return Surface(True, 0.0, centre, own.roles, radius, own.sense)

    def words(
        self, index: int, point: Sequence[float], radius: float
    ) -> list[tuple[str, float | str]]:
        """Return a point of a move on a part in the program's words: X Y Z, on a lathe X C Z.

        Round a mill's part these are the slide along it, its rotary axis and the height.
        """
        cut, zero = self.cut_near(index), self.zero_at(index)
        if not self.turning and not radius:
            turned = cmath.rect(1.0, math.radians(cut.frame.rotation if cut else 0.0))
            at = complex(point[0] - zero[X], point[1] - zero[Y]) / turned
            return [("X", at.real), ("Y", at.imag), ("Z", point[2] - zero[Z])]
        doubled = 2.0 if self.turning and self.diameters(index) else 1.0
        if cut and cut.is_section and not cut.surface and index in cut.moves:
            at = cut.plane_words(complex(*point[:2]))
            return [("X", doubled * at.real), ("C", at.imag), ("Z", point[2] - zero[Z])]
        axes = (X, C, Z)
        if not self.turning:
            cut = next(each for each in self.cuts if each.surface == radius)
            zero, axes = cut.zero, (cut.roles.along, cut.roles.turn, cut.roles.height)
        position = self._position(index, np.array(point, float), radius)
        first, turn, last = axes
        angle = plain(position[turn] - (cut.zero_c if cut else 0.0), 3)
        return [
            (AXIS_LETTERS[first], doubled * (position[first] - zero[first])),
            (AXIS_LETTERS[turn], angle),
            (AXIS_LETTERS[last], position[last] - zero[last]),
        ]

    def _position(self, index: int, point: np.ndarray, radius: float) -> np.ndarray:
        """Return the machine position of a move next to a point of the part."""
        line, move = self.tip(index, radius), self.moves[index]
        if len(line) < 2:
            return np.array(move.end)
        along = np.diff(line, axis=0)
        shares = shares_along(point, line[:-1], along)
        away = np.linalg.norm(line[:-1] + shares[:, None] * along - point, axis=1)
        nearest = int(away.argmin())
        share = (nearest + shares[nearest]) / len(along)
        return np.array(move.start) * (1 - share) + np.array(move.end) * share

    def diameters(self, index: int) -> bool:
        """Return whether X words are diameters, as in the section or the mode next to a move."""
        cut = self.cut_near(index)
        return getattr(cut and cut.plan, "diameters", "G7" in self.trace.modes.gcodes)

    # ------------------------------------------------------------ its moves

    def missing_length(self, index: int, axis: int = Z) -> float:
        """Return by how much the loaded tool is longer than the length in force."""
        move, table = self.moves[index], self.trace.table_at(index)
        sizes = table.lengths if axis == Z else table.offsets
        return sizes.get(move.tool, 0.0) - move.tool_offset[axis]

    def chosen_length(self, index: int) -> bool:
        """Return whether the length in force is one that the program gives itself, and is safe."""
        code = self.last(LENGTH, index).partition(" ")[0]
        safe = code == "G43.1" and self.missing_length(index) < 0.0
        return code == "G43.2" or safe or (code == "G49" and self.turning)

    def tip_beyond(self, index: int) -> np.ndarray:
        """Return by how much the tip (9,) is farther out than the length in force says."""
        used = self.uses_lengths and self.moves[index].tool > 0
        if not used or self.chosen_length(index):
            return np.zeros(9)
        beside = self.missing_length(index, X) if self.turning else 0.0
        return self.missing_length(index) * ALONG_Z + beside * ALONG_X

    @cached_property
    def tip(self) -> Callable[[int, float], np.ndarray]:
        """Points (n, 3) of the part at which the tool's tip is along a move; see ``part_at``."""
        return lru_cache(maxsize=KEPT_TIPS)(self._tip)

    def _tip(self, index: int, radius: float) -> np.ndarray:
        move, part = self.moves[index], self.part_at(radius, index)
        own = self.real.positions[self.real.during(index)] if self.real else ()
        positions = np.array(own) if len(own) else part.machine_points(move, CHORD)
        points = part.points(positions - self.tip_beyond(index))
        return points - (0.0, 0.0, part.centre) if radius else points

    def tips(self, moves: Sequence[int], radius: float = 0.0) -> np.ndarray:
        """Return the points (n, 3) of successive moves."""
        lines = [self.tip(index, radius) for index in moves] or [np.empty((0, 3))]
        return np.concatenate([lines[0], *(line[1:] for line in lines[1:])])

    def cut_at(self, index: int) -> Cut | None:
        """Return the cut that a move belongs to."""
        last = bisect_right(self._starts, index) - 1
        return self.cuts[last] if last >= 0 and index < self.cuts[last].end else None

    def cut_near(self, index: int) -> Cut | None:
        """Return the cut of a move, or the last before it, or the first."""
        last = bisect_right(self._starts, index) - 1
        return self.cuts[max(last, 0)] if self.cuts else None

    def zero_at(self, index: int) -> tuple[float, float, float]:
        cut = self.cut_near(index)
        return cut.zero if cut else self.zero

    def where(self, index: int) -> tuple[int, str]:
        """Return the line of a move, and the file of the sub in which it is, "" of the program."""
        move, cut = self.moves[index], self.cut_at(index)
        if cut:
            return (move.line if cut.is_section else cut.line), cut.file
        return (move.line if not self.calls_files else move.block), ""

    def found(
        self, of: Kind, index: int, place: Sequence[float] | None = None, **values
    ) -> Finding:
        """Return a finding in the line of a move."""
        line, file = self.where(index)
        return Finding(of, line, values, place, file)

    @cached_property
    def calls_files(self) -> bool:
        """Whether the program calls a sub in a file of its own."""
        text = "\n".join(self.texts)
        called = {*SUB_CALL.findall(text), *M98.findall(text)}
        begun = {*SUB_BEGIN.findall(text), *PROGRAM_BEGIN.findall(text)}
        return bool(called - begun or any(cut.file for cut in self.cuts))

    @cached_property
    def sides(self) -> list[set[float] | None]:
        """On what the tool of each move may be: the radii of its cuts next to the move.

        0 is the face. None: a tool without a cut, where the part turns, and on a mill where it is
        not above the axis of a round part; a tool that never feeds is judged on the face.
        """
        if not self.turning and not self.is_round:
            return [{0.0}] * len(self.moves)
        of_tool: dict[int, list[Cut]] = {}
        for cut in self.cuts:
            if cut.at < len(self.moves):
                of_tool.setdefault(self.moves[cut.at].tool, []).append(cut)
        feeding = {move.tool for move in self.moves if move.kind != "rapid"}
        found: list[set[float] | None] = []
        turned = False  # the part: before the next cut also by rapid from there
        for index, move in enumerate(self.moves):
            inside, own = self.cut_at(index), of_tool.get(move.tool, [])
            turns = self.several_spindles and self.turns(index)
            turned = not inside and (turns or (turned and move.kind == "rapid"))
            after = bisect_right(own, index, key=lambda cut: cut.at)
            near = {cut.surface for cut in own[max(after - 1, 0) : after + 1]}
            if move.tool not in feeding:
                near = {0.0}
            elif inside:
                near = {inside.surface}
            elif turned or (self.is_round and self._is_beside_axis(move)):
                near = set()
            found.append(near or None)
        return found

    def _is_beside_axis(self, move: Move) -> bool:
        """Return whether the tool of a mill's move is not above the axis of rotation all along."""
        cut = next(each for each in self.cuts if each.surface)
        across = cut.roles.across
        return any(abs(at[across] - cut.zero[across]) > SIZE for at in (move.start, move.end))

    @cached_property
    def stretches(self) -> list[Stretch]:
        """The moves in stretches, in order."""
        turned_at = len(self.moves) if self.turned_at is None else self.turned_at

        def kind(index: int) -> tuple:
            move, cut, sides = self.moves[index], self.cut_at(index), self.sides[index]
            rapid = move.kind == "rapid"
            key = index if rapid else (cut.at if cut else -1)
            return key, rapid, cut, sides, index < turned_at, move.tool, move.tool_offset

        found = []
        for (_, rapid, cut, sides, known, *_), own in groupby(range(len(self.moves)), kind):
            first, *more = own
            radius = cut.radius if cut else self.trace.radius(first)
            moves = range(first, first + len(more) + 1)
            found.append(Stretch(moves, rapid, cut, sides or frozenset(), radius, known))
        return found

    def stretch_at(self, index: int) -> Stretch:
        """Return the stretch of a move."""
        return self.stretches[bisect_right(self.stretches, index, key=lambda s: s.moves[0]) - 1]

    @cached_property
    def known_after(self) -> list[bool]:
        """Whether the program has said where the tip is at the end of each move.

        After G53, G28 and G30 only a work offset would tell.
        """
        known, found, placed = False, [], self.is_placed
        axes = (X, Z) if self.turning else (Z,)
        for move in self.moves:
            moved = any(move.start[axis] != move.end[axis] for axis in axes)
            if moved or move.kind != "rapid":
                known = not move.by_machine or placed
            found.append(known)
        return found

    @cached_property
    def turned_at(self) -> int | None:
        """The first move of A or B on a mill: what was solid is not known after it."""
        if self.turning or not {"A", "B"} & set(self.ini.axes):
            return None
        if self.is_round:
            return next(filter(self._is_elsewhere, range(len(self.moves))), None)
        return next((index for index, move in enumerate(self.moves) if turns_part(move)), None)

    def _is_elsewhere(self, index: int) -> bool:
        """Return whether a move cuts what a round part's sections do not say."""
        move, first = self.moves[index], self.moves[0]
        sides = self.sides[index]
        if sides is None:
            return move.kind != "rapid"
        return 0.0 in sides and move.start[A : B + 1] != first.start[A : B + 1]

    # ------------------------------------------------------------ its state

    def last(self, kind: str, index: int) -> str:
        """Return the last event of a kind before a move, "" if there is none."""
        events = self._events.setdefault(kind, [])
        if not events:
            events += [(-1, ""), *(e[::2] for e in self.trace.events if re.match(kind, e.text))]
        return events[bisect_right(events, index, key=itemgetter(0)) - 1][1]

    def speed(self, index: int) -> float:
        """Return the speed of the first spindle, as commanded."""
        return float(self.last(SPEED, index)[1:] or 0.0)

    def turns(self, index: int) -> bool:
        """Return whether the first spindle turns."""
        return self.last(SPINDLE, index) in RUNS and self.speed(index) > 0.0


def straight_down(points: np.ndarray) -> bool:
    return bool(np.ptp(points[:, :2], axis=0).max() < 0.05)


def turns_part(move: Move) -> bool:
    """Return whether A or B turns a mill's part."""
    return bool(move.start[A : B + 1] != move.end[A : B + 1])
