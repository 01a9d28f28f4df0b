# SPDX-License-Identifier: GPL-2.0-or-later
"""Shared by the handlers of all kinds of sections: the machine, and the run of a section."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import Generic, NamedTuple

import emccanon

from g12.compensation.contour import Contour
from g12.errors import BlockRefusal, Refusal
from g12.host import borrowed, messages, modes
from g12.host.call_frame import CallFrame
from g12.host.interp import Interp, state_of
from g12.host.kinematics_switch import face_in_force
from g12.host.machine import MACHINE
from g12.host.program_lines import LineOfFile, ProgramLines, running_file
from g12.host.section.output import SectionOutput
from g12.host.section.reader import SectionReader
from g12.host.section.reported_contour import begin_section
from g12.host.section.run import Section
from g12.host.section.start import start_of_section
from g12.lengths import DEGREES_PER_TURN
from g12.moves.setup import Planning, SectionSetup
from g12.moves.steps import SectionPlan
from g12.section.codes import SectionCodes
from g12.section.line import line_named, with_line
from g12.section.start import SectionStart

TYPED = 1  # call level of a block outside any sub
REPORTED_TURN = 540.0  # degrees: a closed contour and its leads take more than one turn
NOT_IN_MDI = (
    "is not possible in MDI: it needs the lines after it. Write them into a program,"
    " or into a sub that MDI calls"
)
FACE_ON = "the face is on already, by hand: G13.1 first"


class SectionKind(NamedTuple, Generic[Planning]):
    """The properties in which one kind of section differs from another.

    ``letters`` are those that the block that switches on may have. ``setup`` returns a section's
    settings, or refuses to begin it, ``codes`` its codes for the one that began it. ``plan`` turns
    the contour into moves. ``surface`` is the radius of its cylinder, 0 on the face. ``in_shape``:
    a shape's sub has it.
    """

    letters: str
    setup: Callable[[SectionStart], SectionSetup[Planning]]
    codes: Callable[[str], SectionCodes]
    plan: Callable[[Contour, SectionSetup[Planning], SectionStart], SectionPlan]
    surface: Callable[[Planning], float] = lambda _: 0.0
    in_shape: bool = False


def check_ini() -> None:
    """Read the INI values that sections use; raise Refusal for one that cannot be used."""
    MACHINE.read("settings", "remaps", "coordinates", "axes", "face")


def is_typed(interp: Interp) -> bool:
    """Return whether the block being remapped was typed in MDI; a sub that MDI calls was not."""
    return messages.in_mdi(interp) and interp.call_level == TYPED


def refuse_typed(interp: Interp) -> None:
    """Refuse a section typed in MDI, where no following lines can be read."""
    if is_typed(interp):
        raise BlockRefusal(messages.code_of_block(interp), NOT_IN_MDI)


def following_lines(interp: Interp) -> ProgramLines:
    """Return the lines after the block; refuse a program whose file is missing."""
    try:
        program = ProgramLines(interp, state_of(interp).source)
    except OSError as problem:
        rule = f"the program's file cannot be read while it runs: {problem.strerror}"
        raise BlockRefusal(messages.code_of_block(interp), rule) from None
    state_of(interp).source = program.home
    return program


def run_section(interp: Interp, kind: SectionKind[Planning]) -> Iterator[int]:
    """Run the section that begins with the block being remapped."""
    if not kind.in_shape:
        messages.settle(interp)
    program, running = following_lines(interp), running_file(interp)
    frame, c = CallFrame(interp, program.home.filename), interp.CC_current
    try:
        yield from _section(interp, kind, frame, program).run()
        if MACHINE.settings.c_clamp_shapes:
            modes.run_code(interp, f"M{MACHINE.settings.c_clamp[1]}")
        if not kind.letters:  # on a cylinder the program itself commands the turns
            report_turns(interp, interp.CC_current - c)
    except Exception as error:
        if isinstance(error, BlockRefusal):
            error = error.at(program.shown_line)
        line = line_named(error)
        called = program.source is not program.home and not line
        frame.unwind(line or program.line, called=called, continue_at=program.next_at_home)
        if isinstance(error, Refusal) and line and program.home.filename != running:
            file = os.path.basename(program.home.filename)
            raise with_line(error, LineOfFile(line, file)) from None
        raise error


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
    """Refuse codes of C's clamp that LinuxCNC would not know when it comes to them."""
    unknown = MACHINE.settings.unknown_clamp_code(MACHINE.m_codes)
    if unknown:
        raise refuse(unknown)


def _section(
    interp: Interp, kind: SectionKind[Planning], frame: CallFrame, program: ProgramLines
) -> Section:
    """Return the section; refuse to begin it where it cannot."""
    start = start_of_section(interp, program.shown_line, kind.letters)
    if face_in_force(interp):
        raise start.location.refuse(FACE_ON)
    setup = kind.setup(start)
    check_clamp(start.location.refuse)
    borrowed.begin(interp)
    output = SectionOutput(interp, start, setup, canon=emccanon)
    return Section(
        kind.codes(start.location.code),
        setup,
        lambda contour: kind.plan(contour, setup, start),
        frame,
        SectionReader(interp, start, setup.words, program),
        output,
        first="".join(f"M{code}" for code in MACHINE.settings.c_clamp_shapes),
        report=lambda contour: begin_section(
            interp, start, contour, kind.surface(setup.plan), setup.words.diameter
        ),
    )
