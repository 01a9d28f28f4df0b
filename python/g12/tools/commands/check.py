# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 check INI``: check the package's installation in a machine config.

The config is read the way LinuxCNC reads it and loaded in the stock interpreter.
"""

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from g12.tools.commands.arguments import FINDING, GOOD, Parser, one_line
from g12.tools.install.config import features
from g12.tools.install.config.findings import PROBLEM, ConfigFinding
from g12.tools.install.config.ini_edit import read_config_text
from g12.tools.install.config.loaded import Config, filters_of, load_config
from g12.tools.install.rules import findings_of

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
    config = load_config(read_config_text(options.ini))
    report = report_of(config, findings_of(config))
    print(json.dumps(report, indent=2) if options.json else "\n".join(lines_of(report)))
    return FINDING if any(each["level"] == PROBLEM for each in report["findings"]) else GOOD


def report_of(config: Config, found: list[ConfigFinding]) -> dict:
    return {
        "ini": str(config.text.path),
        "linuxcnc": config.version,
        "loads": config.failure is None,
        "axes": list(config.ini.axes),
        "codes": [
            {"code": code.remap.code, "feature": code.feature, "line": code.line.location}
            for code in config.codes
        ],
        "programs": {each.suffix: each.control for each in filters_of(config) if each.control},
        "findings": [asdict(finding) for finding in found],
    }


def lines_of(report: dict) -> Iterator[str]:
    """Yield a report as text."""
    loads = "loads" if report["loads"] else "does not load"
    axes = " ".join(report["axes"])
    yield f"{report['ini']}: {loads} in LinuxCNC {report['linuxcnc']}, axes {axes}"
    for code in report["codes"]:
        meaning = features.MEANING[code["feature"]]
        yield f"  {code['code']:6} {code['feature']:12} {meaning} ({code['line']})"
    for suffix, control in report["programs"].items():
        yield f"  .{suffix:5} programs of {control}"
    for finding in report["findings"]:
        yield f"{finding['level']} [{finding['kind']}]: {finding['text']}"
        yield f"  cure: {finding['cure']}"
    if not report["findings"]:
        yield "nothing found"
