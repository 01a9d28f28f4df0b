# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine config as LinuxCNC loads it: read, then loaded in the stock interpreter."""

import json
import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import Remap, entries_of, remap_from_value
from g12.settings import Settings
from g12.tools.install.config.features import feature_of
from g12.tools.install.config.ini_edit import IniText
from g12.tools.machine.ini import Ini, IniError, IniLine, Overrides
from g12.tools.preview.tracer import (
    TraceFailure,
    Tracer,
    linuxcnc_version,
    load_failure,
    python_error,
)
from g12.tools.system import PROGRAM

ANSWER = "G12 CONFIG "
# Code executed in the interpreter: it reports what the machine's Python modules defined.
QUESTION = (
    "import json, sys; "
    "found = getattr(vars(sys.modules['__main__']).get('remap'), '__dict__', {}); "
    f"print({ANSWER!r} + json.dumps({{name: getattr(found[name], '__module__', None) "
    "for name in found if callable(found[name])}), flush=True)"
)
UNKNOWN = "Unknown"  # begins LinuxCNC's error for a G code that it does not have
NO_REMAPS: Overrides = {"RS274NGC": {"REMAP": None, "RS274NGC_STARTUP_CODE": None}}
# The commands that are filters, behind the package's program.
CALL = re.compile(
    rf"(?P<program>\S*{PROGRAM.name}) (?:dynapath\b|translate\s(?:.*\s)?--control (?P<control>\S+))"
)
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


class Code(NamedTuple):
    """A REMAP line in a config, and its feature, None if it is not the package's."""

    line: IniLine
    remap: Remap
    feature: str | None


@dataclass(frozen=True)
class Config:
    """A machine config: its lines and values, and the loaded interpreter's state.

    ``version`` is LinuxCNC's, empty if its Python modules are missing. ``python`` is None if the
    interpreter did not run. ``owned`` has the package's codes that are LinuxCNC's own.
    ``failure`` is the interpreter's own text if it does not load the config.
    """

    text: IniText
    ini: Ini
    version: str
    python: Python | None = None
    owned: frozenset[str] = frozenset()
    failure: str | None = None

    @cached_property
    def settings(self) -> Settings | None:
        """The settings of section [G12], None where one is wrong."""
        try:
            return self.ini.settings
        except IniError:
            return None

    @cached_property
    def remaps(self) -> list[Code]:
        return remaps_in(self.text)

    @property
    def codes(self) -> list[Code]:
        """The REMAP lines that are the package's."""
        return [code for code in self.remaps if code.feature]

    @cached_property
    def features(self) -> dict[str, None]:
        return dict.fromkeys(code.feature for code in self.codes)


def remaps_in(text: IniText) -> list[Code]:
    """Return the REMAP lines that LinuxCNC reads."""
    entries = ((line, remap_from_value(value)) for line, value in text.entries("RS274NGC", "REMAP"))
    return [Code(line, remap, feature_of(remap)) for line, remap in entries]


def load_config(text: IniText, ini: Ini | None = None) -> Config:
    """Return the config of an INI, loaded by LinuxCNC: as ``ini`` instead, if that is given."""
    config = Config(text, ini or text.ini(), linuxcnc_version())
    if not config.version:
        return replace(config, failure="there is none on this computer")
    failure = load_failure(config.ini)
    try:
        with Tracer(config.ini, overrides=NO_REMAPS) as tracer:
            python = python_of(tracer)
            codes = {code.remap.code for code in config.codes if code.remap.number[0] == "G"}
            if python.error:  # then LinuxCNC 2.9.0~pre1 may crash in the second program
                codes = set()
            owned = frozenset(code for code in codes if is_owned(tracer, code))
            return replace(config, python=python, owned=owned, failure=failure)
    except TraceFailure as refused:
        return replace(config, failure=failure or str(refused))


def is_owned(tracer: Tracer, code: str) -> bool:
    """Return whether a G code is LinuxCNC's own; the INI must have no REMAP line for it."""
    error = tracer.trace_text([code]).error
    return error is None or not error.text.startswith(UNKNOWN)


def python_of(tracer: Tracer) -> Python:
    """Return the definitions of the machine's Python modules in a running interpreter."""
    error = python_error(tracer.printed)
    if error:
        return Python(error=error)
    printed = tracer.trace_text([f";py,{QUESTION}"]).printed
    answers = [line for line in printed.splitlines() if line.startswith(ANSWER)]
    if not answers:
        return Python(error="the modules loaded, but the interpreter's Python gives no answer")
    return Python(json.loads(answers[-1][len(ANSWER) :]))


def folder_from_ini(ini: Ini, name: str) -> Path:
    """Return a folder that the INI names, as LinuxCNC resolves it."""
    return (ini.directory / os.path.expanduser(name)).resolve()


def subs_named(ini: Ini, name: str) -> list[Path]:
    """Return every file LinuxCNC could take for an NGC sub, in its order; it takes the first."""
    names = filter(None, ini.get("RS274NGC", "SUBROUTINE_PATH", "").split(":"))
    folders = [folder for each in names if (folder := folder_from_ini(ini, each)).exists()]
    first = [ini.directory, folder_from_ini(ini, ini.get("DISPLAY", "PROGRAM_PREFIX") or "")]
    files = (folder / f"{name}.ngc" for folder in (*first, *folders[:MOST_FOLDERS]))
    return list(dict.fromkeys(file for file in files if file.is_file()))


# Files that the screens open by another command. AXIS, gmoccapy, QtVCP and Touchy look an extension
# up among the keys of [FILTER] as it is written: with ``nc`` alone PART.NC is opened as it is.


def filters_of(config: Config) -> Iterator[tuple[str, str, re.Match[str]]]:
    """Yield suffix and command of the filters that are the package's, with the match of `CALL`."""
    for _, suffix, command in entries_of(config.ini.lines, "FILTER"):
        if call := CALL.search(command):
            yield suffix, command, call


def both_cases(suffix: str) -> tuple[str, str]:
    return suffix.lower(), suffix.upper()
