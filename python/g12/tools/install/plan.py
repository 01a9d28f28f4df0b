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
from g12.tools.install.config import features, screen
from g12.tools.install.config.features import COPY
from g12.tools.install.config.findings import refuse, refuse_problems
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.config.loaded import Config, both_cases, folder_from_ini
from g12.tools.install.lathe import kinematics, spindle_c
from g12.tools.install.rules import calls_abort_sub, odd_folder
from g12.tools.translate.blocks.control import read_control

ONE_OF_EACH = (SETTINGS, "SPINDLE_C", "AXIS_Y")  # sections in which a user's entry stays


@dataclass
class InstallPlan:
    """The lines of an installation, which are in the text of ``config`` in the end, not written.

    ``config`` is without what an earlier one wrote. ``features`` are all, with those that are there
    already. ``options`` are those of `translate`.
    """

    config: Config
    features: Sequence[str]
    options: str = ""
    added: dict[str, list[str]] = field(default_factory=lambda: {"RS274NGC": []})

    @property
    def words(self) -> str:
        """The features and options as typed."""
        return f"{' '.join(self.features)}{self.options}"

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
        self.config.text.replace(section, key, value, self.words)


def make_plan(
    config: Config, names: Sequence[str], pins: spindle_c.Pins | None = None, options: str = ""
) -> IniText:
    """Return a config's text, edited so that it has the features."""
    plan, copy = InstallPlan(config, names, options), config.ini.directory / COPY
    if copy.exists() and not package_copy.is_copy(copy):
        text = f"{copy} is there already, and is no copy of the package that install made"
        raise refuse("folder", text, "rename that folder")
    if plan.codes:
        add_subroutines(plan)
        add_codes(plan)
        add_abort_command(plan)
        add_python(plan)
    for name in filter(None, map(features.CONTROLS.get, names)):
        add_filter(plan, name)
    on_face = kinematics.uses_face_kinematics(config)
    if features.KINEMATICS in names and not on_face:
        refuse_problems(kinematics.obstacles(config, plan.codes))
        for entry in kinematics.replaced(config):
            plan.replace(*entry)
        plan.add(kinematics.added(config))
        on_face = True
    if features.SPINDLE_AS_C in names and not spindle_c.is_connected(config):
        refuse_problems(spindle_c.obstacles(config, pins))
        plan.add(spindle_c.lines_for(config, names, pins))
    add_forms(plan)
    add_picture(plan, on_face)
    for section, lines in plan.added.items():
        if lines:
            config.text.add(section, lines, plan.words)
    for path in config.text.changes():
        if not path.resolve().is_relative_to(config.ini.directory.resolve()):
            raise refuse("outside", f"{path} would have to change, which is outside the folder of "
                         f"{config.text.path.name}", "copy it into that folder")  # fmt: skip
    return config.text


def add_codes(plan: InstallPlan) -> None:
    """Add the REMAP lines that are not there, under this code and with this meaning."""
    present = [(code.remap.number, code.feature) for code in plan.config.codes]
    for feature in plan.codes:
        for remap in features.remaps_of(feature):
            if (remap.number, feature) not in present:
                plan.add({"RS274NGC": [f"REMAP = {remap.text}"]})


def add_subroutines(plan: InstallPlan) -> None:
    """Add the package's folder to SUBROUTINE_PATH, of which LinuxCNC 2.9 reads one line."""
    name, ini = f"{COPY}/ngc", plan.config.ini
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
    elif not calls_abort_sub(plan.config):
        plan.replace("RS274NGC", features.ON_ABORT, features.CALLS_ABORT_SUB)
        plan.add({SETTINGS: [f"{features.ON_ABORT} = {present}"]})


def add_python(plan: InstallPlan) -> None:
    """Make LinuxCNC load the handlers, after the user's own modules."""
    folder, users = f"{COPY}/python", plan.config.ini.get("PYTHON", TOPLEVEL)
    toplevel = f"{folder}/toplevel.py"
    needed = {name for feature in plan.codes for name in features.functions_of(feature)}
    if not users:
        plan.add({"PYTHON": [f"{TOPLEVEL} = {toplevel}", f"PATH_PREPEND = {folder}"]})
    elif plan.config.python.lacks({*needed, features.ABORT_SUB}):
        plan.replace("PYTHON", TOPLEVEL, toplevel)
        plan.add({"PYTHON": [f"PATH_APPEND = {folder}"], SETTINGS: [f"{TOPLEVEL} = {users}"]})


def add_filter(plan: InstallPlan, name: str) -> None:
    """Add the lines that open files as another control's programs, and their settings."""
    control, ini = read_control(name), plan.config.ini
    if control.turns_c:
        on_round = control.onto == "round"
        live = [f"LIVE_SPINDLE = {int(ini.number('TRAJ', 'SPINDLES', 1) > 1)}"]
        plan.add({SETTINGS: [
            "CYLINDER_X = allow" if on_round else "POLAR_Z = allow",
            *([] if on_round and features.rotary_of_mill(ini.axes) else live),
        ]})  # fmt: skip
    suffixes = [written for suffix in control.extensions for written in both_cases(suffix)]
    for suffix in suffixes:
        if value := ini.get("FILTER", suffix):
            raise refuse(
                "filter",
                f"[FILTER] {suffix} = {value} is there already",
                "take that line out, or give your programs another suffix and add the line by "
                "hand (python/g12/tools/translate/README.md)",
            )
    command = f"python3 {COPY}/python/g12 translate --control {name}{plan.options}"
    shown = f"PROGRAM_EXTENSION = .{',.'.join(suffixes)} Programs of {name}"
    plan.add({"FILTER": [shown, *(f"{suffix} = {command}" for suffix in suffixes)]})


def add_forms(plan: InstallPlan) -> None:
    """Add the lines that show the forms of all codes, by ngcgui or on one page."""
    asked = [name for name in (features.FORMS, features.CYCLES_PAGE) if name in plan.features]
    codes = list(dict.fromkeys([*plan.config.features, *plan.features]))
    if asked and not screen.screen_of(plan.config):
        text = "[DISPLAY] DISPLAY is missing: no screen could show a form"
        raise refuse(asked[0], text, "name the screen")
    if asked and not screen.form_files(plan.config, codes):
        cure = f"install a code with them: --with haas {asked[0]}"
        raise refuse(asked[0], "no code here has a form", cure)
    if features.FORMS in asked:
        plan.add(screen.form_lines(plan.config, codes))
    if features.CYCLES_PAGE in asked:
        plan.add(screen.page_lines(plan.config, screen.CYCLES))


def add_picture(plan: InstallPlan, on_face: bool) -> None:
    """Add the view of a lathe's face, and a GEOMETRY if the user has none."""
    on_lathe = not set(features.ON_LATHE).isdisjoint(plan.features)
    if on_lathe and screen.is_for_face(plan.config):
        plan.add(screen.page_lines(plan.config, screen.FACE))
    find = plan.config.ini.get
    if not (on_lathe or on_face) or find("DISPLAY", "GEOMETRY") or not find("DISPLAY", "DISPLAY"):
        return
    shown = screen.geometries(plan.config, plan.features, on_face)
    if len(shown) > 1:
        raise refuse(
            "cylinder",
            "the machine has A and B: the screen has to know which of them turns the part",
            f"write [DISPLAY] GEOMETRY = {' or '.join(shown)} first",
        )
    plan.add({"DISPLAY": [f"GEOMETRY = {geometry}" for geometry in shown]})
