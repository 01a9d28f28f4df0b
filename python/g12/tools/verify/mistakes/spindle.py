# SPDX-License-Identifier: GPL-2.0-or-later
"""How the spindle turns where the program cuts, as far as the program tells."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from g12.tools.machine.ini import Ini
from g12.tools.preview.moves import Event
from g12.tools.verify.mistakes.cut import ProgramCut
from g12.tools.verify.result.finding import Finding

USER_CODE = re.compile(r"M1\d\d P.*")  # may turn a spindle of its own
SPEED = re.compile(r"S[\d.]+")


def judge_spindle(
    cuts: Sequence[ProgramCut], events: Sequence[Event], ini: Ini
) -> Iterator[Finding]:
    """Yield the first cut of each kind with a spindle that stands, or turns as it should not."""
    reported: set[str] = set()
    several = ini.number("TRAJ", "SPINDLES", 1) > 1
    for cut in cuts:
        code = _code_of(cut, [event.text for event in events if event.at < cut.end], several)
        if code and code not in reported:
            reported.add(code)
            yield Finding(code, cut.line, {"code": cut.code}, file=cut.file)


def _code_of(cut: ProgramCut, said: Sequence[str], several: bool) -> str:
    """Return the code of what is unusual about the spindle in front of a cut, "" if nothing.

    ``said`` are the events before it. A trace tells of the first spindle alone: of a machine with
    ``several`` that is the main one, and nothing is known of the tool's.
    """
    if any(USER_CODE.fullmatch(text) for text in said):
        return ""
    turning = next((text for text in reversed(said) if text in ("M3", "M4", "M5")), "")
    speed = next((text for text in reversed(said) if SPEED.fullmatch(text)), "")
    runs = turning in ("M3", "M4") and speed != "S0"
    if several:
        return "main-spindle-turns" if cut.turning and runs else ""
    if not cut.turning and (turning == "M5" or speed == "S0"):
        return "spindle-stands"
    return "spindle-m4" if turning == "M4" and runs else ""
