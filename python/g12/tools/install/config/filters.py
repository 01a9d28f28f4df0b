# SPDX-License-Identifier: GPL-2.0-or-later
"""The [FILTER] of a machine config: the lines for other controls' programs, and the checks.

Every screen (AXIS, gmoccapy, QtVCP, Touchy) looks the extension of a file up among the keys of
[FILTER] as it is written: with ``nc`` alone PART.NC is opened as it is, without a word. Its list of
files shows the extensions of PROGRAM_EXTENSION, in gmoccapy as written too.
"""

import re
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

from g12.machine_ini import entries_of
from g12.tools.install.config.findings import ConfigFinding, problem, warning
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.system import PROGRAM
from g12.tools.translate.blocks.control import Control, ControlError, read_control

TRANSLATE, DYNAPATH = "translate", "dynapath"  # the commands that are filters
FILTER_LINE = re.compile(
    r"PROGRAM_EXTENSION = \.\w+(,\.\w+)* Programs of \S+"
    r"|\w+ = python3 \S+/python/g12 translate --control \S.*"
    r"|(POLAR_Z|CYLINDER_X) = allow|LIVE_SPINDLE = [01]"
)
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


# Checks.


def control_of(config: Config, name: str) -> Control:
    own = name.endswith(".toml")
    return read_control(str(folder_from_ini(config.ini, name)) if own else name)


def filter_findings(config: Config) -> Iterator[ConfigFinding]:
    for rule in (wrong_filters, one_case_alone, files_not_taken):
        yield from rule(config)


def wrong_filters(config: Config) -> Iterator[ConfigFinding]:
    """Find a filter whose command or control is not there."""
    for suffix, value, name in translating_filters(config):
        words = value.split()
        command = folder_from_ini(config.ini, words[words.index(TRANSLATE) - 1])
        if not command.exists():
            yield problem(
                "filter",
                f"[FILTER] {suffix}: {command} is not there: no .{suffix} program opens",
                f"write {PROGRAM} in its place, or take the line out",
            )
        try:
            control_of(config, name)
        except ControlError as wrong:
            yield problem("filter", f"[FILTER] {suffix}: {wrong}", "correct the control's file")


def one_case_alone(config: Config) -> Iterator[ConfigFinding]:
    """Find a suffix whose other case is opened in another way, or as it is."""
    for suffix, command, _ in filters_of(config):
        for other in both_cases(suffix):
            present = config.ini.get("FILTER", other)
            if not present:
                yield problem(
                    "filter",
                    f"[FILTER] {suffix} is there, {other} is not: LinuxCNC would run PART.{other} "
                    "as it is, without a word",
                    f"add to [FILTER]: {other} = {command}, and .{other} to PROGRAM_EXTENSION",
                )
            elif present != command:
                yield warning(
                    "filter",
                    f"[FILTER] {suffix} and {other} differ: .{other} files are opened by {present}",
                    f"if that is not meant: {other} = {command}",
                )


def files_not_taken(config: Config) -> Iterator[ConfigFinding]:
    """Find programs of an installed control that no filter takes."""
    folder = config.ini.get("DISPLAY", "PROGRAM_PREFIX")
    for name in installed_programs(config) if folder else ():
        with suppress(ControlError, OSError):  # `wrong_filters` reports a wrong control
            control = control_of(config, name)
            files = sorted(folder_from_ini(config.ini, folder).iterdir())
            suffixes = ((file.name, file.suffix[1:]) for file in files if file.is_file())
            names = [
                file
                for file, suffix in suffixes
                if suffix.lower() in control.extensions and not config.ini.get("FILTER", suffix)
            ]
            if names:
                yield warning(
                    "filter",
                    f"[DISPLAY] PROGRAM_PREFIX = {folder}: {shortened(names)}: no [FILTER] takes "
                    f"these programs of {name}: LinuxCNC would run them as they are",
                    f"install --with programs-{name} again, or rename the files to end in "
                    f".{control.extensions[0]}; leave them if they are LinuxCNC's own",
                )


def shortened(names: list[str]) -> str:
    """Return some names in one line, and the number of the others."""
    more = f" and {len(names) - MAX_NAMED} more" if len(names) > MAX_NAMED else ""
    return ", ".join(names[:MAX_NAMED]) + more
