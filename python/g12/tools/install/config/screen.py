# SPDX-License-Identifier: GPL-2.0-or-later
"""The package on a machine's screen: ngcgui's forms, the Cycles page, a lathe's face, GEOMETRY.

A page is a file of GladeVCP. It is a tab where the screen has a place for tabs, else a window of
its own. Some screens show the same by a key of their own. AXIS loads ngcgui as a Tcl package, some
screens of QtVCP contain one, GladeVCP makes one from `forms.ui`.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

from g12.lengths import is_inch
from g12.tools.forms.table import FORMS
from g12.tools.install.config.features import COPY, INCLUDES, ROOT, rotary_of_mill
from g12.tools.install.config.findings import refuse
from g12.tools.install.config.loaded import Config, folder_from_ini

Lines = dict[str, list[str]]  # to write, by their sections
INCLUDE = f"{COPY}/{INCLUDES.relative_to(ROOT).as_posix()}"
NGCGUI_PAGE, CYCLES, FACE = "Forms", "Cycles", "Face"  # the pages, as their tabs are called
GLADE = {  # a page: what follows GladeVCP's own options
    NGCGUI_PAGE: f"{INCLUDE}/forms.ui",
    CYCLES: f"-u {COPY}/python/g12/tools/cycles_page/gtk_view.py {INCLUDE}/cycles.ui",
    FACE: f"{INCLUDE}/face_view.ui",
}
AXIS, QTVCP, PROBE_BASIC = "axis", "qtvcp", "probe_basic"
OWN_KEYS = {  # a screen and a page that it shows by a key of [DISPLAY]: the key, its value
    (AXIS, FACE): ("USER_COMMAND_FILE", f"{INCLUDE}/axis_face.py"),
    (PROBE_BASIC, CYCLES): ("USER_TABS_PATH", f"{INCLUDE}/probe_basic/"),
}
WITH_NGCGUI = "tabWidget_utilities"  # of the screens of QtVCP that contain ngcgui
TAB_LOCATIONS = {  # start of a screen's name: its widget for tabs, "" if it has one place for them
    AXIS: "",
    "touchy": "",
    "gmoccapy": "ntb_user_tabs",
    "qtdragon": WITH_NGCGUI,
    "woodpecker": WITH_NGCGUI,
    "qtaxis": "rightTab",
}
FACE_SCREENS = (AXIS, "gmoccapy", "touchy")  # they show a lathe's XZ plane alone
NGCGUI = "Ngcgui"  # the Tcl package that AXIS loads
HERE = "/proc/self/cwd"  # LinuxCNC and its screen work in the INI's folder


def words_of(config: Config) -> list[str]:
    return (config.ini.get("DISPLAY", "DISPLAY") or "").split()


def screen_of(config: Config) -> str:
    """Return the program that a config's screen is, "" if it names none."""
    return Path("".join(words_of(config)[:1])).name


def tab_location(config: Config) -> str | None:
    """Return the widget for a screen's tabs, "" if it has one place, None if it has no tabs."""
    screen = screen_of(config)
    names = words_of(config)[1:] if screen == QTVCP else [screen]
    found = (TAB_LOCATIONS[start] for start in TAB_LOCATIONS for name in names
             if name.startswith(start))  # fmt: skip
    return next(found, None)


def is_for_face(config: Config) -> bool:
    """Return whether a screen shows nothing of the face by itself."""
    return screen_of(config) in FACE_SCREENS and bool(config.ini.get("DISPLAY", "LATHE"))


def glade_files(config: Config) -> list[str]:
    """Return the files of GladeVCP that a config's tabs and windows name."""
    commands = [*config.ini.all("DISPLAY", "EMBED_TAB_COMMAND"), *config.ini.all("HAL", "HALCMD")]
    return [word for command in commands for word in command.split() if word.endswith(".ui")]


def page_lines(config: Config, page: str) -> Lines:
    """Return the lines that show a page; none where the user has them, or others for the face.

    It is refused where the folder of the user's own pages takes the key of the Cycles page.
    """
    key, value = OWN_KEYS.get((screen_of(config), page), ("", ""))
    users = config.ini.get("DISPLAY", key) if key else None
    if users and page == CYCLES and not (folder_from_ini(config.ini, users) / "cycles").exists():
        text = f"[DISPLAY] {key} = {users} is yours and stays: the screen does not show {page}"
        raise refuse("cycles-page", text, f"link {value}cycles into that folder")
    if key:
        return {} if users else {"DISPLAY": [f"{key} = {value}"]}
    if Path(GLADE[page]).name in (Path(name).name for name in glade_files(config)):
        return {}
    return tab_or_window(config, page)


def tab_or_window(config: Config, page: str) -> Lines:
    """Return the lines of a page's tab, or of its window where the screen has no tabs.

    Screens pair names and locations by number: if a tab of the user has none, this one has none.
    QtVCP would not show it then, nor ngcgui, which needs the width: there it gets a window, which
    HAL ends with LinuxCNC.
    """
    location, is_qtvcp = tab_location(config), screen_of(config) == QTVCP
    locations, names = (config.ini.all("DISPLAY", f"EMBED_TAB_{key}")
                        for key in ("LOCATION", "NAME"))  # fmt: skip
    paired = len(locations) == len(names)
    if location is None or (is_qtvcp and (page == NGCGUI_PAGE or not paired)):
        return {"HAL": [f"HALCMD = loadusr gladevcp -c {page.lower()} {GLADE[page]}"]}
    place = [f"EMBED_TAB_LOCATION = {location}"] if location and paired else []
    command = f"EMBED_TAB_COMMAND = gladevcp -x {{XID}} {GLADE[page]}"
    return {"DISPLAY": [f"EMBED_TAB_NAME = {page}", *place, command]}


# The forms of ngcgui.


def form_files(config: Config, features: Iterable[str]) -> list[str]:
    """Return the files of the features' forms, in the machine's unit."""
    unit = "inch" if is_inch(config.ini.mm) else "mm"
    forms = (form for feature in features for form in FORMS if form.feature == feature)
    return [f"form_{form.name}_{unit}.ngc" for form in forms]


def form_lines(config: Config, features: Sequence[str]) -> Lines:
    """Return the missing lines that show the features' forms."""
    present = {Path(name).name for name in config.ini.all("DISPLAY", "NGCGUI_SUBFILE")}
    path, subs, folder = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH"), f"{COPY}/ngc", ""
    if tab_location(config) == WITH_NGCGUI:  # it searches that path alone
        lines = {} if path else {"DISPLAY": [f"NGCGUI_SUBFILE_PATH = {subs}"]}
        folder = "" if path in (None, subs) else f"{HERE}/{subs}/"
    else:
        lines = ngcgui_lines(config)
    pages = [f"NGCGUI_SUBFILE = {folder}{name}" for name in form_files(config, features)
             if name not in present]  # fmt: skip
    return {**lines, "DISPLAY": [*lines.get("DISPLAY", []), *pages]}


def ngcgui_lines(config: Config) -> Lines:
    """Return the lines that make a screen show ngcgui; none where it does already."""
    if screen_of(config) == AXIS:
        packages = [value.split()[:1] for value in config.ini.all("DISPLAY", "TKPKG")]
        return {} if [NGCGUI] in packages else {"DISPLAY": [f"TKPKG = {NGCGUI} 1.0"]}
    files = [folder_from_ini(config.ini, name) for name in glade_files(config)]
    if any(file.is_file() and b"PyNgcGui" in file.read_bytes() for file in files):
        return {}
    return page_lines(config, NGCGUI_PAGE)


# The picture of the part.


def geometries(config: Config, features: Sequence[str], on_face: bool) -> list[str]:
    """Return the GEOMETRY that rotates the part, C before the slides; of A and B one for each.

    ``on_face``: the kinematics add Y to the axes. Screens draw B the wrong way.
    """
    axes = "XYZC" if on_face else config.ini.axes
    if on_face or ("C" in axes and "Y" not in axes):
        return [f"C{''.join(axis for axis in 'XYZ' if axis in axes)}!"]
    is_reversed = config.ini.settings.rotary_sense == "reversed"
    turning = rotary_of_mill(axes) if "cylinder" in features else ""
    return [f"{'-' * ((turn == 'B') != is_reversed)}{turn}XYZ!" for turn in turning]
