# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindles of a lathe whose spindle becomes C, as the program's lines turn them.

A preview shows the first spindle alone, and not the codes that make it C.
"""

import re
from collections.abc import Sequence
from typing import NamedTuple

from g12.machine_ini import remap_lines
from g12.tools.machine.ini import Ini

M_CODE, USER_CODE = re.compile(r"M(\d+)"), re.compile(r"M1\d\d")
SPINDLE, BLOCK_WORD, JUMPS = re.compile(r"\$(-?\d+)"), re.compile(r"\s*O"), {"M98", "M99"}
MAIN, LIVE, EVERY = 0, 1, -1


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


def spindles_of(texts: Sequence[str], ini: Ini) -> list[Spindles] | None:
    """Return the spindles after each line (that of line 0 first).

    None where the lines do not tell: with jumps, and where no spindle becomes C. Another code of
    the machine's own may turn a tool.
    """
    on, off = switching_codes(ini)
    foreign = {each.code for each in remap_lines(ini.all)} - on - off
    found, state = [Spindles()], Spindles()
    for text in texts if on else ():
        codes = {f"M{int(number)}" for number in M_CODE.findall(text)}
        if codes & JUMPS or (BLOCK_WORD.match(text) and "CALL" not in text):
            return None
        state = _after(state, codes, text, on, off)
        if codes & foreign or any(map(USER_CODE.fullmatch, codes)):
            state = state._replace(turning=None)
        found.append(state)
    return found if on else None


def _after(state: Spindles, codes: set[str], text: str, on: set[str], off: set[str]) -> Spindles:
    named = SPINDLE.search(text)
    own = {MAIN, LIVE} if named and int(named[1]) == EVERY else {int(named[1]) if named else MAIN}
    turning = set(state.turning or ())
    if "M5" in codes:
        turning -= own if named else turning
    if codes & {"M3", "M4"}:
        turning |= own
    turning -= turning if "M6" in codes else {MAIN} if codes & on else set()
    is_c = bool(codes & on) or (state.is_c and not codes & off)
    return Spindles(is_c, None if state.turning is None else frozenset(turning))
