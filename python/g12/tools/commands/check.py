# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 check INI``: check the package's installation in a machine config.

The config is read the way LinuxCNC reads it and loaded in the stock interpreter.
"""

import json
from pathlib import Path

from g12.tools.commands.arguments import FINDING, GOOD, Parser, one_line
from g12.tools.install.checking import (
    check_config,
    check_report,
    lines_of_check,
    read_config_text,
)
from g12.tools.install.config.findings import PROBLEM

EXAMPLES = """\
examples:
  g12 check ~/linuxcnc/configs/mill/mill.ini
  g12 check mill.ini --json

exit code: 0 good, warnings and notes included, 1 a problem, 2 wrong use"""


def command_parser() -> Parser:
    parser = Parser(
        prog="g12 check",
        description="Check whether and how the package is set up in a machine config.",
        epilog=EXAMPLES,
    )
    parser.add_argument("ini", type=Path, help="INI file of the machine")
    parser.add_argument("--json", action="store_true", help="the report as JSON")
    return parser


@one_line("check")
def main(arguments: list[str]) -> int:
    options = command_parser().parse_args(arguments)
    config, found = check_config(read_config_text(options.ini))
    report = check_report(config, found)
    print(json.dumps(report, indent=2) if options.json else "\n".join(lines_of_check(report)))
    return FINDING if any(finding.level == PROBLEM for finding in found) else GOOD
