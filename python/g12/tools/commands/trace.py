# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 trace``: the moves of a program, one a line.

The stock interpreter runs as in a preview; nothing moves. Lengths are mm and angles
degrees, whatever the program and the machine use; positions are those of the controlled point
in machine coordinates. A line begins with the program's own line number.
"""

import argparse
from typing import Any

from g12.machine_ini import AXIS_LETTERS
from g12.tools.commands.arguments import (
    GOOD,
    Parser,
    count_from,
    program_of,
    program_parser,
)
from g12.tools.machine.stored_positions import offset_at_start
from g12.tools.preview.ended import ended, explained
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import trace

EXAMPLES = """\
examples:
  g12 trace pocket.ngc --ini mill.ini
  g12 trace pocket.ngc --ini mill.ini --tools other.tbl --digits 10

exit code: 0 the program came to its end, 2 it did not, or wrong use
"""


def line_of(move: Move, digits: int) -> str:
    """Return a move as text: line, kind, what changes, centre of an arc, feed."""
    axes = zip(AXIS_LETTERS, move.start, move.end)
    words = [f"{axis}{end:.{digits}f}" for axis, start, end in axes if start != end]
    if move.kind == "arc":
        words += [f"{name}{value:.{digits}f}" for name, value in zip("IJK", move.centre)]
        words.append(f"turns {move.turns:+d} G{move.plane}")
    if move.feed:
        words.append(f"F{move.feed:.6g} {move.feed_mode}")
    return f"{move.block:6d} {move.kind:5} {' '.join(words)}"


def command_parser() -> Parser:
    parser = program_parser("trace", __doc__, EXAMPLES)
    digits: dict[str, Any] = {"type": count_from(0), "default": 6, "metavar": "N"}
    parser.add_argument("--digits", **digits, help="decimals (default 6)")
    return parser


def main(options: argparse.Namespace) -> int:
    with program_of(options) as (opened, ini):
        found = trace(opened.path, ini, tools=options.tools, parameters=options.var)
        found = explained(found, options.ini, opened.path)
    traced = found.in_source(opened)
    if shifted := offset_at_start(options.var, ini):
        print(f"{0:6d} note  {shifted}")
    for move in traced.moves:
        print(line_of(move, options.digits))
    for line, text in traced.messages:
        print(f"{line:6d} message {text}")
    ended(opened.name, traced)
    return GOOD
