# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine config as LinuxCNC loads it: read, then loaded in the stock interpreter."""

import json
import os
import re
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import Remap, entries_of, remap_from_value
from g12.settings import Settings
from g12.tools.install.config.features import feature_of
from g12.tools.install.config.ini_edit import IniText
from g12.tools.machine.ini import Ini, IniError, IniLine, Overrides
from g12.tools.preview.loading import linuxcnc_version, load_failure, python_error
from g12.tools.preview.tracer import TraceFailure, Tracer
from g12.tools.system import PROGRAM

ANSWER = "G12 CONFIG "
# Code executed in the interpreter: it reports what the machine's Python modules defined.
QUESTION = f"""\
def g12_config():
    import json, sys
    remap = vars(sys.modules["__main__"]).get("remap")
    items = vars(remap).items() if hasattr(remap, "__dict__") else ()
    return {ANSWER!r} + json.dumps(
        {{key: getattr(item, "__module__", None) for key, item in items if callable(item)}})
print(g12_config(), flush=True)
"""
UNKNOWN = "Unknown"  # begins LinuxCNC's error for a G code that it does not have
NO_REMAPS: Overrides = {"RS274NGC": {"REMAP": None, "RS274NGC_STARTUP_CODE": None}}
# The commands that are filters, behind the package's program.
CALL = re.compile(rf"(\S*{PROGRAM.name}) (?:dynapath\b|translate\s(?:.*\s)?--control (\S+))")
MOST_FOLDERS = 10  # of SUBROUTINE_PATH; LinuxCNC ignores the rest


@dataclass(frozen=True)
class Python:
    """The handlers that the machine's Python modules define in the interpreter.

    ``remap`` maps the functions of that module to the module that made them, and is empty if the
    config has none. ``error`` is the exception that stopped the modules, with its file and line.
    """

    remap: dict[str, str | None] = field(default_factory=dict)
    error: str | None = None

    def lacks(self, names: Iterable[str]) -> list[str]:
        """Return those of the handlers that are not there, or not the package's."""
        modules = {name: self.remap.get(name) or "" for name in names}
        return sorted(name for name in modules if modules[name].split(".")[0] != "g12")


@dataclass(frozen=True)
class Code:
    """A REMAP line of the package in a config, and its feature."""

    line: IniLine
    remap: Remap
    feature: str


@dataclass(frozen=True)
class Config:
    """A machine config: its lines, values and REMAP lines, and the loaded interpreter's state.

    ``version`` is LinuxCNC's, empty if its Python modules are missing. ``python`` is None if the
    interpreter did not run. ``owned`` has the package's codes that are LinuxCNC's own.
    ``failure`` is the interpreter's own text if it does not load the config.
    """

    text: IniText
    ini: Ini
    remaps: list[tuple[IniLine, Remap]]
    version: str
    python: Python | None = None
    owned: frozenset[str] = frozenset()
    failure: str | None = None

    @property
    def folder(self) -> Path:
        return self.ini.directory

    @cached_property
    def settings(self) -> Settings | None:
        """The settings of section [G12], None where one is wrong."""
        try:
            return self.ini.settings
        except IniError:
            return None

    @cached_property
    def codes(self) -> list[Code]:
        return codes_of(self.remaps)

    @cached_property
    def features(self) -> dict[str, None]:
        return dict.fromkeys(code.feature for code in self.codes)


def remaps_in(text: IniText) -> list[tuple[IniLine, Remap]]:
    """Return the REMAP lines that LinuxCNC reads."""
    return [(line, remap_from_value(value)) for line, value in text.entries("RS274NGC", "REMAP")]


def codes_of(remaps: list[tuple[IniLine, Remap]]) -> list[Code]:
    """Return the REMAP lines that are the package's."""
    found = (Code(line, remap, feature_of(remap)) for line, remap in remaps)
    return [code for code in found if code.feature]


def load_config(text: IniText, ini: Ini | None = None) -> Config:
    """Return the config of an INI, loaded by LinuxCNC: as ``ini`` instead, if that is given."""
    ini, remaps, version = ini or text.ini(), remaps_in(text), linuxcnc_version()
    if not version:
        return Config(text, ini, remaps, version, failure="there is none on this computer")
    failure = load_failure(ini)
    try:
        with Tracer(ini, overrides=NO_REMAPS) as tracer:
            python = python_of(tracer)
            codes = {code.remap.code for code in codes_of(remaps) if code.remap.number[0] == "G"}
            if python.error:  # then LinuxCNC 2.9.0~pre1 may crash in the second program
                codes = set()
            owned = frozenset(code for code in codes if is_owned(tracer, code))
            return Config(text, ini, remaps, version, python, owned, failure)
    except TraceFailure as refused:
        return Config(text, ini, remaps, version, failure=failure or str(refused))


def is_owned(tracer: Tracer, code: str) -> bool:
    """Return whether a G code is LinuxCNC's own; the INI must have no REMAP line for it."""
    error = tracer.trace_text([code]).error
    return error is None or not error.text.startswith(UNKNOWN)


def python_of(tracer: Tracer) -> Python:
    """Return the definitions of the machine's Python modules in a running interpreter."""
    error = python_error(tracer.printed)
    if error:
        return Python(error=error)
    with tempfile.TemporaryDirectory(prefix="g12-config-") as folder:
        question = Path(folder) / "question.py"
        question.write_text(QUESTION, encoding="utf-8")
        printed = tracer.trace_text([f"(pyrun,{question})"]).printed
    answers = [line for line in printed.splitlines() if line.startswith(ANSWER)]
    if not answers:
        return Python(error="the modules loaded, but the interpreter's Python gives no answer")
    return Python(json.loads(answers[-1][len(ANSWER) :]))


def folder_from_ini(ini: Ini, name: str) -> Path:
    """Return a folder that the INI names, as LinuxCNC resolves it."""
    return (ini.directory / os.path.expanduser(name)).resolve()


def sub_folders(ini: Ini) -> list[Path]:
    """Return the folders that LinuxCNC searches for NGC subs, in its order."""
    prefix = ini.get("DISPLAY", "PROGRAM_PREFIX")
    names = [name for name in ini.get("RS274NGC", "SUBROUTINE_PATH", "").split(":") if name]
    folders = [folder_from_ini(ini, name) for name in names]
    first = [ini.directory, *([folder_from_ini(ini, prefix)] if prefix else [])]
    return [*first, *[folder for folder in folders if folder.exists()][:MOST_FOLDERS]]


def subs_named(ini: Ini, name: str) -> list[Path]:
    """Return every file LinuxCNC could take for an NGC sub; it takes the first."""
    files = (folder / f"{name}.ngc" for folder in sub_folders(ini))
    return list(dict.fromkeys(file for file in files if file.is_file()))


# Files that the screens open by another command. AXIS, gmoccapy, QtVCP and Touchy look an extension
# up among the keys of [FILTER] as it is written: with ``nc`` alone PART.NC is opened as it is.


class Filter(NamedTuple):
    """A line of [FILTER] that calls the package; ``control`` is "" where it does not translate."""

    suffix: str
    command: str
    program: str
    control: str


def filters_of(config: Config) -> Iterator[Filter]:
    """Yield the lines of [FILTER] that call the package."""
    for _, key, value in entries_of(config.ini.lines, "FILTER"):
        call = CALL.search(value)
        if call:
            yield Filter(key, value, call[1], call[2] or "")


def installed_programs(config: Config) -> list[str]:
    """Return the controls whose programs the machine opens."""
    return list(dict.fromkeys(each.control for each in filters_of(config) if each.control))


def both_cases(suffix: str) -> tuple[str, str]:
    return suffix.lower(), suffix.upper()
