# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 verify``: check that a program's pockets, shapes and sections are machined as programmed.

Sections are those of polar interpolation and those on a cylinder. The expected toolpath is read
from the program's words. The actual one is LinuxCNC's motion in a preview, or with --run in a
headless run.
"""

import argparse
from dataclasses import replace
from pathlib import Path

from g12.tools.commands.arguments import (
    FINDING,
    GOOD,
    Parser,
    checked_ini,
    number_above,
    one_line,
    report_line_numbers,
)
from g12.tools.commands.cut import cut_parser, samples_of_run, stock_of
from g12.tools.errors import UsageError
from g12.tools.machine.filter import opened_program
from g12.tools.machine.ini import Ini
from g12.tools.preview.ended import ended
from g12.tools.progress import working
from g12.tools.units import unit_of
from g12.tools.verify.proof import Proof, moves_and_words, prove_subject
from g12.tools.verify.report import as_json, as_text
from g12.tools.verify.subject import subject_of

EXAMPLES = """\
examples:
  g12 verify pocket.ngc --ini mill.ini
  g12 verify flats.ngc --ini lathe.ini --run
  g12 verify flats.ngc --ini lathe.ini --stock 40
  g12 verify pocket.ngc --ini mill.ini --stock "100x80x20 bore 30"
  g12 verify pocket.ngc --ini mill.ini --json

findings, beside sizes, areas and directions that are not as programmed:
  the loaded tool's diameter differs from that of D by more than 5 % (less is a note)
  a rapid leaves, below a pocket's top, what the program has cleared down to that height
  with --stock: a rapid goes into it, something of the bar stands beyond a contour
  an axis leaves its travel, with the work offsets of --var or else of the machine's var file

exit code: 0 good, 1 findings (with --strict notes too), 2 an error or wrong use
"""


def command_parser() -> Parser:
    parser = cut_parser("verify", __doc__, EXAMPLES, "measure the real motion of a headless run")
    parser.add_argument(
        "--tolerance", type=number_above(0), metavar="MM", help="in place of the usual ones"
    )
    parser.add_argument("--full", action="store_true", help="print every measure of every cut")
    parser.add_argument("--strict", action="store_true", help="notes count as findings")
    parser.add_argument("--json", action="store_true", help="print values in mm for a program")
    return parser


@one_line("verify")
def main(arguments: list[str]) -> int:
    options = command_parser().parse_args(arguments)
    ini = checked_ini(options)
    with opened_program(options.program, ini) as opened:
        proof = replace(proof_of(opened.path, ini, options), opened=opened)
    report_line_numbers("verify", opened)
    if not (any(proof.cuts) or proof.lines_with("not-measured") or proof.lines_with("not-cut")):
        raise UsageError(f"{options.program}: has no pocket, no section and no holes to verify")
    unit = unit_of(proof.subject.trace.modes.gcodes, options.units)
    text = as_text(proof, unit, full=options.full, strict=options.strict)
    print(as_json(proof, options.strict) if options.json else text)
    counts = (each.is_finding or (options.strict and each.is_note) for each in proof.judged)
    return FINDING if any(counts) else GOOD


def proof_of(program: Path, ini: Ini, options: argparse.Namespace) -> Proof:
    with working(f"interpreting {program.name}"):
        trace, commanded = moves_and_words(program, ini, options.tools, options.var)
    samples = samples_of_run(program, options, ended(program, trace), ini)
    subject = subject_of(program, ini, trace, samples, commanded)
    with working(f"measuring {program.name}") as tell:
        return prove_subject(subject, options.tolerance, stock_of(options), tell)
