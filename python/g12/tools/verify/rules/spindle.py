# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindle where the program cuts, codes of the machine that no preview executes."""

import os
import re

from g12.machine_ini import remap_lines
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.model.spindles import MAIN, switching_codes
from g12.tools.verify.rules.table import Site, Values, rule

RUNS = ("M3", "M4")
MAIN_SPINDLE, LIVE_TOOL = "the spindle", "the live tool"
C_WORD = re.compile(r"(?<![A-Z<])C[-+]?[\d.\[#]")
NO_MOVE = re.compile(r"G0*(10|92|52|7\.1)(?![.\d])")
USER_CODE = re.compile(r"(M1\d\d) P")


@rule(
    "spindle",
    FINDING,
    "{which} does not turn: S and {code} are missing after the last M5 or M6",
    plain=True,
)
def spindle_off(site: Site) -> Values:
    """Look at the whole cut: an M5 in a section is found at the move after it."""
    for index in site.moves:
        which = _standing(index, site)
        if which:
            own = {"which": which, "code": "M3 $1" if which == LIVE_TOOL else "M3"}
            return own if index == site.at else {**own, "at_line": site.program.where(index)[0]}
    return None


def _standing(index: int, site: Site) -> str:
    """Return which spindle should turn at a move and does not, "" if none is known."""
    program, state = site.program, site.program.state(index)
    if not program.several_spindles:
        turns = state.user_code or (state.spindle in RUNS and state.speed)
        return "" if turns else MAIN_SPINDLE
    if not program.spindles:
        return ""
    is_c, turning = program.spindles[program.moves[index].block]
    if turning is None or (turning if is_c or site.cut else MAIN in turning):
        return ""
    return LIVE_TOOL if is_c or site.cut else MAIN_SPINDLE


@rule(
    "spindle-m4",
    WARNING,
    "the spindle turns counterclockwise: right-hand tools cut with M3",
    plain=True,
)
def spindle_reversed(site: Site) -> Values:
    if site.program.several_spindles or (site.cut and site.cut.is_tap):
        return None
    for index in site.moves:
        if site.program.state(index).spindle == "M4":
            return {} if index == site.at else {"at_line": site.program.where(index)[0]}
    return None


@rule(
    "spindle-unseen", NOT_JUDGED, "whether the tool turns: no preview shows its spindle", once=True
)
def spindle_unseen(site: Site) -> Values:
    if not site.program.several_spindles:
        return None
    states, line = site.program.spindles, site.program.moves[site.at].block
    return None if states and states[line].turning is not None else {}


@rule(
    "main-spindle",
    FINDING,
    "M3 or M4 of the spindle that is C: it does not turn. {off} is missing before it, or $1",
    program=True,
)
def main_spindle_turns(program: TracedProgram) -> Values:
    for line, state in enumerate(program.spindles or ()):
        if state.is_c and state.turns(MAIN):
            off = min(switching_codes(program.ini)[1], default="the code that ends C")
            return {"off": off, "at_line": line}
    return None


@rule(
    "m-code",
    FINDING,
    "{code} is no program in [RS274NGC] USER_M_PATH or [DISPLAY] PROGRAM_PREFIX: the machine stops",
    program=True,
)
def unknown_code(program: TracedProgram) -> Values:
    remapped = {remap.code for remap in remap_lines(program.ini.all)}
    for event in program.trace.events:
        code = USER_CODE.match(event.text)
        if (
            code
            and code[1] not in remapped
            and not any(os.access(place / code[1], os.X_OK) for place in _folders(program))
        ):
            return {"code": code[1], "at_line": event.line}
    return None


def _folders(program: TracedProgram):
    ini = program.ini
    named = [
        ini.get("DISPLAY", "PROGRAM_PREFIX"),
        *(ini.get("RS274NGC", "USER_M_PATH") or "").split(":"),
    ]
    return [ini.directory / os.path.expanduser(name) for name in named if name]


@rule(
    "clamp-closed",
    FINDING,
    "C turns with its clamp closed: {opens} does not come before it",
    program=True,
)
def clamp_closed(program: TracedProgram) -> Values:
    """Look for the first turn of C between a code that closes its clamp and the next code.

    Holes have their own codes. In sections and shapes a light drag may take the clamp's place.
    """
    settings = program.ini.settings
    codes = [each for each in program.trace.events if each.text.startswith("clamp ")]
    if not codes or not settings.c_clamp:
        return None
    closes, opens = (f"M{code}" for code in settings.c_clamp)
    for event, end in zip(codes, [*(each.at for each in codes[1:]), len(program.moves)]):
        for index in range(event.at, end) if event.text == f"clamp {closes}" else ():
            move, cut = program.moves[index], program.cut_at(index)
            apart = cut and (cut.places or settings.c_clamp_shapes)
            if not apart and move.start[5] != move.end[5]:
                return {"opens": opens, "at_line": program.where(index)[0]}
    return None


@rule(
    "clamp-unseen",
    NOT_JUDGED,
    "the clamp of C: no trace shows its codes; both have to be remapped to a sub (ngc=)",
    once=True,
)
def clamp_unseen(site: Site) -> Values:
    events = site.program.trace.events
    unseen = site.program.ini.settings.c_clamp and not any("clamp " in e.text for e in events)
    return {} if unseen and site.own.places else None


@rule(
    "c-axis",
    FINDING,
    "the spindle is no C axis here: {code} does not come before it",
    program=True,
)
def spindle_is_c(program: TracedProgram) -> Values:
    """Look in the program's lines: a preview does not show the codes that switch the spindle."""
    needs_c = {cut.line for cut in program.cuts if not cut.file}
    for line, (state, text) in enumerate(zip(program.spindles or (), ["", *program.texts])):
        turns_c = C_WORD.search(text) and not NO_MOVE.search(text)
        if not state.is_c and (turns_c or line in needs_c):
            return {"code": min(switching_codes(program.ini)[0]), "at_line": line}
    return None
