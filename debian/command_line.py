# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of all commands as one parser, which the manual page and the completions come from."""

from __future__ import annotations

import argparse
from importlib import import_module
from unittest import mock

from g12.tools.commands import arguments
from g12.tools.commands.main import COMMANDS


class Found(BaseException):
    """Carries a command's parser out of it."""


def parser_of(module: str) -> argparse.ArgumentParser:
    """Return the parser that a command makes of itself when it is called."""

    def found(parser: argparse.ArgumentParser, *_arguments: object) -> None:
        raise Found(parser)

    typed = mock.patch.object(arguments, "CALL", "g12")
    with typed, mock.patch.object(argparse.ArgumentParser, "parse_args", found):
        try:
            import_module(module).main([])
        except Found as carried:
            return carried.args[0]
    raise LookupError(f"{module} reads no words")


def parser() -> argparse.ArgumentParser:
    """Return the parser of ``g12``."""
    whole = argparse.ArgumentParser(
        prog="g12", description="The G12 family for LinuxCNC: set it up, look at what programs do."
    )
    commands = whole.add_subparsers(dest="command", metavar="COMMAND")
    for name, (module, summary) in COMMANDS.items():
        own = parser_of(module)
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
