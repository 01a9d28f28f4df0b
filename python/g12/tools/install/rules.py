# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of the package in a machine config, with their remedies.

Each rule is a function that yields findings. A problem prevents a code from working, a warning
reports surprising behaviour.
"""

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from g12.errors import LONGEST_BLOCK, Refusal
from g12.machine_ini import INCLUDE, key_and_value, m_codes_of, remap_from_value
from g12.settings import INI_SECTION, settings_from_lines
from g12.tools.errors import UsageError
from g12.tools.install import package_copy, placing
from g12.tools.install.config import features
from g12.tools.install.config.filters import filter_findings, installed_programs, shortened
from g12.tools.install.config.findings import ConfigFinding, note, problem, warning
from g12.tools.install.config.forms import form_findings
from g12.tools.install.config.loaded import MOST_FOLDERS, Config, folder_from_ini, subs_named
from g12.tools.install.config.screen import screen_findings
from g12.tools.install.lathe.hal_pins import pins_missing
from g12.tools.install.lathe.kinematics_rules import kinematics_findings
from g12.tools.install.lathe.rules import lathe_findings
from g12.tools.install.lathe.spindle_c import live_spindle_missing, spindle_c_findings
from g12.tools.machine.ini import IniError
from g12.tools.path.track import limits_of
from g12.tools.preview.loading import UNREAD
from g12.tools.system import COMMAND

OLDEST = (2, 9)
WELL_FORMED_HEADER = re.compile(r"\[[^\s\]]+\]")
HEADER_LIKE = re.compile(r"\[|\w+\s*\]$")
SETTINGS_PAGE = "configs/README.md has every setting"
OWN_HEADER = f"[{INI_SECTION}]"
IMPORT_HANDLERS = "from g12.remap import *"
SHELL_CHARACTERS = re.compile(r"[^\w@%+=:,./~-]")
MEND = "if it was there once, run install again: it mends the folder g12"
FORM_FILE = re.compile(r"ngc/form_\w+\.ngc")  # whose M codes a lathe's owner writes into it
AFTERMATH = "Bad character 'g'"  # prefix of the error of an interpreter that did not start
STOPPING = {  # kinds that prevent LinuxCNC itself from loading the config
    *("taken", "wrong-line", "no-sub", "blank-in-path", "no-python", "python-fails"),
    *("no-linuxcnc", "header"),
}


Rule = Callable[[Config], Iterator[ConfigFinding]]

# The INI's lines.


def includes(config: Config) -> Iterator[ConfigFinding]:
    """Find an #INCLUDE of a missing file, and one inside an included file."""
    for line in config.text.unreadable:
        yield warning(
            "include",
            f"{line.location}: {line.text.strip()}: there is no such file to read: "
            "LinuxCNC 2.9 goes on, 2.10 does not start",
            "correct the file name or take the line out",
        )
    for line in config.text.lines():
        if line.file != config.text.path and INCLUDE.match(line.text):
            yield warning(
                "include",
                f"{line.location}: {line.text.strip()}: an included file's #INCLUDE is only a "
                "comment to LinuxCNC 2.9 and to this command; 2.10 reads that file",
                f"put the #INCLUDE into {config.text.path.name} itself",
            )


def lines_not_read(config: Config) -> Iterator[ConfigFinding]:
    """Find REMAP lines of the package, or settings, where LinuxCNC does not read them."""
    read = {line for line, _ in config.remaps}
    for line in config.text.lines():
        key, value = key_and_value(line.text)
        if key == "REMAP" and line not in read and features.model_of(remap_from_value(value)):
            yield problem(
                "not-read",
                f"{line.location}: {line.text.strip()}: not in the section [RS274NGC] that is read",
                "move the line into the first [RS274NGC]; LinuxCNC 2.9 reads no second one",
            )
    for header in config.text.headers(INI_SECTION)[1:]:
        yield problem(
            "not-read",
            f"{header.location}: a second [{INI_SECTION}], which LinuxCNC 2.9 does not read",
            f"move its lines into the first [{INI_SECTION}]",
        )


def broken_headers(config: Config) -> Iterator[ConfigFinding]:
    """Find a broken section header; some versions of LinuxCNC ignore it without a report."""
    unread = (config.failure or "").startswith(UNREAD)
    effect = "LinuxCNC reads nothing of this INI" if unread else "what is below it does not act"
    for line in config.text.lines():
        text = line.text.strip()
        other_case = text.upper().startswith(OWN_HEADER) and not text.startswith(OWN_HEADER)
        if HEADER_LIKE.match(text) and (other_case or not WELL_FORMED_HEADER.match(text)):
            yield problem(
                "header",
                f"{line.location}: {text:.40}: begins no section: {effect}",
                f"write the section's name between brackets, without blanks: as {OWN_HEADER}",
            )


def long_lines(config: Config) -> Iterator[ConfigFinding]:
    for section in ("RS274NGC", "PYTHON", INI_SECTION):
        for line in config.text.section(section):
            if len(line.text) > LONGEST_BLOCK:
                yield problem(
                    "long-line",
                    f"{line.location}: {len(line.text)} characters; LinuxCNC reads {LONGEST_BLOCK}",
                    "shorten the line, or break it with a backslash at the end",
                )


# LinuxCNC itself.


def other_linuxcnc(config: Config) -> Iterator[ConfigFinding]:
    """Find no LinuxCNC, one that is too old, and another interpreter."""
    numbers = tuple(map(int, re.findall(r"\d+", config.version)[:2]))
    if not numbers:
        yield problem(
            "no-linuxcnc",
            "there is no LinuxCNC on this computer: nothing could be loaded",
            "run this on the machine's own computer, with LinuxCNC 2.9 or later",
        )
    elif numbers < OLDEST:
        yield problem(
            "too-old",
            f"LinuxCNC {config.version} is too old for the package",
            "update LinuxCNC to 2.9 or later",
        )
    name = config.ini.get("TASK", "INTERPRETER")
    if name:
        yield problem(
            "interpreter",
            f"[TASK] INTERPRETER = {name}: REMAP lines are for LinuxCNC's own interpreter",
            "take that line out to use the package",
        )


# The codes.


def codes_missing(config: Config) -> Iterator[ConfigFinding]:
    if not config.codes and not installed_programs(config):
        yield problem(
            "no-codes",
            "no code of the package is set up here",
            f"{COMMAND} install INI --with haas (or another; see install --help)",
        )


def taken_codes(config: Config) -> Iterator[ConfigFinding]:
    own = [code.line for code in config.codes]
    for code in config.codes:
        earlier = own[: own.index(code.line)]
        for line, remap in config.remaps:
            if remap.number == code.remap.number and line not in (code.line, *earlier):
                yield problem(
                    "taken",
                    f"{line.location}: {remap.code} is remapped here already: REMAP = {remap.text}",
                    f"keep one meaning of {remap.code}: take this line out or the package's "
                    f"({code.line.location})",
                )


def wrong_lines(config: Config) -> Iterator[ConfigFinding]:
    """Find REMAP lines that LinuxCNC ignores, or that are nearly the package's."""
    cures = {"polar": "use the pair G12.3/G13.3: uninstall, then install --with polar-g12.3"}
    for code in config.codes:
        expected, found, name = code.model.keywords, code.remap.keywords, code.remap.code
        if name in config.owned:
            yield problem(
                "owned",
                f"{code.line.location}: {name} is LinuxCNC's own code: its REMAP is ignored",
                cures.get(code.feature, "give the feature another code in its REMAP line"),
            )
        wrong = [f"{key}={value}" for key, value in expected.items() if found.get(key) != value]
        wrong += [f"no {key}=" for key in found if key not in expected]
        if wrong:
            yield problem(
                "wrong-line",
                f"{code.line.location}: REMAP = {code.remap.text}: should have {', '.join(wrong)}",
                code.remap.like(code.model),
            )


def halves(config: Config) -> Iterator[ConfigFinding]:
    others = {remap.number: remap for _, remap in config.remaps}
    for feature in config.features:
        present = {code.model for code in config.codes if code.feature == feature}
        for model in set(features.remaps_of(feature)) - present:
            other = others.get(model.number)
            now = f"means something else here (REMAP = {other.text})" if other else "is missing"
            yield problem(
                "half",
                f"{feature}: {model.code} {now}, though its other code is there",
                f"have in [RS274NGC]: REMAP = {model.text}",
            )


def wrong_subs(config: Config) -> Iterator[ConfigFinding]:
    """Find NGC subs of the codes that LinuxCNC does not find, or finds in another file."""
    names = [name for feature in config.features for name in features.names_of(feature)]
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
    for folder in sorted({files[0].parent for files in subs.values() if files} - {config.folder}):
        yield from odd_folder(folder)
    package = config.python.package if config.python else None
    for name, files in subs.items() if package else ():
        own = (package.parent.parent / "ngc" / f"{name}.ngc").resolve()
        if own in [other.resolve() for other in files[1:]]:
            yield problem(
                "shadowed",
                f"{files[0]} is found before the package's {name}.ngc",
                "rename or remove that file (LinuxCNC looks in the INI's folder, then "
                "PROGRAM_PREFIX, then SUBROUTINE_PATH)",
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
    return features.is_abort_call(config.ini.get("RS274NGC", features.ON_ABORT) or "")


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


def shadowing_functions(config: Config) -> Iterator[ConfigFinding]:
    """Find a Python O-word of the name of a sub that programs call; REMAP lines bypass it."""
    called = {name for feature in config.features for name in features.CALLED_SUBS.get(feature, ())}
    for name in sorted(called & set(config.python.oword if config.python else ())):
        yield problem(
            "shadowed",
            f"a call of o<{name}> runs the function {name} of your module oword, "
            f"not the package's {name}.ngc",
            "give your function another name",
        )


# Python.


def python_not_loaded(config: Config) -> Iterator[ConfigFinding]:
    """Find what keeps LinuxCNC from loading the machine's Python: then it does not start."""
    name, error = config.ini.get("PYTHON", "TOPLEVEL"), config.python and config.python.error
    is_missing = name and not folder_from_ini(config.ini, name).is_file()
    if config.codes and not name:
        yield problem(
            "no-python",
            "[PYTHON] TOPLEVEL is missing: LinuxCNC loads no Python, and the codes need it",
            "add [PYTHON], TOPLEVEL = …/python/toplevel.py and PATH_PREPEND = …/python "
            "with the package's folder",
        )
    elif config.codes and is_missing:
        yield problem(
            "no-python",
            f"[PYTHON] TOPLEVEL = {name}: there is no such file",
            f"correct the name; it is relative to {config.folder}; {MEND}",
        )
    elif error:
        cure = "correct the module named"
        if is_missing:
            cure = f"correct the name in TOPLEVEL = {name}; it is relative to {config.folder}"
        if "No module named" in error:
            cure = "add the folder of that module to [PYTHON] as PATH_PREPEND or PATH_APPEND"
        yield problem("python-fails", f"[PYTHON] does not load: {error}", cure)


def handlers_missing(config: Config) -> Iterator[ConfigFinding]:
    """Find handlers that are missing: LinuxCNC starts, and the code fails when it is used."""
    python = config.python
    if not config.codes or not python or any(python_not_loaded(config)):
        return
    needed = {name for code in config.codes for name in code.model.handlers}
    needed |= {features.ABORT_SUB} if calls_abort_sub(config) else set()
    missing = sorted(needed - set(python.remap))
    if missing and not python.remap and not python.remap_file:
        toplevel = config.ini.get("PYTHON", "TOPLEVEL")
        yield problem(
            "no-remap-module",
            f"{toplevel} does not import a module remap, where LinuxCNC looks for handlers",
            f"add the line: import remap   to {toplevel}",
        )
    elif missing:
        yield problem(
            "no-import",
            f"{python.remap_file} has no {', '.join(missing)}",
            f"add the line: {IMPORT_HANDLERS}   to {python.remap_file}",
        )


def handlers_hidden(config: Config) -> Iterator[ConfigFinding]:
    needed = {name for code in config.codes for name in code.model.handlers}
    for name, module in sorted((config.python.users if config.python else {}).items()):
        if name in needed:
            yield problem(
                "hidden",
                f"your own function {name} (module {module}) hides the package's",
                "give your function another name",
            )


# The machine.


def wrong_values(config: Config) -> Iterator[ConfigFinding]:
    """Find settings that are a start-up error, and values that the other commands refuse."""
    try:
        settings = settings_from_lines(config.ini.lines)
        remaps = (remap for _, remap in config.remaps)
        codes = m_codes_of(config.ini.get, remaps, config.ini.directory)
        wrong = settings.unknown_clamp_code(codes)
    except Refusal as refusal:
        wrong = refusal.message
    if wrong:
        yield problem("setting", wrong, f"correct the line in [{INI_SECTION}]: {SETTINGS_PAGE}")
    try:
        limits_of(config.ini)
    except IniError as refused:
        text = str(refused).removeprefix(f"{config.ini.path}: ")
        yield problem("value", text, "correct the line: verify, trace and plot refuse this INI")


def needs(config: Config) -> Iterator[ConfigFinding]:
    """Find axes that a code needs, and shapes without the polar interpolation of their subs."""
    axes = config.ini.axes
    for feature in config.features:
        needed = features.axes_needed(feature, axes)
        missing = [axis for axis in needed if axis not in axes]
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


def tools(config: Config) -> Iterator[ConfigFinding]:
    """Find a machine without a tool table, or without any diameter in it."""
    name, database = (config.ini.get("EMCIO", key) for key in ("TOOL_TABLE", "DB_PROGRAM"))
    path = config.ini.file("EMCIO", "TOOL_TABLE")
    mill = config.features.keys() - features.AXES_NEEDED
    if not config.codes:
        return
    if database:
        yield note(
            "tool-database",
            f"[EMCIO] DB_PROGRAM = {database}: the tools of that program were not looked at",
            "look yourself whether the cutters have diameters",
        )
    elif not (path and path.is_file()):
        missing = "is missing: this machine knows no tool"
        if path:
            link = f"a link to {path.readlink()}, which is not there" if path.is_symlink() else ""
            missing = f"= {name}: {link or 'there is no such file'}"
        yield warning(
            "no-tool-table",
            f"[EMCIO] TOOL_TABLE {missing}",
            f"name a tool table that is there; it is relative to {config.folder}",
        )
    elif mill and config.diameters is not None and not any(config.diameters.values()):
        yield warning(
            "no-diameters",
            "no tool in the tool table has a diameter: a pocket with D would come out too large",
            "enter the cutters' diameters (D) in the tool table",
        )


# The copy.


def changed_copy(config: Config) -> Iterator[ConfigFinding]:
    copy = config.folder / package_copy.NAME
    if not (config.codes or installed_programs(config)) or not package_copy.is_copy(copy):
        return
    try:
        missing, edited = package_copy.missing(copy), package_copy.edited(copy)
    except UsageError as damaged:
        yield problem("copy", str(damaged), "or take the folder away and run install again")
        return
    if missing:
        yield problem("copy", f"{copy}: missing: {shortened(missing)}", MEND)
    changed = [name for name in edited if name not in missing]
    for name in changed:
        report = note if FORM_FILE.fullmatch(name) else warning
        yield report(
            "copy",
            f"{copy / name}: was changed after it was installed",
            "leave it, if you changed it on purpose: install keeps it; if not, delete this file "
            "and run install again",
        )


def stopped_command(config: Config) -> Iterator[ConfigFinding]:
    place = config.folder / placing.BESIDE
    if place.exists():
        yield warning(
            "unfinished",
            f"{place}: an install or uninstall was stopped before its end, or is at work",
            "run the same command again: it ends what was begun and removes that folder",
        )


CONFIG_RULES: tuple[Rule, ...] = (
    other_linuxcnc,
    codes_missing,
    includes,
    lines_not_read,
    broken_headers,
    long_lines,
    taken_codes,
    wrong_lines,
    halves,
    wrong_subs,
    abort_not_handled,
    shadowing_functions,
    python_not_loaded,
    handlers_missing,
    handlers_hidden,
    wrong_values,
    needs,
    tools,
    filter_findings,
    changed_copy,
    stopped_command,
    form_findings,
    screen_findings,
    kinematics_findings,
    lathe_findings,
    spindle_c_findings,
    live_spindle_missing,
    pins_missing,
)


def findings_of(config: Config) -> list[ConfigFinding]:
    """Return all findings; a failure without one is reported in LinuxCNC's own words."""
    found = [finding for rule in CONFIG_RULES for finding in rule(config)]
    failure = config.failure or function_missing(config)
    if failure and not any(finding.kind in STOPPING for finding in found):
        found.append(
            problem(
                "does-not-load",
                f"LinuxCNC does not load this config: {last_words(failure)}",
                "correct the config until LinuxCNC starts",
            )
        )
    return found


def function_missing(config: Config) -> str:
    """Return LinuxCNC's error for a REMAP line whose function is missing, "" without one.

    The preview of 2.9.9 does not report it: it continues without that line and all after it.
    """
    python = config.python
    if not python or python.error:
        return ""
    for line, remap in config.remaps:
        name = remap.keywords.get("python")
        if name and name not in python.remap:
            return f"{line.location}: '{name}' is not a Python callable function"
    return ""


def last_words(failure: str) -> str:
    """Return the interpreter's last error in one line."""
    lines = [line.strip() for line in failure.splitlines() if line.strip()]
    errors = [line for line in lines if not line.startswith(AFTERMATH)] or lines
    return "; ".join(errors[-2:])
