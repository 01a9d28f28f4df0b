# SPDX-License-Identifier: GPL-2.0-or-later
"""The installation in a machine config: tried out, shown, then written."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.install import package_copy, placing
from g12.tools.install.config import features
from g12.tools.install.config.bare_numbers import question_of
from g12.tools.install.config.filters import installed_programs, shortened
from g12.tools.install.config.ini_edit import BEGIN_MARK, IniText
from g12.tools.install.config.loaded import load_config
from g12.tools.install.lathe.spindle_c import Pins
from g12.tools.install.plan import (
    MODULE_MARK,
    make_plan,
    names_copy,
    refuse,
    refuse_problems,
)
from g12.tools.install.rules import STOPPING, findings_of
from g12.tools.install.trial import try_out
from g12.tools.machine.files import backup_of, difference
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
    if not dry_run:
        yield from placing.tidy(text.path.parent)
    missing = missing_files(text)
    if missing:
        yield f"{text.path.parent / package_copy.NAME}: missing: {shortened(missing)}"
        if dry_run:
            yield "dry run: nothing was written; without these files nothing more can be checked"
            return
        copy = text.path.parent / package_copy.NAME
        yield from write_changes({}, copy.parent, out_of_date(copy))
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
        yield from write_changes(changes, config.folder, old_copy)
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


def write_changes(changes: Mapping[Path, bytes], folder: Path, old_copy: bool) -> list[str]:
    """Put the changes, and with ``old_copy`` a new copy, in place; return a line for each."""
    with placing.folder_beside(folder) as place:
        moves, done = new_copy(place) if old_copy else ([], [])
        for path, content in changes.items():
            note = ""
            if not has_own_lines(path):
                backup = backup_of(path)
                moves.append(placing.stage(place, backup, path.read_bytes(), path))
                note = f"; as it was: {backup.name}"
            moves.append(placing.stage(place, path, content, path))
            done.append(f"{path}: changed{note}")
        placing.put_in_place(place, moves)
    return done


def new_copy(place: Path) -> tuple[list[placing.Move], list[str]]:
    """Build a new copy of the package; return its move, and a line for each change."""
    new, copy = place / package_copy.NAME, place.parent / package_copy.NAME
    renamed = package_copy.build(new, copy, package_copy.package_files())
    notes = [f"{copy / name}: your version, kept beside the new one" for name in renamed]
    return [(new, copy)], [f"{copy}: {size_of_package()}", *notes]


def out_of_date(copy: Path) -> bool:
    """Return whether a copy lacks files of this package; a copy cannot repair itself."""
    if not copy.exists() or not copy.samefile(features.ROOT):
        return not package_copy.is_current(copy)
    for name in package_copy.missing(copy):
        raise UsageError(f"{copy / name}: is missing; run install from the package itself, "
                         "not from this copy of it")  # fmt: skip
    return False


def has_own_lines(path: Path) -> bool:
    """Return whether a file has lines of an earlier installation, and so a backup."""
    return any(mark.encode() in path.read_bytes() for mark in (MODULE_MARK, BEGIN_MARK))
