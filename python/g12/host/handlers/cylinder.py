# SPDX-License-Identifier: GPL-2.0-or-later
"""The handler of G7.1, on and off, whatever code the REMAP line gives it."""

from __future__ import annotations

from collections.abc import Iterator

from g12.cylinder.cylinder_section import RADIUS, Cylinder
from g12.errors import Refusal
from g12.host import messages
from g12.host.interp import MOVE_WORDS, words_in
from g12.host.machine import MACHINE
from g12.host.section_handler import check_ini, refuse_typed, run_section, section_machine
from g12.section.start import SectionCodes, codes_with_word

check_at_start = check_ini


@messages.waiting_handler
def cylinder_mode(self, **words) -> Iterator[int]:
    """Read, plan and execute a section; outside one C0 is a safety line and does nothing."""
    block, code = self.blocks[self.remap_level], messages.code_of_block(self)
    if not (block.c_flag and block.c_number == 0.0):
        refuse_typed(self)
        messages.settle(self)
        yield from run_section(
            self, Cylinder, _codes, lambda start: Cylinder(start, section_machine())
        )
    elif words_in(block, MOVE_WORDS.replace(RADIUS, "")):
        raise Refusal(f"{RADIUS}0 must be alone in its block", code)


def _codes(code: str) -> SectionCodes:
    return codes_with_word(code, MACHINE.remaps.values(), cylinder_mode.__name__, RADIUS)
