# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms in a machine config: the lines that show them on its screen, and the checks.

A form is a sub in `ngc` that LinuxCNC's ngcgui shows as a page. There are three versions of ngcgui.
AXIS loads one as a Tcl package. Some screens of QtVCP contain one. GladeVCP makes one from
`forms.ui`, in a tab of gmoccapy or Touchy or, with any other screen, in a window of its own.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path

from g12.lengths import is_inch
from g12.tools.forms.table import FORMS, HANDLERS
from g12.tools.install.config.findings import ConfigFinding, problem, warning
from g12.tools.install.config.loaded import Config, folder_from_ini, subs_named
from g12.tools.install.config.screen import (
    AXIS,
    NGCGUI_PAGE,
    QTVCP,
    glade_files,
    screen_of,
    tab_or_window,
    window_line,
    words_of,
)

FORMS_OF = {  # the forms of a feature
    feature: tuple(f"form_{form.name}" for form in FORMS if form.feature == feature)
    for feature in HANDLERS
}
UNIT_NAMES = ("inch", "mm")
FORM_SUBS = ("form_start", "form_end")  # subs that forms call
FACE_FORM_SUBS = ("form_face_start", "form_face_end")  # and those of a lathe's face
NGCGUI = "Ngcgui"  # the Tcl package that AXIS loads
QTVCP_WITH_NGCGUI = ("qtdragon", "woodpecker")  # prefix of these screens' names
HERE = "/proc/self/cwd"  # LinuxCNC and its screen work in the INI's folder
FORM_LINE = re.compile(
    r"TKPKG = Ngcgui 1\.0|NGCGUI_SUBFILE = (\S+/ngc/)?form_\w+\.ngc|NGCGUI_SUBFILE_PATH = \S+/ngc"
)
GLADEVCP = "gladevcp"  # beside AXIS and QTVCP, a program whose ngcgui shows the forms


def ngcgui_of(config: Config) -> str:
    """Return the program whose ngcgui shows the forms on a config's screen."""
    screen = screen_of(config)
    own_page = any(word.startswith(QTVCP_WITH_NGCGUI) for word in words_of(config)[1:])
    return screen if screen == AXIS or (screen == QTVCP and own_page) else GLADEVCP


def files_of(config: Config, features: Iterable[str]) -> list[str]:
    """Return the files of the features' forms, in the machine's unit."""
    unit = "inch" if is_inch(config.ini.mm) else "mm"
    return [f"{form}_{unit}.ngc" for feature in features for form in FORMS_OF.get(feature, ())]


def lines_for(config: Config, features: Sequence[str], prefix: str) -> dict[str, list[str]]:
    """Return the missing lines that show the features' forms, by section.

    ``prefix`` is the package's folder as the INI names it.
    """
    present = {Path(name).name for name in config.ini.all("DISPLAY", "NGCGUI_SUBFILE")}
    pages = [name for name in files_of(config, features) if name not in present]
    lines = screen_lines(config, prefix)
    folder = folder_of_pages(config, prefix)
    shown_pages = [f"NGCGUI_SUBFILE = {folder}{page}" for page in pages]
    return {**lines, "DISPLAY": [*lines.get("DISPLAY", []), *shown_pages]}


def folder_of_pages(config: Config, prefix: str) -> str:
    """Return the path before a form's name: QtVCP searches one folder for plain names."""
    folder = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH")
    if ngcgui_of(config) != QTVCP or folder in (None, f"{prefix}/ngc"):
        return ""
    return f"{HERE / Path(prefix)}/ngc/"


def screen_lines(config: Config, prefix: str) -> dict[str, list[str]]:
    """Return the lines, by section, that make a screen show ngcgui; none where it does already."""
    kind = ngcgui_of(config)
    if kind == AXIS:
        return {} if NGCGUI in packages(config) else {"DISPLAY": [f"TKPKG = {NGCGUI} 1.0"]}
    if kind == QTVCP:
        present = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH")
        return {} if present else {"DISPLAY": [f"NGCGUI_SUBFILE_PATH = {prefix}/ngc"]}
    if pages_of_gladevcp(config):
        return {}
    return ngcgui_page(config, prefix)


def ngcgui_page(config: Config, prefix: str) -> dict[str, list[str]]:
    """Return the lines, by section, of the page that contains GladeVCP's ngcgui."""
    if screen_of(config) == QTVCP:
        return window_line(NGCGUI_PAGE, prefix)
    return tab_or_window(config, NGCGUI_PAGE, prefix)


def packages(config: Config) -> list[str]:
    """Return the Tcl packages that AXIS loads, which ngcgui is one of."""
    values = config.ini.all("DISPLAY", "TKPKG")
    return [word for value in values for word in value.split()[:1]]


def pages_of_gladevcp(config: Config) -> list[Path]:
    """Return the GladeVCP files of a config that contain ngcgui or are missing."""
    files = [folder_from_ini(config.ini, name) for name in glade_files(config)]
    return [file for file in files if not file.is_file() or b"PyNgcGui" in file.read_bytes()]


def shown(config: Config) -> list[str]:
    """Return the package's forms that a config names, without ``.ngc``."""
    names = (Path(value).name for value in config.ini.all("DISPLAY", "NGCGUI_SUBFILE"))
    return [name.removesuffix(".ngc") for name in names if name.startswith("form_")]


def form_findings(config: Config) -> Iterator[ConfigFinding]:
    forms = shown(config)
    for form in forms:
        yield from form_finding(config, form)
    if forms:
        yield from SCREEN_RULES[ngcgui_of(config)](config)


def form_finding(config: Config, form: str) -> Iterator[ConfigFinding]:
    stem = form.rpartition("_")[0]
    own = {feature: names for feature, names in FORMS_OF.items() if stem in names}
    parts = FACE_FORM_SUBS if "polar-shapes" in own else FORM_SUBS
    missing = [name for name in (form, *parts) if not subs_named(config.ini, name)]
    if missing:
        known = [f"{name}_{unit}" for name in chain(*FORMS_OF.values()) for unit in UNIT_NAMES]
        cure = "add the package's folder ngc to SUBROUTINE_PATH, or run install again"
        yield problem(
            "form",
            f"[DISPLAY] NGCGUI_SUBFILE = {form}.ngc: {missing[0]}.ngc is in none of the folders "
            "of SUBROUTINE_PATH",
            cure if form in known else f"the forms are {', '.join(known)}",
        )
    elif own and config.features.keys().isdisjoint(own):
        yield problem(
            "form",
            f"[DISPLAY] NGCGUI_SUBFILE = {form}.ngc: the codes of {' or '.join(own)} are not set "
            "up here",
            "take the line out, or install that feature",
        )


def axis_findings(config: Config) -> Iterator[ConfigFinding]:
    if NGCGUI not in packages(config):
        loaded = " and ".join(packages(config)) or "nothing"
        yield problem(
            "form",
            f"[DISPLAY] TKPKG = {loaded}: AXIS shows no forms",
            f"have: TKPKG = {NGCGUI} 1.0",
        )


def gladevcp_findings(config: Config) -> Iterator[ConfigFinding]:
    screen = screen_of(config)
    if not any(file.is_file() for file in pages_of_gladevcp(config)):
        ((section, lines),) = ngcgui_page(config, "g12").items()
        yield problem(
            "form",
            "no EMBED_TAB_COMMAND of [DISPLAY] and no HALCMD of [HAL] names a file with ngcgui: "
            f"{screen} shows no forms",
            f"have: [{section}] {', '.join(lines)}",
        )
    prefix = config.ini.get("DISPLAY", "PROGRAM_PREFIX")
    if prefix and not folder_from_ini(config.ini, prefix).is_dir():
        yield warning(
            "form",
            f"[DISPLAY] PROGRAM_PREFIX = {prefix}: there is no such folder, and Finalize writes "
            "the forms' program nowhere else",
            "make that folder, or name one that is there",
        )


def qtvcp_findings(config: Config) -> Iterator[ConfigFinding]:
    """Find forms outside QtVCP's search: below one folder, or by a full path."""
    folder = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH")
    for name in config.ini.all("DISPLAY", "NGCGUI_SUBFILE"):
        is_form = Path(name).name.startswith("form_")
        file = name.replace(HERE, str(config.folder), 1)
        if is_form and not (folder and (folder_from_ini(config.ini, folder) / file).is_file()):
            yield problem(
                "form",
                f"[DISPLAY] NGCGUI_SUBFILE_PATH = {folder or 'nothing'}, NGCGUI_SUBFILE = {name}: "
                "that file is not there",
                "have NGCGUI_SUBFILE_PATH = g12/ngc; if your own pages need that line, "
                f"NGCGUI_SUBFILE = {HERE}/g12/ngc/{Path(name).name}",
            )


SCREEN_RULES = {AXIS: axis_findings, QTVCP: qtvcp_findings, GLADEVCP: gladevcp_findings}
