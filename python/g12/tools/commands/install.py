# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 install INI --with …``: install the package in a machine config.

The package is copied to the folder ``g12`` beside the INI, and the INI gets the lines for it. The
new config is loaded in the stock interpreter before any of the user's files is changed; a problem
by `check` is refused.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from g12.tools.commands.arguments import FINDING, GOOD, Parser, one_line
from g12.tools.errors import UsageError, print_error
from g12.tools.install.checking import read_config_text
from g12.tools.install.config import features
from g12.tools.install.config.findings import Refused
from g12.tools.install.installation import excluding, install
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
    parser = Parser(
        prog="g12 install",
        description="Put the package into a machine config: a copy in the folder g12 beside the\n"
        "INI, and the lines that name it. Shows what changes; keeps the old files.",
        epilog=EXAMPLES.format(features=listed),
    )
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


def ini_and_features(ini: Path | None, words: Sequence[str]) -> tuple[Path | None, list[str]]:
    """Return the INI, which may come after the features, and the features, each once."""
    if not ini and len(words) > 1 and words[-1].lower() not in features.FEATURE_NAMES:
        *words, last = words
        ini = Path(last)
    features_named = [name for word in words for name in word.lower().split(",") if name]
    return ini, list(dict.fromkeys(features_named))


def wrong_words(ini: Path | None, requested: Sequence[str]) -> str:
    """Return the fault of the command line's features, "" without one."""
    unknown = [f"no feature {name!r}" for name in requested if name not in features.FEATURE_NAMES]
    given = {"the INI": ini, "--with": requested}
    return ", ".join(unknown[:1] or [f"{name} is missing" for name in given if not given[name]])


@one_line("install")
def main(arguments: list[str]) -> int:
    parser = command_parser()
    options = parser.parse_args(arguments)
    ini, requested = ini_and_features(options.ini, options.features)
    wrong = wrong_words(ini, requested)
    if wrong:
        parser.error(wrong)
    for pair in excluding(requested):
        raise UsageError(f"{pair} exclude each other: choose one")
    values = {name: getattr(options, name) for name in ("decimals", "units")}
    numbers = "".join(f" --{name} {value}" for name, value in values.items() if value)
    if numbers and not any(name in features.CONTROLS for name in requested):
        raise UsageError(f"{numbers.split()[0]} is for --with programs-…")
    pins = read_pins(options.pins) if options.pins else None
    try:
        print_all(install(read_config_text(ini), requested, options.dry_run, pins, numbers))
    except Refused as refused:
        for finding in refused.args:
            text = f"[{finding.kind}] {finding.text}; cure: {finding.cure}"
            print_error("g12 install", text)
        return FINDING
    return GOOD
