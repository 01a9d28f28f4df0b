# SPDX-License-Identifier: GPL-2.0-or-later
"""Reports of cuts as comments, for a preview that asks: `g12.cut_report` says what they hold.

`tools/preview/worker` asks by an attribute of the interpreter, a dict that is the memory of this
module. On a machine and in a screen's preview it is missing, and nothing here does anything.
"""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable
from math import radians
from typing import TYPE_CHECKING, Any

import emccanon
from interpreter import MODE_INCREMENTAL

from g12 import cut_report
from g12.cut_report import CutReport, PlannedCut, ProgramFrame
from g12.host import messages
from g12.host.interp import PER_REVOLUTION, Interp, millimetres_per_unit

if TYPE_CHECKING:  # sections load without the cycles
    from g12.request.words import Words

SECTION_BEGAN = "section"  # key: its first part has been reported


def begin_cut(interp: Interp, words: Words, cut: Callable[[], PlannedCut]) -> None:
    """Report the cut of the block, or of the call of its sub."""
    if asked(interp) is not None:
        line = messages.line_of(interp, words.code) or 0
        report = report_of(interp, words.code, line, words.given, cut())
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
    interp: Interp, code: str, line: int, words: dict[str, float], cut: PlannedCut
) -> CutReport:
    return CutReport(
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


def _frame(interp: Interp) -> ProgramFrame:
    shift = complex(interp.axis_offset_x, interp.axis_offset_y)
    turned = shift * rect(1.0, radians(interp.rotation_xy))
    zero = (
        interp.origin_offset_x + turned.real,
        interp.origin_offset_y + turned.imag,
        interp.origin_offset_z + interp.axis_offset_z,
        interp.CC_origin_offset + interp.CC_axis_offset,
    )
    shifted = bool(shift or interp.axis_offset_z or interp.CC_axis_offset)
    return ProgramFrame(millimetres_per_unit(interp), zero, interp.rotation_xy, shifted)
