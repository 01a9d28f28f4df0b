# SPDX-License-Identifier: GPL-2.0-or-later
"""The changes of an installation in a machine config: INI lines and the user's Python modules.

The INI gets blocks between two marker comments. A comment there lists the insertions elsewhere, so
that `uninstall` finds them: an entry of SUBROUTINE_PATH (LinuxCNC 2.9 reads one such line only) and
import lines in the user's own modules.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from g12.settings import INI_SECTION as SETTINGS
from g12.tools.install import package_copy
from g12.tools.install.config import features, filters, forms, screen
from g12.tools.install.config.findings import PROBLEM, ConfigFinding, problem
from g12.tools.install.config.ini_edit import (
    BEGIN_MARK,
    END_MARK,
    NOW,
    IniLine,
    IniText,
    InsertionPoint,
    line_end,
    lines_with_ends,
    to_bytes,
)
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.install.lathe import kinematics_lines, spindle_c
from g12.tools.install.lathe.kinematics_rules import uses_face_kinematics
from g12.tools.install.lathe.rules import ON_A_LATHE, geometry_for
from g12.tools.install.rules import IMPORT_HANDLERS, odd_folder
from g12.tools.translate.blocks.control import Control, read_control

BEGIN_LINE = f"{BEGIN_MARK} (g12 uninstall takes these lines out again)"
BLOCK_NOTE = "# also by g12 install: "
PATH_NOTE = " at the end of SUBROUTINE_PATH"
MODULE_NOTE = "a line in "
MODULE_MARK = "  # by g12 install"
NAMES_COPY = re.compile(
    rf"\s*(#INCLUDE\s+|[^\s#;].*[=:\s])(\./|{forms.HERE}/)?{package_copy.NAME}/"
)
IMPORT_REMAP = "import remap"


class Refused(Exception):
    """The installation is refused; ``args`` are the findings."""


def refuse(kind: str, text: str, cure: str) -> Refused:
    """Return the refusal for one reason, for the caller to raise."""
    return Refused(problem(kind, text, cure))


def refuse_problems(findings: Sequence[ConfigFinding]) -> list[ConfigFinding]:
    """Return the warnings among the findings; refuse if there are problems."""
    problems = [finding for finding in findings if finding.level == PROBLEM]
    if problems:
        raise Refused(*problems)
    return list(findings)


@dataclass
class InstallPlan:
    """The changes of an installation, not written yet.

    ``text`` is the edited INI with its includes, ``modules`` are the user's own Python modules with
    the lines added. ``prefix`` is the package's folder as the INI names it; ``copied``: it is the
    copy that `install` makes. ``numbers`` are the options of `translate` for units and numbers
    without a decimal point. ``added`` are the lines for each section.
    """

    config: Config
    requested: Sequence[str]
    text: IniText
    prefix: str
    copied: bool
    numbers: str = ""
    modules: dict[Path, list[str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    added: dict[str, list[str]] = field(default_factory=lambda: {"RS274NGC": []})

    @property
    def codes(self) -> list[str]:
        return [feature for feature in self.requested if feature in features.REMAP_FILES]

    def add(self, lines_of: Mapping[str, Iterable[str]]) -> None:
        """Add lines to sections."""
        for section, lines in lines_of.items():
            self.added.setdefault(section, []).extend(lines)

    def is_ours(self, line: IniLine) -> bool:
        """Return whether an earlier installation wrote a line of the INI."""
        return any(line in block for block in self.text.blocks())

    def changes(self) -> dict[Path, bytes]:
        """Return the user's files that change and their new content, that with the codes last."""
        modules = {path: with_lines(path, new) for path, new in self.modules.items()}
        files = {**modules, **self.text.contents()}
        return {path: content for path, content in files.items() if content != path.read_bytes()}


def with_lines(path: Path, new: Sequence[str]) -> bytes:
    """Return a module's content with lines at its end."""
    lines = lines_with_ends(path)
    end = line_end(lines)
    ended = not lines or lines[-1].endswith("\n")
    return to_bytes([*lines, *(text + end if ended else end + text for text in new)])


def marked(path: Path, statement: str) -> bool:
    """Return whether an earlier installation added a statement to a module."""
    return any(line.rstrip().endswith(statement + MODULE_MARK) for line in lines_with_ends(path))


def make_plan(
    config: Config, requested: Sequence[str], pins: spindle_c.Pins | None = None, numbers: str = ""
) -> InstallPlan:
    prefix, copied = package_folder(config)
    plan = InstallPlan(config, requested, IniText(config.text.path), prefix, copied, numbers)
    update_remaps(plan)
    if plan.codes:
        add_python(plan)
        add_subroutines(plan)
        plan.add({"RS274NGC": [f"REMAP = {remap.text}" for remap in new_remaps(plan)]})
    add_abort_command(plan)
    add_filter(plan)
    add_kinematics(plan)
    add_spindle(plan, pins)
    add_forms(plan)
    add_face_view(plan)
    add_geometry(plan)
    noted = {line.text for block in plan.text.blocks() for line in block}
    plan.added["RS274NGC"][:0] = [note for note in plan.notes if note not in noted]
    for section, lines in plan.added.items():
        put_section(plan.text, section, lines)
    for path in plan.changes():
        require_inside(config, path)
    return plan


def update_remaps(plan: InstallPlan) -> None:
    """Update the REMAP lines of an older `install`."""
    for line, remap in plan.config.remaps:
        found = features.model_of(remap) if plan.is_ours(line) else None
        if found and found[1].keywords != remap.keywords:
            plan.text.replace(line, remap.like(found[1]))


def names_copy(text: IniText) -> list[IniLine]:
    """Return the lines of an INI that need the copy, by `install` or by hand."""
    here = text.path.parent
    found = [line for line in text.lines() if NAMES_COPY.match(line.text)]
    for line in (line for block in text.blocks() for line in block):
        module = here / line.text.removeprefix(f"{BLOCK_NOTE}{MODULE_NOTE}")
        if line.text.startswith(f"{BLOCK_NOTE}{MODULE_NOTE}") and module.is_file():
            found += [line] * (f'"{package_copy.NAME}/python"' in "".join(lines_with_ends(module)))
    return found


def put_section(text: IniText, section: str, lines: Sequence[str]) -> None:
    """Insert lines into a section, between the markers; a new one goes into [RS274NGC]'s file.

    In an included file that is before a header, where it divides no other section.
    """
    if not lines:
        return
    point = text.end_of_section(section)
    if not point:
        lines = [f"[{section}]", *lines]
        point = InsertionPoint(text.path, len(text.files[text.path]))
        if text.end_of_section("RS274NGC").file != text.path:
            header = text.headers("RS274NGC")[0]
            point = InsertionPoint(header.file, header.row)
    text.insert(point, [BEGIN_LINE, *lines, END_MARK])


def package_folder(config: Config) -> tuple[str, bool]:
    """Return the package's folder as the INI names it, and whether it is `install`'s copy."""
    own = config.folder / package_copy.NAME
    package = config.python.package.parent.parent if config.python.package else None
    if package and not package_copy.is_copy(package):
        return name_in_ini(config, package), False
    if package_copy.is_copy(own):
        return package_copy.NAME, True
    if features.ROOT.is_relative_to(config.folder.resolve()):
        return name_in_ini(config, features.ROOT), False
    if not own.exists():
        return package_copy.NAME, True
    if package_copy.is_package(own):
        return package_copy.NAME, False
    raise refuse(
        "folder",
        f"{own} is there already, and is not this package",
        "rename that folder; what you had changed in an earlier copy can go into the new one",
    )


def name_in_ini(config: Config, folder: Path) -> str:
    """Return a folder's name for the INI: relative if it is inside the config's folder."""
    folder, here = folder.resolve(), config.folder.resolve()
    return folder.relative_to(here).as_posix() if folder.is_relative_to(here) else str(folder)


def new_remaps(plan: InstallPlan) -> list[features.Remap]:
    present = [(remap.number, features.own_names(remap)) for _, remap in plan.config.remaps]
    return [
        remap
        for feature in plan.codes
        for remap in features.remaps_of(feature)
        if not any(
            number == remap.number and names & features.own_names(remap)
            for number, names in present
        )
    ]


def add_subroutines(plan: InstallPlan) -> None:
    """Add the package's folder to SUBROUTINE_PATH, or that line."""
    name, ini = f"{plan.prefix}/ngc", plan.config.ini
    refuse_problems([*odd_folder(folder_from_ini(ini, name))])
    entries = plan.text.entries("RS274NGC", "SUBROUTINE_PATH")
    if not entries:
        plan.add({"RS274NGC": [f"SUBROUTINE_PATH = {name}"]})
        return
    line, value = entries[0]
    folders = {folder_from_ini(ini, folder) for folder in value.split(":") if folder}
    missing = folder_from_ini(ini, name) not in folders
    if missing:
        plan.text.append_to_value(line, f":{name}")
    if missing or (line.file != plan.text.path and not plan.is_ours(line)):
        # in an included file the entry may come from another INI's installation
        plan.notes.append(f"{BLOCK_NOTE}{name}{PATH_NOTE}")


def add_abort_command(plan: InstallPlan) -> None:
    """Make LinuxCNC call the package after an abort, which then calls what the user has there."""
    if not plan.codes and not plan.config.features:
        return
    text = f"{features.ON_ABORT} = {features.CALLS_ABORT_SUB}"
    present = plan.text.entries("RS274NGC", features.ON_ABORT)[:1]
    if not present:
        plan.add({"RS274NGC": [text]})
    for line, command in present:
        if plan.is_ours(line):  # also one of an older package
            plan.text.replace(line, text)
        elif not features.is_abort_call(command):
            plan.text.put_in_place(line, text, BEGIN_LINE)
            users = f"{features.ON_ABORT} = {command}"
            plan.add({SETTINGS: [NOW + users, users]})


def add_filter(plan: InstallPlan) -> None:
    """Add the lines that open files as another control's programs, and their settings."""
    for name in filter(None, map(features.CONTROLS.get, plan.requested)):
        control, find = read_control(name), plan.config.ini.get
        add_settings(plan, control)
        present = {suffix: find("FILTER", suffix) for suffix in filters.suffixes_of(control)}
        refuse_other_filters(plan, name, present)
        command = f"python3 {plan.prefix}/python/g12 translate --control {name}{plan.numbers}"
        command = next(filter(None, present.values()), command)
        missing = [suffix for suffix, value in present.items() if not value]
        plan.add({"FILTER": filters.filter_lines(control, command, missing)})


def refuse_other_filters(
    plan: InstallPlan, control: str, present: Mapping[str, str | None]
) -> None:
    """Refuse if a suffix of a control's programs has a filter that is not for them."""
    ours = {each.suffix for each in filters.translating_filters(plan.config)
            if each.control == control}  # fmt: skip
    for suffix, value in present.items():
        if value and suffix not in ours:
            raise refuse(
                "filter",
                f"[FILTER] {suffix} = {value} is there already",
                "take that line out, or give your programs another suffix and add the line by hand "
                "(python/g12/tools/translate/README.md)",
            )
        if value and plan.numbers and not value.endswith(plan.numbers):
            raise refuse(
                "filter",
                f"[FILTER] {suffix} = {value} is there already",
                f"write{plan.numbers} behind --control {control} in it",
            )


def add_settings(plan: InstallPlan, control: Control) -> None:
    """Add the settings that a lathe's programs need, but for those of the user."""
    if control.turns_c:
        several = plan.config.ini.number("TRAJ", "SPINDLES", 1) > 1
        needed = {"POLAR_Z": "allow", "LIVE_SPINDLE": "1" if several else "0"}
        unset = (key for key in needed if not plan.config.ini.get(SETTINGS, key))
        plan.add({SETTINGS: [f"{key} = {needed[key]}" for key in unset]})


def add_forms(plan: InstallPlan) -> None:
    """Add the lines that show the forms of present and new codes, by ngcgui or on one page."""
    asked = [name for name in (features.FORMS, features.CYCLES_PAGE) if name in plan.requested]
    if not asked:
        return
    if not screen.screen_of(plan.config):
        text = "[DISPLAY] DISPLAY is missing: no screen could show a form"
        raise refuse(asked[0], text, "name the screen")
    codes = [*dict.fromkeys([*plan.config.features, *plan.requested])]
    if not forms.files_of(plan.config, codes):
        cure = f"install a code with them: --with haas {asked[0]}"
        raise refuse(asked[0], "no code here has a form", cure)
    if features.FORMS in asked:
        plan.add(forms.lines_for(plan.config, codes, plan.prefix))
    if features.CYCLES_PAGE in asked:
        for taken in screen.key_taken(plan.config, screen.CYCLES):
            raise refuse(features.CYCLES_PAGE, taken.text, taken.cure)
        plan.add(screen.page_lines(plan.config, screen.CYCLES, plan.prefix))


def add_face_view(plan: InstallPlan) -> None:
    """Add the lines that show the face where the screen shows the XZ plane alone."""
    if not set(ON_A_LATHE).isdisjoint(plan.requested) and screen.is_for_face(plan.config):
        plan.add(screen.page_lines(plan.config, screen.FACE, plan.prefix))


def add_geometry(plan: InstallPlan) -> None:
    """Add the GEOMETRY that rotates the part on a lathe's screen, if the user has none."""
    config = plan.config
    on_face = features.KINEMATICS in plan.requested or uses_face_kinematics(config)
    lathe = set(ON_A_LATHE).intersection(plan.requested) or on_face
    axes = config.ini.axes
    if not lathe or "C" not in axes or ("Y" in axes and not on_face):
        return
    line_text = f"GEOMETRY = {geometry_for('XYZ' if on_face else axes)}"
    present = plan.text.entries("DISPLAY", "GEOMETRY")
    if present and plan.is_ours(present[0][0]):
        plan.text.replace(present[0][0], line_text)
    elif not present and config.ini.get("DISPLAY", "DISPLAY"):
        plan.add({"DISPLAY": [line_text]})


def add_kinematics(plan: InstallPlan) -> None:
    config = plan.config
    if features.KINEMATICS not in plan.requested or uses_face_kinematics(config):
        return
    refuse_problems([*kinematics_lines.obstacles(config, plan.text, plan.requested)])
    for section, key, value in kinematics_lines.in_place(config):
        line, _ = plan.text.entries(section, key)[0]
        plan.text.put_in_place(line, f"{key} = {value}", BEGIN_LINE)
    for key, signal in spindle_c.shared_with_kinematics(config).items():
        for line, _ in plan.text.entries("SPINDLE_C", key):
            if plan.is_ours(line):
                plan.text.replace(line, f"{key} = {signal}")
    plan.add(kinematics_lines.added(config, plan.prefix))


def add_spindle(plan: InstallPlan, pins: spindle_c.Pins | None) -> None:
    config, requested = plan.config, plan.requested
    if features.SPINDLE_AS_C not in requested or config.ini.get("SPINDLE_C", "JOINT"):
        return
    refuse_problems([*spindle_c.spindle_obstacles(config, pins)])
    plan.add(spindle_c.spindle_sections(config, requested, pins, plan.prefix))


def add_python(plan: InstallPlan) -> None:
    """Add the lines for [PYTHON], or those for the user's own modules."""
    folder, config = f"{plan.prefix}/python", plan.config
    if not config.ini.get("PYTHON", "TOPLEVEL"):
        lines = [f"TOPLEVEL = {folder}/toplevel.py", f"PATH_PREPEND = {folder}"]
        plan.add({"PYTHON": lines})
        return
    with_path = "" if config.python.package else f'import sys; sys.path.append("{folder}"); '
    for path, statement, is_missing in own_modules(config, plan.codes):
        installed = marked(path, statement)
        if is_missing and not installed:
            require_inside(config, path)
            plan.modules[path] = [f"{with_path}{statement}{MODULE_MARK}"]
        if is_missing or installed:
            plan.notes.append(f"{BLOCK_NOTE}{MODULE_NOTE}{name_in_ini(config, path)}")


def own_modules(config: Config, requested: Sequence[str]) -> list[tuple[Path, str, bool]]:
    """Return the user's TOPLEVEL and module remap, with the imports, and if they are missing."""
    python, toplevel = config.python, config.ini.file("PYTHON", "TOPLEVEL")
    if not toplevel.is_file():
        raise refuse(
            "no-toplevel",
            f"[PYTHON] TOPLEVEL = {toplevel}: there is no such file",
            "name the machine's own toplevel.py, or take the line out",
        )
    if python.remap and not python.remap_file:
        raise refuse(
            "remap-module",
            f"what {toplevel} calls remap is no module that a line could be added to",
            f"add {IMPORT_HANDLERS} where your handlers are, by hand",
        )
    refuse_own_names(config)
    ours = python.remap.keys() - python.users
    needed = {name for feature in requested for name in features.functions_of(feature)}
    remap = config.folder / python.remap_file if python.remap_file else remap_on_path(config)
    modules = [(toplevel, IMPORT_REMAP, not python.remap_file)]
    modules += [(remap, IMPORT_HANDLERS, bool(needed - ours))] if remap else []
    return [module for module in modules if not is_package_module(module[0])]


def is_package_module(path: Path) -> bool:
    own = features.ROOT / "python" / path.name
    return own.is_file() and own.read_bytes() == path.read_bytes()


def refuse_own_names(config: Config) -> None:
    """Refuse if the import would replace functions of the user's own."""
    handlers = {name for feature in features.REMAP_FILES for name in features.functions_of(feature)}
    for name in sorted(handlers & set(config.python.users)):
        raise refuse(
            "hidden",
            f"{config.python.remap_file} has a function {name}, and so has the package",
            "give your function another name",
        )


def remap_on_path(config: Config) -> Path | None:
    """Return the module remap that `import remap` would find, None if the user has none."""
    prepended = reversed(config.ini.all("PYTHON", "PATH_PREPEND"))
    names = [*prepended, *config.ini.all("PYTHON", "PATH_APPEND")]
    for folder in (folder_from_ini(config.ini, name) for name in names):
        for file in (folder / "remap" / "__init__.py", folder / "remap.py"):
            if file.is_file():
                return file
    return None


def require_inside(config: Config, path: Path) -> None:
    if not path.resolve().is_relative_to(config.folder.resolve()):
        raise refuse(
            "outside",
            f"{path} would have to change, which is outside the folder of {config.text.path.name}",
            "copy that file into the config's folder and name it in the INI, or set the package "
            "up by hand (configs/README.md)",
        )
