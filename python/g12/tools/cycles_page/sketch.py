# SPDX-License-Identifier: GPL-2.0-or-later
"""What a step does on this machine, as the stock interpreter reads it: lines to draw, a sentence.

Lengths are mm. A mill is seen from above, a bar's end from the tool, holes round a bar on its
unrolled surface.
"""

import math
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.forms.table import MILL, Form
from g12.tools.machine.ini import Ini
from g12.tools.path.track import program_seconds
from g12.tools.preview.moves import Move, Trace
from g12.tools.preview.tracer import TraceFailure, Tracer
from g12.tools.units import clock

X, Y, Z, C = (AXIS_LETTERS.index(letter) for letter in "XYZC")
PLANES = {17: (X, Y), 18: (Z, X), 19: (Y, Z)}  # first and second axis
LINEAR = "XYZUVW"
NEAR = 1e-6  # machine units; a limit may be reached
IN_FORM = re.compile(r" line \d+ of form_\w+\.ngc")  # which the operator does not see
STEP = math.radians(5)  # of an arc, or of a turn of C, between two drawn points
PLAN, FACE, UNROLLED = "from above", "the face", "the surface, unrolled"
READY, MESSAGE, REFUSED = "ready", "message", "refused"


class Line(NamedTuple):
    """A move as drawn."""

    is_rapid: bool
    points: np.ndarray  # one row each, in the plane of the view


class Sketch(NamedTuple):
    """What a step would do."""

    state: str  # READY, MESSAGE or REFUSED
    text: str  # for the operator
    view: str = PLAN
    lines: Sequence[Line] = ()
    radius: float = 0.0  # of the cutter


class MachineState(NamedTuple):
    """The machine as it stands, in machine units and degrees."""

    parameters: Mapping[int, float]  # work offsets, as the var file numbers them
    tool: int  # in the spindle, 0 for none
    position: Sequence[float]  # of the axes, in the order of AXIS_LETTERS


class Sketcher:
    """The interpreter of one machine, for steps as the operator types them."""

    def __init__(self, ini: Ini) -> None:
        self.ini, self._tracer = ini, Tracer(ini)

    def close(self) -> None:
        self._tracer.close()

    def sketch(self, form: Form, text: str, state: MachineState) -> Sketch:
        """Return what the lines ``text`` of a form do; the machine is in ``state``."""
        try:
            options = {"setup": self._setup(state), "parameters": state.parameters}
            trace = self._tracer.trace_text(text, **options)
        except TraceFailure as problem:
            return Sketch(REFUSED, str(problem))
        view, paths = view_of(form), [path_of(move) for move in trace.moves]
        moves = zip(trace.moves, paths)
        lines = [Line(move.kind == "rapid", seen(path, view)) for move, path in moves]
        kind, said = self._outcome(trace, paths)
        return Sketch(kind, said, view, lines, _cutter(trace))

    def _outcome(self, trace: Trace, paths: Sequence[np.ndarray]) -> tuple[str, str]:
        """Return the state and the sentence of a trace."""
        refused = trace.error.rule if trace.error else self._beyond(trace.moves, paths)
        if refused:
            return REFUSED, IN_FORM.sub("", refused)
        said = "; ".join(dict.fromkeys(message.text for message in trace.messages))
        return (MESSAGE, said) if said else (READY, self._summary(trace))

    def _setup(self, state: MachineState) -> list[str]:
        """Return the blocks that bring a fresh interpreter to the machine's state."""
        axes = [AXIS_LETTERS.index(letter) for letter in self.ini.axes]
        there = " ".join(f"{AXIS_LETTERS[axis]}{state.position[axis]:.6f}" for axis in axes)
        loaded = [f"M61 Q{state.tool}"] if state.tool else []
        return [*loaded, f"G53 G0 {there}"]

    def _summary(self, trace: Trace) -> str:
        """Return time and depth of what is cut."""
        cutting = [move for move in trace.moves if move.kind != "rapid"]
        seconds = program_seconds(trace, self.ini)
        if not cutting:
            return "nothing is cut"
        lowest = min(move.end[Z] for move in cutting) / self.ini.mm
        return f"{clock(seconds)} at the programmed feeds, down to Z{lowest:.3f} of the machine"

    def _beyond(self, moves: Sequence[Move], paths: Sequence[np.ndarray]) -> str:
        """Return the sentence about a move beyond the machine's travel, or an empty text."""
        if not moves:
            return ""
        reached = np.concatenate([path + move.tool_offset for move, path in zip(moves, paths)])
        for letter, limits in self.ini.axis_limits.items():
            values = reached[:, AXIS_LETTERS.index(letter)] / self._unit(letter)
            past = values[(values < limits.low - NEAR) | (values > limits.high + NEAR)]
            if past.size:
                limit = limits.low if past[0] < limits.low else limits.high
                return f"the {letter} axis would go to {past[0]:.3f}, beyond its limit {limit:g}"
        return ""

    def _unit(self, letter: str) -> float:
        return self.ini.mm if letter in LINEAR else 1.0


def view_of(form: Form) -> str:
    if form.place == MILL:
        return PLAN
    return UNROLLED if form.name == "side_holes" else FACE


def seen(path: np.ndarray, view: str) -> np.ndarray:
    """Return positions in the plane of a view."""
    if view == PLAN:
        return path[:, (X, Y)]
    turn = np.radians(path[:, C])
    if view == UNROLLED:
        return np.column_stack([turn * np.abs(path[:, X]), path[:, Z]])
    cos, sin = np.cos(-turn), np.sin(-turn)
    x, y = path[:, X], path[:, Y]
    return np.column_stack([x * cos - y * sin, x * sin + y * cos])


def drawn_sweep(move: Move) -> float:
    """Return an arc's sweep as drawn: of turns that lie on each other no more than two."""
    turn = math.copysign(2 * math.pi, move.sweep)
    return math.fmod(move.sweep, turn) + turn if abs(move.sweep) > abs(turn) else move.sweep


def path_of(move: Move) -> np.ndarray:
    """Return positions along a move, near enough to draw."""
    start, end = np.array(move.start), np.array(move.end)
    turned = drawn_sweep(move) if move.kind == "arc" else math.radians(end[C] - start[C])
    shares = np.linspace(0, 1, max(1, math.ceil(abs(turned) / STEP)) + 1)[:, np.newaxis]
    path = start + (end - start) * shares
    if move.kind == "arc":
        first, second = PLANES[move.plane]
        x, y = move.centre[first], move.centre[second]
        angles = math.atan2(start[second] - y, start[first] - x) + turned * shares[:, 0]
        path[:, first] = x + move.radius * np.cos(angles)
        path[:, second] = y + move.radius * np.sin(angles)
    return path


def _cutter(trace: Trace) -> float:
    """Return the radius of the last tool that moves."""
    return trace.radius(len(trace.moves) - 1) if trace.moves else 0.0


class Scale(NamedTuple):
    """How a view's plane lies on the screen: pixels to the right and down."""

    factor: float  # pixels per mm
    centre: np.ndarray  # of the plane, mm
    middle: np.ndarray  # of the screen, pixels

    def pixels(self, points: np.ndarray) -> np.ndarray:
        return self.middle + (points - self.centre) * self.factor * (1, -1)


def fitted(sketch: Sketch, width: int, height: int) -> Scale:
    """Return the scale at which what is cut fills a drawing."""
    cut = [line.points for line in sketch.lines if not line.is_rapid] or [np.zeros((1, 2))]
    points = np.concatenate(cut)
    low, high = points.min(axis=0) - sketch.radius, points.max(axis=0) + sketch.radius
    size = np.maximum(high - low, 1e-3)
    factor = 0.92 * min(width / size[0], height / size[1])
    return Scale(factor, (low + high) / 2, np.array([width / 2, height / 2]))
