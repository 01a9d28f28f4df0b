# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands of ``python3 python/g12``: one line each, loaded when called.

A command is a module with ``command_parser()`` and ``main(options) -> exit code``.
"""

import io
import os
import select
import sys
from importlib import import_module
from types import ModuleType

from g12 import __version__
from g12.tools.commands.arguments import FAILURES, WRONG_USE, sentence_of
from g12.tools.errors import ERROR, print_error
from g12.tools.system import COMMAND

INTERRUPTED, UNREAD = 130, 141  # a shell's exit codes for SIGINT, SIGPIPE

COMMANDS = {  # each a module of this folder
    "check": "check how the package is set up in a machine config",
    "install": "put the package into a machine config",
    "uninstall": "take it out again",
    "run": "run a program on a headless LinuxCNC",
    "dynapath": "print Dynapath circle mill events as a LinuxCNC program",
    "translate": "print a program of another control as a LinuxCNC program",
    "plot": "draw a picture of what a program cuts",
    "verify": (
        "prove that pockets, shapes and sections (polar, on a cylinder) come out as programmed"
    ),
    "regress": "record what programs do, and report what changed",
    "demo": "run, draw and measure the manuals' programs",
    "trace": "list the moves of a program",
}


def usage() -> str:
    lines = (f"  {name:10} {summary}" for name, summary in COMMANDS.items())
    return "\n".join([f"usage: {COMMAND} COMMAND [-h] …", "", *lines])


def main(arguments: list[str]) -> int:
    """Run the command named first; return its exit code."""
    name, *rest = arguments or ["--help"]
    sys.set_int_max_str_digits(0)  # a file's number of 5,000 digits is no error of Python's
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a file's name may be no UTF-8
    try:
        try:
            return command(name, rest)
        finally:
            print(end="", flush=True)
    except KeyboardInterrupt:
        print_error(f"g12 {name}", "interrupted")
        return INTERRUPTED
    except BrokenPipeError as problem:
        if not nobody_reads():
            print_error(f"g12 {name}", problem)
            return ERROR
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return UNREAD


def module_of(name: str) -> ModuleType:
    return import_module(f"g12.tools.commands.{name}")


def command(name: str, arguments: list[str]) -> int:
    if name in ("-h", "--help"):
        print(usage())
        return 0
    if name == "--version":
        print(f"g12 {__version__}")
        return 0
    if name not in COMMANDS:
        print_error("g12", f"no command {name!r} (usage: {COMMAND} --help)")
        return ERROR
    module = module_of(name)
    options = module.command_parser().parse_args(arguments)
    try:
        return module.main(options)
    except BrokenPipeError:  # main() handles it
        raise
    except (*WRONG_USE, *FAILURES) as problem:
        print_error(f"g12 {name}", sentence_of(problem))
        return ERROR


def nobody_reads() -> bool:
    """Return whether the reader of the standard output has closed it, as ``| head`` does."""
    output = select.poll()
    output.register(sys.stdout, 0)
    return bool(output.poll(0))
