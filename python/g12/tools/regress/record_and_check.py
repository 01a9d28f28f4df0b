# SPDX-License-Identifier: GPL-2.0-or-later
"""The work of ``g12 regress``: recording programs in a directory, checking them against it."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.machine.ini import read_ini, read_machine_ini
from g12.tools.machine.tables import tool_table, var_file
from g12.tools.regress.recorder import ADDED, MISSING, Job, Result, Terms, results
from g12.tools.regress.recordings import (
    ABOUT,
    PROGRAM_SUFFIXES,
    Baseline,
    load,
    program_names,
)

PROGRAM = attrgetter("program")


@dataclass(frozen=True)
class RecordRequest:
    programs: Sequence[Path] = ()
    ini: Path | None = None
    tools: Path | None = None
    var: Path | None = None


def record(directory: Path, request: RecordRequest, terms: Terms) -> list[Result]:
    """Record programs, by default all recorded ones; return their results."""
    named = [_existing(program) for program in request.programs]
    known = (directory / ABOUT).exists()
    start = (_known if known else _new)(directory.absolute(), request, named)
    baseline = _as_requested(start, request, named)
    names = _names(baseline, named)
    table, var = _tools_and_parameters(baseline, request, everything=not (known and named))
    ini = read_ini(baseline.ini)
    job = Job(baseline, baseline.programs, ini, table, var, terms, keep=True)
    found = results(job, names)
    baseline.take_copies([table, var])
    baseline.save()
    return sorted(found if named else [*found, *_dropped(baseline)], key=PROGRAM)


def check(
    directory: Path,
    names: Sequence[str],
    *,
    programs: Path | None = None,
    ini: Path | None = None,
    tools: Path | None = None,
    terms: Terms | None = None,
) -> tuple[list[Result], list[str]]:
    """Compare programs, all recorded ones if ``names`` is empty, with their recordings.

    ``programs`` is a folder with other versions of them, ``ini`` and ``tools`` replace those
    recorded. Returns the results, and notes on changed files.
    """
    baseline = load(directory.absolute())
    folder = _existing(programs) if programs else baseline.programs
    recorded = [_recorded(baseline, name) for name in names] or baseline.names()
    if not recorded:
        raise UsageError(f"{directory}: no program is recorded there")
    (_, table), (_, parameters) = baseline.copies
    table = _absolute(tool_table(tools)) if tools else table
    machine = read_ini(_machine(ini or baseline.ini))
    present = [name for name in recorded if (folder / name).is_file()]
    job = Job(baseline, folder, machine, table, parameters, terms or Terms())
    found = results(job, present)
    found += [Result(name, MISSING) for name in recorded if name not in present]
    new = [] if names else {*baseline.in_folders(folder)} - {*recorded}
    found += [Result(name, ADDED) for name in new]
    notes = [note for result in found for note in result.notes]
    return sorted(found, key=PROGRAM), [
        *dict.fromkeys(notes + ([] if tools else _outdated(baseline)))
    ]


def _existing(path: Path) -> Path:
    if not path.exists():
        raise UsageError(f"{path}: no such file or folder")
    return _absolute(path)


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path))


def _machine(path: Path) -> Path:
    read_machine_ini(path)
    return _absolute(path)


def _new(directory: Path, request: RecordRequest, named: list[Path]) -> Baseline:
    if directory.exists() and not directory.is_dir():
        raise UsageError(f"{directory}: not a directory")
    if not (named and request.ini):
        missing = "the machine, --ini" if named else "the programs"
        raise UsageError(f"{directory}: nothing is recorded there; name {missing}")
    folders = [path if path.is_dir() else path.parent for path in named]
    return Baseline(directory, request.ini, Path(os.path.commonpath(folders)))


def _known(directory: Path, request: RecordRequest, named: list[Path]) -> Baseline:
    baseline = load(directory)
    if request.ini and named and _machine(request.ini) != baseline.ini:
        raise UsageError(
            f"{directory} is recorded on {baseline.ini}: name no programs to record it"
        )
    return baseline


def _as_requested(baseline: Baseline, request: RecordRequest, named: list[Path]) -> Baseline:
    """Return a directory with the machine's files and the requested folders."""
    ini = _machine(request.ini or baseline.ini)
    table = read_ini(ini).file("EMCIO", "TOOL_TABLE")
    own = _absolute(table) if table and table.is_file() else None
    known = None if request.ini else baseline.tool_table
    folders = [baseline.name_of(path) for path in named if path.is_dir()]
    return replace(
        baseline,
        ini=ini,
        folders=tuple(dict.fromkeys([*baseline.folders, *folders])),
        tool_table=_absolute(tool_table(request.tools)) if request.tools else known or own,
        var_file=_absolute(var_file(request.var)) if request.var else baseline.var_file,
    )


def _names(baseline: Baseline, named: list[Path]) -> list[str]:
    names = {name for path in named for name in _programs(baseline, path)}
    names = names or {*baseline.names(), *baseline.in_folders(baseline.programs)}
    return sorted(name for name in names if (baseline.programs / name).is_file())


def _programs(baseline: Baseline, path: Path) -> list[str]:
    if not path.is_dir():
        return [baseline.name_of(path)]
    names = program_names(baseline.programs, path)
    if not names:
        raise UsageError(f"{path}: no programs in this folder ({', '.join(PROGRAM_SUFFIXES)})")
    return names


def _tools_and_parameters(
    baseline: Baseline, request: RecordRequest, everything: bool
) -> list[Path | None]:
    """Return tool table and var file to record with: the machine's, or the directory's copies.

    One program more is recorded with the copies, as the others were.
    """
    return [
        source if source and (everything or given) and source.is_file() else copy
        for given, (source, copy) in zip((request.tools, request.var), baseline.copies)
    ]


def _recorded(baseline: Baseline, name: str) -> str:
    """Return a recorded program's name from that or from its file's."""
    path = Path(os.path.abspath(name))
    if path.is_relative_to(baseline.programs):
        name = path.relative_to(baseline.programs).as_posix()
    if not baseline.trace_file(name).is_file():
        raise UsageError(f"{name}: not recorded in {baseline.directory}")
    return name


def _dropped(baseline: Baseline) -> list[Result]:
    missing = [name for name in baseline.names() if not (baseline.programs / name).is_file()]
    for name in missing:
        baseline.trace_file(name).unlink()
    return [Result(name, MISSING) for name in missing]


def _outdated(baseline: Baseline) -> list[str]:
    """Return the machine's files that have changed since the recording."""
    return [
        f"{source.name} has changed since the recording, its recorded copy is used"
        for source, copy in baseline.copies
        if source and copy and source.is_file() and source.read_bytes() != copy.read_bytes()
    ]
