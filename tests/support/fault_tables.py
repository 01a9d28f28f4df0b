# SPDX-License-Identifier: GPL-2.0-or-later
"""The programs of tests/faults and of tests/programs, each with the machine that it is for."""

import tomllib
from pathlib import Path
from typing import NamedTuple

from g12.tools.machine.ini import read_ini
from support.sim_machines import PROGRAMS, ROOT

FAULTS = ROOT / "tests" / "faults"
CLAMP = ROOT / "tests" / "support" / "clamp"  # the subs of M10 and M11
TABLES = {path.stem: tomllib.loads(path.read_text()) for path in sorted(FAULTS.glob("*.toml"))}
FOLDERS = {
    "circle_mill": "mill_mm",
    "cylinder": "lathe_mm",
    "dynapath": "mill_inch",
    "haas": "mill_inch",
    "haas_helix": "mill_helix_mm",
    "mitsubishi": "mill_mitsubishi_mm",
    "polar": "lathe_mm",
    "yasnac": "mill_yasnac_mm",
}
OTHERWISE = {"manual_a": "lathe_inch", "manual_b": "lathe_inch", "manual_sample": "lathe_inch"}
TOOLS = {"manual_sample": {8: 0.0}, "O60131": {1: 0.5}, "O60121": {1: 0.25}}
BEFORE = {"flange": "T2 M6\nG0 Z1\n"}


class MachinedProgram(NamedTuple):
    """A program's text and its machine: the INI's name, its [G12] settings."""

    name: str
    text: str
    machine: str
    settings: dict[str, object]

    def written(self, folder: Path) -> Path:
        """Write the program into a folder; return its path."""
        path = folder / f"{Path(self.name).name}.ngc"
        path.write_text(self.text, encoding="utf-8")
        return path

    def ini(self, package: Path):
        """Return its machine, of the package in a folder; a clamp's codes are those of `clamp`."""
        ini = read_ini(package / "configs" / "sim" / f"{self.machine}_headless.ini")
        own = [f"{code} modalgroup=10 ngc={code.lower()}" for code in self.clamp]
        path = f"{ini.get('RS274NGC', 'SUBROUTINE_PATH')}:{CLAMP}"
        remaps = {"REMAP": [*ini.all("RS274NGC", "REMAP"), *own], "SUBROUTINE_PATH": path}
        return ini.replaced({"G12": self.settings, "RS274NGC": remaps if own else {}})

    @property
    def clamp(self) -> list[str]:
        """The codes that close and open C's clamp."""
        return str(self.settings.get("C_CLAMP", "")).split()


def program_of(table: str, name: str) -> MachinedProgram:
    """Return a program of a table of faults."""
    row = TABLES[table][name]
    text = row.get("text") or (PROGRAMS / row["file"]).read_text(encoding="utf-8")
    machine = row.get("ini", TABLES[table]["ini"])
    return MachinedProgram(f"{table}/{name}", text, machine, row.get("settings", {}))
