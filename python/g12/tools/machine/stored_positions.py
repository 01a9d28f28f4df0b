# SPDX-License-Identifier: GPL-2.0-or-later
"""The positions of G28 and G30 in the var file: machine zero until G28.1 or G30.1 is used."""

from __future__ import annotations

import re

from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini

STORED_VALUE = re.compile(r"^\s*([0-9]+)\s+(-?[0-9]+(?:\.[0-9]+)?)", re.MULTILINE)
FIRST = {"G28": 5161, "G30": 5181}  # the first parameter of each, that of X


def unset_positions(ini: Ini) -> tuple[str, ...]:
    """Return those of G28 and G30 whose position is machine zero: G28.1 or G30.1 was never used."""
    path = ini.file("RS274NGC", "PARAMETER_FILE")
    text = path.read_text(errors="replace") if path and path.is_file() else ""
    values = dict(STORED_VALUE.findall(text))
    return tuple(
        code
        for code, first in FIRST.items()
        if not any(float(values.get(str(n), 0)) for n in range(first, first + len(AXIS_LETTERS)))
    )
