# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 dynapath``: circle mill events as a LinuxCNC program.

It prints nothing if any line is refused. For a [FILTER] of LinuxCNC's INI:

  [FILTER]
  PROGRAM_EXTENSION = .dyn,.DYN Dynapath circle mill events
  dyn = python3 /path/to/g12/python/g12 dynapath --units inch
  DYN = python3 /path/to/g12/python/g12 dynapath --units inch
"""

import argparse
from pathlib import Path

from g12.errors import Refusal
from g12.tools.commands.arguments import GOOD, Parser
from g12.tools.dynapath import program_from_events
from g12.tools.errors import ProgramError
from g12.tools.machine.files import existing

EXAMPLES = """\
examples:
  g12 dynapath events.dyn --units inch
  g12 dynapath events.dyn > events.ngc

exit code: 0 the program is printed, 2 a line is wrong, or wrong use
"""


def command_parser() -> Parser:
    parser = Parser(prog="g12 dynapath", description=__doc__, epilog=EXAMPLES)
    parser.add_argument("file", type=Path, help="event text")
    parser.add_argument("--units", choices=("inch", "mm"), help="of the events: adds G20 or G21")
    return parser


def main(options: argparse.Namespace) -> int:
    text = existing(options.file).read_text(encoding="latin-1")
    try:
        program = program_from_events(text, options.units)
    except Refusal as refusal:
        raise ProgramError(f"{options.file}: {refusal}") from None
    print(program, end="")
    return GOOD
