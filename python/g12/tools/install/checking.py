# SPDX-License-Identifier: GPL-2.0-or-later
"""The check of a machine config: loaded as LinuxCNC does it, findings, report."""

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.install.config import features
from g12.tools.install.config.filters import translating_filters
from g12.tools.install.config.findings import ConfigFinding
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import Config, load_config
from g12.tools.install.config.screen import forms_shown
from g12.tools.install.rules import findings_of
from g12.tools.machine.files import existing
from g12.tools.machine.ini import Ini


def read_config_text(ini: Path) -> IniText:
    """Return the INI; refuse a file that is none."""
    existing(ini)
    if ini.suffix == ".expanded":
        raise UsageError(f"{ini}: LinuxCNC makes this file anew at every start; name {ini.stem}")
    text = IniText(ini)
    if not text.section("RS274NGC"):
        raise UsageError(f"{ini}: no [RS274NGC] section: this is no machine's INI file")
    return text


def check_config(text: IniText, ini: Ini | None = None) -> tuple[Config, list[ConfigFinding]]:
    """Return the config of an INI and the findings about it, as `load_config` loads it."""
    config = load_config(text, ini)
    return config, findings_of(config)


def check_report(config: Config, found: list[ConfigFinding]) -> dict:
    return {
        "ini": str(config.text.path),
        "linuxcnc": config.version,
        "loads": config.failure is None,
        "python_loads": not (config.python and config.python.error),
        "axes": list(config.ini.axes),
        "codes": [
            {"code": code.remap.code, "feature": code.feature, "line": code.line.location}
            for code in config.codes
        ],
        "programs": {suffix: control for suffix, _, control in translating_filters(config)},
        "forms": forms_shown(config),
        "findings": [asdict(finding) for finding in found],
    }


def lines_of_check(report: dict) -> Iterator[str]:
    loads = "loads" if report["loads"] else "does not load"
    python = "" if report["python_loads"] else " without its [PYTHON]"
    axes = " ".join(report["axes"])
    yield f"{report['ini']}: {loads} in LinuxCNC {report['linuxcnc']}{python}, axes {axes}"
    for code in report["codes"]:
        meaning = features.MEANING[code["feature"]]
        yield f"  {code['code']:6} {code['feature']:12} {meaning} ({code['line']})"
    programs = report["programs"]
    for control in dict.fromkeys(programs.values()):
        suffixes = " ".join(f".{suffix}" for suffix, of in programs.items() if of == control)
        yield f"  {suffixes:6} {'programs':12} {control}"
    for form in report["forms"]:
        yield f"  {'':6} {'form':12} {form}"
    for finding in report["findings"]:
        yield f"{finding['level']} [{finding['kind']}]: {finding['text']}"
        yield f"  cure: {finding['cure']}"
    if not report["findings"]:
        yield "nothing found"
