# SPDX-License-Identifier: GPL-2.0-or-later
"""The trial of an installation: the new config, loaded from a scratch folder."""

import re
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from g12.tools.install.checking import check_config
from g12.tools.install.config import features
from g12.tools.install.config.findings import WARNING, ConfigFinding
from g12.tools.install.config.forms import HERE
from g12.tools.install.config.ini_edit import IniText, other_inis
from g12.tools.install.plan import InstallPlan, refuse_problems
from g12.tools.machine.ini import Ini, broken_line

OTHERS_LINES = {"filter", "hal-pin", "live-spindle"}  # kinds: of lines that no plan writes
SHOWN_ONLY = {"form", "screen", "no-codes"}  # kinds that do not affect a machine's codes


def try_out(plan: InstallPlan) -> list[ConfigFinding]:
    """Return the warnings of `check` for the plan; refuse if it causes a problem.

    Another INI of the folder that includes a changed file has to load as well; forms of codes that
    it does not have are warnings.
    """
    tried = trial(plan, plan.text)
    others = [replace(each, level=WARNING) for each in tried if each.kind in OTHERS_LINES]
    warnings = others + refuse_problems([each for each in tried if each.kind not in OTHERS_LINES])
    for other, shared in others_including(plan.text, [*plan.changes()]):
        found = [of_other(each, other.path, shared) for each in trial(plan, other)]
        refuse_problems([each for each in found if each.kind not in SHOWN_ONLY | OTHERS_LINES])
        harmless = (each for each in found if each.kind in {"form", *OTHERS_LINES})
        warnings += [replace(each, level=WARNING) for each in harmless]
    return warnings


def others_including(text: IniText, changed: Sequence[Path]) -> Iterator[tuple[IniText, Path]]:
    """Yield the folder's other INIs that include a changed file, with that file."""
    for other in other_inis(text):
        shared = [file for file in changed if file in other.files]
        if shared:
            yield other, shared[0]


def of_other(finding: ConfigFinding, ini: Path, shared: Path) -> ConfigFinding:
    """Return a finding of another INI with that INI's name and why it matters."""
    text = f"{ini.name} includes {shared.name} too and gets the same lines: {finding.text}"
    cure = f"in {ini.name}: {finding.cure}; if no machine uses {ini.name}, rename it to end in .old"
    return replace(finding, text=text, cure=cure)


def trial(plan: InstallPlan, text: IniText) -> list[ConfigFinding]:
    """Return the findings of `check` in an INI with the plan applied."""
    with tempfile.TemporaryDirectory(prefix="g", dir="/tmp") as scratch:
        if plan.copied:
            link_package(Path(scratch))
        _, found = check_config(text, trial_ini(plan, text.ini(), Path(scratch)))
        return found


def trial_ini(plan: InstallPlan, ini: Ini, scratch: Path) -> Ini:
    """Return the INI that makes LinuxCNC load the plan's files.

    Files that are not written yet, or not up to date, are in the folder ``scratch``.
    """
    if plan.copied:
        ini = replace(ini, lines=tuple(relocated(ini.lines, plan.prefix, scratch)))
    python, changes = {}, plan.changes()
    prepended = ini.all("PYTHON", "PATH_PREPEND") + [str(scratch / "package")] * plan.copied
    for path in plan.modules:
        content = changes[path]
        if plan.copied:
            content = content.replace(f'"{plan.prefix}/'.encode(), f'"{scratch}/'.encode())
        module = put_module(path, content, scratch / "own")
        if path == ini.file("PYTHON", "TOPLEVEL"):
            python["TOPLEVEL"] = str(module)
        prepended.append(str(scratch / "own"))
    return ini.replaced({"PYTHON": {**python, "PATH_PREPEND": prepended}})


def relocated(lines: Sequence[str], prefix: str, scratch: Path) -> Iterator[str]:
    """Yield an INI's lines with another folder instead of the copy's."""
    copy = re.compile(rf"(?<![^\s:=])(\./|{HERE}/)?{re.escape(prefix)}(?=[/\s:]|$)")
    for line in lines:
        moved = copy.sub(str(scratch), line)
        yield from [line] if moved == line else broken_line(moved)


def link_package(scratch: Path) -> None:
    """Link the package into a folder, and alone into ``package`` there."""
    for part in ("ngc", "python", "configs"):
        (scratch / part).symlink_to(features.ROOT / part)
    (scratch / "package").mkdir()
    (scratch / "package" / "g12").symlink_to(features.ROOT / "python" / "g12")


def put_module(path: Path, content: bytes, folder: Path) -> Path:
    """Write a module's new content into a folder, with the package that it begins."""
    target = folder / path.name
    if path.name == "__init__.py":
        target = folder / path.parent.name / path.name
        shutil.copytree(path.parent, target.parent)
    folder.mkdir(exist_ok=True)
    target.write_bytes(content)
    return target
