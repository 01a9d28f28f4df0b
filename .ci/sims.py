# SPDX-License-Identifier: GPL-2.0-or-later
"""The simulated machines of configs/sim: flat INIs, each whole, to be copied.

    python3 .ci/sims.py

writes them anew from the table of machines below. Lengths are machine units, angles degrees, times
seconds. The REMAP lines are those of configs/include.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

CONFIGS = Path(__file__).resolve().parents[1] / "configs"
COMMAND = "python3 ../../python/g12"


class Slide(NamedTuple):
    """An axis and its joint."""

    letter: str
    low: float
    high: float
    velocity: float
    acceleration: float


class Machine(NamedTuple):
    """A machine; ``codes`` are files of configs/include, ``remaps`` further lines.

    ``face`` is the acceleration of X and Y on the face, None without its kinematics.
    """

    name: str
    what: str
    unit: str
    slides: tuple[Slide, ...]
    velocities: tuple[float, float]
    codes: tuple[str, ...]
    forms: tuple[str, ...]
    control: str
    remaps: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    table: str = ""
    sample: str = ""
    face: float | None = None
    spindle_c: bool = False
    screens: tuple[str, ...] = ("axis", "headless")
    overrides: str = "2.0"


MILL_MM = (
    Slide("X", -500, 500, 250, 1500),
    Slide("Y", -500, 500, 250, 1500),
    Slide("Z", -300, 300, 150, 1500),
)
MILL_INCH = (
    Slide("X", -20, 20, 10, 60),
    Slide("Y", -20, 20, 10, 60),
    Slide("Z", -12, 12, 6, 60),
)
ROTARY_TABLE = Slide("A", -99999, 99999, 360, 3600)
LATHE_MM = (
    Slide("X", -10, 300, 150, 1000),
    Slide("Z", -500, 500, 150, 1000),
    Slide("C", -99999, 99999, 360, 3600),
)
SLOW_C_MM = (
    Slide("X", -10, 300, 150, 1500),
    Slide("Z", -500, 500, 150, 1000),
    Slide("C", -99999, 99999, 90, 1200),
)
INCHES_PER_S, INCHES_PER_S2 = 5.9055118110236, 39.370078740157  # 150 mm/s, 1000 mm/s²
LATHE_INCH = (
    Slide("X", -0.4, 12, INCHES_PER_S, INCHES_PER_S2),
    Slide("Z", -20, 20, INCHES_PER_S, INCHES_PER_S2),
    Slide("C", -99999, 99999, 360, 3600),
)

ROTARY = "ABC"
HOLES = ("bore", "thread", "frame")
FORMS_OF_LATHE = ("polygon", "slot", "face_pocket", "face_holes", "side_holes")
CODES_OF_LATHE = ("polar", "cylinder", "polar_shapes")
# The manual's codes for the work and the tool spindle, which do nothing on these machines.
UNUSED_SPINDLES = ("REMAP = M33 modalgroup=10 ngc=m33", "REMAP = M35 modalgroup=10 ngc=m35")
# The same codes on a lathe whose spindle becomes C.
SPINDLES = (
    "REMAP = M33 modalgroup=10 ngc=live_tool",
    "REMAP = M35 modalgroup=10 prolog=spindle_c_on ngc=spindle_c_on epilog=spindle_c_is_on",
)
PROGRAMS = {
    "haas-mill": ("Haas programs", ("nc",)),
    "yasnac-mill": ("Yasnac programs", ("nc", "tap")),
    "mitsubishi-mill": ("Mitsubishi programs", ("nc", "tap")),
    "fanuc-lathe": ("Fanuc programs of G code system A", ("nc", "tap")),
}


def mill(name: str, dialect: str, as_on: str, **more) -> Machine:
    unit = name.rsplit("_", 1)[1]
    return Machine(
        name=name,
        what=f"mill in {UNIT_NAMES[unit]}, G12/G13 as on {as_on}",
        unit=unit,
        velocities=(50, 250) if unit == "mm" else (2, 10),
        codes=(f"g12_{dialect}", "circle_mill", *HOLES),
        forms=(dialect, "circle_mill", *HOLES),
        control=f"{dialect}-mill",
        **{
            "slides": MILL_MM if unit == "mm" else MILL_INCH,
            "table": f"mill_{unit}",
            **more,
        },
    )


def with_a(unit: str) -> Machine:
    slides = MILL_MM if unit == "mm" else MILL_INCH
    name, as_on = f"mill_a_{unit}", "Haas, with a rotary axis A"
    more = {"slides": (*slides, ROTARY_TABLE), "settings": ("CYLINDER_X = allow",)}
    made = mill(name, "haas", as_on, **more)
    return made._replace(codes=(*made.codes, "cylinder"))


def lathe(name: str, unit: str, what: str, **more) -> Machine:
    own = {
        "slides": LATHE_MM if unit == "mm" else LATHE_INCH,
        "codes": CODES_OF_LATHE,
        "forms": FORMS_OF_LATHE,
        "remaps": UNUSED_SPINDLES,
        "table": f"lathe_{unit}",
    }
    return Machine(
        name=name,
        what=f"lathe in {UNIT_NAMES[unit]} {what}",
        unit=unit,
        velocities=(50, 150) if unit == "mm" else (2, INCHES_PER_S),
        control="fanuc-lathe",
        **own | more,
    )


def on_face(name: str, unit: str, what: str, face: float, **more) -> Machine:
    codes = (*CODES_OF_LATHE, "polar_kinematics")
    settings = ("POLAR_KINEMATICS = 1",)
    what = f"{what}whose G12.1 moves X and Y by kinematics"
    sample = f"lathe_{unit}"
    return lathe(name, unit, what, face=face, codes=codes, settings=settings, sample=sample, **more)


def spindle_c(unit: str) -> Machine:
    what = "with X slide and a spindle that becomes C"
    codes = (*CODES_OF_LATHE, "spindle_c")
    name = f"lathe_spindle_c_{unit}"
    return lathe(name, unit, what, codes=codes, remaps=SPINDLES, spindle_c=True)


UNIT_NAMES = {"mm": "millimetres", "inch": "inches"}
SLIDE_AND_C = "with X slide and C axis"
HELIX = ("ENTRY = helix", "PLUNGE_FEED = 60")
MACHINES = (
    mill("mill_mm", "haas", "Haas", screens=("axis", "gmoccapy", "headless")),
    mill("mill_inch", "haas", "Haas"),
    mill("mill_helix_mm", "haas", "Haas with a helical plunge", settings=HELIX),
    mill("mill_yasnac_mm", "yasnac", "Yasnac"),
    mill("mill_mitsubishi_mm", "mitsubishi", "Mitsubishi"),
    with_a("mm"),
    with_a("inch"),
    lathe("lathe_mm", "mm", SLIDE_AND_C),
    lathe("lathe_inch", "inch", SLIDE_AND_C),
    # 0.7 of the slide's acceleration, so that no direction on the face needs more of it.
    on_face("lathe_mm_kinematics", "mm", "", 707),
    on_face("lathe_inch_kinematics", "inch", "", 27.834645669291),
    on_face(
        "lathe_slow_c_mm_kinematics",
        "mm",
        "with a slow C axis, ",
        1060,
        slides=SLOW_C_MM,
        forms=FORMS_OF_LATHE[:3],
        overrides="1.5",
    ),
    spindle_c("mm"),
    spindle_c("inch"),
)

SCREENS = {
    "axis": (
        "DISPLAY = axis",
        "CYCLE_TIME = 0.1",
        "POSITION_OFFSET = RELATIVE",
        "POSITION_FEEDBACK = ACTUAL",
        "MAX_SPINDLE_OVERRIDE = 1.2",
        "TKPKG = Ngcgui 1.0",
        "NGCGUI_OPTIONS = noremove",
    ),
    "gmoccapy": (
        "DISPLAY = gmoccapy",
        "CYCLE_TIME = 0.1",
        "MIN_SPINDLE_0_OVERRIDE = 0.5",
        "MAX_SPINDLE_0_OVERRIDE = 1.2",
        "DEFAULT_SPINDLE_0_SPEED = 3000",
        "MIN_SPINDLE_0_SPEED = 100",
        "MAX_SPINDLE_0_SPEED = 6000",
        "MIN_LINEAR_VELOCITY = 1",
        "DEFAULT_LINEAR_VELOCITY = 50",
        "MAX_LINEAR_VELOCITY = 250",
        "# Forms are behind its button for user tabs.",
        "EMBED_TAB_NAME = Forms",
        "EMBED_TAB_LOCATION = ntb_user_tabs",
        "EMBED_TAB_COMMAND = gladevcp -x {XID} ../include/forms.ui",
    ),
    "headless": (
        "# Runs OPEN_FILE, or the program named on LinuxCNC's command line.",
        "DISPLAY = ../../python/g12/tools/headless/screen.py",
    ),
}
ON_SCREEN = {
    "axis": "on the AXIS screen",
    "gmoccapy": "on the gmoccapy screen",
    "headless": "without a screen",
}
NOTE = "# Whole: copy it. (In the package it is generated, by .ci/sims.py.)"
SUFFIXES = {"axis": "", "gmoccapy": "_gmoccapy", "headless": "_headless"}
SPINDLE_C = """\
JOINT = 2
TURNS = spindle-turns
RPS = spindle-rps
INDEX = spindle-index
REACHED = spindle-reached
ENABLED = sc-enabled
HOMED = sc-homed
HOMING = sc-homing
ORIENT = sc-orienting
ANGLE = sc-c-angle
COMMAND = sc-c-command
PLACE = sc-c-position
SPEED = sc-speed-out
ON = sc-started
BRAKE = sc-brake-requested
VELOCITY_SCALE = 1
POSITION_SCALE = 1
TOLERANCE = 0.02
ORIENT_SPEED = 1
ORIENT_ACCELERATION = 4
INDEX_SPEED = 0.5
TIMEOUT = 30
""".splitlines()

Section = tuple[str, list[str]]


def sections(machine: Machine, screen: str) -> Iterator[Section]:
    yield "EMC", ["VERSION = 1.1", f"MACHINE = {machine.name}"]
    yield "DISPLAY", display(machine, screen)
    yield "FILTER", filters(machine)
    yield "RS274NGC", interpreter(machine)
    yield "PYTHON", ["TOPLEVEL = ../../python/toplevel.py", "PATH_PREPEND = ../../python"]
    if machine.settings:
        yield "G12", [*machine.settings]
    yield "TASK", ["TASK = milltask", "CYCLE_TIME = 0.001"]
    yield "EMCMOT", ["EMCMOT = motmod", "COMM_TIMEOUT = 1.0", "SERVO_PERIOD = 1000000"]
    yield "HAL", hal(machine)
    if machine.spindle_c:
        yield "SPINDLE_C", SPINDLE_C
    yield "EMCIO", ["EMCIO = io", "CYCLE_TIME = 0.01", f"TOOL_TABLE = {machine.table}.tbl"]
    yield from axes(machine)


CYCLES = "../../python/g12/tools/cycles_page/gtk_view.py ../include/cycles.ui"
CYCLES_COMMAND = f"EMBED_TAB_COMMAND = gladevcp -x {{XID}} -u {CYCLES}"
FACE_VIEW = "USER_COMMAND_FILE = ../include/axis_face.py"


def display(machine: Machine, screen: str) -> list[str]:
    lines = [*SCREENS[screen], "PROGRAM_PREFIX = ../../tests/programs"]
    lines.append(f"OPEN_FILE = samples/{machine.sample or machine.name}.ngc")
    if screen != "headless" or machine.overrides != "2.0":
        lines.append(f"MAX_FEED_OVERRIDE = {machine.overrides}")
    turn = machine.slides[-1].letter
    if turn in ROTARY:
        lines.append(f"# The preview turns the toolpath by {turn}, as it lies on the part.")
        lines.append(f"GEOMETRY = {turn}{''.join(moving_axes(machine)[:-1])}!")
        lines.append("MAX_ANGULAR_VELOCITY = 90")
    if screen == "axis" and turn == "C" and machine.face is None:
        lines += ["LATHE = 1", "# The key V shows the face too.", FACE_VIEW]
    if screen != "headless":
        place = ["EMBED_TAB_LOCATION = ntb_user_tabs"] if screen == "gmoccapy" else []
        lines += ["EMBED_TAB_NAME = Cycles", *place, CYCLES_COMMAND]
        lines += [f"NGCGUI_SUBFILE = form_{form}_{machine.unit}.ngc" for form in machine.forms]
    return lines


def filters(machine: Machine) -> list[str]:
    kinds = [(*PROGRAMS[machine.control], f"translate --control {machine.control}")]
    if machine.slides[1].letter == "Y":
        kinds.append(("Dynapath circle mill events", ("dyn",), f"dynapath --units {machine.unit}"))
    shown, opened = [], []
    for what, names, command in kinds:
        endings = [ending for name in names for ending in (name, name.upper())]
        shown.append(f"PROGRAM_EXTENSION = {','.join(f'.{ending}' for ending in endings)} {what}")
        opened += [f"{ending} = {COMMAND} {command}" for ending in endings]
    return shown + opened


def interpreter(machine: Machine) -> list[str]:
    lines = [f"PARAMETER_FILE = {machine.name}.var", "SUBROUTINE_PATH = ../../ngc:subs"]
    for name in machine.codes:
        text = (CONFIGS / "include" / f"{name}.inc").read_text(encoding="utf-8")
        lines += [line for line in text.splitlines() if not line.startswith("#")]
    return [*dict.fromkeys(lines), *machine.remaps]  # each code's include has ON_ABORT_COMMAND


def hal(machine: Machine) -> list[str]:
    if machine.spindle_c:
        files = ["spindle_joints.hal", "../include/spindle_c.hal", "spindle_drive.hal"]
        more = ["HALCMD = loadusr sh ../include/spindle_c_limits.sh"]
    else:
        files, more = ["three_joints.hal", *["fourth_joint.hal"] * (len(machine.slides) - 3)], []
    if machine.face is not None:
        files.append("../kinematics/polar_kinematics.hal")
    return [f"HALFILE = {file}" for file in files] + more


def axes(machine: Machine) -> Iterator[Section]:
    letters = [slide.letter for slide in machine.slides]
    module = "trivkins" if machine.face is None else "polar_xzc"
    yield (
        "KINS",
        [f"JOINTS = {len(letters)}", f"KINEMATICS = {module} coordinates={''.join(letters)}"],
    )
    default, fastest = machine.velocities
    yield (
        "TRAJ",
        [
            f"COORDINATES = {' '.join(moving_axes(machine))}",
            f"LINEAR_UNITS = {machine.unit}",
            "ANGULAR_UNITS = degree",
            *(["SPINDLES = 2"] if machine.spindle_c else []),
            f"DEFAULT_LINEAR_VELOCITY = {default}",
            f"MAX_LINEAR_VELOCITY = {fastest}",
        ],
    )
    for number, slide in enumerate(machine.slides):
        yield from axes_of(machine, slide)
        yield (
            f"JOINT_{number}",
            [
                f"TYPE = {'ANGULAR' if slide.letter in ROTARY else 'LINEAR'}",
                *limits(slide),
                "FERROR = 10",
                "MIN_FERROR = 1",
                "HOME = 0",
                "HOME_SEQUENCE = 0",
            ],
        )


def moving_axes(machine: Machine) -> list[str]:
    """Return the letters of the axes; the kinematics of the face makes Y too."""
    letters = [slide.letter for slide in machine.slides]
    return letters if machine.face is None else ["X", "Y", *letters[1:]]


def axes_of(machine: Machine, slide: Slide) -> Iterator[Section]:
    """Yield the axis of a slide, or the two of the face that its slide moves together with C."""
    if slide.letter != "X" or machine.face is None:
        yield f"AXIS_{slide.letter}", limits(slide)
        return
    face = slide._replace(low=-slide.high, acceleration=machine.face)
    note = "# X and Y of the face; the slide's own limits are those of JOINT_0."
    yield "AXIS_X", [note, *limits(face)]
    yield "AXIS_Y", limits(face)


def limits(slide: Slide) -> list[str]:
    return [
        f"MIN_LIMIT = {slide.low}",
        f"MAX_LIMIT = {slide.high}",
        f"MAX_VELOCITY = {slide.velocity}",
        f"MAX_ACCELERATION = {slide.acceleration}",
    ]


def texts() -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each INI."""
    for machine in MACHINES:
        for screen in machine.screens:
            blocks = [f"# Simulated {machine.what}, {ON_SCREEN[screen]}.\n{NOTE}"]
            for name, lines in sections(machine, screen):
                blocks.append("\n".join([f"[{name}]", *lines]))
            yield f"{machine.name}{SUFFIXES[screen]}.ini", "\n\n".join(blocks) + "\n"


if __name__ == "__main__":
    for name, text in texts():
        (CONFIGS / "sim" / name).write_text(text, encoding="utf-8")
