# SPDX-License-Identifier: GPL-2.0-or-later
"""What commands that look at a program share: words of the command line, errors, progress, runs."""

from __future__ import annotations

import argparse
import contextlib
import functools
import re
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Callable

from g12.cli.headless import Machine, MachineError, Run, StartupError
from g12.cli.ini import Ini, IniError, read_ini
from g12.cli.trace import Tools, Trace, TraceFailure, trace

GOOD, FINDING, USAGE = 0, 1, 2
TICK = 1.0  # s
MOST_SECONDS = 24 * 3600.0
RAISED = re.compile(r"[\w.]*(Error|Exception|Refusal)\b.*:")  # how Python names what was raised
HIDDEN = "\r\033[K"


class UsageError(ValueError):
    """The command cannot do what was asked: a wrong file, suffix or word."""


class ProgramError(RuntimeError):
    """The program itself does not come to its end; names its line and LinuxCNC's text."""


def add_program(parser: argparse.ArgumentParser) -> None:
    """Add the words that name a program and its machine."""
    parser.add_argument("program", type=Path, help="program file")
    parser.add_argument("--ini", type=Path, required=True, help="INI file of the machine")
    parser.add_argument("--tools", type=Path, help="tool table in place of the INI's")


def add_run(parser: argparse.ArgumentParser, what: str) -> None:
    """Add the words of commands that can also run the program."""
    parser.add_argument("--run", action="store_true", help=what)
    parser.add_argument(
        "--override",
        type=_percent,
        default=100.0,
        metavar="PERCENT",
        help="feed override of --run (default 100): real time is what a run takes",
    )


def one_line(name: str) -> Callable:
    """Make a command's problems one line on standard error and an exit code."""

    def decorate(command: Callable[[list[str]], int]) -> Callable[[list[str]], int]:
        @functools.wraps(command)
        def guarded(arguments: list[str]) -> int:
            try:
                return command(arguments)
            except (UsageError, IniError, OSError) as problem:
                print(f"g12 {name}: {_text(problem)}", file=sys.stderr)
                return USAGE
            except (ProgramError, TraceFailure, StartupError, MachineError) as problem:
                print(f"g12 {name}: {_text(problem)}", file=sys.stderr)
                return FINDING

        return guarded

    return decorate


def checked_ini(program: Path, ini: Path, tools: Path | None) -> Ini:
    """Return the machine's INI after a look whether all files named are there."""
    for path in filter(None, (program, ini, tools)):
        if not path.is_file():
            raise UsageError(f"{path}: no such file")
    return read_ini(ini)


def traced(program: Path, ini: Path, tools: Tools = None) -> Trace:
    """Return the trace of a program that comes to its end, or raise ProgramError."""
    return ended(program, trace(program, ini, tools=tools))


def ended(program: Path, result: Trace) -> Trace:
    """Return a trace that came to its end, or raise ProgramError."""
    if result.error:
        raise ProgramError(f"{program}:{result.error.line}: {result.error.text}")
    return result


def run_program(program: Path, ini: Path, tools: Tools = None, override: float = 100.0) -> Run:
    """Return the run of a program that comes to its end, or raise ProgramError.

    ``override`` is the feed override in per cent.
    """
    faster = {"DISPLAY": {"MAX_FEED_OVERRIDE": max(1.0, override / 100.0)}}
    with Machine(ini, tools=tools, overrides=faster) as machine:
        machine.feed_override(override / 100.0)
        result = machine.run(program, MOST_SECONDS)
    if result.error:
        raise ProgramError(f"{program}: {result.error.text}")
    return result


@contextlib.contextmanager
def progress(text: str) -> Iterator[None]:
    """Say on standard error what is being done; on a terminal also for how long."""
    if not sys.stderr.isatty():
        print(text, file=sys.stderr, flush=True)
        yield
        return
    done = threading.Event()
    ticker = threading.Thread(target=_tick, args=(text, done))
    ticker.start()
    try:
        yield
    finally:
        done.set()
        ticker.join()


def _tick(text: str, done: threading.Event) -> None:
    started = time.monotonic()
    while not done.wait(TICK):
        seconds = time.monotonic() - started
        print(f"{HIDDEN}{text} {seconds:.0f} s", end="", file=sys.stderr, flush=True)
    print(HIDDEN, end="", file=sys.stderr, flush=True)


def _percent(text: str) -> float:
    value = float(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def _text(problem: Exception) -> str:
    """Return the problem in one line: what went wrong, of a long log only what tells most."""
    lines = [line.strip() for line in str(problem).splitlines() if line.strip()]
    if len(lines) < 2:
        return "".join(lines)
    raised = [line for line in lines if RAISED.match(line)]
    return f"{lines[0]} … {(raised or lines)[-1]}"
