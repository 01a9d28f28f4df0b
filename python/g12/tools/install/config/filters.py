# SPDX-License-Identifier: GPL-2.0-or-later
"""The [FILTER] of a machine config: the lines for other controls' programs, and the checks.

Every screen (AXIS, gmoccapy, QtVCP, Touchy) looks the extension of a file up among the keys of
[FILTER] as it is written: with ``nc`` alone PART.NC is opened as it is, without a word. Its list of
files shows the extensions of PROGRAM_EXTENSION, in gmoccapy as written too.
"""

from collections.abc import Iterator
from typing import NamedTuple

from g12.machine_ini import entries_of
from g12.tools.install.config.findings import ConfigFinding, problem
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.system import PROGRAM
from g12.tools.translate.blocks.control import Control

TRANSLATE, DYNAPATH = "translate", "dynapath"  # the commands that are filters
MAX_NAMED = 8  # files are named in a line


class Filter(NamedTuple):
    """A line of [FILTER] that calls the package; ``control`` is "" where it does not translate."""

    suffix: str
    command: str
    control: str


def filters_of(config: Config) -> Iterator[Filter]:
    """Yield the lines of [FILTER] that call the package."""
    for _, key, value in entries_of(config.ini.lines, "FILTER"):
        words = value.split()
        if TRANSLATE in words and "--control" in words[:-1]:
            yield Filter(key, value, words[words.index("--control") + 1])
        elif DYNAPATH in words[1:] and words[words.index(DYNAPATH) - 1].endswith(PROGRAM.name):
            yield Filter(key, value, "")


def translating_filters(config: Config) -> Iterator[Filter]:
    return (each for each in filters_of(config) if each.control)


def installed_programs(config: Config) -> list[str]:
    """Return the controls whose programs the machine opens."""
    return list(dict.fromkeys(each.control for each in translating_filters(config)))


def both_cases(suffix: str) -> tuple[str, str]:
    return suffix.lower(), suffix.upper()


def suffixes_of(control: Control) -> list[str]:
    """Return the suffixes of a control's programs, each in both cases."""
    return [written for suffix in control.extensions for written in both_cases(suffix)]


def filter_lines(control: Control, command: str, missing: list[str]) -> list[str]:
    """Return the lines that open files with the missing suffixes as programs of a control."""
    shown = ",".join(f".{suffix}" for suffix in missing)
    lines = [f"PROGRAM_EXTENSION = {shown} Programs of {control.name}"] if missing else []
    return [*lines, *(f"{suffix} = {command}" for suffix in missing)]


def filter_findings(config: Config) -> Iterator[ConfigFinding]:
    """Find a filter that cannot work."""
    for suffix, command, name in filters_of(config):
        words, used = command.split(), TRANSLATE if name else DYNAPATH
        program = folder_from_ini(config.ini, words[words.index(used) - 1])
        if not program.exists():
            yield problem(
                "filter",
                f"[FILTER] {suffix}: {program} is not there: no .{suffix} program opens",
                f"write {PROGRAM} in its place, or take the line out",
            )
        for other in both_cases(suffix):
            if config.ini.get("FILTER", other) != command:
                yield problem(
                    "filter",
                    f"[FILTER] {suffix} is not for .{other} files: LinuxCNC opens PART.{other} "
                    "another way, or as it is, without a word",
                    f"have in [FILTER]: {other} = {command}, and .{other} in PROGRAM_EXTENSION",
                )


def shortened(names: list[str]) -> str:
    """Return some names in one line, and the number of the others."""
    more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
    return ", ".join(names[:MAX_NAMED]) + more
