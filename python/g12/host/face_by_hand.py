# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 typed in MDI, with kinematics: X and Y move on the face until G13.1.

Nothing is planned ahead here. The lines in between are LinuxCNC's own; `polar_xzc` slows them
where C could not follow (M52 P1), and lets no program move.
"""

from __future__ import annotations

from collections.abc import Iterator

from g12.errors import BlockRefusal
from g12.host import glue
from g12.host.call_frame import CallFrame
from g12.host.kinematics_switch import (
    BY_HAND,
    FACE_OUTPUT,
    NOT_SWITCHED,
    OFF,
    ON_THE_FACE,
    face_in_force,
    has_switched,
    modes_found,
    other_offset,
    to_axes,
    to_face,
    y_offset,
)
from g12.host.program_lines import ProgramLines, read_source, without_line
from g12.section.start import SectionStart

ADAPTIVE = 52  # active_m_codes
MDI_LINE = 0  # of the moves that follow, by which polar_xzc knows them


def switch_on(interp: object, start: SectionStart, beside: float) -> Iterator[int]:
    """Go to the face where a section could begin, with the tool ``beside`` the X line."""
    code = start.place.code
    if face_in_force():
        raise BlockRefusal(code, "is already on")
    if y_offset(interp):
        raise BlockRefusal(code, "needs an offset of 0 in Y in MDI: its Y0 is the spindle's axis")
    interp.g12_found = modes_found(interp) + adaptive_feed(interp)
    asked = to_face(interp, start.machine_unit, BY_HAND)
    yield from _switch(interp, code, CallFrame(interp, glue.NO_FILE), MDI_LINE, asked)
    wrong = other_offset(interp, beside)
    if wrong:
        yield from switch_off(interp)
        raise BlockRefusal(code, wrong)
    interp.execute(f"{ON_THE_FACE}M52P1")


def switch_off(interp: object) -> Iterator[int]:
    """Come back from the face, if that is where the machine is, to the modes that were found."""
    give_back_modes(interp)
    if face_in_force():
        mdi = glue.in_mdi(interp)
        home = read_source(interp.filename) if not mdi else None
        frame = CallFrame(interp, home.filename if home else glue.NO_FILE)
        line = ProgramLines(interp, home).line if home else MDI_LINE
        yield from _switch(interp, glue.code_of_block(interp), frame, line, to_axes(interp))


def abort(interp: object) -> None:
    """Come back behind an abort: nothing can be waited for, so ask and go on.

    `Interp::read_inputs` (rs274ngc_pre.cc) takes the position that the machine has then when it
    reads the next line, as behind a tool change: the one that LinuxCNC took is the face's.
    """
    interp.execute(f"M68E{FACE_OUTPUT}Q{OFF}")
    give_back_modes(interp)
    interp.toolchange_flag = True


def give_back_modes(interp: object) -> None:
    """Give back the modes that `switch_on`, or a section, found."""
    found, interp.g12_found = getattr(interp, "g12_found", None), None
    if found:
        interp.execute(found)


def adaptive_feed(interp: object) -> str:
    """Return the block that gives back M52 as it is."""
    return f"M52P{int(ADAPTIVE in without_line(interp.active_m_codes))}"


def _switch(
    interp: object, code: str, frame: CallFrame, line: int, blocks: Iterator[str]
) -> Iterator[int]:
    frame.enter()
    for block in blocks:
        yield from frame.execute_and_wait(block)
    frame.leave(line)
    if not has_switched(interp):
        raise BlockRefusal(code, NOT_SWITCHED)
