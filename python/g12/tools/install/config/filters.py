# SPDX-License-Identifier: GPL-2.0-or-later
"""The [FILTER] of a machine config: the lines for other controls' programs, and the check.

Every screen (AXIS, gmoccapy, QtVCP, Touchy) looks the extension of a file up among the keys of
[FILTER] as it is written: with ``nc`` alone PART.NC is opened as it is, without a word. Its list of
files shows the extensions of PROGRAM_EXTENSION, in gmoccapy as written too.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from g12.machine_ini import entries_of
from g12.tools.install.config.findings import ConfigFinding, problem
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.system import PROGRAM
from g12.tools.translate.blocks.control import Control

# The commands that are filters, behind the package's program.
CALL = re.compile(rf"(\S*{PROGRAM.name}) (?:dynapath\b|translate\s(?:.*\s)?--control (\S+))")


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
    for suffix, command, program, _ in filters_of(config):
        file = folder_from_ini(config.ini, program)
        if not file.exists():
            yield problem(
                "filter",
                f"[FILTER] {suffix}: {file} is not there: no .{suffix} program opens",
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
