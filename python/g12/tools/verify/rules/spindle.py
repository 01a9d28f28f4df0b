# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindle where the program cuts, codes of the machine that no preview executes."""

import os
import re
from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from g12.machine_ini import remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.path.part import C
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING
from g12.tools.verify.model.program import RUNS, SPINDLE, TracedProgram
from g12.tools.verify.rules.table import FIRST, Site, Values, rule

C_WORD = re.compile(r"(?<![A-Z<])C[-+]?[\d.\[#]")
NO_MOVE = re.compile(r"G0*(10|92|52|7\.1)(?![.\d])")
USER_CODE = r"(M1\d\d) P"
M_CODE, ANY_USER_CODE = re.compile(r"M(\d+)"), re.compile(r"M1\d\d")
NAMED, BLOCK_WORD, JUMPS = re.compile(r"\$(-?\d+)"), re.compile(r"\s*O"), {"M98", "M99"}
MAIN, LIVE, EVERY = 0, 1, -1


@rule("spindle", FINDING, "{which} does not turn: {missing} missing", plain=FIRST)
def spindle_off(site: Site) -> Values:
    return _first_move(lambda index: _standing(index, site), site)


def _first_move(wrong: Callable[[int], Values], site: Site) -> Values:
    """Return the values of the first wrong move: an M5 in a section is found at the next one."""
    for index in site.moves:
        values = wrong(index)
        if values is not None:
            at_line = {"at_line": site.program.where(index)[0]} if index > site.at else {}
            return {**values, **at_line}
    return None


def _standing(index: int, site: Site) -> Values:
    """Tell which spindle should turn at a move and does not, None if none is known."""
    program = site.program
    if not program.several_spindles:
        if program.last(USER_CODE, index) or program.turns(index):
            return None
        on = program.last(SPINDLE, index) in RUNS
        return {"which": "the spindle", "missing": "S is" if on else "M3 and S are"}
    states = spindles_of(program)
    if not states:
        return None
    is_c, turning = states[program.moves[index].block]
    of_live = is_c or site.cut
    if turning is None or (turning if of_live else MAIN in turning):
        return None
    if of_live:
        return {"which": "the live tool", "missing": "M3 $1 and S are"}
    return {"which": "the spindle", "missing": "M3 and S are"}


@rule("spindle-m4", WARNING, "M4: right-hand tools cut with M3", plain=FIRST)
def spindle_reversed(site: Site) -> Values:
    if site.program.several_spindles or (site.cut and site.cut.is_tap):
        return None
    last = site.program.last
    return _first_move(lambda index: {} if last(SPINDLE, index) == "M4" else None, site)


@rule("spindle-unseen", NOT_JUDGED, "whether the tool turns: no preview shows it", once=True)
def spindle_unseen(site: Site) -> Values:
    if not site.program.several_spindles:
        return None
    states, line = spindles_of(site.program), site.program.moves[site.at].block
    return None if states and states[line].turning is not None else {}


@rule(
    "main-spindle",
    FINDING,
    "M3 or M4 of the spindle that is C: {off} or $1 is missing",
    program=True,
)
def main_spindle_turns(program: TracedProgram) -> Values:
    for line, state in enumerate(spindles_of(program) or ()):
        if state.is_c and MAIN in (state.turning or ()):
            off = min(switching_codes(program.ini)[1], default="the code that ends C")
            return {"off": off, "at_line": line}
    return None


@rule("m-code", FINDING, "{code} is no program in USER_M_PATH or PROGRAM_PREFIX", program=True)
def unknown_code(program: TracedProgram) -> Values:
    ini = program.ini
    folders = [ini.get("DISPLAY", "PROGRAM_PREFIX")]
    folders += (ini.get("RS274NGC", "USER_M_PATH") or "").split(":")
    places = [ini.directory / os.path.expanduser(folder) for folder in folders if folder]
    remapped = {remap.code for remap in remap_lines(ini.all)}
    for event in program.trace.events:
        code = re.match(USER_CODE, event.text)
        own = code and code[1] not in remapped and [place / code[1] for place in places]
        if own and not any(os.access(file, os.X_OK) for file in own):
            return {"code": code[1], "at_line": event.line}
    return None


@rule("clamp-closed", FINDING, "C turns with its clamp closed: {opens} is missing", program=True)
def clamp_closed(program: TracedProgram) -> Values:
    """Look for the first turn of C between a code that closes its clamp and the next code.

    Holes have their own codes. In sections and shapes a light drag may take the clamp's place.
    """
    settings = program.ini.settings
    codes = [(each.at, each.text) for each in program.trace.events if "clamp " in each.text]
    closes, opens = (f"M{code}" for code in settings.c_clamp or ("", ""))
    for (at, text), (end, _) in pairwise([*codes, (len(program.moves), "")]):
        for index in range(at, end) if text == f"clamp {closes}" else ():
            move, cut = program.moves[index], program.cut_at(index)
            apart = cut and (cut.places or settings.c_clamp_shapes)
            if not apart and move.start[C] != move.end[C]:
                return {"opens": opens, "at_line": program.where(index)[0]}
    return None


@rule("c-axis", FINDING, "the spindle is no C axis here: {code} is missing", program=True)
def spindle_is_c(program: TracedProgram) -> Values:
    """Look in the program's lines: a preview does not show the codes that switch the spindle."""
    needs_c = {cut.line for cut in program.cuts if not cut.file}
    for line, (state, text) in enumerate(zip(spindles_of(program) or (), ["", *program.texts])):
        turns_c = C_WORD.search(text) and not NO_MOVE.search(text)
        if not state.is_c and (turns_c or line in needs_c):
            return {"code": min(switching_codes(program.ini)[0]), "at_line": line}
    return None


# ------------------------------------------------------------ of a lathe whose spindle becomes C


class Spindles(NamedTuple):
    """After a line: whether the main spindle is C; which spindles turn, None if not known."""

    is_c: bool = False
    turning: frozenset[int] | None = frozenset()


def switching_codes(ini: Ini) -> tuple[set[str], set[str]]:
    """Return the codes that make the spindle C, and those that end it."""
    remaps = remap_lines(ini.all)
    on, off = (
        {each.code for each in remaps if f"prolog=spindle_c_{state}" in str(each)}
        for state in ("on", "off")
    )
    return on, off


@lru_cache(maxsize=1)
def spindles_of(program: TracedProgram) -> list[Spindles] | None:
    """Return the spindles after each line (that of line 0 first), as the program's lines turn them.

    A preview shows the first spindle alone, and not the codes that make it C.

    None where the lines do not tell: with jumps, and where no spindle becomes C. Another code of
    the machine's own may turn a tool.
    """
    on, off = switching_codes(program.ini)
    foreign = {each.code for each in remap_lines(program.ini.all)} - on - off
    found, state = [Spindles()], Spindles()
    for text in program.texts if on else ():
        codes = {f"M{int(number)}" for number in M_CODE.findall(text)}
        if codes & JUMPS or (BLOCK_WORD.match(text) and "CALL" not in text):
            return None
        state = _after(state, codes, text, on, off)
        if codes & foreign or any(map(ANY_USER_CODE.fullmatch, codes)):
            state = state._replace(turning=None)
        found.append(state)
    return found if on else None


def _after(state: Spindles, codes: set[str], text: str, on: set[str], off: set[str]) -> Spindles:
    named = NAMED.search(text)
    own = {MAIN, LIVE} if named and int(named[1]) == EVERY else {int(named[1]) if named else MAIN}
    turning = set(state.turning or ())
    if "M5" in codes:
        turning -= own if named else turning
    if codes & {"M3", "M4"}:
        turning |= own
    turning -= turning if "M6" in codes else {MAIN} if codes & on else set()
    is_c = bool(codes & on) or (state.is_c and not codes & off)
    return Spindles(is_c, None if state.turning is None else frozenset(turning))
