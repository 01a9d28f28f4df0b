# SPDX-License-Identifier: GPL-2.0-or-later
"""LinuxCNC's own ngcgui, without its screen: how it reads a form and what it writes."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import NamedTuple

from support.sim_machines import ROOT

NGC = ROOT / "ngc"
SCRIPT = Path(__file__).with_name("ngcgui_form.tcl")
INSTALLED = Path("/usr/lib/tcltk/linuxcnc/ngcgui.tcl")


class Field(NamedTuple):
    """An entry of a form: its number, name, default and the words beside it."""

    number: int
    name: str
    default: str
    words: str


def source() -> Path:
    """Return the program text of ngcgui, of the LinuxCNC in use."""
    built = os.environ.get("EMC2_HOME")
    return Path(built) / "tcl" / "ngcgui.tcl" if built else INSTALLED


def ngcgui(form: str, program: Path | str = "", entries: tuple[str, ...] = ()) -> list[str]:
    """Have ngcgui read a form and, with a ``program``, write it; return what it printed."""
    command = ["tclsh", str(SCRIPT), str(source()), str(NGC / f"{form}.ngc"), str(program)]
    done = subprocess.run([*command, *entries], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr
    return [line for line in done.stdout.splitlines() if "\t" in line]


def fields(form: str) -> list[Field]:
    """Return the entries of a form as ngcgui shows them."""
    rows = (line.split("\t") for line in ngcgui(form)[1:])
    return [Field(int(number), *texts) for number, *texts in rows]


def filled_in(form: str, program: Path, **values: float) -> Path:
    """Write the program of a form filled in; what is not given stays at its default."""
    numbers = {field.name: field.number for field in fields(form)}
    entries = tuple(f"{numbers[name]}={value:.10g}" for name, value in values.items())
    ngcgui(form, program, entries)
    return program
