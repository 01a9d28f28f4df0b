# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 uninstall INI``: remove from a machine config exactly what `install` added.

The copy of the package, and lines in included files, stay until the last INI of a folder that uses
them is uninstalled.
"""

import argparse
from pathlib import Path

from g12.tools.commands.arguments import GOOD, Parser
from g12.tools.install.config.ini_edit import read_config_text
from g12.tools.install.installation import uninstall
from g12.tools.progress import print_all

EXAMPLES = """\
example:
  g12 uninstall ~/linuxcnc/configs/mill/mill.ini

exit code: 0 done or nothing to do, 2 wrong use"""


def command_parser() -> Parser:
    text = "Take out of a machine config what install put in, and nothing else."
    parser = Parser("g12 uninstall", text, EXAMPLES)
    parser.add_argument("ini", type=Path, help="INI file of the machine")
    parser.add_argument("--dry-run", action="store_true", help="show the changes only")
    return parser


def main(options: argparse.Namespace) -> int:
    print_all(uninstall(read_config_text(options.ini), options.dry_run))
    return GOOD
