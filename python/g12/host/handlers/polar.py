# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers of G12.1 and G13.1, whatever codes the REMAP lines give them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from g12.errors import BlockRefusal, Refusal
from g12.host import borrowed, messages
from g12.host.handlers import aborts, face_by_hand
from g12.host.interp import MOVE_WORDS, Interp, words_in
from g12.host.kinematics_switch import face_in_force
from g12.host.machine import MACHINE
from g12.host.section.kind import (
    NOT_IN_MDI,
    SectionKind,
    check_ini,
    is_typed,
    run_section,
)
from g12.host.section.start import start_of_section
from g12.machine_ini import owns_g12_1, refuse_owned_codes
from g12.moves.setup import SectionSetup
from g12.polar import plan as polar
from g12.polar.plan import PolarSettings
from g12.polar.start import check_section_start, polar_setup
from g12.section.codes import SectionCodes, codes_of_section
from g12.section.start import SectionStart
from g12.shapes import SHAPE_SUBS


def check_at_start() -> None:
    check_ini()
    try:
        refuse_owned_codes(MACHINE.remaps, owns_g12_1(Path("/proc/self/maps").read_text()))
    except Refusal as refusal:
        messages.report_at_start(refusal.message)


@messages.waiting_handler
def polar_on(self, **words) -> Iterator[int]:
    """Read, plan and execute a section: the handler of G12.1, which yields to wait."""
    if is_typed(self):
        yield from run_by_hand(self)
    else:
        in_shape = self.sub_context[self.call_level - 1].subname in SHAPE_SUBS
        yield from run_section(self, SHAPE_SECTION if in_shape else POLAR_SECTION)


@messages.waiting_handler
def polar_off(self, **words) -> Iterator[int]:
    """End the face of a G12.1 in MDI: the handler of G13.1 outside a section.

    Otherwise it is a safety line. Typed in MDI it restores what an interrupted section left where
    no ON_ABORT_COMMAND did. With a P word it is itself one, of an earlier version of the package:
    the word is the reason of the abort.
    """
    block = self.blocks[self.remap_level]
    if words_in(block, MOVE_WORDS):
        raise BlockRefusal(messages.code_of_block(self), "must be alone in its block")
    if block.p_flag:
        aborts.restore_all(self, round(block.p_number))
        aborts.after_abort_on_face(self)
        return
    if is_typed(self):
        borrowed.restore_left(self)
    messages.settle(self)
    if MACHINE.switches_kinematics and self.task:
        yield from face_by_hand.switch_off(self)


def run_by_hand(interp: Interp) -> Iterator[int]:
    """Switch on in MDI, where no following lines can be read: they could be an old program's."""
    start = start_of_section(interp, 0)
    if not MACHINE.switches_kinematics:
        raise BlockRefusal(start.location.code, NOT_IN_MDI)
    if face_in_force(interp):
        raise BlockRefusal(start.location.code, "is already on")
    yield from face_by_hand.switch_on(interp, start, polar_section_setup(start).words.beside)


def polar_section_setup(start: SectionStart) -> SectionSetup[PolarSettings]:
    """Return the setup of a section on the face; refuse to begin it where none can."""
    check_section_start(start, MACHINE.coordinates)
    return polar_setup(start, MACHINE.settings, MACHINE.axes, MACHINE.face)


def _codes(code: str) -> SectionCodes:
    return codes_of_section(code, MACHINE.remaps.values(), polar_on.__name__, polar_off.__name__)


POLAR_SECTION = SectionKind(
    letters="",
    setup=polar_section_setup,
    codes=_codes,
    plan=lambda contour, setup, start: polar.plan(contour, setup.plan, c=start.c),
)


def _setup_of_shape(start: SectionStart) -> SectionSetup[PolarSettings]:
    """Return the setup of a shape's section, whose tool goes down along a ramp."""
    setup = polar_section_setup(start)
    return setup._replace(words=setup.words._replace(third_with_others=True))


SHAPE_SECTION = POLAR_SECTION._replace(setup=_setup_of_shape, in_shape=True)
