# SPDX-License-Identifier: GPL-2.0-or-later
"""The package on a machine's screen: ngcgui's forms, the Cycles page, a lathe's face; the checks.

A page is a file of GladeVCP. It is a tab where the screen has a place for tabs, else a window of
its own. Some screens show the same by a key of their own. AXIS loads ngcgui as a Tcl package, some
screens of QtVCP contain one, GladeVCP makes one from `forms.ui`.
"""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from g12.lengths import is_inch
from g12.tools.forms.table import FORMS
from g12.tools.install.config.features import INCLUDES, ON_LATHE, ROOT, rotary_of_mill
from g12.tools.install.config.findings import ConfigFinding, note, problem, warning
from g12.tools.install.config.loaded import Config, folder_from_ini, subs_named


class Page(NamedTuple):
    """A page: the name of its tab, GladeVCP's file, and the Python file that handles it."""

    name: str
    file: str
    handler: str = ""

    def command(self, prefix: str) -> str:
        """Return what follows GladeVCP's own options; ``prefix`` is the package's folder."""
        handler = f"-u {prefix}/{self.handler} " if self.handler else ""
        return f"{handler}{prefix}/{self.file}"


class OwnKey(NamedTuple):
    """A key of [DISPLAY] by which one screen shows a page, and the package's value.

    Where the user's own file has ``mark`` in it, or the user's own folder, the page is shown too.
    """

    key: str
    value: str
    mark: str
    cure: str


Lines = dict[str, list[str]]  # to write, by their sections
INCLUDE = INCLUDES.relative_to(ROOT).as_posix()
NGCGUI_PAGE = Page("Forms", f"{INCLUDE}/forms.ui")
CYCLES = Page("Cycles", f"{INCLUDE}/cycles.ui", "python/g12/tools/cycles_page/gtk_view.py")
FACE = Page("Face", f"{INCLUDE}/face_view.ui")
AXIS, QTVCP, PROBE_BASIC = "axis", "qtvcp", "probe_basic"
OWN_KEYS = {
    (AXIS, FACE): OwnKey(
        "USER_COMMAND_FILE",
        f"{INCLUDE}/axis_face.py",
        "axis_face.py",
        f'add exec(open("g12/{INCLUDE}/axis_face.py").read()) to that file',
    ),
    (PROBE_BASIC, CYCLES): OwnKey(
        "USER_TABS_PATH",
        f"{INCLUDE}/probe_basic/",
        "cycles",
        f"link g12/{INCLUDE}/probe_basic/cycles into that folder",
    ),
}
TAB_LOCATIONS = {  # start of a screen's name: its widget for tabs, "" if it has one place for them
    AXIS: "",
    "touchy": "",
    "gmoccapy": "ntb_user_tabs",
    "qtdragon": "tabWidget_utilities",
    "woodpecker": "tabWidget_utilities",
    "qtaxis": "rightTab",
}
WITH_PREVIEW = (AXIS, "gmoccapy", "gscreen", QTVCP, "touchy")
FACE_SCREENS = (AXIS, "gmoccapy", "touchy")  # they show a lathe's XZ plane alone
NGCGUI = "Ngcgui"  # the Tcl package that AXIS loads
QTVCP_WITH_NGCGUI = ("qtdragon", "woodpecker")  # prefix of these screens' names
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


# A page.


def page_lines(config: Config, page: Page, prefix: str) -> Lines:
    """Return the lines that show a page; none where the user has them or others."""
    own = OWN_KEYS.get((screen_of(config), page))
    if own:
        present = config.ini.get("DISPLAY", own.key)
        return {} if present else {"DISPLAY": [f"{own.key} = {prefix}/{own.value}"]}
    if Path(page.file).name in (Path(name).name for name in glade_files(config)):
        return {}
    return tab_or_window(config, page, prefix)


def tab_or_window(config: Config, page: Page, prefix: str) -> Lines:
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
        window = f"loadusr gladevcp -c {page.name.lower()} {page.command(prefix)}"
        return {"HAL": [f"HALCMD = {window}"]}
    place = [f"EMBED_TAB_LOCATION = {location}"] if location and paired else []
    command = f"EMBED_TAB_COMMAND = gladevcp -x {{XID}} {page.command(prefix)}"
    return {"DISPLAY": [f"EMBED_TAB_NAME = {page.name}", *place, command]}


def key_taken(config: Config, page: Page) -> Iterator[ConfigFinding]:
    """Report the user's own file or folder, which takes the key that would show a page."""
    own = OWN_KEYS.get((screen_of(config), page))
    value = config.ini.get("DISPLAY", own.key) if own else None
    if not own or not value or value.endswith(own.value):
        return
    place = folder_from_ini(config.ini, value)
    within = (place / own.mark).exists()
    if not within and not (place.is_file() and own.mark.encode() in place.read_bytes()):
        yield note(
            "screen",
            f"[DISPLAY] {own.key} = {value} is yours and stays: the screen does not show "
            f"{page.name}",
            own.cure,
        )


# The forms of ngcgui.


def form_files(config: Config, features: Iterable[str]) -> list[str]:
    """Return the files of the features' forms, in the machine's unit."""
    unit = "inch" if is_inch(config.ini.mm) else "mm"
    forms = (form for feature in features for form in FORMS if form.feature == feature)
    return [f"form_{form.name}_{unit}.ngc" for form in forms]


def form_lines(config: Config, features: Sequence[str], prefix: str) -> Lines:
    """Return the missing lines that show the features' forms."""
    present = {Path(name).name for name in config.ini.all("DISPLAY", "NGCGUI_SUBFILE")}
    lines, folder = ngcgui_lines(config, prefix), ""
    path = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH")
    if has_own_ngcgui(config) and path not in (None, f"{prefix}/ngc"):  # QtVCP searches that alone
        folder = f"{HERE / Path(prefix)}/ngc/"
    pages = [f"NGCGUI_SUBFILE = {folder}{name}" for name in form_files(config, features)
             if name not in present]  # fmt: skip
    return {**lines, "DISPLAY": [*lines.get("DISPLAY", []), *pages]}


def has_own_ngcgui(config: Config) -> bool:
    """Return whether a screen is one of QtVCP that contains ngcgui."""
    names = words_of(config)[1:]
    return screen_of(config) == QTVCP and any(map(is_with_ngcgui, names))


def is_with_ngcgui(name: str) -> bool:
    return name.startswith(QTVCP_WITH_NGCGUI)


def ngcgui_lines(config: Config, prefix: str) -> Lines:
    """Return the lines that make a screen show ngcgui; none where it does already."""
    if screen_of(config) == AXIS:
        packages = [value.split()[:1] for value in config.ini.all("DISPLAY", "TKPKG")]
        return {} if [NGCGUI] in packages else {"DISPLAY": [f"TKPKG = {NGCGUI} 1.0"]}
    if has_own_ngcgui(config):
        present = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH")
        return {} if present else {"DISPLAY": [f"NGCGUI_SUBFILE_PATH = {prefix}/ngc"]}
    files = [folder_from_ini(config.ini, name) for name in glade_files(config)]
    if any(file.is_file() and b"PyNgcGui" in file.read_bytes() for file in files):
        return {}
    return page_lines(config, NGCGUI_PAGE, prefix)


def forms_shown(config: Config) -> list[str]:
    """Return the package's forms that a config names, without ``.ngc``."""
    names = (Path(value).name for value in config.ini.all("DISPLAY", "NGCGUI_SUBFILE"))
    return [name.removesuffix(".ngc") for name in names if name.startswith("form_")]


# Checks.


def screen_findings(config: Config) -> Iterator[ConfigFinding]:
    if "C" in config.ini.axes and not config.features.keys().isdisjoint(ON_LATHE):
        yield from key_taken(config, FACE) if is_for_face(config) else ()
        yield from part_not_turned(config)
    shown = forms_shown(config)
    for form in shown:
        yield from form_findings(config, form)
    for section, lines in ngcgui_lines(config, "g12").items() if shown else ():
        yield problem(
            "form",
            f"{screen_of(config)} shows no forms: nothing makes it show ngcgui",
            f"have: [{section}] {', '.join(lines)}",
        )


def geometry_for(axes: str) -> str:
    """Return the GEOMETRY of a lathe's axes: C, which rotates the part, before the slides."""
    return f"C{''.join(axis for axis in 'XYZ' if axis in axes)}!"


def geometries_of_mill(config: Config) -> list[str]:
    """Return the GEOMETRY for each axis that turns a mill's part; screens draw B the wrong way."""
    is_reversed = config.ini.settings.rotary_sense == "reversed"
    return [
        f"{'-' * ((turn == 'B') != is_reversed)}{turn}XYZ!"
        for turn in rotary_of_mill(config.ini.axes)
    ]


def part_not_turned(config: Config) -> Iterator[ConfigFinding]:
    found = config.ini.get("DISPLAY", "GEOMETRY") or ""
    turns_first = 0 <= found.upper().find("C") < found.upper().find("X")
    if screen_of(config) in WITH_PREVIEW and not turns_first:
        yield warning(
            "geometry",
            f"[DISPLAY] GEOMETRY {f'= {found}' if found else 'is missing'}: the screen draws a "
            "section as a line to and fro along X",
            f"have: GEOMETRY = {geometry_for(config.ini.axes)}",
        )


def form_findings(config: Config, form: str) -> Iterator[ConfigFinding]:
    name = form.removeprefix("form_").rpartition("_")[0]
    own = [each.feature for each in FORMS if each.name == name]
    if not subs_named(config.ini, form):
        yield problem(
            "form",
            f"[DISPLAY] NGCGUI_SUBFILE = {form}.ngc is in none of the folders of SUBROUTINE_PATH",
            "add the package's folder ngc to SUBROUTINE_PATH, or correct the name",
        )
    elif own and config.features.keys().isdisjoint(own):
        yield problem(
            "form",
            f"[DISPLAY] NGCGUI_SUBFILE = {form}.ngc: the codes of {own[0]} are not set up here",
            "take the line out, or install that feature",
        )
