# SPDX-License-Identifier: GPL-2.0-or-later
"""Messages to the operator: refusals of a block, faults, notes, errors at the start.

A comment at a line names the fact about the interpreter that the line relies on.
"""

from __future__ import annotations

import functools
import sys
from cmath import rect
from math import radians
from pathlib import Path
from typing import Any

import emccanon
import linuxcnc
from interpreter import INTERP_ERROR, INTERP_OK, MODE_INCREMENTAL

from g12 import cut_report
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.host import borrowed
from g12.host.interp import PER_REVOLUTION, Interp, kept, millimetres_per_unit
from g12.host.program_lines import line_at, running_file

NO_FILE = ""  # a constant, as the interpreter makes no copy of the text


@functools.cache  # several modules may report the same
def report_at_start(text: str) -> None:
    print(f"g12: {text}", file=sys.stderr)
    emccanon.CANON_ERROR(f"g12: {text}")


def refuse_block(interp: Interp, error: Exception) -> int:
    """Report to the operator why the remapped block is not executed; return the error status.

    LinuxCNC would show a raised exception or a returned string as "pycall(...) failed". After a
    failed execute, which is a SystemError, LinuxCNC has set its own text already.
    """
    if isinstance(error, Refusal) and error.lacks_line:
        error.at(line_of(interp, error.code))
    if not isinstance(error, SystemError):
        interp.set_errormsg(shown_text(error))
    return INTERP_ERROR


def shown_text(error: Exception) -> str:
    """Return what the operator reads of an error; a fault of the package is also logged."""
    if isinstance(error, Refusal):
        return error.message
    sys.excepthook(type(error), error, error.__traceback__)
    return fault_text(error)[:LONGEST_MESSAGE]


def line_of(interp: Interp, code: str) -> int | None:
    """Return the line of the block being remapped, None where it is typed in MDI.

    If ``code`` is not the block's but the name of its sub, that of the call.
    """
    own, mdi = code == code_of_block(interp), in_mdi(interp)
    level = interp.call_level - 1 if own else level_of_call(interp, code)
    if mdi and not level:
        return None
    if own:
        filename, offset = file_of_block(interp), interp.blocks[interp.remap_level].offset
    else:
        frame = interp.sub_context[level]
        filename, offset = frame.filename, frame.position - 1
    main = filename if interp.call_level < 2 else interp.sub_context[0].filename
    return line_at(filename, offset, own=not mdi and filename == main)


def level_of_call(interp: Interp, sub: str) -> int:
    """Return the call level from which a running sub was called."""
    level = interp.call_level - 1
    while level and interp.sub_context[level].subname != sub:
        level -= 1
    return level - 1


def file_of_block(interp: Interp) -> str:
    """Return the file of the block being remapped; in an epilog the sub's own file is open."""
    remap = interp.blocks[interp.remap_level].executing_remap
    in_sub = remap.remap_ngc and Path(interp.filename).name == f"{remap.remap_ngc}.ngc"
    return interp.sub_context[interp.call_level - 1].filename if in_sub else interp.filename


def in_mdi(interp: Interp) -> bool:
    """Return whether the block, or what called its sub, was typed in MDI."""
    if not interp.task:
        return False
    status = linuxcnc.stat()
    status.poll()
    return status.task_mode == linuxcnc.MODE_MDI


def fault_text(error: Exception) -> str:
    return f"g12: a fault of the package, please report it: {type(error).__name__}: {error}"


def handler(function):
    """Turn an exception of a remap handler into the operator's message."""

    @functools.wraps(function)
    def guarded(self, **words):
        try:
            return function(self, **words)
        except Exception as error:
            status = refuse_block(self, error)
            forget_return(self)
            return status

    return guarded


def waiting_handler(function):
    """Turn an exception of a remap handler that yields, to wait, into the operator's message."""

    @functools.wraps(function)
    def guarded(self, **words):
        try:
            forget_return(self)
            yield from function(self, **words)
        except Exception as error:
            yield refuse_block(self, error)
        yield INTERP_OK

    return guarded


def forget_return(interp: Interp) -> None:
    """Let the remap's caller continue with its next line if this one fails.

    `Interp::unwind_call` (rs274ngc_pre.cc) goes back to the return position of each frame. The
    caller's is still that of an earlier call; without a file name it is ignored.
    """
    interp.sub_context[interp.call_level - 1].filename = NO_FILE


def code_of_block(interp: Interp) -> str:
    """Return the remapped code as the operator wrote it: ``G12``, ``G12.2``."""
    return interp.blocks[interp.remap_level].executing_remap.name.upper()


def settle(interp: Interp) -> None:
    """Restore what an interrupted code left, as far as that is certain, and report the rest."""
    left = borrowed.settle_interrupted(interp)
    if left:
        code = code_of_block(interp)
        message(
            f"{code}: a code before it was interrupted, and no ON_ABORT_COMMAND restored {left}:"
            " what is in force now stays"
        )


def message(text: str) -> None:
    emccanon.MESSAGE(text)


class ShownOnce(set[object]):
    """The messages that were shown, by program and key."""


def message_once(interp: Interp, key: object, text: str) -> None:
    """Show a message once for each program and ``key``, as long as LinuxCNC runs."""
    once = main_program(interp), key
    shown = kept(interp, ShownOnce)
    if once not in shown:
        shown.add(once)
        message(text)


def main_program(interp: Interp) -> tuple[str, int] | None:
    """Return the file at the bottom of the call stack and when it was last written.

    In MDI it is the one that is open, if any.
    """
    name = running_file(interp)
    try:
        return name, Path(name).stat().st_mtime_ns
    except (OSError, TypeError):
        return None


SECTION_BEGAN = "section"  # key: its first part has been reported


def begin_cut(
    interp: Interp, code: str, given: dict[str, float], cut: cut_report.PlannedCut
) -> None:
    """Report the cut of the block, or of the call of its sub."""
    if asked(interp) is not None:
        line = line_of(interp, code) or 0
        report = report_of(interp, code, line, given, cut)
        emccanon.COMMENT(cut_report.report_text(report))


def end_cut(interp: Interp) -> None:
    memory = asked(interp)
    if memory is not None:
        memory.pop(SECTION_BEGAN, None)
        emccanon.COMMENT(cut_report.END)


def asked(interp: Interp) -> dict[str, Any] | None:
    """Return the memory of reports, None if nobody asks for them."""
    return getattr(interp, cut_report.ASKED, None)


def report_of(
    interp: Interp, code: str, line: int, words: dict[str, float], cut: cut_report.PlannedCut
) -> cut_report.CutReport:
    return cut_report.CutReport(
        code,
        int(line),
        getattr(line, "file", ""),
        _frame(interp),
        (interp.current_x, interp.current_y, interp.current_z, interp.CC_current),
        interp.feed_rate,
        interp.feed_mode == PER_REVOLUTION,
        interp.distance_mode == MODE_INCREMENTAL,
        words,
        cut,
    )


def _frame(interp: Interp) -> cut_report.ProgramFrame:
    shift = complex(interp.axis_offset_x, interp.axis_offset_y)
    turned = shift * rect(1.0, radians(interp.rotation_xy))
    zero = (
        interp.origin_offset_x + turned.real,
        interp.origin_offset_y + turned.imag,
        interp.origin_offset_z + interp.axis_offset_z,
        interp.CC_origin_offset + interp.CC_axis_offset,
    )
    shifted = bool(shift or interp.axis_offset_z or interp.CC_axis_offset)
    return cut_report.ProgramFrame(millimetres_per_unit(interp), zero, interp.rotation_xy, shifted)
