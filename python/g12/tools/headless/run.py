# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs run to their end, each on a headless LinuxCNC of its own."""

import re
from pathlib import Path

from g12.tools.errors import ProgramError
from g12.tools.headless.errors import MachineError
from g12.tools.headless.machine import Machine, Run
from g12.tools.preview.ended import explained_text
from g12.tools.preview.tracer import Parameters, Tools

MOST_SECONDS = 24 * 3600.0


def run_program(
    program: Path,
    ini: Path,
    tools: Tools = None,
    parameters: Parameters = None,
    override: float = 100.0,
) -> Run:
    """Return the run of a program that runs to its end, or raise ProgramError.

    ``override`` is the feed override in per cent.
    """
    result = run_anyhow(program, ini, tools, parameters, override)
    if result.error:
        raise ProgramError(f"{program}: {explained_text(result.error.text, ini)}")
    return result


def run_anyhow(
    program: Path,
    ini: Path,
    tools: Tools = None,
    parameters: Parameters = None,
    override: float = 100.0,
    timeout: float = MOST_SECONDS,
) -> Run:
    """Return the run of a program that may end with an error; ``timeout`` is in seconds.

    LinuxCNC runs a copy of the program; the program's own name replaces the copy's in its texts.
    """
    faster = {"DISPLAY": {"MAX_FEED_OVERRIDE": max(1.0, override / 100.0)}}
    with Machine(ini, tools=tools, parameters=parameters, overrides=faster) as machine:
        machine.feed_override(override / 100.0)
        try:
            return machine.run(program, timeout)
        except MachineError as problem:
            copy = rf"[^\s'\"]*/{re.escape(program.name)}"
            raise type(problem)(re.sub(copy, str(program), str(problem))) from None
