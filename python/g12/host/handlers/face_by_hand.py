# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 typed in MDI, with kinematics: X and Y move on the face until G13.1.

Nothing is planned ahead here: LinuxCNC executes the lines itself. `polar_xzc` slows them where C
could not follow (M52 P1), and blocks programs. When the face ends in another way than by G13.1, it
blocks all motion until G13.1 or the next G12.1: the operator's next line may still use X and Y of
the face.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from g12.errors import BlockRefusal
from g12.host import borrowed, kinematics_switch, messages
from g12.host.call_frame import CallFrame
from g12.host.interp import Interp, state_of
from g12.host.machine import MACHINE
from g12.host.program_lines import ProgramLines, read_source
from g12.section.codes import code_of_handler
from g12.section.start import SectionStart

MDI_LINE = 0  # line number of the following moves, by which polar_xzc identifies them


ONLY_MOVES = 3  # cutter_comp_side that is neither left nor right: see `_lock`
COMPENSATION_OFF, COMPENSATED = 0, (1, 2)  # cutter_comp_side


class ByHand(NamedTuple):
    """The state of G12.1 in MDI, until G13.1.

    ``code`` is G12.1 as typed, ``radius`` the last commanded compensation radius, ``saved`` the
    modes before it.
    """

    code: str
    radius: float
    saved: borrowed.Saved
    ended: bool = False  # by an abort or an error


def switch_on(interp: Interp, start: SectionStart, beside: float) -> Iterator[int]:
    """Switch to the face if a section may begin, with the tool ``beside`` the X line."""
    code = start.location.code
    if kinematics_switch.y_offset(interp):
        raise BlockRefusal(code, "needs an offset of 0 in Y in MDI: its Y0 is the spindle's axis")
    saved = borrowed.modes_in_force(interp)
    blocks = kinematics_switch.to_face(
        interp,
        start.machine_unit,
        kinematics_switch.FaceRequest.BY_HAND,
        partial(BlockRefusal, code),
        saved.accelerations,
    )
    yield from _switch(interp, code, CallFrame(interp, messages.NO_FILE), MDI_LINE, blocks)
    wrong = kinematics_switch.other_offset(interp, beside, start.millimetre)
    if wrong:
        yield from switch_off(interp)
        raise BlockRefusal(code, wrong)
    interp.execute(kinematics_switch.ON_THE_FACE)
    state_of(interp).by_hand = ByHand(code, interp.cutter_comp_radius, saved)
    _lock(interp)


def switch_off(interp: Interp) -> Iterator[int]:
    """Switch back from the face, if it is active, and restore the modes before it."""
    code = messages.code_of_block(interp)
    if state_of(interp).by_hand and interp.cutter_comp_side in COMPENSATED:
        raise BlockRefusal(code, "needs G40 before it")
    by_hand = _unlock(interp)
    of_ini = by_hand.saved.accelerations if by_hand else ()
    _restore(interp, by_hand)
    if kinematics_switch.is_requested() or kinematics_switch.face_in_force(interp):
        mdi = messages.in_mdi(interp)
        home = read_source(interp.filename) if not mdi else None
        frame = CallFrame(interp, home.filename if home else messages.NO_FILE)
        line = ProgramLines(interp, home).line if home else MDI_LINE
        yield from _switch(interp, code, frame, line, kinematics_switch.to_axes(interp, of_ini))


def abort(interp: Interp) -> None:
    """Switch back after an abort."""
    by_hand = _unlock(interp)
    if by_hand:
        state_of(interp).by_hand = by_hand._replace(ended=True)
        borrowed.command_adaptive(interp, by_hand.saved)  # the abort before may have lost it
    if by_hand and not by_hand.ended:
        _restore(interp, by_hand)
        on, off = by_hand.code, code_of_handler(MACHINE.remaps.values(), "polar_off")
        messages.message(
            f"{on} is off: nothing moves by program or MDI until G{off:g} or {on} is typed"
        )
    kinematics_switch.leave(interp)


def _lock(interp: Interp) -> None:
    """Make LinuxCNC refuse on the face the codes that it refuses under compensation.

    These are G41 and G42, planes, offsets, tools and M52. With a radius of 0, and before any move
    with it, compensation has no other effect (`Interp::find_ends`, `Interp::convert_straight`).
    """
    interp.cutter_comp_side, interp.cutter_comp_radius = ONLY_MOVES, 0.0
    interp.cutter_comp_firstmove = True


def _unlock(interp: Interp) -> ByHand | None:
    """Undo `_lock`, and a compensation that began after a G40; return the locked state."""
    state = state_of(interp)
    by_hand, state.by_hand = state.by_hand, None
    if by_hand and not by_hand.ended:
        interp.cutter_comp_side, interp.cutter_comp_radius = COMPENSATION_OFF, by_hand.radius
        interp.cutter_comp_firstmove = True
    return by_hand


def _restore(interp: Interp, by_hand: ByHand | None) -> None:
    """Restore the modes before the face that no line of MDI on it can change."""
    if by_hand and not by_hand.ended:
        borrowed.restore_before_face(interp, by_hand.saved)


def _switch(
    interp: Interp, code: str, frame: CallFrame, line: int, blocks: Iterator[str]
) -> Iterator[int]:
    frame.enter()
    for block in blocks:
        yield from frame.execute_and_wait(block)
    frame.leave(line)
    if not kinematics_switch.has_switched(interp):
        raise BlockRefusal(code, kinematics_switch.not_switched())
