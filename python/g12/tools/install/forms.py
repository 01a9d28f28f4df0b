# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms in a machine config: the lines of [DISPLAY] that show them, and what can be wrong.

A form is a sub in `ngc` that LinuxCNC's ngcgui makes a page of. AXIS has ngcgui of its own, QtVCP's
screens too; gmoccapy shows it in a tab that GladeVCP makes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from g12.lengths import is_inch
from g12.tools.install.config import Config, folder_from_ini, subs_named
from g12.tools.install.findings import Finding, problem

OF = {  # the forms of a feature
    "haas": ("form_haas",),
    "yasnac": ("form_yasnac",),
    "mitsubishi": ("form_mitsubishi",),
    "circle-mill": ("form_circle_mill",),
    "polar-shapes": ("form_polygon", "form_slot", "form_face_pocket"),
}
UNITS = ("inch", "mm")
PARTS = ("form_start", "form_end")  # subs that forms call
FACE_PARTS = ("form_face_start", "form_face_end")  # and those of a lathe's face
NGCGUI = "Ngcgui"  # the Tcl package that AXIS loads
TAB = "gladevcp -x {XID} "
PAGE = "configs/include/forms.ui"
OWN_LINE = re.compile(
    r"TKPKG = Ngcgui 1\.0|NGCGUI_SUBFILE = form_\w+\.ngc|NGCGUI_SUBFILE_PATH = \S+/ngc"
    r"|EMBED_TAB_NAME = Forms|EMBED_TAB_LOCATION = ntb_user_tabs"
    r"|EMBED_TAB_COMMAND = gladevcp -x \{XID\} \S+/forms\.ui"
)
SCREENS = ("axis", "gmoccapy", "qtvcp")


def screen_of(config: Config) -> str:
    """Return the program that a config's screen is, "" if it names none."""
    words = (config.ini.get("DISPLAY", "DISPLAY") or "").split()
    return Path(words[0]).name if words else ""


def files_of(config: Config, features: Iterable[str]) -> list[str]:
    """Return the files of the features' forms, in the machine's unit."""
    unit = UNITS[0] if is_inch(config.ini.mm) else UNITS[1]
    return [f"{form}_{unit}.ngc" for feature in features for form in OF.get(feature, ())]


def lines_for(config: Config, features: Sequence[str], prefix: str) -> list[str]:
    """Return the lines of [DISPLAY] that show the features' forms, without those that are there.

    ``prefix`` is the package's folder as the INI names it.
    """
    there = config.ini.all("DISPLAY", "NGCGUI_SUBFILE")
    pages = [name for name in files_of(config, features) if name not in there]
    return [
        *screen_lines(config, screen_of(config), prefix),
        *(f"NGCGUI_SUBFILE = {page}" for page in pages),
    ]


def screen_lines(config: Config, screen: str, prefix: str) -> list[str]:
    """Return the lines that make a screen show ngcgui, none if it does."""
    if screen == "axis" and NGCGUI not in packages(config):
        return [f"TKPKG = {NGCGUI} 1.0"]
    if screen == "qtvcp" and not config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH"):
        return [f"NGCGUI_SUBFILE_PATH = {prefix}/ngc"]
    if screen == "gmoccapy" and not pages_in_tabs(config):
        return [
            "EMBED_TAB_NAME = Forms",
            "EMBED_TAB_LOCATION = ntb_user_tabs",
            f"EMBED_TAB_COMMAND = {TAB}{prefix}/{PAGE}",
        ]
    return []


def packages(config: Config) -> list[str]:
    """Return the Tcl packages that AXIS loads, which ngcgui is one of."""
    values = config.ini.all("DISPLAY", "TKPKG")
    return [word for value in values for word in value.split()[:1]]


def pages_in_tabs(config: Config) -> list[Path]:
    """Return the GladeVCP files of a config's tabs that hold ngcgui, or that are not there."""
    commands = config.ini.all("DISPLAY", "EMBED_TAB_COMMAND")
    names = (word for command in commands for word in command.split() if word.endswith(".ui"))
    files = [folder_from_ini(config.ini, name) for name in names]
    return [file for file in files if not file.is_file() or b"PyNgcGui" in file.read_bytes()]


def shown(config: Config) -> list[str]:
    """Return the package's forms that a config names, without ``.ngc``."""
    names = (Path(value).name for value in config.ini.all("DISPLAY", "NGCGUI_SUBFILE"))
    return [name.removesuffix(".ngc") for name in names if name.startswith("form_")]


def form_findings(config: Config, features: set[str]) -> Iterator[Finding]:
    """Find what keeps forms from being shown or from working; ``features`` are those there."""
    forms = shown(config)
    for form in forms:
        yield from form_finding(config, form, features)
    if forms:
        yield from screen_findings(config, screen_of(config))


def form_finding(config: Config, form: str, features: set[str]) -> Iterator[Finding]:
    """Find what is wrong with one form."""
    own = {feature: names for feature, names in OF.items() if form.rpartition("_")[0] in names}
    parts = FACE_PARTS if "polar-shapes" in own else PARTS
    missing = [name for name in (form, *parts) if not subs_named(config.ini, name)]
    if missing:
        known = [f"{name}_{unit}" for names in OF.values() for name in names for unit in UNITS]
        cure = "add the package's folder ngc to SUBROUTINE_PATH, or run install again"
        yield problem(
            "form",
            f"[DISPLAY] NGCGUI_SUBFILE = {form}.ngc: {missing[0]}.ngc is in none of the folders "
            "of SUBROUTINE_PATH",
            cure if form in known else f"the forms are {', '.join(known)}",
        )
    elif own and not features & own.keys():
        yield problem(
            "form",
            f"[DISPLAY] NGCGUI_SUBFILE = {form}.ngc: the codes of {' or '.join(own)} are not set "
            "up here",
            "take the line out, or install that feature",
        )


def screen_findings(config: Config, screen: str) -> Iterator[Finding]:
    """Find a screen that does not show the forms its INI names."""
    if screen == "axis" and NGCGUI not in packages(config):
        said = f"[DISPLAY] TKPKG = {' and '.join(packages(config)) or 'nothing'}"
        yield problem("form", f"{said}: AXIS shows no forms", f"have: TKPKG = {NGCGUI} 1.0")
    if screen == "gmoccapy" and not any(file.is_file() for file in pages_in_tabs(config)):
        yield problem(
            "form",
            "no [DISPLAY] EMBED_TAB_COMMAND names a file with ngcgui: gmoccapy shows no forms",
            f"have: EMBED_TAB_COMMAND = {TAB}g12/{PAGE}, EMBED_TAB_NAME and EMBED_TAB_LOCATION",
        )
    if screen == "qtvcp":
        yield from qtvcp_findings(config)


def qtvcp_findings(config: Config) -> Iterator[Finding]:
    """Find forms that are not in the one folder where a QtVCP screen looks."""
    name = config.ini.get("DISPLAY", "NGCGUI_SUBFILE_PATH")
    folder = folder_from_ini(config.ini, name) if name else None
    for form in shown(config):
        if not folder or not (folder / f"{form}.ngc").is_file():
            yield problem(
                "form",
                f"[DISPLAY] NGCGUI_SUBFILE_PATH = {name or 'nothing'}: {form}.ngc is not there",
                "have: NGCGUI_SUBFILE_PATH = g12/ngc (QtVCP's screens look nowhere else)",
            )
