# SPDX-License-Identifier: GPL-2.0-or-later
"""The handler of G7.1, on and off, whatever code the REMAP line gives it."""

from __future__ import annotations

from collections.abc import Iterator

from interpreter import INTERP_OK

from g12.cylinder.plan import plan
from g12.cylinder.start import RADIUS, check_cylinder_start, cylinder_setup
from g12.errors import BlockRefusal
from g12.host import messages
from g12.host.machine import MACHINE
from g12.host.section.kind import (
    NOT_IN_MDI,
    SectionKind,
    check_ini,
    has_move_words,
    is_typed,
    run_section,
)
from g12.section.codes import SectionCodes, codes_with_word


def check_at_start() -> None:
    check_ini()


def cylinder_mode(self, **words) -> Iterator[int]:
    """Read, plan and execute a section; outside one C0 is a safety line and does nothing."""
    try:
        messages.forget_return(self)
        block = self.blocks[self.remap_level]
        if block.c_flag and block.c_number == 0.0:
            if has_move_words(block, but=RADIUS):
                raise BlockRefusal(
                    messages.code_of_block(self), f"{RADIUS}0 must be alone in its block"
                )
        else:
            if is_typed(self):
                raise BlockRefusal(messages.code_of_block(self), NOT_IN_MDI)
            yield from run_section(self, CYLINDER_SECTION)
    except Exception as error:
        yield messages.refuse_block(self, error)
    yield INTERP_OK


def _codes(code: str) -> SectionCodes:
    return codes_with_word(code, MACHINE.remaps.values(), cylinder_mode.__name__, RADIUS)


CYLINDER_SECTION = SectionKind(
    letters=RADIUS,
    check=lambda start: check_cylinder_start(start, MACHINE.coordinates),
    setup=lambda start: cylinder_setup(start, MACHINE.settings, MACHINE.axes),
    codes=_codes,
    plan=lambda contour, setup, start: plan(contour, setup.plan),
)
