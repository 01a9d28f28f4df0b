# SPDX-License-Identifier: GPL-2.0-or-later
"""The whole program: its travel, offsets that are in force before and after it, what is not run."""

import math
import re
from collections.abc import Iterator

import numpy as np

from g12.machine_ini import face_joints
from g12.tools.machine.stored_positions import shift_at_start
from g12.tools.path.part import turning_points
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING
from g12.tools.verify.model.program import SIZE, TracedProgram
from g12.tools.verify.rules.table import Values, rule

ROTATIONS = range(5230, 5391, 20)  # parameters of a var file
SHIFTS = ("axis_offset_x", "axis_offset_y", "axis_offset_z", "CC_axis_offset")
SHIFT_CODE, ROTATES = re.compile(r"G(92|52)(?![.\d])"), re.compile(r"G10.*R")


@rule(
    "travel", FINDING, "{axis} would go to {position:mm}, its limit is {limit:length}", program=True
)
def beyond_travel(program: TracedProgram) -> Values:
    """Without a work offset only what is wider than the travel itself is known."""
    limits, mm = program.ini.axis_limits, program.ini.mm
    if face_joints(program.ini.get):  # whose X and Y are the tool's, and refused by the package
        return None
    positions, moves = _positions(program)
    for axis, at in zip("XYZ", positions.T):
        if axis not in limits:
            continue
        low, high = limits[axis].low * mm, limits[axis].high * mm
        if not program.is_placed:
            shift = at.min(initial=low) - low
            low, high = low + shift, high + shift
        beyond = np.flatnonzero((at < low - SIZE) | (at > high + SIZE))
        if len(beyond):
            position, line = at[beyond[0]], program.where(int(moves[beyond[0]]))[0]
            limit = low if position < low else high
            return {"axis": axis, "position": position, "limit": limit, "at_line": line}
    return None


def _positions(program: TracedProgram) -> tuple[np.ndarray, np.ndarray]:
    """Return where X, Y and Z (n, 3) come to rest or turn back, with the indices of the moves.

    They are those of the moves that a work offset places.
    """
    positions, moves = [], []
    for index, move in enumerate(program.moves):
        if program.is_placed or not move.by_machine:
            ends = turning_points(move) if move.kind == "arc" else (move.start, move.end)
            own = [np.add(at[:3], move.tool_offset[:3]) for at in ends[int(index > 0) :]]
            positions += own
            moves += [index] * len(own)
    return np.reshape(positions, (-1, 3)), np.array(moves, int)


def travel_needed(program: TracedProgram) -> Iterator[tuple[str, float, float]]:
    """Yield the axes of a program that no work offset places, with its least and its greatest."""
    if program.is_placed:
        return
    for axis, at in zip("XYZ", _positions(program)[0].T):
        if axis in program.ini.axis_limits and len(at):
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
