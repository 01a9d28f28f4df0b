# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 regress``: record programs' motion, and report later changes with line and amount.

``record`` writes a trace of each program to a directory to keep under version control; ``check``
interprets the programs again and compares. For a shop that updates LinuxCNC (same programs) or a
post-processor (new programs, ``--programs``), or edits its INI, its remaps or its tools.
"""

import argparse
import os
from pathlib import Path
from typing import Any

from g12.tools.commands.arguments import (
    FINDING,
    GOOD,
    VAR_HELP,
    Parser,
    count_from,
    number_above,
    number_from,
)
from g12.tools.progress import working
from g12.tools.regress.differences import TOLERANCE, Tolerance
from g12.tools.regress.record_and_check import RecordRequest, check, record
from g12.tools.regress.recorder import FAILED, SAME, Result, Terms
from g12.tools.regress.report import json_report, text_report

DESCRIPTION = __doc__.partition("\n\n")[2].replace("`", "")
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


def command_parser() -> Parser:
    parser = Parser(prog="g12 regress", description=DESCRIPTION)
    actions = parser.add_subparsers(dest="action", required=True, metavar="record | check")
    text = "program or folder with programs (default: all that are recorded)"
    recording = actions.add_parser("record", help="record what programs do", epilog=RECORD_EXAMPLES)
    recording.set_defaults(run=run_record)
    recording.add_argument("programs", nargs="*", type=Path, metavar="PROGRAM", help=text)
    _add_path(recording, "--ini", "INI file of the machine")
    _add_path(recording, "--tools", "tool table in place of the INI's")
    _add_path(recording, "--var", VAR_HELP)
    checking = actions.add_parser("check", help="report what changed", epilog=CHECK_EXAMPLES)
    checking.set_defaults(run=run_check)
    checking.add_argument("names", nargs="*", metavar="PROGRAM", help="default: all recorded")
    _add_path(checking, "--programs", "folder with other versions of the programs", "DIR")
    _add_path(checking, "--ini", "INI file in place of the recorded one")
    _add_path(checking, "--tools", "tool table in place of the recorded one")
    _add_path(checking, "--picture", "draw each change, in this folder", "DIR")
    for action in (recording, checking):
        _add_common(action)
    return parser


def _add_path(parser: argparse.ArgumentParser, name: str, text: str, metavar: str = "FILE") -> None:
    parser.add_argument(name, type=Path, metavar=metavar, help=text)


def _add_common(parser: argparse.ArgumentParser) -> None:
    directory: dict[str, Any] = {"type": Path, "required": True, "metavar": "DIR"}
    parser.add_argument("-d", "--directory", **directory, help="the recordings")
    for name, default, metavar, text in (
        ("--tolerance", TOLERANCE.ends, "LENGTH", "of ends, in machine units and degrees"),
        ("--feed-tolerance", TOLERANCE.feeds, "PERCENT", "of feeds"),
        ("--timeout", Terms.timeout, "SECONDS", "for each program"),
    ):
        help_ = f"{text} (default {default:g})"
        read = number_above(0) if name == "--timeout" else number_from(0)
        parser.add_argument(name, type=read, default=default, metavar=metavar, help=help_)
    jobs: dict[str, Any] = {"type": count_from(1), "default": os.cpu_count(), "metavar": "N"}
    parser.add_argument("--jobs", **jobs, help="default: all cores")
    parser.add_argument("--json", action="store_true", help="report as JSON")


def main(options: argparse.Namespace) -> int:
    tolerance = Tolerance(options.tolerance, options.feed_tolerance)
    pictures = getattr(options, "picture", None)
    with working("") as report:
        terms = Terms(tolerance, options.timeout, options.jobs, pictures, report)
        found, notes, good = options.run(options, terms)
    print(json_report(found, notes, good) if options.json else "\n".join(text_report(found, notes)))
    return GOOD if good else FINDING


def run_record(options: argparse.Namespace, terms: Terms) -> tuple[list[Result], list[str], bool]:
    """Record programs; return results, no notes, and whether all succeeded."""
    what = RecordRequest(options.programs, options.ini, options.tools, options.var)
    found = record(options.directory, what, terms)
    return found, [], all(result.verdict != FAILED for result in found)


def run_check(options: argparse.Namespace, terms: Terms) -> tuple[list[Result], list[str], bool]:
    """Compare programs with their recordings; return results, notes and whether all are equal."""
    others = {"programs": options.programs, "ini": options.ini, "tools": options.tools}
    found, notes = check(options.directory, options.names, **others, terms=terms)
    return found, notes, all(result.verdict == SAME for result in found)
