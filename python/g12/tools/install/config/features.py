# SPDX-License-Identifier: GPL-2.0-or-later
"""The features that a machine can have: one table, and what follows from it."""

from functools import cache
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import HANDLERS, Remap, entries_of, remap_from_value
from g12.tools.translate.blocks.control import read_control, shipped_controls

ROOT = Path(__file__).resolve().parents[5]  # the folder that holds ngc, python and configs
INCLUDES = ROOT / "configs" / "include"
COPY = "g12"  # the folder beside the INI that gets the package


class Feature(NamedTuple):
    """A name of ``--with``."""

    meaning: str
    remaps: str = ""  # the file of its REMAP lines
    axes: str = "XYZ"  # that the machine needs
    subs: tuple[str, ...] = ()  # that a program or a handler calls, besides those of the codes
    first_step: str = ""  # what to try of it, besides a code


POLAR_SHAPES = "polar-shapes"  # they need polar or polar-g12.3
SPINDLE_AS_C, KINEMATICS = "spindle-c", "polar-kinematics"
FORMS, CYCLES_PAGE = "forms", "cycles-page"
POLAR_FEATURES = ("polar", "polar-g12.3")
SECTION_SUBS = ("g12_skipped_over",)
NOTHING = "does nothing, and is no error"
HOLES = ("face_holes", "side_holes", "face_hole_at", "g12_holes")
FEATURES = {
    "haas": Feature("G12/G13 circular pocket, Haas words", "g12_haas.inc"),
    "yasnac": Feature("G12/G13 circle cutting, Yasnac words", "g12_yasnac.inc"),
    "mitsubishi": Feature("G12/G13 circular cutting, Mitsubishi words", "g12_mitsubishi.inc"),
    "circle-mill": Feature("G12.2/G13.2 circle mill event, perimeter and pocket",
                           "circle_mill.inc", subs=("circle_mill",)),
    "bore": Feature("G12.5/G13.5 bore along a helix", "bore.inc"),
    "thread": Feature("G12.6/G13.6 thread milling", "thread.inc"),
    "frame": Feature("G12.7/G13.7 frame: a rectangle as pocket or wall", "frame.inc",
                     subs=("g12_frame_ring",)),
    "polar": Feature("G12.1/G13.1 polar coordinate interpolation on and off", "polar.inc", "XC",
                     SECTION_SUBS, f"G13.1  {NOTHING}"),
    "polar-g12.3": Feature("G12.3/G13.3 polar coordinate interpolation on and off",
                           "polar_g12_3.inc", "XC", SECTION_SUBS, f"G13.3  {NOTHING}"),
    "cylinder": Feature("G7.1 (G07.1) cylindrical interpolation on and off", "cylinder.inc", "XZC",
                        SECTION_SUBS, f"G7.1 C0 (on a mill A0 or B0) {NOTHING}"),
    POLAR_SHAPES: Feature(
        "o<polar_polygon> and other shapes, o<face_holes> and other holes, by G12.4/G13.4",
        "polar_shapes.inc", "XC",
        ("polar_polygon", "polar_slot", "polar_pocket", *HOLES),
        "o<polar_polygon> call is refused, its entries are missing: it works"),
    SPINDLE_AS_C: Feature(
        "M254/M255 the spindle becomes C, and the spindle again (--pins)", "spindle_c.inc", "C",
        first_step="home, M254: the spindle turns to its index and to C; M255 gives it back"),
    KINEMATICS: Feature(
        "G12.1 in LinuxCNC's planner, on a lathe of the usual form (make kinematics)",
        first_step="home, a program with G12.1: the screen shows the face until its G13.1"),
    FORMS: Feature(
        "ngcgui's pages to fill in, with pictures, for the codes that the machine has",
        first_step="fill in a form on its page, Create Feature, Finalize: the program is open"),
    CYCLES_PAGE: Feature(
        "one page for these codes, which draws each cycle as it is typed",
        first_step="on the page Cycles choose a cycle, type, Add, Open: the program is open"),
}  # fmt: skip
CONTROLS = {f"programs-{control}": control for control in shipped_controls()}
CODES = tuple(name for name, feature in FEATURES.items() if feature.remaps)
ON_LATHE = tuple(name for name in CODES if "C" in FEATURES[name].axes)
FEATURE_NAMES = (*FEATURES, *CONTROLS)
EXCLUSIVE = (("haas", "yasnac", "mitsubishi"), POLAR_FEATURES, tuple(CONTROLS))
MEANING = {name: feature.meaning for name, feature in FEATURES.items()} | {
    name: f"files such as .nc are opened as programs of {control}"
    for name, control in CONTROLS.items()
}
ON_ABORT = "ON_ABORT_COMMAND"  # of [RS274NGC], and of [G12] for the user's own command
ABORT_SUB = "g12_on_abort"
CALLS_ABORT_SUB = f"O <{ABORT_SUB}> call"
SHARED_EPILOG = "cycle_done"  # it does not identify a cycle


def own_names(remap: Remap) -> set[str]:
    """Return the names that identify a REMAP line's cycle: its subs and functions."""
    names = {remap.keywords[word] for word in ("ngc", *HANDLERS) if word in remap.keywords}
    return names - {SHARED_EPILOG}


@cache
def remaps_of(feature: str) -> tuple[Remap, ...]:
    """Return the REMAP lines of a feature, from its file in configs/include."""
    lines = (INCLUDES / FEATURES[feature].remaps).read_text(encoding="utf-8").splitlines()
    entries = entries_of(["[RS274NGC]", *lines], "RS274NGC")
    return tuple(remap_from_value(value) for _, key, value in entries if key == "REMAP")


def feature_of(remap: Remap) -> str | None:
    """Return the feature of a machine's REMAP line, whatever its code; None if it is no one's."""
    own = own_names(remap)
    models = [(model, feature) for feature in CODES for model in remaps_of(feature)]
    alike = [(model, feature) for model, feature in models if own & own_names(model)]
    same_code = [feature for model, feature in alike if model.number == remap.number]
    return next(iter([*same_code, *(feature for _, feature in alike)]), None)


def functions_of(feature: str) -> list[str]:
    return list(dict.fromkeys(name for remap in remaps_of(feature) for name in remap.handlers))


def first_step(feature: str) -> str:
    """Return what to try first of an installed feature, and what happens then."""
    if feature in CONTROLS:
        control = read_control(CONTROLS[feature])
        return f"open a .{control.extensions[0]} program of {control.name}"
    refused = "is refused, a word is missing: it works"
    return FEATURES[feature].first_step or f"{remaps_of(feature)[0].code:6} {refused}"


def axes_needed(feature: str, axes: str) -> str:
    """Return the axes that a code needs; a mill whose ``axes`` have A or B can cut a cylinder."""
    on_mill = feature == "cylinder" and rotary_of_mill(axes)
    return "XYZ" if on_mill else FEATURES[feature].axes


def rotary_of_mill(axes: str) -> str:
    """Return the letters of the axes that turn a part on a mill."""
    return "".join(axis for axis in "AB" if axis in axes and "Y" in axes)
