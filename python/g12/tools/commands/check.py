# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 check INI``: is the package in this machine config as it should be, and if not, why not.

The config is read the way LinuxCNC reads it and loaded in the stock interpreter.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from g12.ini_sections import entries_of
from g12.settings import SECTION, TABLE
from g12.tools.commands.arguments import FINDING, GOOD, Parser, one_line
from g12.tools.errors import UsageError
from g12.tools.install import features
from g12.tools.install.config import Config, load_config, remaps_in
from g12.tools.install.ini_edit import IniText
from g12.tools.install.rules import NOTE, Finding, codes_of, findings_of
from g12.tools.machine.files import existing

EXAMPLES = """\
examples:
  python3 python/g12 check ~/linuxcnc/configs/mill/mill.ini
  python3 python/g12 check mill.ini --json

exit code: 0 good, 1 something found, 2 wrong use"""


def check(text: IniText) -> tuple[Config, list[Finding]]:
    """Return the config of an INI and what there is to say about it."""
    codes = {code.remap.code for code in codes_of(remaps_in(text))}
    config = load_config(text, codes)
    return config, findings_of(config)


# What is printed.


def settings_of(config: Config) -> dict[str, str]:
    """Return the settings that section [G12] changes."""
    entries = entries_of(config.ini.lines, SECTION)
    return {key: value for _, key, value in entries if key in TABLE}


def report(config: Config, found: list[Finding]) -> dict:
    """Return everything `check` says, for a program to read."""
    codes = codes_of(config.remaps)
    mine = {code.line for code in codes}
    others = [remap for line, remap in config.remaps if line not in mine]
    return {
        "ini": str(config.text.path),
        "linuxcnc": config.version,
        "loads": config.failure is None,
        "axes": list(config.ini.axes),
        "codes": [
            {"code": code.remap.code, "feature": code.feature, "line": code.line.place}
            for code in codes
        ],
        "other_remaps": {remap.code: remap.text for remap in others},
        "settings": settings_of(config),
        "findings": [asdict(finding) for finding in found],
    }


def lines_of(said: dict) -> Iterator[str]:
    """Yield the report for a person."""
    loads = "loads" if said["loads"] else "does not load"
    yield f"{said['ini']}: {loads} in LinuxCNC {said['linuxcnc']}, axes {' '.join(said['axes'])}"
    for code in said["codes"]:
        meaning = features.MEANING[code["feature"]]
        yield f"  {code['code']:6} {code['feature']:12} {meaning} ({code['line']})"
    for code, text in said["other_remaps"].items():
        yield f"  {code:6} {'not ours':12} REMAP = {text}"
    for key, value in said["settings"].items():
        yield f"  [{SECTION}] {key} = {value}"
    for finding in said["findings"]:
        yield f"{finding['level']} [{finding['kind']}]: {finding['text']}"
        yield f"  cure: {finding['cure']}"
    if not said["findings"]:
        yield "nothing found"


def readable(ini: Path) -> IniText:
    """Return the INI, or refuse what is no INI file."""
    existing(ini)
    if ini.suffix == ".expanded":
        raise UsageError(f"{ini}: LinuxCNC makes this file anew at every start; name {ini.stem}")
    text = IniText(ini)
    if not text.section("RS274NGC"):
        raise UsageError(f"{ini}: no [RS274NGC] section: this is no machine's INI file")
    return text


@one_line("check")
def main(arguments: list[str]) -> int:
    """Run the command."""
    parser = Parser(
        prog="g12 check",
        description="Check whether and how the package is set up in a machine config.",
        epilog=EXAMPLES,
    )
    parser.add_argument("ini", type=Path, help="INI file of the machine")
    parser.add_argument("--json", action="store_true", help="the report as JSON")
    asked = parser.parse_args(arguments)
    config, found = check(readable(asked.ini))
    said = report(config, found)
    print(json.dumps(said, indent=2) if asked.json else "\n".join(lines_of(said)))
    return FINDING if any(finding.level != NOTE for finding in found) else GOOD
