# SPDX-License-Identifier: GPL-2.0-or-later
"""What the var file keeps: the positions of G28 and G30, an offset of G92 or G52.

G28 and G30 lead to machine zero until G28.1 or G30.1 is used.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini

STORED_VALUE = re.compile(r"^\s*([0-9]+)\s+(-?[0-9]+(?:\.[0-9]+)?)", re.MULTILINE)
FIRST = {"G28": 5161, "G30": 5181}  # the first parameter of each, that of X
G92_IN_FORCE, G92_FIRST = 5210, 5211
SWITCHED_OFF = ("", "0", "NO", "FALSE", "OFF")


def unset_positions(ini: Ini) -> tuple[str, ...]:
    """Return those of G28 and G30 whose position is machine zero: G28.1 or G30.1 was never used."""
    values = stored_values(ini.file("RS274NGC", "PARAMETER_FILE"))
    return tuple(code for code, first in FIRST.items() if not any(_axes_from(first, values)))


def offset_at_start(parameters: Path | None, ini: Ini) -> str:
    """Return a sentence on the G92 or G52 that a var file puts in force, "" if there is none."""
    shift = shift_at_start(stored_values(parameters), ini)
    if not shift:
        return ""
    return (
        "a G92 or G52 from before is in force at the start, and shifts everything by "
        f"{shift} (machine units): G92.1 ends it"
    )


def shift_at_start(values: Mapping[int, float], ini: Ini) -> str:
    """Return the axes of a G92 or G52 that stored values put in force, "" if there is none."""
    kept = (ini.get("RS274NGC", "DISABLE_G92_PERSISTENCE") or "").upper() in SWITCHED_OFF
    offsets = zip(AXIS_LETTERS, _axes_from(G92_FIRST, values))
    texts = [f"{axis}{value:g}" for axis, value in offsets if value]
    return " ".join(texts) if kept and values.get(G92_IN_FORCE) else ""


def _axes_from(first: int, values: Mapping[int, float]) -> list[float]:
    """Return the values of all axes, from the parameter of X on."""
    return [values.get(first + at, 0.0) for at in range(len(AXIS_LETTERS))]


def stored_values(path: Path | None) -> dict[int, float]:
    """Return the numbered parameters of a var file, none where it is missing."""
    text = path.read_text(errors="replace") if path and path.is_file() else ""
    return {int(number): float(value) for number, value in STORED_VALUE.findall(text)}
