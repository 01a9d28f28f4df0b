# SPDX-License-Identifier: GPL-2.0-or-later
"""Each reported cut of a trace against what its words ask for."""

import cmath
import math
import re
from bisect import bisect
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

import numpy as np

from g12.cut_report import EventCut, HolesCut, PocketCut, SectionCut
from g12.geometry.curve import Arc, Line
from g12.machine_ini import remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.path.lathe_axes import lathe_axes
from g12.tools.path.part import Part, arc_points, plane_axes
from g12.tools.path.surface import Surface
from g12.tools.path.track import limits_of, track
from g12.tools.preview.moves import Event, Move, ReportedCut, Trace
from support.oracle import circles
from support.oracle.calls import SubCall, equal_steps
from support.oracle.circles import BlockInMm
from support.oracle.contour import contour_path, elements_of
from support.oracle.follow import Laid, Made, judge_path, lay
from support.oracle.holes import Holes, HolesPath, holes_of
from support.oracle.lathe import LatheCut, judge_lathe_cut
from support.oracle.shapes import shape_path
from support.oracle.state import Surroundings, judge_events, judge_state, surroundings_of
from support.oracle.toolpath import Difference, Expected

WALL = 0.005  # mm of a pocket's toolpath and of holes
LEVEL = 1e-3
ACTS = re.compile(r"(M\d|S|G10|G4[39]|G5\d|G92|dwell (?!0$)|message (?!G[0-9.]+: ))")
CART_FUZZ = 1e-8
SHARES = np.linspace(0.0, 1.0, 25)  # of an arc in another plane than the pocket's
SAME_AXIS = 1e-9
WHOLE_TURN = 39.0  # square of a sweep
THIRD = {"G18": 1, "G19": 0}  # the axis across a plane
PATHS = {
    "haas": circles.haas_path,
    "yasnac": circles.yasnac_path,
    "mitsubishi": circles.mitsubishi_path,
}
Expectations = Mapping[str, Mapping[str, str]]


class Oracle:
    """A trace of a `ModalTracer`, with reports; ``leaves`` and ``acts`` are by a cut's line.

    ``leaves`` has the codes and F that a section leaves behind, ``acts`` what happens in one:
    ``8 dwell 0.25`` after the moves of line 8. They are written by hand.
    """

    def __init__(
        self, trace: Trace, ini: Ini, text: str, expected: Expectations | None = None
    ) -> None:
        self.trace, self.moves, self.ini = trace, trace.moves, ini
        self.settings, self.known = ini.settings, expected
        handlers = [remap.keywords.get("prolog", "") for remap in remap_lines(ini.all)]
        self.dialect = next((d for d in PATHS if any(h.endswith(d) for h in handlers)), "")
        self.around = surroundings_of(trace, text.splitlines())

    def differences(self) -> Iterator[Difference]:
        cuts = self.trace.cuts
        assert len(self.around) == len(cuts), "a program of the tests ends after its cuts"
        for number, (cut, around) in enumerate(zip(cuts, self.around)):
            if cut.at == cut.end:
                yield Difference("path-missing", cut.line, "nothing is cut")
            else:
                yield from self._judged(number, cut, around)
        own = {index for cut in cuts for index in range(cut.at, cut.end)}
        lines = (m.block for i, m in enumerate(self.moves) if m.remap and i not in own)
        yield from (Difference("not-measured", line) for line in dict.fromkeys(lines))

    def _judged(self, number: int, cut: ReportedCut, around: Surroundings) -> Iterator[Difference]:
        planned = cut.report.cut
        if isinstance(planned, SectionCut):
            yield from judge_lathe_cut(self._section(cut, around.events))
            yield from self._acts(cut, around.events)
        elif isinstance(planned, PocketCut | EventCut):
            yield from self._pocket(number, cut)
            yield from judge_events(cut, around.events)
        elif isinstance(planned, HolesCut):
            yield from self._holes(cut, around)
        else:
            call = self._call(cut, around.found)
            yield from judge_lathe_cut(self._shape(cut, call))
            yield from compared(cut, call.unit, shape_of(planned), shape_of_words(planned, call))
            others = (e for e in around.events if e.text != "dwell 0" and e.text[:2] != "G6")
            yield from judge_events(cut, list(others))
        is_section = isinstance(planned, SectionCut)
        leaves = self._written("leaves", cut)
        yield from judge_state(cut, around, leaves, is_section)
        begun, path = around.paths
        if begun != path and "G6" not in leaves and not (is_section and self.known is None):
            yield Difference("state", cut.last_line, f"it leaves {path}, not {begun}")

    def _written(self, name: str, cut: ReportedCut) -> str:
        return (self.known or {}).get(name, {}).get(str(cut.line), "")

    # ------------------------------------------------------------ pockets and events

    def _pocket(self, number: int, cut: ReportedCut) -> Iterator[Difference]:
        cutter = self._cutter(number, cut)
        block = BlockInMm(cut.report, cutter, self.settings)
        block.machine_mm = self.ini.mm
        if isinstance(cut.report.cut, EventCut):
            path = circles.event_path(block, [self._before(number, plane) for plane in "WO"])
        else:
            path = PATHS[self.dialect](block)
        first = self.moves[cut.at]
        x, y, z = block.centre()
        there = cut.report.frame.point(x, y)
        origin = np.array([there.real, there.imag, cut.report.frame.level(z)])
        made = made_in(origin, plane_axes(first), self.moves, range(cut.at, cut.end))
        yield from judge_path(lay(path, made, WALL), cut.line)
        yield from self._report_of_circle(cut, block, path)

    def _cutter(self, number: int, cut: ReportedCut) -> float:
        """Return the radius of the cutter that a path is for: D's, the last D's, the loaded one."""
        loaded = self.trace.radius(cut.at)
        if isinstance(cut.report.cut, EventCut):
            return loaded
        before = self.trace.cuts[: number + 1] if self.dialect == "haas" else [cut]
        for each in reversed(before):
            d = each.report.words.get("D")
            if d is not None and isinstance(each.report.cut, PocketCut):
                return self.trace.table_at(each.at).diameters.get(round(d), 0.0) / 2
        return loaded if self.dialect == "haas" else 0.0

    def _before(self, number: int, plane: str) -> float | None:
        """Return W or O of the last event that has one, mm."""
        for cut in reversed(self.trace.cuts[:number]):
            if isinstance(cut.report.cut, EventCut):
                entries = circles.event_entries(BlockInMm(cut.report, 0.0, None))
                if plane in entries:
                    return entries[plane]
        return None

    def _report_of_circle(
        self, cut: ReportedCut, block: BlockInMm, path: Sequence[Expected]
    ) -> Iterator[Difference]:
        """Yield the numbers of a report that are not those of the expected toolpath."""
        planned, unit = cut.report.cut, block.unit
        rings = [move for move in path if getattr(move.curve, "sweep", 0.0) ** 2 > WHOLE_TURN]
        radii = [abs(move.curve.start - move.curve.centre) for move in rings]
        here = cut.report.at[THIRD.get(getattr(planned, "plane", "G17"), 2)]
        outside = isinstance(planned, EventCut) and planned.side > 0
        wall = (min if outside else max)(radii) + block.cutter
        levels = dict.fromkeys(round(here + move.end_level / unit, 6) for move in rings)
        reported = dict.fromkeys(round(level, 6) for level in planned.levels)
        yield from compared(
            cut,
            unit,
            [planned.wall, planned.cutter.radius, *planned.centre[:2], *reported],
            [wall / unit, block.cutter / unit, *block.centre()[:2], *levels],
        )

    # ------------------------------------------------------------ a lathe

    def _on_lathe(self, cut: ReportedCut, surface: float) -> dict:
        """Return what a section and a shape share: their plane, their moves on the part."""
        zero = cut.report.frame.zero
        x, _, z = (value * cut.report.frame.mm for value in zero[:3])
        own, speed = range(cut.at, cut.end), self.trace.modes.speed
        part = Surface(True, self.ini.tool_beside, x, radius=surface) if surface else None
        part = part or Part(True, self.ini.tool_beside, x)
        drawn = range(len(self.moves))[max(0, cut.at - 1) : cut.end + 1]
        return {
            "line": cut.line,
            "last_line": cut.last_line,
            "own": own,
            "moves": self.moves,
            "path": track(part, self.moves, limits_of(self.ini), speed, own=drawn),
            "axes": lathe_axes(self.ini),
            "base": x if surface else z,
            "surface": surface,
            "tolerance": self.ini.settings.tolerance(self.ini.mm) * self.ini.mm,
        }

    def _section(self, cut: ReportedCut, events: Sequence[Event]) -> LatheCut:
        planned, frame = cut.report.cut, cut.report.frame
        surface, shared = planned.surface * frame.mm, None
        shared = self._on_lathe(cut, surface)
        elements = list(elements_of(cut.report, planned))
        height = cut.report.at[0 if surface else 2] * frame.mm
        tool = self.trace.radius(cut.at)
        steps = contour_path(elements, height, tool)
        angle = math.radians(frame.zero[3] + (0.0 if surface else cut.report.at[3]))
        zero = complex(angle * surface, frame.zero[2] * frame.mm) if surface else 0j
        axis = 1 + 0j if surface else cmath.rect(1.0, angle)
        path = [step.move for step in steps]
        return LatheCut(expected=path, zero=zero, axis=axis, steps=steps, events=events, **shared)

    def _shape(self, cut: ReportedCut, call: SubCall) -> LatheCut:
        axis = cmath.rect(1.0, math.radians(call.zero[2]))
        shared = self._on_lathe(cut, 0.0)
        return LatheCut(expected=shape_path(call), zero=0j, axis=axis, **shared)

    def _call(self, cut: ReportedCut, found: Mapping) -> SubCall:
        own, radius = self.moves[cut.at : cut.end], self.trace.radius(cut.at)
        return SubCall(cut.report, found, radius, self.settings, own)

    def _acts(self, cut: ReportedCut, events: Sequence[Event]) -> Iterator[Difference]:
        """Yield the first act of a section that is not as written; nothing if none is known."""
        if self.known is None:
            return
        written = [each.strip() for each in self._written("acts", cut).split(";") if each.strip()]
        made = [
            f"{self.moves[event.at - 1].line if event.at > cut.at else 0} {event.text.strip()}"
            for event in events
            if ACTS.match(event.text)
        ]
        if made != written:
            yield Difference("acts", cut.line, f"{made}, not {written}")

    # ------------------------------------------------------------ holes

    def _holes(self, cut: ReportedCut, around: Surroundings) -> Iterator[Difference]:
        own = range(cut.at, cut.end)
        holes = holes_of(self._call(cut, around.found))
        path = HolesPath(holes, holes.call.turned).toolpath()
        laid = lay(path, made_of_holes(holes, self.moves, own), WALL)
        yield from judge_path(laid, cut.line)
        yield from compared(cut, holes.call.unit, holes_reported(cut), holes_of_words(holes))
        passed = [move for move, made in zip(path, laid.moves) if not made]
        if passed and not laid.difference:
            yield Difference("path-missing", cut.line, passed[0].name)
        if any(self.moves[i].kind == "rapid" and not self.moves[i].exact for i in own):
            yield Difference("blended-hole", cut.line)
        yield from judge_dwells(cut, holes, around.events, self.moves)
        codes = [f"M{code}" for code in self.settings.c_clamp]
        if codes:
            yield from judge_clamp(cut, holes, path, laid, around.events, codes)
        known = ("dwell", "pitch", "clamp", "G6")
        others = [event for event in around.events if not event.text.startswith(known)]
        yield from judge_events(cut, others)


def compared(
    cut: ReportedCut, unit: float, found: Sequence[float], expected: Sequence[float]
) -> Iterator[Difference]:
    """Yield that the numbers of a report are not those of its words; in program units."""
    same = len(found) == len(expected)
    if not same or any(abs(a - b) * unit > LEVEL for a, b in zip(found, expected)):
        yield Difference("report", cut.line, f"{[*found]}, not {[*expected]}")


def shape_of(planned) -> list[float]:
    """Return the numbers of a reported shape."""
    own = [value for value in planned[:-1] if not isinstance(value, tuple)]
    return [
        *getattr(planned, "centre", ()),
        *own,
        planned.passes.cutter.radius,
        *planned.passes.levels,
    ]


def shape_of_words(planned, call: SubCall) -> list[float]:
    """Return the same numbers by the entries of the call."""
    given, unit = call.given, call.unit
    names = [name for name in planned._fields[:-1] if name != "centre"]
    centre = [call.x() / unit, given.get("c", 0.0)] if hasattr(planned, "centre") else []
    depth = given["depth"]
    levels = equal_steps(0.0, -depth, given.get("depth_per_pass", depth), 1e-6 / unit)
    return [*centre, *(given.get(name, 0.0) for name in names), call.cutter / unit, *levels]


def holes_reported(cut: ReportedCut) -> list[float]:
    """Return the numbers of reported holes; angles from 0 on, each as the length of its place."""
    planned = cut.report.cut
    places = [number for x, z, c in planned.places for number in (x, z, *on_circle(x, c))]
    return [planned.surface, planned.depth, planned.kind, *places]


def holes_of_words(holes: Holes) -> list[float]:
    """Return the same numbers by the entries of the call."""
    unit = holes.call.unit
    x, z = holes.x / unit, holes.z / unit
    angles = [holes.angle + holes.turn * number for number in range(holes.count)]
    places = [number for angle in angles for number in (x, z, *on_circle(x, angle))]
    return [x * holes.side, holes.depth / unit, holes.kind, *places]


def on_circle(x: float, angle: float) -> tuple[float, float]:
    place = cmath.rect(x, math.radians(angle))
    return place.real, place.imag


def made_in(
    origin: np.ndarray, axes: np.ndarray, moves: Sequence[Move], own: range
) -> Iterator[Made]:
    """Yield the moves that have a length, from a place along axes."""

    def local(positions):
        found = (np.atleast_2d(positions)[:, :3] - origin) @ axes.T
        return [(complex(x, y), level) for x, y, level in found.tolist()]

    for index in own:
        move = moves[index]
        if move.length <= CART_FUZZ:
            continue
        points = local([move.start[:3], move.end[:3]])
        across = plane_axes(move)
        if move.kind != "arc":
            curve = Line(points[0][0], points[1][0])
        elif np.abs(across[2] - axes[2]).max() < SAME_AXIS:
            curve = Arc(points[0][0], local(move.centre)[0][0], move.sweep)
        else:
            curve, points = None, local(arc_points(move, SHARES))
        yield Made.of(index, move, points, curve)


def made_of_holes(holes: Holes, moves: Sequence[Move], own: range) -> Iterator[Made]:
    """Yield the moves of a call that go anywhere."""
    for index in own:
        move = moves[index]
        ends = [holes.point(move.start), holes.point(move.end)]
        if max(abs(ends[0][0] - ends[1][0]), abs(ends[0][1] - ends[1][1])) > CART_FUZZ:
            yield Made.of(index, move, ends, Line(ends[0][0], ends[1][0]))


def judge_dwells(
    cut: ReportedCut, holes: Holes, events: Sequence[Event], moves: Sequence[Move]
) -> Iterator[Difference]:
    """Yield what is wrong with the dwells at the bottoms, and with the pitches of taps."""
    act = f"dwell {holes.dwell:g}" if holes.dwell else f"pitch {holes.pitch:.10g} mm"
    found = [e for e in events if e.text.startswith(("dwell", "pitch")) and e.text != "dwell 0"]
    same = [each for each in found if each.text == act]
    yield from judge_events(cut, [each for each in found if each.text != act])
    if len(same) < holes.count and (holes.dwell or holes.pitch):
        yield Difference("act-missing", cut.line, act)
    bottom = -holes.depth if holes.dwell else holes.call.length("retract")
    levels = [holes.point(moves[each.at].start)[1] for each in same]
    if any(abs(level - bottom) > LEVEL for level in levels):
        yield Difference("act-off-bottom", cut.line, act)


def judge_clamp(
    cut: ReportedCut,
    holes: Holes,
    path: Sequence[Expected],
    laid: Laid,
    events: Sequence[Event],
    codes: Sequence[str],
) -> Iterator[Difference]:
    """Yield the first move of each kind in which the clamp is otherwise, or that it stays so."""
    close, opens = codes
    own = [each for each in events if each.text.startswith("clamp ")]
    at, told = [each.at for each in own], ["", *(each.text.split()[1] for each in own)]
    for closed, name, code in ((True, "clamp-open", close), (False, "clamp-closed", opens)):
        wrong = (
            move.name
            for move, made in zip(path, laid.moves)
            if holes.clamped(move) is closed
            and any(told[bisect(at, index)] != code for index in made)
        )
        yield from (Difference(name, cut.line, what) for what in islice(wrong, 1))
    if told[-1] != opens:
        yield Difference("clamp-left", cut.line)
