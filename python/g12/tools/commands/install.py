# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 install INI --with …``: install the package in a machine config.

The package is copied to the folder ``g12`` beside the INI, and the INI gets the lines for it. The
new config is loaded in the stock interpreter before any of the user's files is changed; a problem
by `check` is refused.
"""

import argparse
from pathlib import Path
from typing import Any

from g12.tools.commands.arguments import FINDING, GOOD, Parser
from g12.tools.errors import UsageError, print_error
from g12.tools.install.config import features
from g12.tools.install.config.findings import Refused
from g12.tools.install.config.ini_edit import read_config_text
from g12.tools.install.installation import install
from g12.tools.install.lathe.spindle_c import read_pins
from g12.tools.progress import print_all

EXAMPLES = """\
features:
{features}

examples:
  g12 install ~/linuxcnc/configs/mill/mill.ini --with haas circle-mill
  g12 install lathe.ini --with polar --dry-run
  g12 install lathe.ini --with polar programs-fanuc-lathe --decimals least
  g12 install lathe.ini --with polar polar-kinematics

exit code: 0 done or nothing to do, 1 refused, 2 wrong use"""


def command_parser() -> Parser:
    listed = "\n".join(f"  {name:24} {meaning}" for name, meaning in features.MEANING.items())
    text = (
        "Put the package into a machine config: a copy in the folder g12 beside the\n"
        "INI, and the lines that name it. Shows what changes; keeps the old files."
    )
    parser = Parser("g12 install", text, EXAMPLES.format(features=listed))
    parser.add_argument("ini", nargs="?", type=Path, help="INI file of the machine")
    words: dict[str, Any] = {"dest": "features", "nargs": "+", "default": [], "metavar": "FEATURE"}
    parser.add_argument("--with", **words, help="what to install (see below)")
    parser.add_argument("--pins", type=Path, metavar="TOML", help="inputs of the drive: spindle-c")
    reading = "of programs-…: what numbers without a decimal point are"
    parser.add_argument("--decimals", choices=("least", "whole"), help=reading)
    units = "of programs-…: units of a program that says neither G20 nor G21"
    parser.add_argument("--units", choices=("inch", "mm"), help=units)
    parser.add_argument("--dry-run", action="store_true", help="show the changes only")
    return parser


def main(options: argparse.Namespace) -> int:
    ini, requested = options.ini, options.features
    if not ini and requested[1:] and requested[-1] not in features.FEATURE_NAMES:
        *requested, ini = requested  # the INI may come last
    unknown = [name for name in requested if name not in features.FEATURE_NAMES]
    if unknown:
        command_parser().error(f"no feature {unknown[0]!r}")
    missing = [name for name, given in (("the INI", ini), ("--with", requested)) if not given]
    if missing:
        command_parser().error(", ".join(f"{name} is missing" for name in missing))
    values = {name: getattr(options, name) for name in ("decimals", "units")}
    of_translate = "".join(f" --{name} {value}" for name, value in values.items() if value)
    if of_translate and features.CONTROLS.keys().isdisjoint(requested):
        raise UsageError(f"{of_translate.split()[0]} is for --with programs-…")
    pins = read_pins(options.pins) if options.pins else None
    text = read_config_text(Path(ini))
    try:
        print_all(install(text, requested, options.dry_run, pins, of_translate))
    except Refused as refused:
        for finding in refused.args:
            said = f"[{finding.kind}] {finding.text}; cure: {finding.cure}"
            print_error("g12 install", said)
        return FINDING
    return GOOD
