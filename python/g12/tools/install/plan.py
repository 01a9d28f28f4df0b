# SPDX-License-Identifier: GPL-2.0-or-later
"""The lines of an installation: what each feature adds to a config that has none of them.

Two lines of the user's are replaced by ones that lead to them: [G12] names the user's TOPLEVEL and
ON_ABORT_COMMAND, which the package runs. LinuxCNC reads one of each.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from g12.settings import INI_SECTION as SETTINGS
from g12.settings import TOPLEVEL
from g12.tools.install import package_copy
from g12.tools.install.config import features, filters, screen
from g12.tools.install.config.findings import refuse, refuse_problems
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import Config, folder_from_ini
from g12.tools.install.lathe import kinematics, spindle_c
from g12.tools.install.rules import odd_folder
from g12.tools.translate.blocks.control import Control, read_control

ONE_OF_EACH = (SETTINGS, "SPINDLE_C", "AXIS_Y")  # sections in which a user's entry stays


@dataclass
class InstallPlan:
    """The lines of an installation, which are in ``text`` in the end, and not written yet.

    ``config`` is without what an earlier one wrote. ``features`` are all, ``words`` with their
    options as typed. ``prefix`` is the package's folder as the INI names it; ``copied``: it is the
    copy that `install` makes. ``numbers`` are the options of `translate`.
    """

    config: Config
    text: IniText
    features: Sequence[str]
    words: str
    prefix: str
    copied: bool
    numbers: str = ""
    added: dict[str, list[str]] = field(default_factory=lambda: {"RS274NGC": []})

    @property
    def codes(self) -> list[str]:
        return [feature for feature in self.features if feature in features.CODES]

    def add(self, lines_of: Mapping[str, Iterable[str]]) -> None:
        """Add lines to sections."""
        for section, lines in lines_of.items():
            find = self.config.ini.get if section in ONE_OF_EACH else lambda *_: None
            new = (line for line in lines if not find(section, line.partition(" =")[0]))
            self.added.setdefault(section, []).extend(new)

    def replace(self, section: str, key: str, value: str) -> None:
        self.text.replace(section, key, value, self.words)


def make_plan(
    config: Config,
    names: Sequence[str],
    pins: spindle_c.Pins | None = None,
    numbers: str = "",
) -> InstallPlan:
    """Edit a config's text so that it has the features."""
    words = f"{' '.join(names)}{numbers}"
    plan = InstallPlan(config, config.text, names, words, *package_folder(config), numbers)
    if plan.codes:
        add_subroutines(plan)
        plan.add({"RS274NGC": [f"REMAP = {remap.text}" for remap in new_remaps(plan)]})
        add_abort_command(plan)
        add_python(plan)
    add_filter(plan)
    on_lathe = not set(features.ON_LATHE).isdisjoint(names)
    if features.KINEMATICS in names and not kinematics.uses_face_kinematics(config):
        refuse_problems(kinematics.obstacles(config, plan.codes))
        for entry in kinematics.replaced(config):
            plan.replace(*entry)
        plan.add(kinematics.added(config, plan.prefix))
    if features.SPINDLE_AS_C in names and not spindle_c.is_connected(config):
        refuse_problems(spindle_c.obstacles(config, pins))
        plan.add(spindle_c.lines_for(config, names, pins, plan.prefix))
    add_forms(plan)
    if on_lathe and screen.is_for_face(config):
        plan.add(screen.page_lines(config, screen.FACE, plan.prefix))
    on_face = features.KINEMATICS in names or kinematics.uses_face_kinematics(config)
    if on_lathe or on_face:
        add_geometry(plan, on_face)
    if "cylinder" in names:
        add_geometry_of_mill(plan)
    for section, lines in plan.added.items():
        if lines:
            plan.text.add(section, lines, words)
    for path in plan.text.changes():
        if not path.resolve().is_relative_to(config.folder.resolve()):
            raise refuse("outside", f"{path} would have to change, which is outside the folder of "
                         f"{config.text.path.name}", "copy it into that folder")  # fmt: skip
    return plan


def package_folder(config: Config) -> tuple[str, bool]:
    """Return the package's folder as the INI names it, and whether it is `install`'s copy."""
    own, here = config.folder / package_copy.NAME, config.folder.resolve()
    users = config.python.package.parent.parent if config.python.package else features.ROOT
    is_users = config.python.package or users.is_relative_to(here)
    if not (is_users and not package_copy.is_copy(users)):
        if own.exists() and not package_copy.is_copy(own):
            text = f"{own} is there already, and is no copy of the package that install made"
            raise refuse("folder", text, "rename that folder")
        return package_copy.NAME, True
    folder = users.resolve()
    inside = folder.is_relative_to(here)
    return folder.relative_to(here).as_posix() if inside else str(folder), False


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
    """Add the package's folder to SUBROUTINE_PATH, of which LinuxCNC 2.9 reads one line."""
    name, ini = f"{plan.prefix}/ngc", plan.config.ini
    refuse_problems(odd_folder(folder_from_ini(ini, name)))
    present = ini.get("RS274NGC", "SUBROUTINE_PATH")
    folders = [folder_from_ini(ini, folder) for folder in (present or "").split(":") if folder]
    if present is None:
        plan.add({"RS274NGC": [f"SUBROUTINE_PATH = {name}"]})
    elif folder_from_ini(ini, name) not in folders:
        plan.replace("RS274NGC", "SUBROUTINE_PATH", f"{present.strip()}:{name}")


def add_abort_command(plan: InstallPlan) -> None:
    """Make LinuxCNC call the package after an abort, which then calls what the user has there."""
    present = plan.config.ini.get("RS274NGC", features.ON_ABORT)
    if present is None:
        plan.add({"RS274NGC": [f"{features.ON_ABORT} = {features.CALLS_ABORT_SUB}"]})
    elif not features.is_abort_call(present):
        plan.replace("RS274NGC", features.ON_ABORT, features.CALLS_ABORT_SUB)
        plan.add({SETTINGS: [f"{features.ON_ABORT} = {present}"]})


def add_python(plan: InstallPlan) -> None:
    """Make LinuxCNC load the handlers, after the user's own modules."""
    folder, users = f"{plan.prefix}/python", plan.config.ini.get("PYTHON", TOPLEVEL)
    toplevel = f"{folder}/toplevel.py"
    needed = {name for feature in plan.codes for name in features.functions_of(feature)}
    if not users:
        plan.add({"PYTHON": [f"{TOPLEVEL} = {toplevel}", f"PATH_PREPEND = {folder}"]})
    elif not {*needed, features.ABORT_SUB} <= plan.config.python.remap.keys():
        plan.replace("PYTHON", TOPLEVEL, toplevel)
        plan.add({"PYTHON": [f"PATH_APPEND = {folder}"], SETTINGS: [f"{TOPLEVEL} = {users}"]})


def add_filter(plan: InstallPlan) -> None:
    """Add the lines that open files as another control's programs, and their settings."""
    for name in filter(None, map(features.CONTROLS.get, plan.features)):
        control, find = read_control(name), plan.config.ini.get
        add_settings(plan, control)
        present = {suffix: find("FILTER", suffix) for suffix in filters.suffixes_of(control)}
        ours = {each.suffix for each in filters.translating_filters(plan.config)
                if each.control == name}  # fmt: skip
        for suffix, value in present.items():
            if value and (suffix not in ours or not value.endswith(plan.numbers)):
                raise refuse(
                    "filter",
                    f"[FILTER] {suffix} = {value} is there already",
                    "take that line out, or give your programs another suffix and add the line by "
                    "hand (python/g12/tools/translate/README.md)",
                )
        command = f"python3 {plan.prefix}/python/g12 translate --control {name}{plan.numbers}"
        command = next(filter(None, present.values()), command)
        missing = [suffix for suffix, value in present.items() if not value]
        plan.add({"FILTER": filters.filter_lines(control, command, missing)})


def add_settings(plan: InstallPlan, control: Control) -> None:
    """Add the settings that a lathe's programs need."""
    if control.turns_c:
        several = plan.config.ini.number("TRAJ", "SPINDLES", 1) > 1
        on_mill = control.onto == "round" and features.rotary_of_mill(plan.config.ini.axes)
        depth = "CYLINDER_X = allow" if control.onto == "round" else "POLAR_Z = allow"
        live = [] if on_mill else [f"LIVE_SPINDLE = {int(several)}"]
        plan.add({SETTINGS: [depth, *live]})


def add_forms(plan: InstallPlan) -> None:
    """Add the lines that show the forms of all codes, by ngcgui or on one page."""
    asked = [name for name in (features.FORMS, features.CYCLES_PAGE) if name in plan.features]
    if not asked:
        return
    if not screen.screen_of(plan.config):
        text = "[DISPLAY] DISPLAY is missing: no screen could show a form"
        raise refuse(asked[0], text, "name the screen")
    codes = list(dict.fromkeys([*plan.config.features, *plan.features]))
    if not screen.form_files(plan.config, codes):
        cure = f"install a code with them: --with haas {asked[0]}"
        raise refuse(asked[0], "no code here has a form", cure)
    if features.FORMS in asked:
        plan.add(screen.form_lines(plan.config, codes, plan.prefix))
    if features.CYCLES_PAGE in asked:
        for taken in screen.key_taken(plan.config, screen.CYCLES):
            raise refuse(features.CYCLES_PAGE, taken.text, taken.cure)
        plan.add(screen.page_lines(plan.config, screen.CYCLES, plan.prefix))


def add_geometry(plan: InstallPlan, on_face: bool) -> None:
    """Add the GEOMETRY that rotates the part on a lathe's screen, if the user has none."""
    ini = plan.config.ini
    axes = "XYZC" if on_face else ini.axes
    if ini.get("DISPLAY", "GEOMETRY") or not ini.get("DISPLAY", "DISPLAY"):
        return
    if on_face or ("C" in axes and "Y" not in axes):
        plan.add({"DISPLAY": [f"GEOMETRY = {screen.geometry_for(axes)}"]})


def add_geometry_of_mill(plan: InstallPlan) -> None:
    """Add the GEOMETRY that rotates the part on a mill's screen, if the user has none."""
    ini = plan.config.ini
    shown = screen.geometries_of_mill(plan.config)
    if ini.get("DISPLAY", "GEOMETRY") or not ini.get("DISPLAY", "DISPLAY") or not shown:
        return
    if len(shown) > 1:
        raise refuse(
            "cylinder",
            "the machine has A and B: the screen has to know which of them turns the part",
            f"write [DISPLAY] GEOMETRY = {' or '.join(shown)} first",
        )
    plan.add({"DISPLAY": [f"GEOMETRY = {shown[0]}"]})
