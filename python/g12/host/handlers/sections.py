# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers of G12.1, G13.1 and G7.1, and how a section begins: its state, report and run."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import emccanon

from g12.compensation.contour import Contour, PathElement, PlaneMove, Plunge
from g12.cut_report import CutElement, SectionCut, more_text, report_text
from g12.cylinder import CYLINDERS
from g12.errors import Refusal
from g12.geometry.curve import Arc
from g12.host import borrowed, kinematics_switch, messages
from g12.host.call_frame import CallFrame, run_code
from g12.host.handlers import aborts
from g12.host.interp import MOVE_WORDS, Interp, ParsedBlock, words_in
from g12.host.interp_state import read_state
from g12.host.kinematics_switch import face_in_force
from g12.host.machine import MACHINE
from g12.host.messages import SECTION_BEGAN, asked, report_of
from g12.host.program_lines import ProgramLines, running_file
from g12.host.section_output import SectionOutput
from g12.host.section_reader import SectionReader, block_of
from g12.host.section_run import Section
from g12.host.spindle_c import missing_code
from g12.lengths import DEGREES_PER_TURN
from g12.machine_ini import owns_g12_1, refuse_owned_codes
from g12.moves.setup import SectionKind, SectionMachine
from g12.polar.polar_section import Polar
from g12.section.block_rules import alone
from g12.section.effects import SectionCodes, SectionStart, codes_of_section
from g12.section.line import BlockLocation
from g12.shapes import SHAPE_SUBS

OTHER_WORDS = "DHKTUVW"


def start_of_section(interp: Interp, line: int, words: str = "") -> SectionStart:
    """Return the state at the start of a section, whose code is the remapped block on ``line``.

    ``words`` are the letters that the block may have.
    """
    block = interp.blocks[interp.remap_level]
    return SectionStart(
        location=BlockLocation(messages.code_of_block(interp), line),
        words=block_of(block).words,
        alone=is_alone(block, words),
        level=interp.call_level,
        state=read_state(interp),
        missing_code=missing_code(interp),
    )


def is_alone(block: ParsedBlock, words: str = "") -> bool:
    return alone(block_of(block), words) and not words_in(block, OTHER_WORDS)


def begin_report(interp: Interp, kind: SectionKind, contour: Contour) -> None:
    """Report a section, or the part of it that follows M66."""
    start = kind.start
    memory = asked(interp)
    if memory is None:
        return
    elements = tuple(element for each in contour.elements if (element := _element(each)))
    if memory.get(SECTION_BEGAN):
        emccanon.COMMENT(more_text(elements))
        return
    memory[SECTION_BEGAN] = True
    turn = kind.words.axes.turn
    sense = math.copysign(1.0, kind.rules.turn_scale)
    cut = SectionCut(kind.surface, kind.rules.diameter, elements, turn, sense)
    report = report_of(interp, start.location.code, start.location.line, start.words, cut)
    turn_zero = start.state.offsets[turn] - getattr(interp.tool_offset, turn.lower())
    home = interp.filename
    report = report._replace(  # since the lines of the section were read other modes are in force
        file="" if home == running_file(interp) else os.path.basename(home),
        frame=report.frame._replace(zero=(*report.frame.zero[:3], turn_zero)),
        at=(*start.state.xyz, start.state.position(turn)),
        feed=start.state.feed,
        per_revolution=start.state.per_revolution,
        incremental=start.state.incremental,
    )
    emccanon.COMMENT(report_text(report))


def _element(element: PathElement) -> CutElement | None:
    if isinstance(element, PlaneMove):
        line, feed, offset, curve, h0, h1, side = element
        more = (curve.centre, curve.sweep) if isinstance(curve, Arc) else (None, 0.0)
        return CutElement(line, side, abs(offset), feed, h0, h1, curve.start, curve.end, *more)
    if isinstance(element, Plunge):
        return CutElement(element.line, 0, 0.0, element.feed, element.h0, element.h1)
    return None


TYPED = 1  # call level of a block outside any sub
REPORTED_TURN = 540.0  # degrees: a closed contour and its leads take more than one turn
NOT_IN_MDI = (
    "is not possible in MDI: it needs the lines after it. Write them into a program,"
    " or into a sub that MDI calls"
)
FACE_ON = "the face is on already, by hand: G13.1 first"


def check_ini() -> None:
    """Read the INI values that sections use; raise Refusal for one that cannot be used."""
    MACHINE.read("settings", "remaps")
    section_machine()


def section_machine() -> SectionMachine:
    return SectionMachine(
        frozenset(MACHINE.coordinates), MACHINE.settings, MACHINE.axes, MACHINE.face
    )


def is_typed(interp: Interp) -> bool:
    """Return whether the block being remapped was typed in MDI; a sub that MDI calls was not."""
    return messages.in_mdi(interp) and interp.call_level == TYPED


def refuse_typed(interp: Interp) -> None:
    """Refuse a section typed in MDI, where no following lines can be read."""
    if is_typed(interp):
        raise Refusal(NOT_IN_MDI, messages.code_of_block(interp))


def following_lines(interp: Interp) -> ProgramLines:
    """Return the lines after the block; refuse a program whose file is missing."""
    try:
        return ProgramLines(interp)
    except OSError as problem:
        rule = f"the program's file cannot be read while it runs: {problem.strerror}"
        raise Refusal(rule, messages.code_of_block(interp)) from None


def run_section(
    interp: Interp, kind: type[SectionKind], codes: SectionCodes, **options: bool
) -> Iterator[int]:
    """Run the section of a kind, with its options, that begins with the block being remapped."""
    program, running = following_lines(interp), running_file(interp)
    frame, c = CallFrame(interp, program.home.filename), interp.CC_current
    try:
        start = start_of_section(interp, program.shown_line, kind.on_words)
        if face_in_force(interp):
            raise start.location.refuse(FACE_ON)
        section, drag = kind(start, section_machine(), **options), drag_codes(kind)
        check_clamp(start.location.refuse)
        borrowed.begin(interp)
        yield from Section(
            section,
            codes,
            frame,
            SectionReader(interp, section, program),
            SectionOutput(interp, section, canon=emccanon),
            first="".join(drag[:1]),
            report=partial(begin_report, interp, section),
        ).run()
        for code in drag[1:]:
            run_code(interp, code)
        if kind.unwinds:
            report_turns(interp, interp.CC_current - c)
    except Exception as error:
        line = None
        if isinstance(error, Refusal):
            if error.lacks_line:
                error.at(program.shown_line)
            line = None if error.file else error.line
            if line and program.home.filename != running:
                error.file = os.path.basename(program.home.filename)
        called = program.source is not program.home and not line
        frame.unwind(line or program.line, called=called, continue_at=program.next_at_home)
        raise


def report_turns(interp: Interp, turned: float) -> None:
    """Show the operator, once a program, how far C has to unwind; ``turned`` is in degrees."""
    if abs(turned) > REPORTED_TURN and not interp.c_axis_wrapped:
        code, turns = messages.code_of_block(interp), abs(turned) / DEGREES_PER_TURN
        text = (
            f"{code}: C has turned {turns:.1f} times, and G0 C0"
            " unwinds all of it. With [AXIS_C] WRAPPED_ROTARY = 1 it takes the short way"
        )
        messages.message_once(interp, "turns", text)


def check_clamp(refuse: Callable[[str], Refusal]) -> None:
    """Refuse codes of a clamp that LinuxCNC would not know when it comes to them."""
    unknown = MACHINE.settings.unknown_clamp_code(MACHINE.m_codes)
    if unknown:
        raise refuse(unknown)


def drag_codes(kind: type[SectionKind]) -> list[str]:
    """Return the codes that begin and end the drag of the section's rotary axis, if any."""
    return [f"M{code}" for code in MACHINE.settings.drag(kind.words.axes.turn)]


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
    handlers, code = (polar_on.__name__, polar_off.__name__), messages.code_of_block(self)
    codes = codes_of_section(code, MACHINE.remaps.values(), *handlers)
    yield from run_section(self, Polar, codes, in_shape=in_shape)


@messages.waiting_handler
def polar_off(self, **words) -> Iterator[int]:
    """Leave the face that an interrupted section has left on: the handler of G13.1 outside one.

    Otherwise it is a safety line. Typed in MDI it restores what an interrupted section left where
    no ON_ABORT_COMMAND did. With P it is itself the command of an earlier version of the package.
    """
    block = self.blocks[self.remap_level]
    if words_in(block, MOVE_WORDS):
        raise Refusal("must be alone in its block", messages.code_of_block(self))
    if block.p_flag:
        aborts.by_earlier_command(self)
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


@messages.waiting_handler
def cylinder_mode(self, **words) -> Iterator[int]:
    """Read, plan and execute a section; outside one C0 is a safety line and does nothing."""
    block, code = self.blocks[self.remap_level], messages.code_of_block(self)
    given = words_in(block, CYLINDERS)
    letter = next(iter(given), _rotary_axis())
    if given.get(letter) != 0.0:
        refuse_typed(self)
        messages.settle(self)
        remaps, handler = MACHINE.remaps.values(), cylinder_mode.__name__
        codes = codes_of_section(code, remaps, handler, handler, letter)
        yield from run_section(self, CYLINDERS[letter], codes)
    elif words_in(block, MOVE_WORDS.replace(letter, "")):
        raise Refusal(f"{letter}0 must be alone in its block", code)


def _rotary_axis() -> str:
    """Return the letter of the axis that a cylinder of this machine turns with."""
    return next((letter for letter in CYLINDERS if letter in MACHINE.coordinates), "C")
