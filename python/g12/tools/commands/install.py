# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 install INI --with …``: put the package into a machine config.

The folder ``g12`` beside the INI gets a copy of the package, the INI the lines that name it. The
new config is loaded in the stock interpreter before anything of the user's is changed; what
`check` calls a problem is refused.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from g12.tools.commands.arguments import FINDING, GOOD, Parser, one_line
from g12.tools.commands.check import readable
from g12.tools.errors import UsageError
from g12.tools.install import features, package_copy
from g12.tools.install.config import Config, load_config, remaps_in
from g12.tools.install.ini_edit import IniText, other_inis
from g12.tools.install.plan import Plan, Refused, make_plan, names_copy, refuse
from g12.tools.install.rules import PROBLEM, Finding, codes_of, findings_of
from g12.tools.machine.files import back_up, difference, drop_backup, require_writable, write_all
from g12.tools.machine.ini import Overrides
from g12.tools.progress import print_all

BEFORE = {"no-linuxcnc", "python-fails", "does-not-load"}  # what keeps a config from being read
EXAMPLES = """\
features:
{features}

examples:
  python3 python/g12 install ~/linuxcnc/configs/mill/mill.ini --with haas circle-mill
  python3 python/g12 install lathe.ini --with polar --dry-run

exit code: 0 done or nothing to do, 1 refused, 2 wrong use"""


def trial(plan: Plan, text: IniText) -> list[Finding]:
    """Return what `check` finds in an INI with the plan carried out, before it is."""
    with tempfile.TemporaryDirectory(prefix="g", dir="/tmp") as scratch:
        codes = {code.remap.code for code in codes_of(remaps_in(text))}
        overlay = trial_values(plan, text, Path(scratch))
        return findings_of(load_config(text, codes, overlay))


def trial_values(plan: Plan, text: IniText, scratch: Path) -> Overrides:
    """Return the INI values that make LinuxCNC load what the plan would write.

    What is not written yet, or not up to date, stands in the folder ``scratch``.
    """
    ini, modules = text.ini(), []
    if plan.copied:
        copy_package(scratch)
        modules.append(str(scratch / "package"))

    def now(name: str) -> str:
        inside = plan.copied and f"{name}/".startswith(f"{plan.prefix}/")
        return str(scratch / name[len(plan.prefix) + 1 :]) if inside else name

    toplevel, subs = ini.get("PYTHON", "TOPLEVEL"), ini.get("RS274NGC", "SUBROUTINE_PATH")
    toplevel = now(toplevel) if toplevel else None
    for path in plan.modules:
        content = plan.changes()[path]
        if plan.copied:
            content = content.replace(f'"{plan.prefix}/'.encode(), f'"{scratch}/'.encode())
        module = put_module(path, content, scratch / "own")
        toplevel = str(module) if path == ini.file("PYTHON", "TOPLEVEL") else toplevel
        modules.append(str(scratch / "own"))
    paths = {
        "PATH_PREPEND": [*map(now, ini.all("PYTHON", "PATH_PREPEND")), *modules],
        "PATH_APPEND": [*map(now, ini.all("PYTHON", "PATH_APPEND"))],
    }
    folders = ":".join(map(now, subs.split(":"))) if subs else None
    return {"RS274NGC": {"SUBROUTINE_PATH": folders}, "PYTHON": {"TOPLEVEL": toplevel, **paths}}


def copy_package(scratch: Path) -> None:
    """Put the package into a folder; in ``package`` there it stands without other modules."""
    for part in ("ngc", "python"):
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


def refuse_problems(findings: Sequence[Finding]) -> list[Finding]:
    """Return the warnings among the findings; refuse if there are problems."""
    problems = [finding for finding in findings if finding.level == PROBLEM]
    if problems:
        raise Refused(*problems)
    return list(findings)


def others_including(text: IniText, changed: Sequence[Path]) -> Iterator[IniText]:
    """Yield the folder's other INIs that include a changed file, changed as it will be."""
    for other in other_inis(text):
        shared = [file for file in changed if file in other.files]
        other.files.update({file: text.files[file] for file in shared})
        if shared:
            yield other


def try_out(plan: Plan) -> list[Finding]:
    """Return the warnings of `check` for the plan; refuse if it finds a problem."""
    warnings = refuse_problems(trial(plan, plan.text))
    included = [path for path in plan.changes() if path in plan.text.files]
    for other in others_including(plan.text, included):
        refuse_problems(trial(plan, other))
    return warnings


def carry_out(plan: Plan, folder: Path) -> list[str]:
    """Write everything; return what was done, a line each."""
    changes, copy = plan.changes(), folder / package_copy.NAME
    require_writable(changes)
    fresh, kept = plan.copied and not copy.exists(), {}
    try:
        done = bring_copy_up_to_date(copy) if plan.copied else []
        for path in changes:
            if not is_marked(path):
                kept[path] = back_up(path)
        write_all(changes)
    except BaseException:
        take_back(kept, copy if fresh else None)
        raise
    for path in changes:
        before = f"; as it was: {kept[path].name}" if path in kept else ""
        done.append(f"{path}: changed{before}")
    return done


def take_back(kept: Iterable[Path], copy: Path | None) -> None:
    """Take away what an installation that failed has written: old versions, a new copy."""
    for path in kept:
        drop_backup(path)
    if copy and copy.exists():
        shutil.rmtree(copy)


def bring_copy_up_to_date(copy: Path) -> list[str]:
    """Write what is new of the package; return what was done, a line each."""
    if not out_of_date(copy):
        return []
    aside = package_copy.write_copy(copy)
    kept = [f"{copy / name}: your version, kept beside the new one" for name in aside]
    return [f"{copy}: the package, {len(package_copy.package_files())} files", *kept]


def out_of_date(copy: Path) -> bool:
    """Tell whether a copy lacks files of this package; from inside itself it cannot be mended."""
    if not copy.exists() or not copy.samefile(features.ROOT):
        return bool(package_copy.stale(copy))
    for name in package_copy.missing(copy):
        raise UsageError(f"{copy / name}: is missing; run install from the package itself, "
                         "not from this copy of it")  # fmt: skip
    return False


def lost_files(text: IniText) -> list[str]:
    """Return what is missing of the copy that the config's lines name."""
    copy = text.path.parent / package_copy.NAME
    if copy.exists():
        return package_copy.missing(copy)
    return list(package_copy.package_files()) if names_copy(text) else []


def is_marked(path: Path) -> bool:
    """Tell whether a file has lines of an earlier installation, and so a kept old version."""
    return b"by g12 install" in path.read_bytes() or b">>> g12 install" in path.read_bytes()


def readable_config(text: IniText) -> Config:
    """Return the config as it is; refuse one that LinuxCNC cannot load."""
    config = load_config(text, set())
    refuse_problems([finding for finding in findings_of(config) if finding.kind in BEFORE])
    return config


def install(text: IniText, wanted: Sequence[str], dry_run: bool) -> Iterator[str]:
    """Install features in a machine config; yield what is shown."""
    lost = lost_files(text)
    if lost:
        yield f"{text.path.parent / package_copy.NAME}: {len(lost)} of its files are missing"
        if dry_run:
            yield "dry run: nothing was written; without these files nothing more can be told"
            return
        yield from bring_copy_up_to_date(text.path.parent / package_copy.NAME)
    config = readable_config(text)
    there = [code.feature for code in codes_of(config.remaps)]
    for pair in excluding([*there, *wanted]):
        raise refuse("dialects", f"{pair} exclude each other", "uninstall first")
    plan = make_plan(config, wanted)
    changes = plan.changes()
    old_copy = plan.copied and out_of_date(config.folder / package_copy.NAME)
    if not changes and not old_copy:
        yield f"{text.path}: {', '.join(wanted)}: installed already, nothing to do"
        return
    warnings = try_out(plan)
    for path, content in changes.items():
        yield from difference(path, content)
    if dry_run:
        yield "dry run: nothing was written"
        return
    yield from carry_out(plan, config.folder)
    for warning in warnings:
        yield f"{warning.level} [{warning.kind}]: {warning.text}; cure: {warning.cure}"


def excluding(names: Sequence[str]) -> Iterator[str]:
    """Yield the features that exclude each other, in words."""
    for group in features.ONE_OF:
        chosen = [name for name in group if name in names]
        if len(chosen) > 1:
            yield " and ".join(chosen)


def parser() -> Parser:
    """Return the command line's parser."""
    listed = "\n".join(f"  {name:12} {meaning}" for name, meaning in features.MEANING.items())
    result = Parser(
        prog="g12 install",
        description="Put the package into a machine config: a copy in the folder g12 beside the "
        "INI, and the lines that name it. Shows what changes; keeps the old files.",
        epilog=EXAMPLES.format(features=listed),
    )
    result.add_argument("ini", nargs="?", type=Path, help="INI file of the machine")
    result.add_argument(
        "--with",
        dest="wanted",
        nargs="+",
        required=True,
        metavar="FEATURE",
        help="what to install (see below)",
    )
    result.add_argument("--dry-run", action="store_true", help="show the changes only")
    return result


def named(ini: Path | None, words: Sequence[str]) -> tuple[Path | None, list[str]]:
    """Return the INI, which may stand behind the features, and the features, each once."""
    if not ini and len(words) > 1:
        *words, last = words
        ini = Path(last)
    features_named = [name for word in words for name in word.lower().split(",") if name]
    return ini, list(dict.fromkeys(features_named))


@one_line("install")
def main(arguments: list[str]) -> int:
    """Run the command."""
    words = parser()
    asked = words.parse_args(arguments)
    ini, wanted = named(asked.ini, asked.wanted)
    unknown = [name for name in wanted if name not in features.FILES]
    if not ini or unknown:
        known = f"{unknown[0]!r} is none of {', '.join(features.FILES)}" if unknown else ""
        words.error(known or "the INI is missing")
    for pair in excluding(wanted):
        raise UsageError(f"{pair} exclude each other: choose one")
    try:
        print_all(install(readable(ini), wanted, asked.dry_run))
    except Refused as refused:
        for finding in refused.args:
            said = f"[{finding.kind}] {finding.text}; cure: {finding.cure}"
            print(f"g12 install: {said}", file=sys.stderr)
        return FINDING
    return GOOD
