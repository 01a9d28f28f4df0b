# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 check INI``: check the package's installation in a machine config.

The config is read the way LinuxCNC reads it and loaded in the stock interpreter.
"""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

from g12.tools.commands.arguments import FINDING, GOOD, Parser
from g12.tools.install.config.features import MEANING
from g12.tools.install.config.findings import PROBLEM, ConfigFinding
from g12.tools.install.config.ini_edit import read_config_text
from g12.tools.install.config.loaded import Config, filters_of, load_config
from g12.tools.install.rules import findings_of

EXAMPLES = """\
example:
  g12 check ~/linuxcnc/configs/mill/mill.ini

exit code: 0 good, warnings and notes included, 1 a problem, 2 wrong use"""


def command_parser() -> Parser:
    text = "Check whether and how the package is set up in a machine config."
    parser = Parser("g12 check", text, EXAMPLES)
    parser.add_argument("ini", type=Path, help="INI file of the machine")
    return parser


def main(options: argparse.Namespace) -> int:
    config = load_config(read_config_text(options.ini))
    found = findings_of(config)
    print("\n".join(report_of(config, found)))
    return FINDING if any(finding.level == PROBLEM for finding in found) else GOOD


def report_of(config: Config, found: Sequence[ConfigFinding]) -> Iterator[str]:
    loads = "does not load" if config.failure else "loads"
    axes = " ".join(config.ini.axes)
    yield f"{config.text.path}: {loads} in LinuxCNC {config.version}, axes {axes}"
    for code in config.codes:
        meaning = f"{MEANING[code.feature]} ({code.line.location})"
        yield f"  {code.remap.code:6} {code.feature:12} {meaning}"
    for suffix, _, call in filters_of(config):
        if call["control"]:
            yield f"  .{suffix:5} programs of {call['control']}"
    for finding in found:
        yield f"{finding.level} [{finding.kind}]: {finding.text}"
        yield f"  cure: {finding.cure}"
    if not found:
        yield "nothing found"
