# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the spindle turns where a pocket is cut, as far as the program tells.

What turns a lathe's driven tool is the machine's choice, so sections are not asked.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from g12.tools.machine.ini import Ini
from g12.tools.preview.moves import Event

USER_CODE = re.compile(r"M1\d\d P.*")  # may turn a spindle of its own


def stands_still(events: Iterable[Event], before: int, ini: Ini) -> bool:
    """Tell whether the spindle surely stands at the moves before an index.

    Of a machine with several spindles a trace tells of the first alone, and says nothing here.
    """
    if ini.number("TRAJ", "SPINDLES", 1) > 1:
        return False
    said = [event.text for event in events if event.at < before]
    if any(USER_CODE.fullmatch(text) for text in said):
        return False
    turning = [text for text in said if text in ("M3", "M4", "M5")][-1:]
    speeds = [text for text in said if re.fullmatch(r"S[\d.]+", text)][-1:]
    return turning == ["M5"] or speeds == ["S0"]
