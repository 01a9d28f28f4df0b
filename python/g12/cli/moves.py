# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 trace INI PROGRAM``: list the moves of a program, one a line, in mm and degrees."""

from __future__ import annotations

import argparse
import sys

from g12.cli.trace import AXES, Move, TraceFailure, trace


def line_of(move: Move, digits: int) -> str:
    """Return a move as text: line, kind, what changes, centre of an arc, feed."""
    words = [f"{axis}{end:.{digits}f}" for axis, end in zip(AXES, move.end) if _moves(move, axis)]
    if move.kind == "arc":
        words += [f"{name}{value:.{digits}f}" for name, value in zip("IJK", move.centre)]
        words.append(f"turns {move.turns:+d} G{move.plane}")
    if move.feed:
        words.append(f"F{move.feed:.6g} {move.feed_mode}")
    return f"{move.block:6d} {move.kind:5} {' '.join(words)}"


def _moves(move: Move, axis: str) -> bool:
    index = AXES.index(axis)
    return move.start[index] != move.end[index]


def main(arguments: list[str]) -> int:
    """Run the command; the exit code is 0 if the program came to its end."""
    parser = argparse.ArgumentParser(prog="g12 trace", description=__doc__)
    parser.add_argument("ini", help="INI file of the machine")
    parser.add_argument("program", help="program file")
    parser.add_argument("--tools", help="tool table in place of the INI's")
    parser.add_argument("--digits", type=int, default=6, help="decimals (default 6)")
    asked = parser.parse_args(arguments)
    try:
        traced = trace(asked.program, asked.ini, tools=asked.tools)
    except (TraceFailure, OSError, ValueError) as error:
        print(f"g12 trace: {error}", file=sys.stderr)
        return 1
    print("".join(f"{line_of(move, asked.digits)}\n" for move in traced.moves), end="")
    for line, text in traced.messages:
        print(f"{line:6d} message {text}")
    if traced.error:
        print(f"line {traced.error.line}: {traced.error.text}", file=sys.stderr)
    return 1 if traced.error else 0
