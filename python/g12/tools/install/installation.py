# SPDX-License-Identifier: GPL-2.0-or-later
"""Installation in a machine config, and its reverse.

Every installation first takes out, in memory, what an earlier one wrote; then all features are
planned anew. The new INI is loaded from a scratch folder before anything is changed. The copy of
the package is put in place first, the file with the codes last.
"""

import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from g12.machine_ini import INCLUDE, key_and_value
from g12.tools.install import package_copy
from g12.tools.install.config import features
from g12.tools.install.config.features import COPY
from g12.tools.install.config.findings import WARNING, ConfigFinding, refuse, refuse_problems
from g12.tools.install.config.ini_edit import BEGIN_MARK, IniText, other_inis
from g12.tools.install.config.loaded import load_config, remaps_in
from g12.tools.install.config.screen import HERE
from g12.tools.install.lathe.spindle_c import Pins, pins_in_ini
from g12.tools.install.plan import make_plan
from g12.tools.install.rules import LOADING, STOPPING, findings_of
from g12.tools.machine.files import (
    backup_of,
    backups_of,
    difference,
    equal_backups,
    write,
)
from g12.tools.machine.ini import IniLine, broken_line
from g12.tools.system import COMMAND
from g12.tools.translate.blocks.control import Control, read_control

PREVENTING = STOPPING | {"no-axis"}  # kinds: another INI must not get these
NAMES_COPY = re.compile(rf"(?<![^\s:=])(\./|{HERE}/)?{COPY}(?=/)")  # in a line


def install(
    text: IniText,
    requested: Sequence[str],
    dry_run: bool,
    pins: Pins | None = None,
    options: str = "",
) -> Iterator[str]:
    copy = text.path.parent / COPY
    if not dry_run:
        package_copy.recover(copy)
    earlier, pins = text.words(), pins or pins_in_ini(text.ini())
    text.take_out()
    names = [name for name in features.FEATURE_NAMES if name in (*earlier, *requested)]
    refuse_excluding(names)
    config = load_config(text)
    before = findings_of(config)
    refuse_problems(finding for finding in before if finding.kind in LOADING)
    options = options or "".join(f" {word}" for word in earlier if word not in names)
    make_plan(config, names, pins, options)
    for name in filter(None, map(features.CONTROLS.get, requested)):
        yield from question_of(read_control(name), options)
    changes = text.changes()
    files = {} if package_copy.is_current(copy) else package_copy.package_files()
    if not changes and not files:
        yield f"{text.path}: {', '.join(requested)}: installed already, nothing to do"
        return
    warnings = try_out(text, before)
    for path, content in changes.items():
        yield from difference(path, content)
    if files:
        yield f"{copy}: {'would get ' * dry_run}the package, {len(files)} files"
    for warning in warnings:
        yield f"{warning.level} [{warning.kind}]: {warning.text}; cure: {warning.cure}"
    if dry_run:
        yield "dry run: nothing was written"
        return
    yield from write_all(changes, copy, files)
    yield "next: restart LinuxCNC, then try in MDI or with a program:"
    yield from (f"  {features.first_step(feature)}" for feature in requested)
    yield f"to take it out again: {COMMAND} uninstall {text.path}"


def refuse_excluding(names: Sequence[str]) -> None:
    """Refuse features of which a machine has one."""
    for group in features.EXCLUSIVE:
        chosen = [name for name in group if name in names]
        if len(chosen) > 1:
            raise refuse(
                "exclusive", f"{' and '.join(chosen)} exclude each other", "choose one; a feature "
                "that is there goes by uninstall"
            )  # fmt: skip


def question_of(control: Control, options: str) -> Iterator[str]:
    """Yield the question for ``--decimals``, where neither control nor user have answered it."""
    if not control.decimals and "--decimals" not in options:
        mm = 1500 * float(control.value("increments", "length_mm", 0.0))
        yield (
            f"asked: X1500 has no decimal point. With --decimals least it is {mm:g} mm, with "
            f"--decimals whole 1500 mm. Install programs-{control.name} with one of them: until "
            "then such programs are refused."
        )


def write_all(
    changes: Mapping[Path, bytes], copy: Path, files: Mapping[str, bytes]
) -> Iterator[str]:
    """Put a new copy and the changed files in place, a backup of the user's first.

    A file with lines of an earlier installation has one.
    """
    for path in changes:  # its owner may protect it
        path.open("r+b").close()
    for name in package_copy.replace(copy, files) if files else ():
        yield f"{copy / name}: your version, kept beside the new one"
    for path, content in changes.items():
        present = path.read_bytes()
        backup = path if BEGIN_MARK.encode() in present else backup_of(path)
        if not backup.exists():
            write(backup, present, model=path)
        write(path, content)
        yield f"{path}: changed" + f"; as it was: {backup.name}" * (backup != path)


# The trial.


def try_out(text: IniText, before: Sequence[ConfigFinding]) -> list[ConfigFinding]:
    """Return the warnings of `check` for an edited INI; refuse if the edits cause a problem.

    What was found before, and a spindle that may not be there, are no reason. Another INI of the
    folder that includes a changed file has to load as well.
    """
    warnings = refuse_problems(
        replace(each, level=WARNING) if each in before or each.kind == "live-spindle" else each
        for each in trial(text)
        if each.kind != "copy"  # which is renewed
    )
    for other in other_inis(text):
        shared = [file.name for file in text.changes() if file in other.files]
        name, found = other.path.name, trial(other) if shared else []
        refuse_problems(
            replace(
                each,
                text=f"{name} includes {shared[0]} too and gets the same lines: {each.text}",
                cure=f"in {name}: {each.cure}; if no machine uses it, rename it to end in .old",
            )
            for each in found
            if each.kind in PREVENTING
        )
    return warnings


def trial(text: IniText) -> list[ConfigFinding]:
    """Return the findings of `check` in an edited INI.

    A folder of links is in place of the package's copy, which may not be there yet.
    """
    ini = text.ini()
    with tempfile.TemporaryDirectory(prefix="g", dir="/tmp") as scratch:
        for part in ("ngc", "python", "configs"):
            (Path(scratch) / part).symlink_to(features.ROOT / part)
        ini = replace(ini, lines=tuple(relocated(ini.lines, scratch)))
        return findings_of(load_config(text, ini))


def relocated(lines: Sequence[str], folder: str) -> Iterator[str]:
    """Yield an INI's lines with another folder instead of the copy's."""
    for line in lines:
        moved = NAMES_COPY.sub(folder, line)
        yield from [line] if moved == line else broken_line(moved)


# Uninstallation.


def uninstall(text: IniText, dry_run: bool) -> Iterator[str]:
    copy, blocks = text.path.parent / COPY, text.blocks()
    if not dry_run:
        package_copy.recover(copy)
    users = text.take_out(shared_files(text))
    needing = [*names_copy(text), *(code.line for code in remaps_in(text) if code.feature)]
    used = any(map(names_copy, other_inis(text)))
    if not blocks and (used or not package_copy.is_copy(copy)):
        yield f"{text.path}: nothing that install put in"
        return
    changes = text.changes()
    for path, content in changes.items():
        yield from difference(path, content)
    for line in users:
        yield f"{line.location}: stays, it is not by install, or you changed it: {line.text}"
    for line in needing:
        yield f"{line.location}: still needs the package: {line.text.strip()}"
    if dry_run:
        yield "dry run: nothing was written"
        return
    for path, content in reversed(changes.items()):  # the codes first: they need the rest
        write(path, content)
    for path in text.files:
        for backup in equal_backups(path):
            backup.unlink()
        backups = ", ".join(backup.name for backup in backups_of(path))
        if path in changes:
            yield f"{path}: changed" + f"; you changed it since, {backups} stays" * bool(backups)
    if used or needing:
        yield f"{copy}: stays, {'another INI of this folder uses it' if used else 'lines need it'}"
    elif package_copy.is_copy(copy):
        package_copy.replace(copy, {})
        kept = ", ".join(package_copy.files_below(copy))
        yield f"{copy}: taken away" + f" but for what you changed: {kept}" * bool(kept)


def names_copy(text: IniText) -> list[IniLine]:
    """Return the lines of an INI that need the copy, by `install` or by hand."""
    return [
        line
        for line in text.lines()
        if NAMES_COPY.search(line.text)
        and (INCLUDE.match(line.text) or key_and_value(line.text)[0])
    ]


def shared_files(text: IniText) -> list[Path]:
    """Return the included files that another INI, which has blocks of its own, includes too."""
    return [
        file
        for other in other_inis(text)
        if any(block[0].file not in text.files for block in other.blocks())
        for file in other.files
        if file in text.files
    ]
