# SPDX-License-Identifier: GPL-2.0-or-later
"""The whole program: its travel, offsets that are in force before and after it, what is not run."""

import math
import re
from collections.abc import Iterator

import numpy as np

from g12.machine_ini import face_joints
from g12.tools.machine.stored_positions import shift_at_start
from g12.tools.path.part import turning_points
from g12.tools.preview.moves import Move
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING
from g12.tools.verify.model.program import SIZE, TracedProgram
from g12.tools.verify.rules.table import Values, rule

ROTATIONS = range(5230, 5391, 20)  # parameters of a var file
SHIFTS = ("axis_offset_x", "axis_offset_y", "axis_offset_z", "CC_axis_offset")
UNPLACED = ", with the work offset that fits best: none is set (--var)"
SHIFT_CODE, ROTATES = re.compile(r"G(92|52)(?![.\d])"), re.compile(r"G10.*R")


@rule(
    "travel",
    FINDING,
    "{axis} would go to {position:mm}, its limit is {limit:length}{hint}",
    program=True,
)
def beyond_travel(program: TracedProgram) -> Values:
    """Without a work offset only what is wider than the travel itself is known."""
    limits, mm = program.ini.axis_limits, program.ini.mm
    if face_joints(program.ini.get):  # whose X and Y are the tool's, and refused by the package
        return None
    for axis, at, moves in _reached(program):
        low, high, hint = limits[axis].low * mm, limits[axis].high * mm, ""
        if not program.is_placed:
            low, high, hint = at.min(), at.min() + high - low, UNPLACED
        beyond = np.flatnonzero((at < low - SIZE) | (at > high + SIZE))
        if len(beyond):
            position, line = at[beyond[0]], program.where(int(moves[beyond[0]]))[0]
            values = {"axis": axis, "position": position, "hint": hint, "at_line": line}
            return {**values, "limit": low if position < low else high}
    return None


def _reached(program: TracedProgram) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield the axes with limits, where each comes to rest or turns back, and the moves' indices.

    They are those of the moves that a work offset places.
    """
    moves = [i for i, m in enumerate(program.moves) if program.is_placed or not m.by_machine]
    own = [_ends(program.moves[index], index) for index in moves]
    indices = np.repeat(moves, [len(ends) for ends in own])
    for axis, at in zip("XYZ", np.concatenate(own).T if own else ()):
        if axis in program.ini.axis_limits:
            yield axis, at, indices


def _ends(move: Move, index: int) -> np.ndarray:
    """Return where a move's axes come to rest or turn back (n, 3), of the first also its start."""
    return turning_points(move)[int(index > 0) :, :3] + move.tool_offset[:3]


def travel_needed(program: TracedProgram) -> Iterator[tuple[str, float, float]]:
    """Yield the axes of a program that no work offset places, with its least and its greatest."""
    for axis, at, _ in _reached(program) if not program.is_placed else ():
        yield axis, float(at.min()), float(at.max())


@rule(
    "g92-stale", WARNING, "G92 is in force by the var file: {shift} (G92.1 ends it)", program=True
)
def stale_g92(program: TracedProgram) -> Values:
    shift = shift_at_start(program.parameters, program.ini)
    return {"shift": shift} if shift else None


@rule(
    "rotation-stale", WARNING, "a work offset is rotated by the var file: {turned:3}°", program=True
)
def stale_rotation(program: TracedProgram) -> Values:
    turned = [program.parameters.get(number, 0.0) for number in ROTATIONS]
    own = any(map(ROTATES.search, program.texts))
    return {"turned": max(turned, key=abs)} if any(turned) and not own else None


@rule("g92-left", WARNING, "G92 or G52 is left in force: G92.1 ends it", program=True)
def left_g92(program: TracedProgram) -> Values:
    left = [program.trace.state.get(name, 0.0) for name in SHIFTS]
    left[3] = math.remainder(left[3], 360.0)
    line = _last_line(SHIFT_CODE, program)
    return {"at_line": line} if line and any(abs(value) > SIZE for value in left) else None


@rule(
    "rotation-left",
    WARNING,
    "the work offset is left turned by {turned:3}°: G10 L2 P1 R0 ends it",
    program=True,
)
def left_rotation(program: TracedProgram) -> Values:
    turned, line = program.trace.state.get("rotation_xy", 0.0), _last_line(ROTATES, program)
    return {"turned": turned, "at_line": line} if turned and line else None


def _last_line(code: re.Pattern, program: TracedProgram) -> int:
    lines = [number for number, text in enumerate(program.texts, 1) if code.search(text)]
    return lines[-1] if lines else 0


@rule(
    "block-delete",
    NOT_JUDGED,
    "the program with block delete off: lines with / are skipped",
    program=True,
)
def block_delete(program: TracedProgram) -> Values:
    deleted = (n for n, text in enumerate(program.texts, 1) if text.lstrip().startswith("/"))
    line = next(deleted, 0)
    return {"at_line": line} if line else None
