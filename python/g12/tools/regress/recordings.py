# SPDX-License-Identifier: GPL-2.0-or-later
"""A recorded directory: one machine, the folder of its programs, a trace for each of them.

``regress.json`` names the INI, the programs' folder and the sources of tool table and var file, all
relative to the directory; ``tool.tbl`` and ``parameters.var`` are copies, so a tool that wears or a
work offset that is touched off changes no trace. Everything in it is text to commit.
"""

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.machine.files import write

FORMAT = 1
ABOUT = "regress.json"
TOOLS, PARAMETERS = "tool.tbl", "parameters.var"
SUFFIX = ".trace"
PROGRAM_SUFFIXES = (".ngc", ".nc", ".tap", ".gcode", ".min", ".eia")


@dataclass(frozen=True)
class Baseline:
    """The paths of a recorded directory.

    ``folders`` are those recorded as a whole, relative to ``programs``. ``tool_table`` and
    ``var_file`` are the sources of the directory's copies.
    """

    directory: Path
    ini: Path
    programs: Path
    folders: tuple[str, ...] = ()
    tool_table: Path | None = None
    var_file: Path | None = None

    @property
    def copies(self) -> list[tuple[Path | None, Path | None]]:
        """The sources of tool table and var file, each with the directory's copy of it."""
        sources = (self.tool_table, TOOLS), (self.var_file, PARAMETERS)
        return [(source, self.directory / name if source else None) for source, name in sources]

    def names(self) -> list[str]:
        found = self.directory.rglob(f"*{SUFFIX}")
        return sorted(path.relative_to(self.directory).as_posix()[: -len(SUFFIX)] for path in found)

    def trace_file(self, name: str) -> Path:
        return self.directory / f"{name}{SUFFIX}"

    def keep(self, name: str, text: str) -> None:
        path = self.trace_file(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        content = text.encode(errors="surrogateescape")  # the program's name may be no UTF-8
        if not path.exists() or path.read_bytes() != content:
            write(path, content)

    def in_folders(self, programs: Path) -> list[str]:
        """Return the present programs in the folders recorded as a whole."""
        names = (program_names(programs, programs / folder) for folder in self.folders)
        return sorted({name for found in names for name in found})

    def name_of(self, program: Path) -> str:
        if not program.is_relative_to(self.programs):
            where = f"{self.programs}, the programs of {self.directory}"
            raise UsageError(f"{program}: not in {where}; use another -d for it")
        return program.relative_to(self.programs).as_posix()

    def save(self) -> None:
        about = {
            "format": FORMAT,
            "ini": self._relative(self.ini),
            "programs": self._relative(self.programs),
            "folders": list(self.folders),
            "tool_table": self._relative(self.tool_table),
            "var_file": self._relative(self.var_file),
        }
        write(self.directory / ABOUT, f"{json.dumps(about, indent=2)}\n".encode())

    def take_copies(self, sources: Iterable[Path | None]) -> None:
        self.directory.mkdir(parents=True, exist_ok=True)
        for source, (_, copy) in zip(sources, self.copies):
            if source and copy and source != copy:
                write(copy, source.read_bytes())

    def _relative(self, path: Path | None) -> str | None:
        return Path(os.path.relpath(path, self.directory)).as_posix() if path else None


def load(directory: Path) -> Baseline:
    about = directory / ABOUT
    if not about.is_file():
        raise UsageError(f"{directory}: nothing is recorded there (no {ABOUT})")
    try:
        values = json.loads(about.read_text(encoding="utf-8"))
        known, folders = values.pop("format") == FORMAT, tuple(values.pop("folders"))
        paths = {key: _absolute(directory, value) for key, value in values.items()}
        named = known and paths["ini"] and paths["programs"]
        if not (named and all(isinstance(folder, str) for folder in folders)):
            raise ValueError
        return Baseline(directory, folders=folders, **paths)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise UsageError(f"{about}: not a file of g12 regress, or of another version") from None


def _absolute(directory: Path, name: str | None) -> Path | None:
    return Path(os.path.normpath(directory / name)) if name else None


def program_names(root: Path, folder: Path) -> list[str]:
    """Return the programs in a folder and below, by their paths below ``root``."""
    found = (path for path in folder.rglob("*") if path.suffix.lower() in PROGRAM_SUFFIXES)
    return sorted(path.relative_to(root).as_posix() for path in found if path.is_file())
