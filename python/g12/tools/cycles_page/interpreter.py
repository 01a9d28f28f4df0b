# SPDX-License-Identifier: GPL-2.0-or-later
"""A step as the stock interpreter reads it on this machine.

A mill is seen from above, a bar's end from the tool, holes round a bar on its unrolled surface.
"""

import re
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.cycles_page.machine import MachineState
from g12.tools.cycles_page.sketch import MESSAGE, READY, REFUSED, Sketch
from g12.tools.forms.table import MILL, ROUND, Form
from g12.tools.machine.ini import Ini, IniError, read_ini
from g12.tools.path.part import Part, Surface, X, Z, last_zero
from g12.tools.path.track import program_seconds
from g12.tools.preview.moves import IS_LENGTH, Move, Trace
from g12.tools.preview.tracer import Tracer
from g12.tools.units import clock

NEAR = 1e-6  # machine units; a limit may be reached
IN_FORM = re.compile(r" line \d+ of form_\w+\.ngc")  # which the operator does not see
CHORD_ERROR = 0.02  # mm, of what is drawn
MOST_TURNS = 2  # of a helix, whose turns lie on each other
TIMEOUT = 10.0  # s
Moves: TypeAlias = Sequence[tuple[Move, np.ndarray]]  # with the positions along them
EDITED = "{} was edited: LinuxCNC and this page go by it when they are started again"


class Sketcher:
    """The interpreter of one machine, for steps as the operator types them."""

    def __init__(self, ini: Ini) -> None:
        self.ini, self._table = ini, b""
        self._tracer: Tracer | None = None

    def close(self) -> None:
        if self._tracer:
            self._tracer.close()
        self._tracer = None

    def sketch(self, form: Form, text: str, state: MachineState) -> Sketch:
        """Return what the lines ``text`` of a form do; the machine is in ``state``."""
        options = {"setup": self._setup(state), "parameters": state.parameters}
        trace = self._interpreter().trace_text(text, timeout=TIMEOUT, **options)
        part = self._part(form, trace)
        drawn = () if trace.error else trace.moves
        moves = [(move, positions_of(move, part)) for move in drawn]
        cut, rapid = (
            [part.points(at)[:, :2] for move, at in moves if (move.kind == "rapid") is rapid]
            for rapid in (False, True)
        )
        radius = trace.radius(len(moves) - 1) if moves else 0.0
        return Sketch(*self._outcome(trace, moves, form), cut, rapid, radius)

    def _part(self, form: Form, trace: Trace) -> Part:
        """Return what the form cuts; a surface is unrolled where the tool begins to cut."""
        zero = last_zero(trace)
        cuts = [abs(move.start[X] - zero) for move in trace.moves if move.kind != "rapid"]
        if form.place == ROUND:
            return Surface(True, self.ini.tool_beside, zero, radius=max(cuts, default=0.0))
        return Part(form.place != MILL, self.ini.tool_beside, zero)

    def _interpreter(self) -> Tracer:
        """Return the interpreter, a new one where the tool table is another."""
        path = self.ini.file("EMCIO", "TOOL_TABLE")
        table = path.read_bytes() if path and path.is_file() else b""
        if self._tracer is None or table != self._table:
            self.close()
            self._tracer, self._table = Tracer(self.ini), table
        return self._tracer

    def _outcome(self, trace: Trace, moves: Moves, form: Form) -> tuple[str, str]:
        """Return the state and the sentence of a trace."""
        refused = trace.error.rule if trace.error else self._beyond(moves)
        if refused:
            return REFUSED, IN_FORM.sub("", refused)
        said = dict.fromkeys(message.text for message in trace.messages)
        told = [*said, *([EDITED.format(self.ini.path.name)] if self._is_edited() else [])]
        return (MESSAGE, "; ".join(told)) if told else (READY, self._summary(trace, form))

    def _is_edited(self) -> bool:
        try:
            return read_ini(self.ini.path).lines != self.ini.lines
        except IniError:
            return True

    def _setup(self, state: MachineState) -> list[str]:
        """Return the blocks that bring a fresh interpreter to the machine's state."""
        at = dict(zip(AXIS_LETTERS, state.position))
        there = " ".join(f"{letter}{at[letter]:.6f}" for letter in self.ini.axes)
        loaded = [f"M61 Q{state.tool}"] if state.tool else []
        return [*loaded, f"G53 G0 {there}"]

    def _summary(self, trace: Trace, form: Form) -> str:
        """Return time and depth of what is cut."""
        depths = [move.end[Z] for move in trace.moves if move.kind != "rapid"]
        if not depths:
            return "nothing is cut"
        depth = (min(depths) - last_zero(trace, Z)) / self.ini.mm
        time = clock(program_seconds(trace, self.ini))
        return f"{form.place}: {time} at the programmed feeds, down to Z{depth:.3f}"

    def _beyond(self, moves: Moves) -> str:
        """Return the sentence about a move beyond the machine's travel, or an empty text."""
        reached = np.concatenate([np.empty((0, 9)), *(at + move.tool_offset for move, at in moves)])
        for letter, limits in self.ini.axis_limits.items():
            axis = AXIS_LETTERS.index(letter)
            values = reached[:, axis] / (self.ini.mm if IS_LENGTH[axis] else 1.0)
            past = values[(values < limits.low - NEAR) | (values > limits.high + NEAR)]
            if past.size:
                limit = limits.low if past[0] < limits.low else limits.high
                return f"the {letter} axis would go to {past[0]:.3f}, beyond its limit {limit:g}"
        return ""


def positions_of(move: Move, part: Part) -> np.ndarray:
    """Return positions along a move, near enough to draw."""
    turns = max(-MOST_TURNS, min(MOST_TURNS, move.turns))
    return part.machine_points(move._replace(turns=turns), CHORD_ERROR)
