# SPDX-License-Identifier: GPL-2.0-or-later
"""The handler of [RS274NGC] ON_ABORT_COMMAND = O <g12_on_abort> call.

LinuxCNC executes that line after each abort, error, emergency stop and switching off, with the
reason as its entry. ngc/g12_on_abort.ngc calls this handler by a ;py comment.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from g12.host import borrowed, kinematics_switch, messages
from g12.host.call_frame import run_code
from g12.host.interp import Interp
from g12.host.machine import MACHINE
from g12.host.program_lines import error_text

REASON = 1  # the sub's entry
SUB = "g12_on_abort"


def g12_on_abort(interp: Interp) -> None:
    """Restore what is borrowed, open the clamps, run the user's own command, and end the sub.

    None of them depends on the success of another one. The face ends with a flag that LinuxCNC has
    to meet at the operator's next line. So the sub's last line is executed here, before it.
    """
    command, reason = MACHINE.settings.on_abort_command, round(interp.params[REASON])
    restore(interp)
    if command:
        _attempt(interp, run_code, f"{command} [{reason}]")
    if interp.call_level:
        _attempt(interp, run_code, f"o<{SUB}> endsub")
    leave_face(interp)


def by_earlier_command(interp: Interp) -> None:
    """Do the same for ON_ABORT_COMMAND = G13.1 P, which earlier versions of the package wrote.

    If install has made it the user's own command since, all of it is done here already.
    """
    if interp.sub_context[interp.call_level - 1].subname != SUB:
        restore(interp)
        leave_face(interp)


def restore(interp: Interp) -> None:
    _attempt(interp, borrowed.after_abort, time.monotonic())
    for code in MACHINE.settings.opening_codes:
        _attempt(interp, run_code, f"M{code}")


def leave_face(interp: Interp) -> None:
    interp.read("")  # or LinuxCNC would go on with the last block executed here
    if MACHINE.face:
        kinematics_switch.leave(interp)


def _attempt(interp: Interp, step: Callable[..., None], argument: object) -> None:
    """Do a step; report its error to the operator, as a message: an error would abort again."""
    try:
        step(interp, argument)
    except SystemError:  # how LinuxCNC hands a failed read or execute to Python
        messages.message(f"ON_ABORT_COMMAND: {error_text(interp)}")
    except Exception as error:
        messages.message(messages.shown_text(error))
