# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers of G12.1, G13.1 and G7.1, whatever codes the REMAP lines give them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

from g12.cylinder.cylinder_section import CYLINDERS
from g12.errors import Refusal
from g12.host import borrowed, kinematics_switch, messages
from g12.host.call_frame import CallFrame
from g12.host.handlers import aborts
from g12.host.interp import MOVE_WORDS, Interp, words_in
from g12.host.machine import MACHINE
from g12.host.program_lines import ProgramLines
from g12.host.section_handler import (
    check_ini,
    is_typed,
    refuse_typed,
    run_section,
    section_machine,
)
from g12.machine_ini import owns_g12_1, refuse_owned_codes
from g12.polar.polar_section import Polar
from g12.section.start import SectionCodes, codes_of_section, codes_with_word
from g12.shapes import SHAPE_SUBS

MDI_LINE = 0  # the number of a line in MDI


def check_at_start() -> None:
    check_ini()
    try:
        refuse_owned_codes(MACHINE.remaps, owns_g12_1(Path("/proc/self/maps").read_text()))
    except Refusal as refusal:
        messages.report_at_start(refusal.message)


@messages.waiting_handler
def polar_on(self, **words) -> Iterator[int]:
    """Read, plan and execute a section: the handler of G12.1, which yields to wait."""
    refuse_typed(self)
    in_shape = self.sub_context[self.call_level - 1].subname in SHAPE_SUBS
    if not in_shape:
        messages.settle(self)
    yield from run_section(
        self, Polar, _polar_codes, lambda start: Polar(start, section_machine(), in_shape=in_shape)
    )


@messages.waiting_handler
def polar_off(self, **words) -> Iterator[int]:
    """Leave the face that an interrupted section has left on: the handler of G13.1 outside one.

    Otherwise it is a safety line. Typed in MDI it restores what an interrupted section left where
    no ON_ABORT_COMMAND did. With a P word it is itself one, of an earlier version of the package:
    the word is the reason of the abort.
    """
    block = self.blocks[self.remap_level]
    if words_in(block, MOVE_WORDS):
        raise Refusal("must be alone in its block", messages.code_of_block(self))
    if block.p_flag:
        aborts.restore_all(self, round(block.p_number))
        aborts.after_abort_on_face(self)
        return
    if is_typed(self):
        borrowed.restore_left(self)
    messages.settle(self)
    if kinematics_switch.may_be_on_face(self):
        yield from _leave_face(self)


def _leave_face(interp: Interp) -> Iterator[int]:
    code, mdi = messages.code_of_block(interp), messages.in_mdi(interp)
    program = None if mdi else ProgramLines(interp)
    frame = CallFrame(interp, program.home.filename if program else messages.NO_FILE)
    line = program.line if program else MDI_LINE
    frame.enter()
    for block in kinematics_switch.to_axes(interp, ()):
        yield from frame.execute_and_wait(block)
    frame.leave(line)
    if not kinematics_switch.has_switched(interp):
        raise Refusal(kinematics_switch.not_switched(), code)


def _polar_codes(code: str) -> SectionCodes:
    return codes_of_section(code, MACHINE.remaps.values(), polar_on.__name__, polar_off.__name__)


@messages.waiting_handler
def cylinder_mode(self, **words) -> Iterator[int]:
    """Read, plan and execute a section; outside one C0 is a safety line and does nothing."""
    block, code = self.blocks[self.remap_level], messages.code_of_block(self)
    given = words_in(block, CYLINDERS)
    letter = next(iter(given), _rotary_axis())
    if given.get(letter) != 0.0:
        refuse_typed(self)
        messages.settle(self)
        kind, codes = CYLINDERS[letter], partial(_cylinder_codes, letter)
        yield from run_section(self, kind, codes, lambda start: kind(start, section_machine()))
    elif words_in(block, MOVE_WORDS.replace(letter, "")):
        raise Refusal(f"{letter}0 must be alone in its block", code)


def _rotary_axis() -> str:
    """Return the letter of the axis that a cylinder of this machine turns with."""
    return next((letter for letter in CYLINDERS if letter in MACHINE.coordinates), "C")


def _cylinder_codes(letter: str, code: str) -> SectionCodes:
    return codes_with_word(code, MACHINE.remaps.values(), cylinder_mode.__name__, letter)
