# SPDX-License-Identifier: GPL-2.0-or-later
"""The handlers for a spindle that becomes C (configs/include/spindle_c.hal).

The state is in HAL: an input of motion shows whether the spindle is C. Both changes end with a
wait, so the interpreter is never ahead of that state.
"""

from __future__ import annotations

from interpreter import INTERP_OK

from g12.errors import Refusal, number
from g12.host import messages
from g12.host.interp import Interp
from g12.host.machine import MACHINE

INPUT = 2  # of motion, as in spindle_c.hal and spindle_c_on.ngc
SECTION_HANDLERS = ("polar_on", "cylinder_mode")


def check_at_start() -> None:
    MACHINE.read("spindle_c_timeout")


@messages.handler
def spindle_c_on(self, **words):
    """Let `ngc/spindle_c_on.ngc` run: prolog of M254."""
    self.params["timeout"] = MACHINE.spindle_c_timeout
    return INTERP_OK


@messages.handler
def spindle_c_is_on(self, **words):
    """Refuse to continue if the spindle did not become C: epilog of M254."""
    if self.task and not is_c():
        seconds = number(MACHINE.spindle_c_timeout)
        rule = (
            f"the spindle did not become C within {seconds} s: it has to stop, to find "
            "its index and to reach the angle of C (spindle_c.md)"
        )
        raise Refusal(rule, messages.code_of_block(self))
    return INTERP_OK


@messages.handler
def spindle_c_off(self, **words):
    """Refuse to end C inside a section: prolog of M255."""
    if in_section(self):
        raise Refusal("the section needs C to its end", messages.code_of_block(self))
    return INTERP_OK


def in_section(interp: Interp) -> bool:
    remaps = (interp.blocks[level].executing_remap for level in range(1, interp.remap_level))
    return any(remap and remap.remap_py in SECTION_HANDLERS for remap in remaps)


def is_c() -> bool:
    return MACHINE.digital_input(INPUT)


def missing_code(interp: Interp) -> str:
    """Return the code that is needed first to make the spindle C, "" where none is."""
    code = MACHINE.spindle_c_code
    return code if code and interp.task and not is_c() else ""
