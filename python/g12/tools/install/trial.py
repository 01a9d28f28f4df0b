# SPDX-License-Identifier: GPL-2.0-or-later
"""An installation tried out: the config as it would be, loaded from a scratch folder."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from g12.ini_sections import entries_of
from g12.tools.install import features
from g12.tools.install.checking import check_config
from g12.tools.install.findings import PROBLEM, Finding
from g12.tools.install.ini_edit import IniText, other_inis
from g12.tools.install.plan import InstallPlan, Refused
from g12.tools.machine.ini import Ini, Overrides


def try_out(plan: InstallPlan) -> list[Finding]:
    """Return the warnings of `check` for the plan; refuse if it finds a problem."""
    warnings = refuse_problems(trial(plan, plan.text))
    included = [path for path in plan.changes() if path in plan.text.files]
    for other in others_including(plan.text, included):
        refuse_problems(trial(plan, other))
    return warnings


def others_including(text: IniText, changed: Sequence[Path]) -> Iterator[IniText]:
    """Yield the folder's other INIs that include a changed file, changed as it will be."""
    for other in other_inis(text):
        shared = [file for file in changed if file in other.files]
        other.files.update({file: text.files[file] for file in shared})
        if shared:
            yield other


def refuse_problems(findings: Sequence[Finding]) -> list[Finding]:
    """Return the warnings among the findings; refuse if there are problems."""
    problems = [finding for finding in findings if finding.level == PROBLEM]
    if problems:
        raise Refused(*problems)
    return list(findings)


def trial(plan: InstallPlan, text: IniText) -> list[Finding]:
    """Return what `check` finds in an INI with the plan carried out, before it is."""
    with tempfile.TemporaryDirectory(prefix="g", dir="/tmp") as scratch:
        if plan.copied:
            copy_package(Path(scratch))
        _, found = check_config(text, trial_values(plan, text.ini(), Path(scratch)))
        return found


def trial_values(plan: InstallPlan, ini: Ini, scratch: Path) -> Overrides:
    """Return the INI values that make LinuxCNC load what the plan would write.

    What is not written yet, or not up to date, stands in the folder ``scratch``.
    """
    toplevel, subs = ini.get("PYTHON", "TOPLEVEL"), ini.get("RS274NGC", "SUBROUTINE_PATH", "")
    toplevel = relocated(plan, toplevel, scratch) if toplevel else None
    prepended = [relocated(plan, name, scratch) for name in ini.all("PYTHON", "PATH_PREPEND")]
    appended = [relocated(plan, name, scratch) for name in ini.all("PYTHON", "PATH_APPEND")]
    prepended += [str(scratch / "package")] if plan.copied else []
    for path, content in trial_modules(plan, scratch):
        module = put_module(path, content, scratch / "own")
        toplevel = str(module) if path == ini.file("PYTHON", "TOPLEVEL") else toplevel
        prepended.append(str(scratch / "own"))
    folders = ":".join(relocated(plan, name, scratch) for name in subs.split(":"))
    files = [relocated(plan, name, scratch) for name in ini.all("HAL", "HALFILE")]
    paths = {"PATH_PREPEND": prepended, "PATH_APPEND": appended}
    return {
        "RS274NGC": {"SUBROUTINE_PATH": folders or None},
        "PYTHON": {"TOPLEVEL": toplevel, **paths},
        "HAL": {"HALFILE": files} if files else {},
        "FILTER": trial_filters(plan, ini, scratch),
    }


def trial_filters(plan: InstallPlan, ini: Ini, scratch: Path) -> dict[str, str]:
    """Return the lines of [FILTER] that name the copy, as they are for the trial."""
    found = {}
    for _, key, value in entries_of(ini.lines, "FILTER"):
        words = [relocated(plan, word, scratch) for word in value.split()]
        if words != value.split():
            found[key] = " ".join(words)
    return found


def relocated(plan: InstallPlan, name: str, scratch: Path) -> str:
    """Return where a file or folder that the INI names stands for the trial."""
    inside = plan.copied and f"{name}/".startswith(f"{plan.prefix}/")
    return str(scratch / name[len(plan.prefix) + 1 :]) if inside else name


def trial_modules(plan: InstallPlan, scratch: Path) -> Iterator[tuple[Path, bytes]]:
    """Yield the user's modules that change, with their content for the trial."""
    changes = plan.changes()
    for path in plan.modules:
        content = changes[path]
        if plan.copied:
            content = content.replace(f'"{plan.prefix}/'.encode(), f'"{scratch}/'.encode())
        yield path, content


def copy_package(scratch: Path) -> None:
    """Put the package into a folder; in ``package`` there it stands without other modules."""
    for part in ("ngc", "python", "configs/kinematics"):
        shutil.copytree(features.ROOT / part, scratch / part)
    (scratch / "package").mkdir()
    (scratch / "package" / "g12").symlink_to(scratch / "python" / "g12")


def put_module(path: Path, content: bytes, folder: Path) -> Path:
    """Write a module's new content into a folder, with the package that it begins."""
    target = folder / path.name
    if path.name == "__init__.py":
        target = folder / path.parent.name / path.name
        shutil.copytree(path.parent, target.parent)
    folder.mkdir(exist_ok=True)
    target.write_bytes(content)
    return target
