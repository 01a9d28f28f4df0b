# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers of G12.1 and G13.1, whatever codes the REMAP lines give them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import emccanon
import linuxcnc
from interpreter import INTERP_OK, MODE_ABSOLUTE

from g12.errors import BlockRefusal, Refusal
from g12.host import face_by_hand, glue
from g12.host.call_frame import CallFrame
from g12.host.kinematics_switch import face_in_force
from g12.host.polar_section import PolarSection
from g12.host.program_lines import ProgramLines
from g12.host.section_output import SectionOutput
from g12.host.section_reader import SectionReader
from g12.host.section_start import start_of_section
from g12.machine_ini import (
    axes_of,
    coordinates_of,
    face_of,
    owns_g12_1,
    refuse_owned_codes,
    remap_lines,
)
from g12.polar.start import check_section_start, polar_setup
from g12.section.codes import codes_of_section
from g12.section.line import line_named

DROPPED_WORDS = "abcdhijkruvwxyz"  # nothing else in a block with G13.1 could read them


SETTINGS = glue.settings_of_machine()
INI = linuxcnc.ini(glue.ini_file() or os.devnull)
REMAPS = {remap.code: remap for remap in remap_lines(INI.findall)}
COORDINATES, AXES = set(coordinates_of(INI.find)), axes_of(INI.find, "XZC")
FACE = face_of(INI.find)
KINEMATICS = SETTINGS.polar_kinematics == "1"


def check_at_start() -> None:
    """Say so, when LinuxCNC comes up, if it takes G12.1 for itself."""
    try:
        refuse_owned_codes(REMAPS, owns_g12_1(Path("/proc/self/maps").read_text()))
    except Refusal as refusal:
        glue.say_at_start(refusal.message)


check_at_start()


def polar_on(self, **words) -> Iterator[int]:
    """Read, plan and move a section: the handler of G12.1, which may have to wait."""
    try:
        glue.forget_return(self)
        if glue.in_mdi(self):
            yield from run_by_hand(self)
        else:
            program = program_behind(self)
            yield from run_section(self, CallFrame(self, program.home.filename), program)
    except Exception as error:
        yield glue.refuse_block(self, error)
    yield INTERP_OK


def polar_off(self, **words) -> Iterator[int]:
    """End what G12.1 in MDI began: the handler of G13.1 outside a section.

    Otherwise it is a safety line and does nothing. With a P word it is LinuxCNC's
    ON_ABORT_COMMAND, which gets the reason behind it.
    """
    try:
        glue.forget_return(self)
        block = self.blocks[self.remap_level]
        others = any(getattr(block, f"{letter}_flag") for letter in DROPPED_WORDS)
        if others or (block.p_flag and not FACE):
            raise BlockRefusal(glue.code_of_block(self), "stands alone in its block")
        if block.p_flag:
            face_by_hand.abort(self)
        elif KINEMATICS and self.task:
            yield from face_by_hand.switch_off(self)
    except Exception as error:
        yield glue.refuse_block(self, error)
    yield INTERP_OK


def run_by_hand(interp: object) -> Iterator[int]:
    """Switch on in MDI, where nothing behind can be read: it could be an old program's."""
    start = start_of_section(interp, 0)
    if not KINEMATICS:
        rule = "is not possible in MDI: it needs the lines behind it"
        raise BlockRefusal(start.place.code, rule)
    check_section_start(start, COORDINATES)
    polar_setup(start, SETTINGS, AXES, FACE)  # refuses what the machine cannot
    yield from face_by_hand.switch_on(interp, start)


def program_behind(interp: object) -> ProgramLines:
    """Return the program that goes on behind the block; refuse one whose file is gone."""
    try:
        program = ProgramLines(interp, getattr(interp, "g12_source", None))
    except OSError as problem:
        rule = f"the program's file cannot be read while it runs: {problem.strerror}"
        raise BlockRefusal(glue.code_of_block(interp), rule) from None
    interp.g12_source = program.home
    return program


def run_section(interp: object, frame: CallFrame, program: ProgramLines) -> Iterator[int]:
    """Run the section that begins with the block being remapped."""
    try:
        start = start_of_section(interp, program.place)
        check_section_start(start, COORDINATES)
        if KINEMATICS and interp.task and face_in_force():
            raise start.place.refuse("is on already, by hand: G13.1 first")
        setup = polar_setup(start, SETTINGS, AXES, FACE)
        codes = codes_of_section(
            start.place.code, REMAPS.values(), polar_on.__name__, polar_off.__name__
        )
        reader = SectionReader(interp, start, setup.words, program)
        output = SectionOutput(
            interp,
            start.place.code,
            x_factor=2.0 if start.diameter else 1.0,
            blending=setup.tolerance / 2,
            machine_unit=start.machine_unit,
            absolute=MODE_ABSOLUTE,
            canon=emccanon,
        )
        yield from PolarSection(codes, setup, frame, program, reader, output).run()
    except Exception as error:
        line = line_named(error)
        called = program.source is not program.home and not line
        frame.give_up(line or program.line, called=called, behind=program.next_at_home)
        raise
