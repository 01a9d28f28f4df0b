# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of all commands as one parser, which the manual page and the completions come from."""

import argparse

from g12.tools.commands.main import COMMANDS, module_of
from g12.tools.system import COMMAND


def parser() -> argparse.ArgumentParser:
    """Return the parser of ``g12``."""
    whole = argparse.ArgumentParser(
        prog="g12", description="The G12 family for LinuxCNC: set it up, look at what programs do."
    )
    commands = whole.add_subparsers(dest="command", metavar="COMMAND")
    for name, summary in COMMANDS.items():
        own = named_as_installed(module_of(name).command_parser())
        commands.add_parser(
            name,
            help=summary,
            description=own.description,
            epilog=own.epilog,
            formatter_class=own.formatter_class,
            parents=[own],
            add_help=False,
        )
    return whole


def named_as_installed(parser: argparse.ArgumentParser) -> argparse.ArgumentParser:
    """Return a command's parser, and those below it, with ``g12`` for what is typed here."""
    parser.prog = parser.prog.replace(COMMAND, "g12")
    parser.epilog = (parser.epilog or "").replace(COMMAND, "g12")
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                named_as_installed(below)
    return parser
