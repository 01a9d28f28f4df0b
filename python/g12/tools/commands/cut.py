# SPDX-License-Identifier: GPL-2.0-or-later
"""Shared by the commands for a program's cut: its stock, and its run on a headless machine."""

import argparse
from pathlib import Path

from g12.tools.commands.arguments import Parser, add_override, program_parser
from g12.tools.headless.machine import run_program
from g12.tools.machine.ini import Ini
from g12.tools.material.stock import StockText
from g12.tools.path.follow import Samples
from g12.tools.path.track import program_seconds
from g12.tools.preview.moves import Trace
from g12.tools.progress import working
from g12.tools.units import UNITS, clock


def cut_parser(name: str, description: str, epilog: str, run: str) -> Parser:
    """Return the parser of a command for a program's cut; ``run`` is the help of --run."""
    parser = program_parser(name, description, epilog)
    parser.add_argument("--units", choices=sorted(UNITS), help="default: the program's")
    parser.add_argument(
        "--stock",
        metavar="SIZE",
        help="a bar's diameter on a lathe (40), a block and a bore on a mill "
        "(100x80x20, 100x80x20@-10,-10, bore 30); in the program's unit, or 40mm, 1.5in",
    )
    parser.add_argument("--run", action="store_true", help=run)
    add_override(parser, "of --run")
    return parser


def stock_of(options: argparse.Namespace) -> StockText | None:
    return None if options.stock is None else StockText(options.stock, options.units)


def samples_of_run(
    program: Path, options: argparse.Namespace, trace: Trace | None, ini: Ini
) -> Samples | None:
    """Return the actual motion of a traced program, if --run is given."""
    if not options.run:
        return None
    override, files = options.override, (options.ini, options.tools, options.var)
    with working(run_text(program, override, trace, ini), clock=True):
        return run_program(program, *files, override=override).samples


def run_text(program: Path, override: float, trace: Trace | None, ini: Ini) -> str:
    pace = "in real time" if override == 100.0 else f"at {override:g} % feed"
    if not trace or trace.error:
        return f"running {program.name} {pace}"
    seconds = program_seconds(trace, ini, override)
    return f"running {program.name} {pace}, {clock(seconds)} without acceleration"
