# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of the package in a machine config, with their remedies.

Each rule is a function that yields findings. A problem prevents a code from working, a warning
reports surprising behaviour.
"""

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from g12.errors import Refusal
from g12.machine_ini import m_codes_of
from g12.settings import INI_SECTION, check_section, settings_from_lines
from g12.tools.install import package_copy
from g12.tools.install.config import features
from g12.tools.install.config.features import COPY
from g12.tools.install.config.findings import ConfigFinding, note, problem
from g12.tools.install.config.loaded import (
    MOST_FOLDERS,
    Config,
    both_cases,
    filters_of,
    folder_from_ini,
    subs_named,
)
from g12.tools.install.lathe.hal import pins_missing, pins_taken
from g12.tools.install.lathe.kinematics import kinematics_findings
from g12.tools.install.lathe.spindle_c import live_spindle_missing, spindle_c_findings
from g12.tools.system import COMMAND, PROGRAM

SHELL_CHARACTERS = re.compile(r"[^\w@%+=:,./~-]")
MEND = "if it was there once, run install again: it mends the folder g12"
MAX_NAMED = 8  # files are named in a line
AFTERMATH = "Bad character 'g'"  # prefix of the error of an interpreter that did not start
# Kinds: what keeps LinuxCNC from loading a config, with its own words for it, and these.
LOADING = {"python-fails", "does-not-load"}
STOPPING = {*LOADING, "taken", "no-sub", "blank-in-path", "no-python"}


# The codes.


def codes_missing(config: Config) -> Iterator[ConfigFinding]:
    if not config.codes and not any(filters_of(config)):
        yield problem(
            "no-codes",
            "no code of the package is set up here",
            f"{COMMAND} install INI --with haas (or another; see install --help)",
        )


def taken_codes(config: Config) -> Iterator[ConfigFinding]:
    for row, code in enumerate(config.codes):
        for line, remap, _ in (each for each in config.remaps if each not in config.codes[:row]):
            if remap.number == code.remap.number and line != code.line:
                yield problem(
                    "taken",
                    f"{line.location}: {remap.code} is remapped here already: REMAP = {remap.text}",
                    f"keep one meaning of {remap.code}: take this line out or the package's "
                    f"({code.line.location})",
                )


def owned_codes(config: Config) -> Iterator[ConfigFinding]:
    """Find REMAP lines that LinuxCNC ignores."""
    cures = {"polar": "use the pair G12.3/G13.3: uninstall, then install --with polar-g12.3"}
    for code in config.codes:
        if code.remap.code in config.owned:
            yield problem(
                "owned",
                f"{code.line.location}: {code.remap.code} is LinuxCNC's own: its REMAP is ignored",
                cures.get(code.feature, "give the feature another code in its REMAP line"),
            )


def wrong_subs(config: Config) -> Iterator[ConfigFinding]:
    """Find NGC subs of the codes that LinuxCNC does not find, or finds in another file."""
    names = [code.remap.keywords["ngc"] for code in config.codes if "ngc" in code.remap.keywords]
    names += [name for feature in config.features for name in features.FEATURES[feature].subs]
    names += [features.ABORT_SUB] * calls_abort_sub(config)
    subs = {name: subs_named(config.ini, name) for name in names}
    missing = [f"{name}.ngc" for name, files in subs.items() if not files]
    if missing:
        yield problem(
            "no-sub",
            f"{' and '.join(missing)} {'are' if missing[1:] else 'is'} in none of the folders "
            "LinuxCNC looks in",
            "add the package's folder ngc to SUBROUTINE_PATH in [RS274NGC] "
            f"(the first such line counts, and its first {MOST_FOLDERS} folders); {MEND}",
        )
    found = list(filter(None, subs.values()))
    for folder in sorted({first.parent for first, *_ in found} - {config.ini.directory}):
        yield from odd_folder(folder)
    for first, *others in found:
        if any(first.read_bytes() != other.read_bytes() for other in others):
            yield problem(
                "shadowed",
                f"{first} is found before {others[0]}",
                "rename or remove the one that is not the package's (LinuxCNC looks in the INI's "
                "folder, then PROGRAM_PREFIX, then SUBROUTINE_PATH)",
            )


def odd_folder(folder: Path) -> Iterator[ConfigFinding]:
    """Find a character in a folder's path that LinuxCNC, like a shell, cannot expand."""
    odd = SHELL_CHARACTERS.search(str(folder))
    if odd:
        yield problem(
            "blank-in-path",
            f"{folder}: LinuxCNC finds no NGC subs in a folder with {odd[0]!r} in its path",
            "rename the folder: letters, digits, - and _ only",
        )


def calls_abort_sub(config: Config) -> bool:
    """Return whether LinuxCNC calls the package after an abort."""
    command, own = config.ini.get("RS274NGC", features.ON_ABORT) or "", features.CALLS_ABORT_SUB
    return "".join(command.lower().split()) == "".join(own.lower().split())


def abort_not_handled(config: Config) -> Iterator[ConfigFinding]:
    """Find codes after whose abort LinuxCNC does not call the package."""
    command = config.ini.get("RS274NGC", features.ON_ABORT)
    if not config.codes or calls_abort_sub(config):
        return
    users = f", and [{INI_SECTION}] {features.ON_ABORT} = {command}" if command else ""
    yield problem(
        "on-abort",
        f"[RS274NGC] {features.ON_ABORT} {f'= {command}' if command else 'is missing'}: after an "
        "abort modes and kinematics of a code that did not end stay as they are",
        f"have {features.ON_ABORT} = {features.CALLS_ABORT_SUB}{users}; or run install again",
    )


# Python.


def python_not_loaded(config: Config) -> Iterator[ConfigFinding]:
    """Find what keeps LinuxCNC from loading the machine's Python: then it does not start."""
    error = config.python and config.python.error
    if config.codes and not config.ini.get("PYTHON", "TOPLEVEL"):
        yield problem(
            "no-python",
            "[PYTHON] TOPLEVEL is missing: LinuxCNC loads no Python, and the codes need it",
            "add [PYTHON], TOPLEVEL = …/python/toplevel.py and PATH_PREPEND = …/python "
            "with the package's folder",
        )
    elif error:
        cure = f"correct the module or the name; {MEND}"
        if "No module named" in error:
            cure = "add the folder of that module to [PYTHON] as PATH_PREPEND or PATH_APPEND"
        yield problem("python-fails", f"[PYTHON] does not load: {error}", cure)


def handlers_missing(config: Config) -> Iterator[ConfigFinding]:
    """Find handlers that are not there: LinuxCNC starts, and the code fails when used."""
    if not config.codes or not config.python or any(python_not_loaded(config)):
        return
    needed = {name for code in config.codes for name in code.remap.handlers}
    missing = config.python.lacks([*needed, *[features.ABORT_SUB] * calls_abort_sub(config)])
    if missing:
        yield problem(
            "no-import",
            f"remap, where LinuxCNC looks for handlers, has no {', '.join(missing)} of the package",
            f"have [PYTHON] TOPLEVEL = …/python/toplevel.py, [{INI_SECTION}] TOPLEVEL = "
            f"{config.ini.get('PYTHON', 'TOPLEVEL')} and [PYTHON] PATH_APPEND = …/python, and no "
            "function of yours under such a name",
        )


# The machine.


def wrong_values(config: Config) -> Iterator[ConfigFinding]:
    """Find settings that are a start-up error."""
    try:
        check_section(config.ini.lines)
        remaps = (code.remap for code in config.remaps)
        codes = m_codes_of(config.ini.get, remaps, config.ini.directory)
        wrong = settings_from_lines(config.ini.lines).unknown_clamp_code(codes)
    except Refusal as refusal:
        wrong = refusal.message
    if wrong:
        yield problem("setting", wrong, f"correct the line in [{INI_SECTION}]: configs/README.md "
                      "has every setting")  # fmt: skip


def needs(config: Config) -> Iterator[ConfigFinding]:
    """Find axes that a code needs, and shapes without the polar interpolation of their subs."""
    axes = config.ini.axes
    for feature in config.features:
        missing = [axis for axis in features.axes_needed(feature, axes) if axis not in axes]
        if missing:
            yield problem(
                "no-axis",
                f"{feature} needs axis {' and '.join(missing)}; "
                f"[TRAJ] COORDINATES has {' '.join(axes)}",
                "add the axis to the machine, or take these codes out",
            )
    is_polar = not config.features.keys().isdisjoint(features.POLAR_FEATURES)
    if features.POLAR_SHAPES in config.features and not is_polar:
        yield problem(
            "no-polar",
            f"{features.POLAR_SHAPES} needs polar or polar-g12.3: the subs use its codes",
            f"install both: --with polar {features.POLAR_SHAPES}",
        )


def filter_findings(config: Config) -> Iterator[ConfigFinding]:
    """Find a filter that cannot work."""
    for suffix, command, call in filters_of(config):
        file = folder_from_ini(config.ini, call["program"])
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


def changed_copy(config: Config) -> Iterator[ConfigFinding]:
    copy = config.ini.directory / COPY
    changed = dict(sorted(package_copy.changed(copy).items()))
    missing = [name for name, digest in changed.items() if not digest]
    if missing:
        more = f" and {len(missing) - MAX_NAMED} more" * (len(missing) > MAX_NAMED)
        yield problem("copy", f"{copy}: missing: {', '.join(missing[:MAX_NAMED])}{more}", MEND)
    for name in (name for name in changed if name not in missing):
        cure = "nothing if you did; install keeps it. Else delete this file and run install again"
        yield note("copy", f"{copy / name}: was changed after it was installed", cure)


CONFIG_RULES: tuple[Callable[[Config], Iterator[ConfigFinding]], ...] = (
    codes_missing,
    taken_codes,
    owned_codes,
    wrong_subs,
    abort_not_handled,
    python_not_loaded,
    handlers_missing,
    wrong_values,
    needs,
    filter_findings,
    changed_copy,
    kinematics_findings,
    spindle_c_findings,
    live_spindle_missing,
    pins_missing,
    pins_taken,
)


def findings_of(config: Config) -> list[ConfigFinding]:
    """Return all findings; a failure without one is reported in LinuxCNC's own words."""
    found = [finding for rule in CONFIG_RULES for finding in rule(config)]
    if config.failure and not any(finding.kind in STOPPING for finding in found):
        lines = [line.strip() for line in config.failure.splitlines() if line.strip()]
        errors = [line for line in lines if not line.startswith(AFTERMATH)] or lines
        text = f"LinuxCNC does not load this config: {'; '.join(errors[-2:])}"
        found.append(problem("does-not-load", text, "correct the config until LinuxCNC starts"))
    return found
