# SPDX-License-Identifier: GPL-2.0-or-later
"""The installation in a machine config: tried out, shown, then written."""

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.install import package_copy
from g12.tools.install.config import features
from g12.tools.install.config.bare_numbers import question_of
from g12.tools.install.config.ini_edit import BEGIN_MARK, IniText
from g12.tools.install.config.loaded import load_config
from g12.tools.install.lathe.spindle_c import Pins
from g12.tools.install.plan import (
    MODULE_MARK,
    InstallPlan,
    make_plan,
    names_copy,
    refuse,
    refuse_problems,
)
from g12.tools.install.rules import STOPPING, findings_of, installed_programs, shortened
from g12.tools.install.trial import try_out
from g12.tools.machine.files import back_up, difference, drop_backup, require_writable, write_all
from g12.tools.system import COMMAND
from g12.tools.translate.blocks.control import read_control

PREVENTING = {"python-fails", "does-not-load"}  # kinds: what the config does is unknown


def install(
    text: IniText,
    requested: Sequence[str],
    dry_run: bool,
    pins: Pins | None = None,
    numbers: str = "",
) -> Iterator[str]:
    missing = missing_files(text)
    if missing:
        yield f"{text.path.parent / package_copy.NAME}: missing: {shortened(missing)}"
        if dry_run:
            yield "dry run: nothing was written; without these files nothing more can be checked"
            return
        yield from bring_copy_up_to_date(text.path.parent / package_copy.NAME)
    config = load_config(text)
    preventing = PREVENTING if config.python else PREVENTING | STOPPING
    refuse_problems([finding for finding in findings_of(config) if finding.kind in preventing])
    programs = [f"programs-{control}" for control in installed_programs(config)]
    for pair in excluding([*config.features, *programs, *requested]):
        raise refuse("dialects", f"{pair} exclude each other", "uninstall first")
    plan = make_plan(config, requested, pins, numbers)
    changes = plan.changes()
    if "--decimals" not in numbers:
        for name in filter(None, map(features.CONTROLS.get, requested)):
            yield from question_of(read_control(name), config)
    old_copy = plan.copied and out_of_date(config.folder / package_copy.NAME)
    if not changes and not old_copy:
        yield f"{text.path}: {', '.join(requested)}: installed already, nothing to do"
        return
    warnings = try_out(plan)
    for path, content in changes.items():
        yield from difference(path, content)
    if dry_run and old_copy:
        yield f"{config.folder / package_copy.NAME}: would get {size_of_package()}"
    if not dry_run:
        yield from write_changes(plan, config.folder)
    for warning in warnings:
        yield f"{warning.level} [{warning.kind}]: {warning.text}; cure: {warning.cure}"
    if dry_run:
        yield "dry run: nothing was written"
    else:
        yield "next: restart LinuxCNC, then try in MDI or with a program:"
        yield from (f"  {features.first_step(feature)}" for feature in requested)
        yield f"to take it out again: {COMMAND} uninstall {text.path}"


def size_of_package() -> str:
    sizes = [len(content) for content in package_copy.package_files().values()]
    return f"the package, {len(sizes)} files, {sum(sizes) / 1e6:.1f} MB"


def excluding(names: Sequence[str]) -> Iterator[str]:
    chosen = ([name for name in group if name in names] for group in features.EXCLUSIVE)
    yield from (" and ".join(group) for group in chosen if len(group) > 1)


def missing_files(text: IniText) -> list[str]:
    """Return the missing files of the copy that the config's lines name."""
    copy = text.path.parent / package_copy.NAME
    if copy.exists():
        return package_copy.missing(copy)
    return list(package_copy.package_files()) if names_copy(text) else []


def write_changes(plan: InstallPlan, folder: Path) -> list[str]:
    """Write all changes; return a line for each."""
    changes, copy = plan.changes(), folder / package_copy.NAME
    require_writable(changes)
    new_copy, backups = plan.copied and not copy.exists(), {}
    try:
        done = bring_copy_up_to_date(copy) if plan.copied else []
        for path in changes:
            if not has_own_lines(path):
                backups[path] = back_up(path)
        write_all(changes)
    except BaseException:
        for path in backups:
            drop_backup(path)
        if new_copy:
            shutil.rmtree(copy, ignore_errors=True)
        raise
    for path in changes:
        before = f"; as it was: {backups[path].name}" if path in backups else ""
        done.append(f"{path}: changed{before}")
    return done


def bring_copy_up_to_date(copy: Path) -> list[str]:
    """Update the copy of the package; return a line for each change."""
    if not out_of_date(copy):
        return []
    renamed = package_copy.write_copy(copy)
    notes = [f"{copy / name}: your version, kept beside the new one" for name in renamed]
    return [f"{copy}: {size_of_package()}", *notes]


def out_of_date(copy: Path) -> bool:
    """Return whether a copy lacks files of this package; a copy cannot repair itself."""
    if not copy.exists() or not copy.samefile(features.ROOT):
        return bool(package_copy.stale(copy))
    for name in package_copy.missing(copy):
        raise UsageError(f"{copy / name}: is missing; run install from the package itself, "
                         "not from this copy of it")  # fmt: skip
    return False


def has_own_lines(path: Path) -> bool:
    """Return whether a file has lines of an earlier installation, and so a backup."""
    return any(mark.encode() in path.read_bytes() for mark in (MODULE_MARK, BEGIN_MARK))
