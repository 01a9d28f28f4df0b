# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 verify``: judge a program by its material and its cuts, before it is run.

What is solid is the given stock, or all below Z0. What is moved is LinuxCNC's motion in a preview,
or with --run in a headless run.
"""

import argparse

from g12.tools.commands.arguments import (
    FINDING,
    GOOD,
    Parser,
    number_above,
    program_of,
)
from g12.tools.commands.cut import cut_parser, samples_of_run, stock_of
from g12.tools.machine.stored_positions import stored_values
from g12.tools.preview.ended import ended
from g12.tools.progress import working
from g12.tools.units import unit_of
from g12.tools.verify.judge import Judgement, acceptable, judge_trace, traced
from g12.tools.verify.model.finding import FINDING as IS_FINDING
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.report import as_json, as_text

EXAMPLES = """\
examples:
  g12 verify pocket.ngc --ini mill.ini
  g12 verify flats.ngc --ini lathe.ini --run
  g12 verify flats.ngc --ini lathe.ini --stock 40
  g12 verify pocket.ngc --ini mill.ini --stock "100x80x20 bore 30"
  g12 verify pocket.ngc --ini mill.ini --json

findings: a rapid through material, a cut too far, too little or beside the stock, a tool in the
  part at its change or at the end, a missing spindle, tool, length or diameter, the wrong side
warnings: what is most likely a mistake; (g12: expect core) in the line of a cut accepts one

exit code: 0 no finding, 1 findings (with --strict also warnings, and what was not judged),
  2 an error or wrong use
"""


def command_parser() -> Parser:
    parser = cut_parser("verify", __doc__, EXAMPLES, "judge the real motion of a headless run")
    parser.add_argument(
        "--tolerance", type=number_above(0), metavar="MM", help="in place of the usual ones"
    )
    parser.add_argument("--full", action="store_true", help="print every measure of every cut")
    parser.add_argument(
        "--accept",
        action="append",
        default=[],
        metavar="CODE",
        choices=sorted(acceptable()),
        help="a warning that is wanted, as core; may be repeated",
    )
    text = "warnings count as findings, and what was not judged"
    parser.add_argument("--strict", action="store_true", help=text)
    parser.add_argument("--json", action="store_true", help="print values in mm for a program")
    return parser


def main(options: argparse.Namespace) -> int:
    with program_of(options) as (opened, ini):
        path = opened.path
        with working(f"interpreting {path.name}"):
            trace = ended(path, traced(path, ini, options.tools, options.var))
        samples = samples_of_run(path, options, trace, ini)
        program = TracedProgram(path, ini, trace, samples, stored_values(options.var))
        with working(f"judging {path.name}") as tell:
            judgement = judge_trace(
                program,
                stock=stock_of(options),
                tolerance=options.tolerance,
                accept=options.accept,
                opened=opened,
                tell=tell,
            )
        unit = unit_of(trace.modes.gcodes, options.units)
        print(as_json(judgement) if options.json else as_text(judgement, unit, full=options.full))
    return exit_code(judgement, options.strict)


def exit_code(judgement: Judgement, strict: bool) -> int:
    counted = judgement.found if strict else judgement.of(IS_FINDING)
    return FINDING if counted else GOOD
