# SPDX-License-Identifier: GPL-2.0-or-later
"""The features that a machine can have, and their REMAP lines."""

from difflib import get_close_matches
from functools import cache
from pathlib import Path

from g12.machine_ini import HANDLERS, Remap, entries_of, remap_from_value
from g12.tools.translate.blocks.control import read_control, shipped_controls

ROOT = Path(__file__).resolve().parents[5]  # the folder that holds ngc, python and configs
INCLUDES = ROOT / "configs" / "include"

POLAR_SHAPES = "polar-shapes"  # they need polar or polar-g12.3
SPINDLE_AS_C = "spindle-c"
REMAP_FILES = {
    "haas": "g12_haas.inc",
    "yasnac": "g12_yasnac.inc",
    "mitsubishi": "g12_mitsubishi.inc",
    "circle-mill": "circle_mill.inc",
    "bore": "bore.inc",
    "thread": "thread.inc",
    "frame": "frame.inc",
    "polar": "polar.inc",
    "polar-g12.3": "polar_g12_3.inc",
    "cylinder": "cylinder.inc",
    POLAR_SHAPES: "polar_shapes.inc",
    SPINDLE_AS_C: "spindle_c.inc",
}
CONTROLS = {f"programs-{control}": control for control in shipped_controls()}
FORMS, CYCLES_PAGE = "forms", "cycles-page"
KINEMATICS = "polar-kinematics"
FEATURE_NAMES = (*REMAP_FILES, KINEMATICS, FORMS, CYCLES_PAGE, *CONTROLS)
EXCLUSIVE = (("haas", "yasnac", "mitsubishi"), ("polar", "polar-g12.3"), tuple(CONTROLS))
POLAR_FEATURES = ("polar", "polar-g12.3")
AXES_NEEDED = {  # of the machine; a mill's are XYZ
    **dict.fromkeys((*POLAR_FEATURES, POLAR_SHAPES), "XC"),
    "cylinder": "XZC",
    SPINDLE_AS_C: "C",
}
ROTARY_OF_MILL = "AB"  # the axes round which a mill can cut a cylinder
MEANING = {
    "haas": "G12/G13 circular pocket, Haas words",
    "yasnac": "G12/G13 circle cutting, Yasnac words",
    "mitsubishi": "G12/G13 circular cutting, Mitsubishi words",
    "circle-mill": "G12.2/G13.2 circle mill event, perimeter and pocket",
    "bore": "G12.5/G13.5 bore along a helix",
    "thread": "G12.6/G13.6 thread milling",
    "frame": "G12.7/G13.7 frame: a rectangle as pocket or wall",
    "polar": "G12.1/G13.1 polar coordinate interpolation on and off",
    "polar-g12.3": "G12.3/G13.3 polar coordinate interpolation on and off",
    "cylinder": "G7.1 (G07.1) cylindrical interpolation on and off",
    KINEMATICS: "G12.1 in LinuxCNC's planner, on a lathe of the usual form (make kinematics)",
    FORMS: "ngcgui's pages to fill in, with pictures, for the codes that the machine has",
    CYCLES_PAGE: "one page for these codes, which draws each cycle as it is typed",
    SPINDLE_AS_C: "M254/M255 the spindle becomes C, and the spindle again (--pins)",
    POLAR_SHAPES: "o<polar_polygon> and other shapes, o<face_holes> and other holes, "
    "by G12.4/G13.4",
    **{
        name: f"files such as .nc are opened as programs of {control}"
        for name, control in CONTROLS.items()
    },
}
FIRST_STEPS = {  # what to try of a feature, besides a code
    POLAR_SHAPES: "o<polar_polygon> call is refused, its entries are missing: it works",
    SPINDLE_AS_C: "home, M254: the spindle turns to its index and to C; M255 gives it back",
    KINEMATICS: "home, a program with G12.1: the screen shows the face until its G13.1",
    FORMS: "fill in a form on its page, Create Feature, Finalize: the program is open",
    CYCLES_PAGE: "on the page Cycles choose a cycle, type, Add, Open: the program is open",
}
ON_ABORT = "ON_ABORT_COMMAND"  # of [RS274NGC], and of [G12] for the user's own command
ABORT_SUB = "g12_on_abort"
CALLS_ABORT_SUB = f"O <{ABORT_SUB}> call"
SHARED_EPILOG = "cycle_done"  # it does not identify a cycle
CALLED_SUBS = {  # subs that a program or a handler calls, besides those of the codes
    "circle-mill": ("circle_mill",),
    "frame": ("g12_frame_ring",),
    **dict.fromkeys(AXES_NEEDED, ("g12_skipped_over",)),
    POLAR_SHAPES: (
        "polar_polygon",
        "polar_slot",
        "polar_pocket",
        "face_holes",
        "side_holes",
        "face_hole_at",
        "g12_holes",
    ),
    SPINDLE_AS_C: (),
}

CLOSE = 0.8  # least similarity of a misspelt name


def own_names(remap: Remap) -> set[str]:
    """Return the names that identify a REMAP line's cycle: its subs and functions."""
    names = {remap.keywords[word] for word in ("ngc", *HANDLERS) if word in remap.keywords}
    return names - {SHARED_EPILOG}


@cache
def remaps_of(feature: str) -> tuple[Remap, ...]:
    """Return the REMAP lines of a feature, from its file in configs/include."""
    lines = (INCLUDES / REMAP_FILES[feature]).read_text(encoding="utf-8").splitlines()
    entries = entries_of(["[RS274NGC]", *lines], "RS274NGC")
    return tuple(remap_from_value(value) for _, key, value in entries if key == "REMAP")


def model_of(remap: Remap) -> tuple[str, Remap] | None:
    """Return the feature of a machine's REMAP line, and the package's own line."""
    models = [(feature, model) for feature in REMAP_FILES for model in remaps_of(feature)]

    def likeness(candidate: tuple[str, Remap]) -> tuple[int, bool]:
        _, model = candidate
        return len(own_names(model) & own_names(remap)), model.number == remap.number

    best = max(models, key=likeness)
    if likeness(best)[0]:
        return best
    return next((found for found in models if is_misspelt(remap, found[1])), None)


def is_misspelt(remap: Remap, model: Remap) -> bool:
    """Return whether a REMAP line of the same code has the names of a line, misspelt."""
    names = own_names(remap) if remap.number == model.number else ()
    close = [get_close_matches(name, own_names(model), cutoff=CLOSE) for name in names]
    return bool(close) and all(close)


def names_of(feature: str) -> list[str]:
    """Return the NGC subs that a feature's codes and programs call."""
    called = [remap.keywords["ngc"] for remap in remaps_of(feature) if "ngc" in remap.keywords]
    return list(dict.fromkeys([*called, *CALLED_SUBS.get(feature, ())]))


def first_step(feature: str) -> str:
    """Return what to try first of an installed feature, and what happens then."""
    if feature in FIRST_STEPS:
        return FIRST_STEPS[feature]
    if feature in CONTROLS:
        control = read_control(CONTROLS[feature])
        return f"open a .{control.extensions[0]} program of {control.name}"
    codes = [remap.code for remap in remaps_of(feature)]
    if feature in (*POLAR_FEATURES, "cylinder"):
        block = codes[1] if feature in POLAR_FEATURES else f"{codes[0]} C0"
        return f"{block:6} does nothing, and is no error"
    return f"{codes[0]:6} is refused, a word is missing: it works"


def is_abort_call(command: str) -> bool:
    """Return whether LinuxCNC calls the package after an abort."""
    return "".join(command.lower().split()) == "".join(CALLS_ABORT_SUB.lower().split())


def axes_needed(feature: str, axes: str) -> str:
    """Return the axes that a code needs; ``axes`` are the machine's."""
    turn = next((letter for letter in ROTARY_OF_MILL if letter in axes and "Y" in axes), "")
    if feature == "cylinder" and turn:
        return f"XYZ{turn}"
    return AXES_NEEDED.get(feature, "XYZ")


def functions_of(feature: str) -> list[str]:
    return list(dict.fromkeys(name for remap in remaps_of(feature) for name in remap.handlers))
