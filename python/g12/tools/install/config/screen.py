# SPDX-License-Identifier: GPL-2.0-or-later
"""The package's pages on a machine's screen: the lines that show them, and the checks.

A page is a file of GladeVCP. It is a tab where the screen has a place for tabs, else a window of
its own. Some screens show the same by a key of their own.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from g12.tools.install.config.features import AXES_NEEDED, INCLUDES, ROOT
from g12.tools.install.config.findings import ConfigFinding, note, problem
from g12.tools.install.config.loaded import Config, folder_from_ini


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
FACE_SCREENS = (AXIS, "gmoccapy", "touchy")  # they show a lathe's XZ plane alone
TAB = "gladevcp -x {XID} "
OWN_WINDOW = "loadusr gladevcp -c "  # HAL ends it with LinuxCNC
OWN_FILES = re.compile(r"/(cycles\.ui|cycles_page/gtk_view\.py|face_view\.ui|axis_face\.py"
                       r"|include/probe_basic/?)$")  # fmt: skip
GLADE_FILES = r"(-u \S+/gtk_view\.py )?\S+/(forms|cycles|face_view)\.ui"
SCREEN_LINE = re.compile(
    r"EMBED_TAB_NAME = (Forms|Cycles|Face)"
    r"|EMBED_TAB_LOCATION = (ntb_user_tabs|tabWidget_utilities|rightTab)"
    rf"|EMBED_TAB_COMMAND = gladevcp -x \{{XID\}} {GLADE_FILES}"
    rf"|HALCMD = loadusr gladevcp -c (forms|cycles) {GLADE_FILES}"
    r"|USER_COMMAND_FILE = \S+/axis_face\.py|USER_TABS_PATH = \S+/probe_basic/"
)


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


def page_lines(config: Config, page: Page, prefix: str) -> dict[str, list[str]]:
    """Return the lines, by section, that show a page; none where the user has them or others."""
    own = OWN_KEYS.get((screen_of(config), page))
    if own:
        present = config.ini.get("DISPLAY", own.key)
        return {} if present else {"DISPLAY": [f"{own.key} = {prefix}/{own.value}"]}
    if Path(page.file).name in (Path(name).name for name in glade_files(config)):
        return {}
    return tab_or_window(config, page, prefix)


def window_line(page: Page, prefix: str) -> dict[str, list[str]]:
    return {"HAL": [f"HALCMD = {OWN_WINDOW}{page.name.lower()} {page.command(prefix)}"]}


def tab_or_window(config: Config, page: Page, prefix: str) -> dict[str, list[str]]:
    """Return the lines of a page's tab, or of its window where the screen has no tabs.

    Screens pair names and locations by number: if a tab of the user has none, this one has none.
    QtVCP would not show it then: there it gets a window.
    """
    location = tab_location(config)
    locations, names = (config.ini.all("DISPLAY", f"EMBED_TAB_{key}")
                        for key in ("LOCATION", "NAME"))  # fmt: skip
    paired = len(locations) == len(names)
    if location is None or (screen_of(config) == QTVCP and not paired):
        return window_line(page, prefix)
    place = [f"EMBED_TAB_LOCATION = {location}"] if location and paired else []
    command = f"EMBED_TAB_COMMAND = {TAB}{page.command(prefix)}"
    return {"DISPLAY": [f"EMBED_TAB_NAME = {page.name}", *place, command]}


def screen_findings(config: Config) -> Iterator[ConfigFinding]:
    yield from missing_files(config)
    if is_for_face(config) and not config.features.keys().isdisjoint(AXES_NEEDED):
        yield from key_taken(config, FACE)


def missing_files(config: Config) -> Iterator[ConfigFinding]:
    """Find lines that name a page's file where it is not."""
    keys = ("EMBED_TAB_COMMAND", "USER_COMMAND_FILE", "USER_TABS_PATH")
    entries = [("DISPLAY", key) for key in keys] + [("HAL", "HALCMD")]
    for section, key in entries:
        for value in config.ini.all(section, key):
            for word in filter(OWN_FILES.search, value.split()):
                if not folder_from_ini(config.ini, word).exists():
                    yield problem(
                        "screen",
                        f"[{section}] {key}: {word} is not there, the screen cannot show it",
                        "name it where the package is (g12/…), or run install again",
                    )


def key_taken(config: Config, page: Page) -> Iterator[ConfigFinding]:
    """Report the user's own file or folder, which takes the key that would show a page."""
    own = OWN_KEYS.get((screen_of(config), page))
    value = config.ini.get("DISPLAY", own.key) if own else None
    if not own or not value or OWN_FILES.search(value):
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
