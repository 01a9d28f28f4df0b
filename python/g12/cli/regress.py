# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 regress``: keep what programs do, and tell later what changed, where and by how much.

``record`` writes a trace of each program to a directory to keep under version control; ``check``
interprets the programs again and compares. For a shop that updates LinuxCNC (same programs) or a
post-processor (new programs, ``--programs``), or edits its INI, its remaps or its tools.
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from g12.cli.baseline import (
    ABOUT,
    PROGRAM_SUFFIXES,
    Baseline,
    common_folder,
    load,
    program_names,
)
from g12.cli.command import FINDING, GOOD, UsageError, one_line
from g12.cli.edits import Tolerance
from g12.cli.ini import read_ini
from g12.cli.recorder import (
    ADDED,
    FAILED,
    MISSING,
    SAME,
    Job,
    Machine,
    Result,
    linuxcnc_version,
    results,
)
from g12.cli.regress_report import Progress, common_notes, json_report, text_report
from g12.cli.trace import mm_per_unit

RECORD_EXAMPLES = """\
examples:
  g12 regress record nc/ --ini mill.ini -d regress      a folder of programs, for the first time
  g12 regress record nc/new.ngc -d regress              one program more, or one again
  g12 regress record -d regress                         everything again: what it does now is right

A program that LinuxCNC refuses is recorded with its error as the expected result.
exit code: 0 recorded, 1 the interpreter died or found no end with a program, 2 wrong use
"""
CHECK_EXAMPLES = """\
examples:
  g12 regress check -d regress                          after an update of LinuxCNC
  g12 regress check -d regress --programs new_nc/       after an update of the post-processor
  g12 regress check -d regress --picture changes/       with a picture of each change
  g12 regress check -d regress --tools mill.tbl         with the present tool table

exit code: 0 as recorded, 1 something changed, 2 wrong use
"""
TIMEOUT = 600.0  # s
END_TOLERANCE = 1e-6  # machine units and degrees
FEED_TOLERANCE = 0.01  # per cent


def parser() -> argparse.ArgumentParser:
    """Return the command's words."""
    words = argparse.ArgumentParser(prog="g12 regress", description=__doc__)
    actions = words.add_subparsers(dest="action", required=True, metavar="record | check")
    raw = argparse.RawDescriptionHelpFormatter
    record_words = actions.add_parser(
        "record", help="keep what programs do", epilog=RECORD_EXAMPLES, formatter_class=raw
    )
    record_words.set_defaults(run=record)
    record_words.add_argument(
        "programs", nargs="*", type=Path, help="programs and folders (default: all recorded)"
    )
    record_words.add_argument("--ini", type=Path, help="INI file of the machine")
    record_words.add_argument("--tools", type=Path, help="tool table in place of the INI's")
    record_words.add_argument("--var", type=Path, help="var file (default: all parameters 0)")
    check_words = actions.add_parser(
        "check", help="tell what changed", epilog=CHECK_EXAMPLES, formatter_class=raw
    )
    check_words.set_defaults(run=check)
    check_words.add_argument("names", nargs="*", help="recorded programs (default: all)")
    check_words.add_argument(
        "--programs", type=Path, help="folder with other versions of the programs"
    )
    check_words.add_argument("--ini", type=Path, help="INI in place of the recorded one")
    check_words.add_argument("--tools", type=Path, help="tool table in place of the recorded one")
    check_words.add_argument("--picture", type=Path, metavar="DIR", help="draw changes there")
    for either in (record_words, check_words):
        _add_common(either)
    return words


def _add_common(words: argparse.ArgumentParser) -> None:
    words.add_argument("-d", "--directory", type=Path, required=True, help="recorded directory")
    words.add_argument(
        "--tolerance",
        type=_not_negative,
        default=END_TOLERANCE,
        help="of ends, in machine units and degrees (default 0.000001)",
    )
    words.add_argument(
        "--feed-tolerance",
        type=_not_negative,
        default=FEED_TOLERANCE,
        metavar="PERCENT",
        help="of feeds (default 0.01)",
    )
    words.add_argument("--jobs", type=_count, default=os.cpu_count(), help="default: all cores")
    words.add_argument(
        "--timeout", type=_not_negative, default=TIMEOUT, help="seconds a program (default 600)"
    )
    words.add_argument("--json", action="store_true", help="report as JSON")


def _not_negative(text: str) -> float:
    value = float(text)
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a number from 0")
    return value


def _count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a number from 1")
    return value


@one_line("regress")
def main(arguments: list[str]) -> int:
    """Run the command."""
    asked = parser().parse_args(arguments)
    return asked.run(asked)


def record(asked: argparse.Namespace) -> int:
    """Record programs; return the exit code."""
    named = [_existing(program) for program in asked.programs]
    known = (asked.directory / ABOUT).exists()
    baseline = _known(asked, named) if known else _new(asked, named)
    names = _names(baseline, named)
    tools, parameters = _sources(baseline, asked, everything=not (known and named))
    machine = Machine(baseline.ini, tools, parameters, linuxcnc_version(), asked.timeout)
    found = _done(baseline, names, baseline.programs, machine, asked, keep=True)
    baseline.take_copies(tools, parameters)
    baseline.save()
    if not named:
        found += _dropped(baseline)
    failed = any(result.verdict == FAILED for result in found)
    return _said(found, [], asked, good=not failed)


def check(asked: argparse.Namespace) -> int:
    """Compare programs with their recordings; return the exit code."""
    baseline = load(asked.directory.absolute())
    programs = _existing(asked.programs) if asked.programs else baseline.programs
    ini = _existing(asked.ini or baseline.ini)
    tools = _existing(asked.tools) if asked.tools else baseline.tools
    names = [_recorded(baseline, name) for name in asked.names] or baseline.names()
    if not names:
        raise UsageError(f"{asked.directory}: no program is recorded there")
    there = [name for name in names if (programs / name).is_file()]
    machine = Machine(ini, tools, baseline.parameters, linuxcnc_version(), asked.timeout)
    found = _done(baseline, there, programs, machine, asked)
    found += [Result(name, MISSING) for name in names if name not in there]
    if not asked.names:
        new = sorted({*baseline.in_folders(programs)} - {*names})
        found += [Result(name, ADDED) for name in new]
    notes = [*common_notes(found), *([] if asked.tools else _outdated(baseline))]
    good = all(result.verdict == SAME for result in found)
    return _said(found, notes, asked, good)


def tolerance_of(ini: Path, ends: float, feeds: float) -> Tolerance:
    """Return the tolerance in mm; ``ends`` in machine units and degrees, ``feeds`` in per cent."""
    return Tolerance(ends * mm_per_unit(read_ini(ini)), ends, feeds / 100)


def _done(baseline, names, programs, machine, asked, keep: bool = False) -> list[Result]:
    """Trace programs and compare them with their recordings."""
    tolerance = tolerance_of(machine.ini, asked.tolerance, asked.feed_tolerance)
    pictures = None if keep else asked.picture
    jobs = [
        Job(baseline, machine, name, programs / name, tolerance, keep, pictures) for name in names
    ]
    return results(jobs, asked.jobs, Progress(len(jobs)))


def _said(found: Sequence[Result], notes: list[str], asked: argparse.Namespace, good: bool) -> int:
    found = sorted(found, key=lambda result: result.program)
    if asked.json:
        print(json_report(found, notes, good))
    else:
        print("\n".join(text_report(found, notes)))
    return GOOD if good else FINDING


def _existing(path: Path) -> Path:
    if not path.exists():
        raise UsageError(f"{path}: no such file")
    return Path(os.path.abspath(path))


def _new(asked: argparse.Namespace, named: list[Path]) -> Baseline:
    """Return a directory that nothing is recorded in so far."""
    if not named:
        raise UsageError(f"{asked.directory}: nothing is recorded there; name the programs")
    if not asked.ini:
        raise UsageError(f"{asked.directory}: nothing is recorded there; name the machine, --ini")
    return _with(
        Baseline(asked.directory.absolute(), asked.ini, common_folder(named)), asked, named
    )


def _known(asked: argparse.Namespace, named: list[Path]) -> Baseline:
    """Return a recorded directory with what was asked for."""
    baseline = load(asked.directory.absolute())
    if asked.ini and named and _existing(asked.ini) != baseline.ini:
        raise UsageError(
            f"{asked.directory} is recorded on {baseline.ini}; without programs all of it is "
            f"recorded anew on another INI, or use another -d"
        )
    return _with(baseline, asked, named)


def _with(baseline: Baseline, asked: argparse.Namespace, named: list[Path]) -> Baseline:
    """Return a directory with the machine's files and the folders asked for."""
    ini = _existing(asked.ini or baseline.ini)
    table = read_ini(ini).file("EMCIO", "TOOL_TABLE")
    own = Path(os.path.abspath(table)) if table and table.is_file() else None
    known = None if asked.ini else baseline.tool_table
    folders = [baseline.name_of(path) for path in named if path.is_dir()]
    return replace(
        baseline,
        ini=ini,
        folders=tuple(dict.fromkeys([*baseline.folders, *folders])),
        tool_table=_existing(asked.tools) if asked.tools else known or own,
        var_file=_existing(asked.var) if asked.var else baseline.var_file,
    )


def _names(baseline: Baseline, named: list[Path]) -> list[str]:
    """Return the programs to record: those named, or all."""
    if not named:
        names = {*baseline.names(), *baseline.in_folders(baseline.programs)}
        return sorted(name for name in names if (baseline.programs / name).is_file())
    found = [_programs(baseline, path) for path in named]
    return sorted({name for names in found for name in names})


def _programs(baseline: Baseline, path: Path) -> list[str]:
    names = [baseline.name_of(path)]
    if path.is_dir():
        names = program_names(baseline.programs, path)
    if not names:
        raise UsageError(f"{path}: no programs in this folder ({', '.join(PROGRAM_SUFFIXES)})")
    return names


def _sources(baseline: Baseline, asked, everything: bool) -> tuple[Path | None, Path | None]:
    """Return tool table and var file to record with: the machine's, or the directory's copies.

    One program more is recorded with the copies, as the others were.
    """
    asked_for = (
        (asked.tools, baseline.tool_table, baseline.tools),
        (
            asked.var,
            baseline.var_file,
            baseline.parameters,
        ),
    )
    return tuple(
        source if source and (everything or given) and source.is_file() else copy
        for given, source, copy in asked_for
    )


def _recorded(baseline: Baseline, name: str) -> str:
    """Return a recorded program's name from that or from its file's."""
    path = Path(os.path.abspath(name))
    if path.is_relative_to(baseline.programs):
        name = path.relative_to(baseline.programs).as_posix()
    if not baseline.trace_file(name).is_file():
        raise UsageError(f"{name}: not recorded in {baseline.directory}")
    return name


def _dropped(baseline: Baseline) -> list[Result]:
    """Remove the recordings of programs that are gone."""
    gone = [name for name in baseline.names() if not (baseline.programs / name).is_file()]
    for name in gone:
        baseline.drop(name)
    return [Result(name, MISSING) for name in gone]


def _outdated(baseline: Baseline) -> list[str]:
    """Return which of the machine's files are no longer as they were recorded."""
    copies = (baseline.tool_table, baseline.tools), (baseline.var_file, baseline.parameters)
    return [
        f"{source.name} has changed since the recording, its recorded copy is used"
        for source, copy in copies
        if source and source.is_file() and source.read_bytes() != copy.read_bytes()
    ]
