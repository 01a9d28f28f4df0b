# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a pocket fits into the machine's travel: the axes' own positions against their limits.

A trace starts from a var file without offsets. What the machine's var file holds for the work
offset is added, unless the program sets offsets itself; with neither, the pocket is not known
to be where it is traced, but how wide it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from g12.machine_ini import axes_of
from g12.tools.machine.ini import Ini
from g12.tools.path.track import Track
from g12.tools.preview.executed_blocks import Text
from g12.tools.preview.moves import Trace

LETTERS = "XYZ"
SETTING = (10.0, 52.0, 92.0, 92.1, 92.2, 92.3)  # codes that change offsets
SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
FIRST, APART = 5221, 20  # parameter of the first system's X, and from system to system
BEYOND = 1e-3  # mm


class Overrun(NamedTuple):
    """An axis that would go to a position (mm) beyond its limit.

    ``certain`` is False where another work offset may be meant.
    """

    letter: str
    position: float
    limit: float
    certain: bool


class Travel:
    """A machine's limits in mm, and how far its work offset moves what was traced."""

    def __init__(self, ini: Ini, trace: Trace, texts: list[Text]) -> None:
        unit, limits = ini.mm, axes_of(ini.get, LETTERS)
        self._low = np.array([limits[letter].low for letter in LETTERS]) * unit
        self._high = np.array([limits[letter].high for letter in LETTERS]) * unit
        sets = any(code in SETTING for text in texts for code in text.codes)
        shift = np.zeros(3) if sets else stored_offset(ini, trace) * unit
        self._known = sets or bool(shift.any())
        self._shift = shift

    def overruns(self, first: int, last: int, path: Track) -> Iterator[Overrun]:
        """Yield where moves ``first`` to ``last`` - 1 leave the travel."""
        vertices = slice(path.vertices(first).start, path.vertices(last - 1).stop)
        points = (path.positions + path.offsets)[vertices, :3] + self._shift
        for axis, letter in enumerate(LETTERS):
            low, high = points[:, axis].min(), points[:, axis].max()
            certain = self._known or bool(high - low > self._high[axis] - self._low[axis])
            if not certain and letter == "Z":  # hardly ever true, with any tool length
                continue
            if high > self._high[axis] + BEYOND:
                yield Overrun(letter, float(high), float(self._high[axis]), certain)
            elif low < self._low[axis] - BEYOND:
                yield Overrun(letter, float(low), float(self._low[axis]), certain)


def stored_offset(ini: Ini, trace: Trace) -> np.ndarray:
    """Return the work offset (machine units) that the machine's var file holds for a program."""
    path = ini.file("RS274NGC", "PARAMETER_FILE")
    system = next((code for code in trace.modes.gcodes if code in SYSTEMS), SYSTEMS[0])
    first = FIRST + APART * SYSTEMS.index(system)
    values = read_var_file(Path(path)) if path and Path(path).is_file() else {}
    return np.array([values.get(first + axis, 0.0) for axis in range(3)])


def read_var_file(path: Path) -> dict[int, float]:
    """Return the parameters of a var file."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    pairs = (line.split()[:2] for line in lines)
    return {int(pair[0]): float(pair[1]) for pair in pairs if len(pair) == 2 and pair[0].isdigit()}
